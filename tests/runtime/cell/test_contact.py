"""What the tool feels, by way of an arm that presses, slides and searches as a real one does."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest

from runtime.cell import Contact, Thread

INSERTIONS = [
    ("hubcover-1", "case-1"),
    ("input-1", "case-1"),
    ("transfer-1", "case-1"),
    ("bearing-1", "input-1"),
]


def test_with_an_empty_hand_or_a_part_that_fits_nowhere_far_away_there_is_no_contact(bench):
    bench.move(0.5, 0.2, 0.1)
    assert bench.world.contact() is None
    bench.world.place("input-1", 0.95, 0.0)  # the bearing's only seat is out of the way
    bench.pick("bearing-1")
    bench.world.insert("bearing-2", "input-1")
    bench.world.insert("casingtop-1", "case-1")
    bench.move(0.4, 0.1, 0.45)
    bench.move(0.4, 0.1, 0.45)
    contact = bench.world.contact()
    assert contact is None or contact.height_at(0.4, 0.1) is None


def test_on_the_table_a_part_is_felt_where_it_stands(bench):
    bench.grip("hubcover-1")
    contact = bench.world.contact()
    assert contact is not None
    x, y, z = bench.place
    assert contact.height_at(x, y) == pytest.approx(z, abs=1e-5)
    assert np.ptp(contact.heights) == 0


def test_what_the_arm_will_come_down_into_is_told_as_soon_as_it_holds_the_part(bench):
    """An arm on a fast clock may be down before the cell looks again."""
    bench.pick("input-1")
    bench.move(0.35, 0.1, 0.3)
    contact = bench.world.contact()
    assert contact is not None
    x, y, z = bench.seat("input-1", "case-1")
    grasp = bench.world.parts["input-1"].model.grasp_height_m
    assert contact.height_at(x, y) == pytest.approx(z + grasp, abs=1e-5)
    for height in (0.3, 0.25, z + grasp + 0.01, z + grasp):
        bench.move(x + 0.002, y - 0.001, height)
        assert bench.world.contact() is contact


def test_hovering_over_the_table_the_place_below_is_told(bench):
    bench.pick("input-1")
    bench.move(0.3, 0.0, 0.25)
    bench.move()
    assert bench.world.contact().height_at(0.3, 0.0) == pytest.approx(0.035)


def test_the_field_over_a_seat_is_a_hole_with_a_broken_edge(bench):
    bench.pick("hubcover-1")
    x, y, z = bench.seat("hubcover-1", "case-1")
    bench.move(x, y, z + 0.05)
    bench.move()
    contact = bench.world.contact()
    above = bench.world.parts["hubcover-1"].model.grasp_height_m
    profile = [contact.height_at(x + aside, y) - above - z for aside in np.arange(0, 8e-3, 5e-4)]
    assert profile[0] == pytest.approx(0, abs=1e-5)
    assert profile[1] == pytest.approx(0, abs=1e-5)  # 0.5 mm aside, within the play
    assert profile[2] == pytest.approx(0.00045, abs=1e-5)  # the foot of the wall
    # On the edge, 45 degrees, up to the floor of the case, 4 mm above the seat.
    assert profile[3] == pytest.approx(0.0019, abs=1e-5)
    assert profile[4] == pytest.approx(0.0024, abs=1e-5)
    assert profile[8:] == pytest.approx([0.004] * 8, abs=1e-5)


@pytest.mark.parametrize(("name", "into"), INSERTIONS)
@pytest.mark.parametrize("aside", [(0.0, 0.0), (0.003, -0.002), (-0.002, 0.004)])
def test_pressing_and_searching_every_part_finds_its_seat(bench, name, into, aside):
    assert bench.pick(name)
    assert bench.push_in(name, into, aside) < 3e-4
    part = bench.world.parts[name]
    assert (part.parent, part.seated) == (into, True)
    assert part.position == pytest.approx(tuple(bench.seat(name, into)))


def test_the_lid_finds_its_dowels_while_the_case_is_held(bench):
    assert bench.pick("casingtop-1")
    bench.world.arrangement.pinned = frozenset({"case-1"})
    assert bench.push_in("casingtop-1", "case-1", (0.003, 0.003)) < 3e-4
    assert bench.world.parts["casingtop-1"].seated


def test_a_wall_beside_the_seat_is_in_the_field(bench):
    bench.pick("input-1")
    x, y, z = bench.seat("input-1", "case-1")
    bench.move(x - 0.004, y, z + 0.08)
    bench.move()
    contact = bench.world.contact()
    above = bench.world.parts["input-1"].model.grasp_height_m
    wall = (
        bench.world.parts["case-1"].position[2]
        + 0.035
        + bench.world.parts["input-1"].model.size[2] / 2
    )
    assert contact.height_at(x - 0.005, y) == pytest.approx(wall + above, abs=1e-5)


def test_the_lid_does_not_go_in_turned_by_a_quarter(bench):
    bench.pick("casingtop-1")
    x, y, z = bench.seat("casingtop-1", "case-1")
    bench.move(x, y, z + 0.06, yaw=math.pi / 2)
    bench.move()
    assert np.min(bench.world.contact().heights) > z + 0.01


def test_the_same_field_is_given_until_something_changes(bench):
    bench.pick("hubcover-1")
    x, y, z = bench.seat("hubcover-1", "case-1")
    bench.move(x, y, z + 0.05)
    bench.move()
    first = bench.world.contact()
    bench.move(x + 0.004, y, z + 0.02)
    assert bench.world.contact() is first
    bench.world.place("bearing-1", x, y)
    bench.move()
    blocked = bench.world.contact()
    assert blocked is not first
    assert np.min(blocked.heights) > np.min(first.heights) + 0.01


def test_as_a_request_it_is_json_with_the_names_the_bench_knows():
    thread = Thread((0.1, 0.2), 0.05, 0.0015, 4, 0.5, -1.0, jam_at_rad=2.0)
    contact = Contact((0.0, 0.1), 0.0005, ((0.1, 0.2), (0.3, 0.4)), 20000.0, thread)
    sent = json.loads(json.dumps(contact.request()))
    assert sent == {
        "origin": [0.0, 0.1],
        "step_m": 0.0005,
        "heights": [[0.1, 0.2], [0.3, 0.4]],
        "stiffness_n_m": 20000.0,
        "thread": {
            "axis": [0.1, 0.2],
            "top_z": 0.05,
            "pitch_m": 0.0015,
            "turns": 4,
            "turned_rad": 0.5,
            "at_yaw_rad": -1.0,
            "friction_nm": 0.25,
            "jam_at_rad": 2.0,
        },
    }


def test_between_heights_it_is_bilinear_and_outside_there_is_nothing():
    heights = ((0.0, 1.0, 0.0), (2.0, 3.0, 0.0), (0.0, 0.0, 0.0))
    contact = Contact((0.0, 0.0), 0.5, heights, 100.0)
    assert contact.height_at(0.25, 0.25) == pytest.approx(1.5)
    assert contact.height_at(0.5, 0.0) == pytest.approx(2.0)
    assert contact.height_at(-0.01, 0.0) is None
    assert contact.height_at(0.3, 1.2) is None
    assert contact.press_n(0.3, 1.2, 0.0) is None


def test_on_a_slope_only_part_of_the_push_goes_up():
    flat = Contact((0.0, 0.0), 1.0, ((1.0, 1.0), (1.0, 1.0)), 100.0)
    slope = Contact((0.0, 0.0), 1.0, ((0.0, 0.0), (2.0, 2.0)), 100.0)
    assert flat.press_n(0.5, 0.5, 0.9) == pytest.approx(10.0)
    assert slope.press_n(0.5, 0.5, 0.9) == pytest.approx(10.0 / 5)
    assert slope.press_n(0.5, 0.5, 1.1) == 0.0
