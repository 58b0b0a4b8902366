from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from runtime.cell.body import FORE_M, LIMBS, REST, SHOULDER, UPPER_M, body_at

places = st.tuples(st.floats(0.2, 0.95), st.floats(-0.4, 0.45), st.floats(0.0, 0.4))


@given(places)
@settings(max_examples=80, deadline=None, derandomize=True)
def test_the_limbs_hang_together_wherever_the_hand_is(place):
    body = body_at(place)
    assert len(body.poses) == len(LIMBS)
    for pose in body.poses:
        assert pose[:3, :3].T @ pose[:3, :3] == pytest.approx(np.eye(3), abs=1e-9)
        assert np.linalg.det(pose[:3, :3]) == pytest.approx(1.0)
    assert body.hand[:3, 3] == pytest.approx(place)
    elbow = body.upper[:3, 3] + UPPER_M * body.upper[:3, 2]
    assert elbow == pytest.approx(body.fore[:3, 3], abs=1e-6)
    wrist = body.fore[:3, 3] + FORE_M * body.fore[:3, 2]
    assert math.dist(wrist, place) == pytest.approx(0.075, abs=1e-6)


def test_somebody_upright_does_not_lean_and_far_places_make_them():
    assert body_at(REST).upper[:3, 3] == pytest.approx(SHOULDER)
    assert body_at((0.3, -0.2, 0.05)).upper[0, 3] < SHOULDER[0] - 0.1


def test_elbows_hang_below_the_line_from_shoulder_to_wrist():
    body = body_at(REST)
    wrist = body.fore[:3, 3] + FORE_M * body.fore[:3, 2]
    assert body.fore[2, 3] < (body.upper[2, 3] + wrist[2]) / 2
