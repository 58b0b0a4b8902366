from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aapa.camera import Camera

# Looking along +x of the base frame; right is -y and down is -z.
ROTATION = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
CAMERA = Camera(640, 480, 500.0, (0.5, 0.1, 0.3), ROTATION)


def test_what_lies_straight_ahead_is_in_the_middle():
    assert CAMERA.project((2.5, 0.1, 0.3)) == pytest.approx((320, 240, 2))


def test_right_is_right_and_up_is_up():
    u, v, depth = CAMERA.project((1.5, -0.1, 0.4))
    assert (u, v, depth) == pytest.approx((420, 190, 1))


def test_behind_has_a_negative_depth():
    assert CAMERA.project((0.0, 0.1, 0.3))[2] == pytest.approx(-0.5)


def test_the_optical_centre_itself_has_no_depth():
    assert CAMERA.project(CAMERA.position)[2] == 0.0


@given(st.floats(0, 640), st.floats(0, 480), st.floats(0.01, 10))
def test_projecting_undoes_projecting_back(u, v, depth):
    assert CAMERA.project(CAMERA.back_project(u, v, depth)) == pytest.approx(
        (u, v, depth), abs=1e-9
    )
