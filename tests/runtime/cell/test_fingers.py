"""Which part the closing fingers reach, and how far they push it."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from runtime.cell.arrangement import PlacedPart
from runtime.cell.fingers import between_fingers, pushed_aside
from runtime.kinematics import matrix_to_pose, pose_to_matrix
from runtime.parts import load_parts

BEARING = load_parts()["bearing"]


def at(x, y, z, *, down=False):
    pose = np.diag([1.0, -1.0, -1.0, 1.0]) if down else np.eye(4)
    pose[:3, 3] = x, y, z
    return pose


@pytest.mark.parametrize(
    ("aside", "reached"),
    [
        ((0.0, 0.0, 0.0), True),
        ((0.011, 0.0, 0.0), True),
        ((0.013, 0.0, 0.0), False),
        ((0.0, 0.024, 0.0), True),
        ((0.0, 0.025, 0.0), False),
        ((0.0, 0.0, 0.014), True),
        ((0.0, 0.0, -0.016), False),
    ],
)
def test_a_part_is_reached_from_close_enough(aside, reached):
    part = PlacedPart("bearing-1", BEARING, at(0.4, 0.1, 0.01))
    x, y, z = np.add((0.4, 0.1, 0.01 + BEARING.grasp_height_m), aside)
    found = between_fingers(part, at(x, y, z, down=True), 0.012, 0.015)
    assert (found is not None) == reached
    if found is not None:
        assert abs(found) == pytest.approx(abs(aside[0]))


def test_a_tool_that_does_not_point_down_reaches_nothing():
    part = PlacedPart("bearing-1", BEARING, at(0.4, 0.1, 0.01))
    assert between_fingers(part, at(0.4, 0.1, 0.01 + BEARING.grasp_height_m), 0.012, 0.015) is None


@given(aside=st.floats(-0.02, 0.02), room=st.floats(0.0, 0.03), yaw=st.floats(-3.0, 3.0))
def test_a_part_is_pushed_to_the_middle_or_as_far_as_there_is_room(aside, room, yaw):
    tcp = at(0.4, 0.1, 0.02, down=True) @ pose_to_matrix((0, 0, 0, 0, 0, yaw))
    stands = tcp @ at(0.0, aside, 0.0)
    pose = at(*matrix_to_pose(stands)[:3])

    def heights(places):
        went = np.hypot(*(places - pose[:2, 3]).T)
        return np.where(went <= room, pose[2, 3], pose[2, 3] + 0.01)

    left = pushed_aside(pose, tcp, aside, heights)
    went = abs(aside - left)
    assert went <= room + 1e-9
    assert abs(left) <= abs(aside)
    assert left == 0.0 or left * aside > 0
    if room >= abs(aside) + 1e-9:
        assert left == pytest.approx(0.0, abs=1e-12)
    else:
        assert went >= room - 0.0005 - 1e-9
