from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from runtime.cell.arrangement import FIXTURE, PlacedPart
from runtime.cell.world import HandParameters, World
from runtime.errors import UsageError
from runtime.parts import GRIPPER_OPENING_M, PartModel, Primitive, load_parts

PARTS = load_parts()
PLATE = PartModel(
    FIXTURE, (Primitive("box", (0.2, 0.2, 0.006), (0, 0, 0), (0, 0, 0)),), (0.2, 0.2, 0.006), 0, 0.2
)


def at(x, y, z):
    pose = np.eye(4)
    pose[:3, 3] = x, y, z
    return pose


def tool(x, y, z, turn=0.0, tilt=0.0):
    """A tool centre point pointing down, its fingers closing along y."""
    c, s = math.cos(turn), math.sin(turn)
    yaw = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    lean = np.array(
        [[math.cos(tilt), 0, math.sin(tilt)], [0, 1, 0], [-math.sin(tilt), 0, math.cos(tilt)]]
    )
    pose = at(x, y, z)
    pose[:3, :3] = yaw @ lean @ np.diag([1.0, -1.0, -1.0])
    return pose


@pytest.fixture
def world():
    def standing(name, kind, x, y, bottom=0.0, parent=None):
        return PlacedPart(
            name, PARTS[kind], at(x, y, bottom + PARTS[kind].size[2] / 2), parent=parent
        )

    return World(
        [
            standing("case-1", "case", 0.5, 0.2, 0.006, FIXTURE),
            standing("hubcover-1", "hubcover", 0.4, 0.0),
            standing("input-1", "input", 0.4, -0.1),
            standing("bearing-1", "bearing", 0.3, -0.1),
            standing("casingtop-1", "casingtop", 0.5, -0.2),
        ],
        PlacedPart(FIXTURE, PLATE, at(0.5, 0.2, 0.003)),
    )


def grip(world, name, **turned):
    part = world.parts[name]
    x, y, z = part.position
    here = tool(x, y, z + part.model.grasp_height_m, **turned)
    world.step(here, closed=False)
    return world.step(here, closed=True)


def drop(world, x, y, z, **turned):
    """Open the hand with the held part's centre at x, y, z."""
    height = world.parts[world.held].model.grasp_height_m
    world.step(tool(x, y, z + height, **turned), closed=True)
    world.step(tool(x, y, z + height, **turned), closed=False)


def seat(world, name, into):
    part, receiver = world.parts[name], world.parts[into]
    offset = next(s.offset for s in part.model.seats if s.into == receiver.model.type)
    return np.add(receiver.position, offset)


def test_closing_on_nothing_grips_nothing(world):
    assert world.opening_m == GRIPPER_OPENING_M
    assert world.step(tool(0.3, 0.3, 0.1), closed=True) is False
    assert world.held is None
    assert world.opening_m == 0.0


def test_a_part_between_the_fingers_is_gripped_and_carried(world):
    assert grip(world, "hubcover-1")
    assert world.held == "hubcover-1"
    assert world.opening_m == PARTS["hubcover"].grip_width_m
    assert world.step(tool(0.35, 0.1, 0.3), closed=True)
    expected = (0.35, 0.1, 0.3 - PARTS["hubcover"].grasp_height_m)
    assert world.parts["hubcover-1"].position == pytest.approx(expected)


def test_fingers_already_closed_grip_nothing(world):
    world.step(tool(0.3, 0.3, 0.1), closed=True)
    x, y, z = world.parts["hubcover-1"].position
    assert not world.step(tool(x, y, z + 0.006), closed=True)


@pytest.mark.parametrize(
    ("dx", "dy", "dz", "gripped"),
    [
        (0.010, 0.0, 0.0, True),
        (0.014, 0.0, 0.0, False),  # past the fingers' plane
        (0.0, 0.026, 0.0, True),
        (0.0, 0.030, 0.0, False),  # a finger would come down on the boss
        (0.0, 0.0, 0.014, True),
        (0.0, 0.0, 0.017, False),  # closes above it
    ],
)
def test_the_hand_must_be_where_the_part_is(world, dx, dy, dz, gripped):
    x, y, z = world.parts["hubcover-1"].position
    here = tool(x + dx, y + dy, z + PARTS["hubcover"].grasp_height_m + dz)
    world.step(here, closed=False)
    assert world.step(here, closed=True) is gripped


