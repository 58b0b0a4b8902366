from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from runtime.controller.contact import ContactError, Surface, Thread, parse_contact

FLAT = {"origin": [0.1, -0.2], "step_m": 0.01, "heights": [[0.3, 0.3], [0.3, 0.3]]}
FLOOR = {**FLAT, "stiffness_n_m": 20000}
THREAD = {
    "axis": [0.4, 0.0],
    "top_z": 0.1,
    "pitch_m": 0.0015,
    "turns": 4,
    "turned_rad": 0.5,
    "at_yaw_rad": -1.0,
    "friction_nm": 0.2,
    "jam_at_rad": None,
}


def test_the_bench_s_example_is_read():
    contact = parse_contact({**FLOOR, "thread": THREAD})
    assert contact is not None
    assert contact.surface.under(0.105, -0.195).height == pytest.approx(0.3)
    assert contact.thread.end_rad == pytest.approx(8 * math.pi)
    assert parse_contact({**FLOOR, "thread": None}).thread is None
    assert parse_contact(FLOOR).thread is None
    assert parse_contact(None) is None


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"origin": [1]}, '"origin" takes a list of two numbers'),
        ({"step_m": 0}, '"step_m" must be greater than 0'),
        ({"step_m": -1}, '"step_m" is -1, but must be from 0 to 100'),
        ({"heights": [[1, 2], [3]]}, '"heights" takes a list of at least two rows'),
        ({"heights": [[1, 2]]}, '"heights" takes a list of at least two rows'),
        ({"heights": [[1, 2], [3, "x"]]}, "\"heights\" takes numbers, not 'x'"),
        ({"heights": [[1, 2], [3, float("nan")]]}, '"heights" is nan, but must be from'),
        ({"stiffness_n_m": True}, '"stiffness_n_m" takes numbers, not True'),
        ({"colour": 1}, '"contact" has no key "colour"; it has origin, step_m'),
        ({"thread": 7}, '"thread" takes an object or null, not 7'),
        ({"thread": {**THREAD, "turns": 0}}, '"turns" must be greater than 0'),
        ({"thread": {**THREAD, "pitch": 0}}, '"thread" has no key "pitch"'),
        ({"thread": {"axis": [0, 0]}}, '"thread" lacks "top_z"'),
    ],
)
def test_what_is_no_contact_is_refused_with_what_it_should_be(change, words):
    with pytest.raises(ContactError) as refused:
        parse_contact({**FLOOR, **change})
    assert words in str(refused.value)


def test_what_is_missing_or_no_object_is_named():
    with pytest.raises(ContactError, match='"contact" lacks "stiffness_n_m"'):
        parse_contact(FLAT)
    with pytest.raises(ContactError, match='"contact" takes an object or null'):
        parse_contact([1])


_HEIGHTS = st.tuples(*[st.tuples(*[st.floats(-0.1, 0.1)] * 4)] * 3)


@given(_HEIGHTS, st.floats(0, 2), st.floats(0, 3))
def test_the_surface_goes_through_its_heights_and_its_slopes_are_its_derivatives(heights, u, v):
    surface = Surface((0.0, 0.0), 1.0, heights, 1.0)
    for i, row in enumerate(heights):
        for j, height in enumerate(row):
            assert surface.under(float(i), float(j)).height == pytest.approx(height, abs=1e-12)
    here = surface.under(u, v)
    # Within a cell it is linear along either axis.
    x = math.floor(min(u, 1.999)) + 0.5
    along = surface.under(x, v)
    assert here.height == pytest.approx(along.height + (u - x) * along.slope_x, abs=1e-9)
    y = math.floor(min(v, 2.999)) + 0.5
    across = surface.under(u, y)
    assert here.height == pytest.approx(across.height + (v - y) * across.slope_y, abs=1e-9)


@pytest.mark.parametrize("at", [(-0.001, 0.5), (0.5, 1.001), (5, 5), (math.nan, 0)])
def test_outside_of_the_grid_there_is_nothing(at):
    surface = Surface((0.0, 0.0), 1.0, ((1.0, 1.0), (1.0, 1.0)), 1.0)
    assert surface.under(*at) is None


def test_the_floor_of_a_place_is_the_lowest_height_close_by():
    heights = tuple(tuple(-0.02 if (i, j) == (5, 5) else 0.0 for j in range(11)) for i in range(11))
    surface = Surface((0.0, 0.0), 0.001, heights, 1.0)
    assert surface.floor(0.005, 0.005) == -0.02
    assert surface.floor(0.0055, 0.0045) == -0.02
    assert surface.floor(0.001, 0.001) == 0.0
    assert surface.floor(1.0, 1.0) is None


def test_a_thread_goes_down_by_its_pitch_for_each_turn_and_no_further_than_its_ends():
    thread = Thread((0.4, 0.0), 0.1, 0.0015, 4, 0.0, 0.0, 0.2, None)
    assert thread.height(0.0) == 0.1
    assert thread.height(2 * math.pi) == pytest.approx(0.1 - 0.0015)
    assert thread.height(-1.0) == 0.1
    assert thread.height(100.0) == pytest.approx(0.1 - 4 * 0.0015)
    assert Thread((0.4, 0.0), 0.1, 0.0015, 4, 0.0, 0.0, 0.2, 3.0).end_rad == 3.0
    assert thread.is_under(0.4, 0.0029)
    assert not thread.is_under(0.4, 0.0031)
