from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from runtime.drivers.ur_connection import pose_error
from runtime.drivers.ur_dashboard import check_version
from runtime.errors import ControllerError


@pytest.mark.parametrize(
    ("text", "version"),
    [("3.15.8.106339", (3, 15)), ("PolyscopeVersion: 3.9.1.64192", (3, 9)), ("5.17.0", (5, 17))],
)
def test_controllers_that_the_client_can_drive_are_let_in(text, version):
    assert check_version(text) == version


@pytest.mark.parametrize("text", ["3.2.0.1", "3.8.9", "5.0.1.2", "5.3.0", "5.5.1", "10.7.0"])
def test_controllers_on_which_the_client_hangs_or_crashes_are_refused(text):
    with pytest.raises(ControllerError, match=r"not supported \(supported: 3\.9 to 3\.15 and"):
        check_version(text)


def test_a_controller_without_a_version_is_refused():
    with pytest.raises(ControllerError, match="does not tell its version"):
        check_version("hello")


def test_a_rotation_vector_and_its_negative_near_a_half_turn_are_one_orientation():
    half = math.pi / math.sqrt(2)
    distance, angle = pose_error(
        (0.4, 0.1, 0.2, half, half, 0.0), (0.4, 0.1, 0.203, -half, -half, 0.0)
    )
    assert distance == pytest.approx(0.003)
    assert angle == pytest.approx(0.0, abs=1e-6)


@given(st.floats(-3.0, 3.0))
def test_the_angle_between_poses_is_the_turn_between_them(turn):
    distance, angle = pose_error((0.0,) * 6, (0.0, 0.0, 0.0, 0.0, 0.0, turn))
    assert distance == 0.0
    assert angle == pytest.approx(abs(turn), abs=1e-6)