def test_a_slanted_hand_and_a_wide_part_are_not_gripped(world):
    assert not grip(world, "hubcover-1", tilt=0.5)
    world.step(tool(0.3, 0.3, 0.2), closed=False)
    assert not grip(world, "case-1")


def test_the_part_centres_itself_along_the_closing_axis_only(world):
    x, y, z = world.parts["hubcover-1"].position
    here = tool(x + 0.006, y + 0.015, z + 0.01)
    world.step(here, closed=False)
    world.step(here, closed=True)
    assert world.parts["hubcover-1"].position == pytest.approx((x, y + 0.015, z))


def test_let_go_in_the_air_it_falls_to_the_table(world):
    grip(world, "hubcover-1")
    drop(world, 0.3, 0.1, 0.25)
    assert world.held is None
    part = world.parts["hubcover-1"]
    assert part.position == pytest.approx((0.3, 0.1, 0.012))
    assert (part.parent, part.seated) == (None, False)


@pytest.mark.parametrize(
    ("aside", "down", "seated"),
    [
        (0.0, -0.0006, True),
        (0.0007, -0.0012, True),  # at the foot of the wall
        (0.00055, -0.0005, True),  # against it: it tells less of the force than the depth
        (0.0020, -0.0006, False),  # still on the broken edge
        (0.0, 0.0010, False),  # nothing has pressed it in
        (0.0, 0.0030, False),
    ],
)
def test_where_it_is_let_go_decides_whether_it_is_seated(world, aside, down, seated):
    grip(world, "hubcover-1")
    target = seat(world, "hubcover-1", "case-1")
    drop(world, target[0] + aside, target[1], target[2] + down)
    part = world.parts["hubcover-1"]
    assert part.parent == "case-1"
    assert part.seated is seated
    if seated:
        assert part.position == pytest.approx(target)


def test_beside_its_seat_it_lies_on_the_floor_of_the_case(world):
    grip(world, "hubcover-1")
    target = seat(world, "hubcover-1", "case-1")
    drop(world, target[0] + 0.0085, target[1], target[2] + 0.005)
    part = world.parts["hubcover-1"]
    assert (part.parent, part.seated) == ("case-1", False)
    assert part.position[2] == pytest.approx(0.006 + 0.014 + 0.012)


def test_let_go_too_deep_it_is_not_seated(world):
    grip(world, "hubcover-1")
    x, y, z = seat(world, "hubcover-1", "case-1")
    drop(world, x, y, z - 0.012)
    assert not world.parts["hubcover-1"].seated


def test_a_lid_fits_only_the_right_way_round(world):
    x, y, z = seat(world, "casingtop-1", "case-1")
    world.arrangement.pinned = frozenset({"case-1"})
    grip(world, "casingtop-1")
    drop(world, x, y, z - 0.0015, turn=math.pi / 2)
    assert not world.parts["casingtop-1"].seated
    assert grip(world, "casingtop-1", turn=math.pi / 2)
    drop(world, x, y, z - 0.0015, turn=math.pi)
    assert world.parts["casingtop-1"].seated


def test_under_a_lid_nothing_can_be_seated(world):
    world.insert("casingtop-1", "case-1")
    grip(world, "hubcover-1")
    x, y, z = seat(world, "hubcover-1", "case-1")
    drop(world, x, y, z + 0.2)
    assert world.parts["hubcover-1"].parent == "casingtop-1"
    assert not world.parts["hubcover-1"].seated


def test_what_sits_in_a_part_moves_with_it(world):
    world.insert("bearing-1", "input-1")
    before = np.subtract(world.parts["bearing-1"].position, world.parts["input-1"].position)
    grip(world, "input-1", turn=0.3)
    x, y, z = seat(world, "input-1", "case-1")
    drop(world, x, y, z - 0.0006, turn=0.3)
    after = np.subtract(world.parts["bearing-1"].position, world.parts["input-1"].position)
    assert after == pytest.approx(before)
    assert world.parts["bearing-1"].parent == "input-1"
    assert world.parts["input-1"].parent == "case-1"


