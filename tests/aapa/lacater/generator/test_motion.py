from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aapa.lacater.generator.motion import LIFT, eased, pick_place, slide, turn


def test_a_planned_slide_is_even():
    assert slide(5).planned.travel.tolist() == [0, 0.25, 0.5, 0.75, 1]
    assert slide(5).planned.lift.tolist() == [0] * 5


def test_a_planned_pick_and_place_goes_up_across_and_down():
    # 20 frames: up during 0…4, across 5…16, down 17…19.
    profile = pick_place(20).planned
    assert profile.lift[:5].tolist() == [0, 0.25, 0.5, 0.75, 1]
    assert (profile.lift[4:18] == 1).all()
    assert profile.lift[17:] == pytest.approx([1, 0.5, 0])
    assert (profile.travel[:6] == 0).all()
    assert profile.travel[5:17] == pytest.approx(np.arange(12) / 11)
    assert (profile.travel[16:] == 1).all()


def test_a_path_goes_from_origin_to_target_and_lifts():
    origin, target = np.array([1.0, 2.0, 0.5]), np.array([-1.0, 0.0, 0.5])
    path = pick_place(25).planned.path(origin, target)
    assert path.shape == (25, 3)
    assert path[0] == pytest.approx(origin)
    assert path[-1] == pytest.approx(target)
    assert path[:, 2].max() == pytest.approx(0.5 + LIFT)
    assert origin.tolist() == [1.0, 2.0, 0.5]


@given(st.floats(0, 1))
def test_easing_is_symmetric_and_near_a_smoothstep(share):
    value, mirrored = eased(np.array([share, 1 - share]))
    assert value + mirrored == pytest.approx(1, abs=1e-9)
    assert abs(value - (3 * share**2 - 2 * share**3)) < 0.021


def test_easing_solves_the_curve():
    parameter = np.linspace(0, 1, 50)
    rest, handle = 1 - parameter, 1 / 2.5614
    time = 3 * rest**2 * parameter * handle + 3 * rest * parameter**2 * (1 - handle) + parameter**3
    assert eased(time) == pytest.approx(3 * parameter**2 - 2 * parameter**3, abs=1e-9)


@pytest.mark.parametrize("frames", range(21, 32))
def test_every_filmed_move_starts_and_ends_at_rest(frames):
    for way in (slide(frames), pick_place(frames)):
        travel = way.filmed.travel
        assert (travel[0], travel[-1]) == (0, pytest.approx(1))
        assert (np.diff(travel) >= -1e-12).all()
        assert travel[1] - travel[0] < 0.02
        assert way.filmed.lift[[0, -1]] == pytest.approx([0, 0])
    assert turn(frames)[[0, -1]] == pytest.approx([0, 1])
    assert pick_place(frames).filmed.lift.max() == 1
