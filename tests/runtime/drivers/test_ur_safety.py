from __future__ import annotations

import pytest

from runtime.drivers.ur_safety import SAFE, status_in_words, stop_in_words


@pytest.mark.parametrize("mode", SAFE)
def test_nothing_stops_an_arm_in_a_safe_mode(mode):
    assert stop_in_words(mode) == ""


@pytest.mark.parametrize("name", ["NORMAL", "REDUCED"])
def test_the_dashboard_says_the_same(name):
    assert status_in_words(name) == ""


@pytest.mark.parametrize(
    ("mode", "name", "to_do"),
    [
        (3, "PROTECTIVE_STOP", "find its cause, wait 5 s, unlock it"),
        (4, "RECOVERY", "move the arm back within its limits"),
        (5, "SAFEGUARD_STOP", "reset the safeguard"),
        (6, "SYSTEM_EMERGENCY_STOP", "release the button, power the arm on"),
        (7, "ROBOT_EMERGENCY_STOP", "release the button, power the arm on"),
        (8, "VIOLATION", "restart the safety system"),
        (9, "FAULT", "restart the safety system"),
    ],
)
def test_every_stop_says_what_a_person_must_do(mode, name, to_do):
    assert to_do in stop_in_words(mode)
    assert status_in_words(name) == stop_in_words(mode)


def test_a_mode_nobody_has_heard_of_stops_the_arm_too():
    assert stop_in_words(42) == "safety mode 42: see the teach pendant"
    assert status_in_words("DREAMING") == "safety mode DREAMING: see the teach pendant"
    assert "safeguard stop" in status_in_words("AUTOMATIC_MODE_SAFEGUARD_STOP")