def test_a_seated_part_can_be_taken_out_again(world):
    world.insert("hubcover-1", "case-1")
    assert grip(world, "hubcover-1")
    assert world.parts["hubcover-1"].parent is None
    drop(world, 0.3, 0.1, 0.1)
    assert world.parts["hubcover-1"].position == pytest.approx((0.3, 0.1, 0.012))


def test_a_slanted_part_stands_upright_once_let_go(world):
    grip(world, "input-1")
    drop(world, 0.3, 0.1, 0.2, tilt=0.3)
    assert world.parts["input-1"].pose[:3, :3] == pytest.approx(np.eye(3))


def test_names_and_seats_that_are_not_there_are_refused(world):
    with pytest.raises(UsageError, match="No part is called 'gear'; there are case-1"):
        world.place("gear", 0, 0)
    with pytest.raises(UsageError, match="A hubcover has no seat in a bearing"):
        world.insert("hubcover-1", "bearing-1")


@given(
    st.lists(st.tuples(st.floats(0.25, 0.6), st.floats(-0.3, 0.3), st.floats(0, 0.3)), max_size=6)
)
@settings(max_examples=30, deadline=None, derandomize=True)
def test_wherever_the_hand_lets_go_parts_end_up_supported(places):
    # Built here: a hypothesis test must start from the same world each time.
    world = World(
        [
            PlacedPart("case-1", PARTS["case"], at(0.5, 0.2, 0.041), parent=FIXTURE),
            PlacedPart("hubcover-1", PARTS["hubcover"], at(0.4, 0.0, 0.012)),
            PlacedPart("casingtop-1", PARTS["casingtop"], at(0.5, -0.2, 0.03)),
        ],
        PlacedPart(FIXTURE, PLATE, at(0.5, 0.2, 0.003)),
        HandParameters(),
    )
    for x, y, z in places:
        assert grip(world, "hubcover-1")
        drop(world, x, y, z + 0.03)
        part = world.parts["hubcover-1"]
        assert part.position[2] >= 0.012 - 1e-9
        assert (part.parent is None) == (abs(part.position[2] - 0.012) < 1e-9)
        assert math.hypot(part.position[0] - x, part.position[1] - y) <= 0.008


def test_closing_fingers_push_a_part_to_their_middle_over_the_table(bench):
    x, y, z = bench.world.parts["input-1"].position
    grasp = bench.world.parts["input-1"].model.grasp_height_m
    bench.move(x, y + 0.008, z + grasp)
    assert bench.close()
    assert bench.world.parts["input-1"].position == pytest.approx((x, y + 0.008, z))


def test_closing_fingers_push_a_part_through_no_wall_of_its_seat(bench):
    bench.pick("input-1")
    bench.push_in("input-1", "case-1")
    assert bench.world.parts["input-1"].seated
    x, y, z = bench.world.parts["input-1"].position
    grasp = bench.world.parts["input-1"].model.grasp_height_m
    bench.move(x, y + 0.008, z + grasp)
    assert bench.close()
    moved = bench.world.parts["input-1"].position
    assert moved == pytest.approx((x, y, z), abs=1e-3)
    assert bench.world.contact().press_n(*bench.place) < 20.0


def test_closing_fingers_push_a_part_no_farther_than_to_its_neighbour(bench):
    first, second = bench.world.parts["bearing-1"], bench.world.parts["bearing-2"]
    x, y, z = first.position
    bench.world.place("bearing-2", x, y - first.model.size[1] - 0.004)
    bench.move(x, y - 0.01, z + first.model.grasp_height_m)
    assert bench.close()
    assert bench.world.held == "bearing-1"
    gap = bench.world.parts["bearing-1"].position[1] - bench.world.parts["bearing-2"].position[1]
    assert gap == pytest.approx(second.model.size[1], abs=6e-4)
    assert bench.world.contact().press_n(*bench.place) < 20.0
