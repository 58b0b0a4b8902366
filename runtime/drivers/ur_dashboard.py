"""A UR controller's dashboard: what must be so before the client is let near the controller.

Also how a stopped arm is made fit to be driven again, at the operator's word. Lives in the worker
process only: the client's constructors hold the interpreter while they wait.
"""

from __future__ import annotations

import contextlib
import re
import time
from typing import Final

from dashboard_client import DashboardClient

from runtime.config import RobotConfig
from runtime.drivers.ur_safety import PROTECTIVE_STOP, status_in_words
from runtime.errors import ControllerError

SUPPORTED: Final = "3.9 to 3.15 and 5.6 or newer"

_CONNECT_MS: Final = 2000
_TRIES: Final = 3
_TIMED_OUT: Final = "Operation canceled"  # what the client says then
_UNLOCK_WITHIN_S: Final = 12.0  # a controller refuses in the first 5 s
_ASK_EVERY_S: Final = 0.5
_RELEASED_WITHIN_S: Final = 3.0


def check_version(text: str) -> tuple[int, int]:
    """Refuse controllers on which the client is known to hang or crash.

    Args:
        text: What the dashboard answers to `PolyscopeVersion`.

    Returns:
        Major and minor version.

    Raises:
        ControllerError: Names the version and those that are supported.
    """
    match = re.search(r"(\d+)\.(\d+)", text)
    if match is None:
        raise ControllerError(f"the controller does not tell its version (it says {text!r})")
    major, minor = int(match[1]), int(match[2])
    if not ((major == 3 and 9 <= minor <= 15) or (major == 5 and minor >= 6)):
        raise ControllerError(
            f"PolyScope {major}.{minor} is not supported (supported: {SUPPORTED}); "
            "update the controller"
        )
    return major, minor


def check_controller(address: str, config: RobotConfig) -> str:
    """Ask version, model and power; give the version.

    Raises:
        ControllerError: Nobody answers, or the controller is not fit; says what to do.
    """
    dashboard = _dial(address)
    try:
        version = dashboard.polyscopeVersion()
        mode = dashboard.robotmode()
    except RuntimeError as error:
        raise ControllerError(_no_answer(address, error)) from None
    major, _ = check_version(version)
    if "RUNNING" not in mode.upper():
        raise ControllerError(
            f"{address}: the arm is not running ({_value(mode)}); power it on and release its "
            "brakes on the teach pendant"
        )
    model = ""
    with contextlib.suppress(RuntimeError):  # older controllers do not tell their model
        model = dashboard.getRobotModel().strip().lower()
    # Controllers of the e-Series leave the e out.
    if model.startswith("ur") and model.rstrip("e") != config.model.rstrip("e"):
        raise ControllerError(
            f"{address}: model: this is a {model.upper()}, the configuration is for a "
            f"{config.model}; give the configuration of this arm (--robot)"
        )
    if (major >= 5) != config.model.endswith("e"):
        series = "an e-Series" if major >= 5 else "a CB3"
        raise ControllerError(
            f"{address}: model: this is {series} controller (PolyScope {_value(version)}), the "
            f"configuration is for a {config.model}; give the configuration of this arm (--robot)"
        )
    if major >= 5 and not _is_remote(dashboard):
        raise ControllerError(
            f"{address}: the controller is in local control; switch it to remote control on the "
            "teach pendant (the icon at the upper right)"
        )
    dashboard.disconnect()
    return str(version)


def end_program(address: str) -> None:
    """End the program on the controller without the client's control connection, if it listens.

    After a protective stop a program is only paused: "play" on the pendant would go on with the
    interrupted move.
    """
    with contextlib.suppress(RuntimeError):
        dashboard = DashboardClient(address)
        dashboard.connect(500)
        dashboard.stop()


def release(address: str) -> str:
    """Make a stopped arm fit to be driven again: the operator has looked, and gave the word.

    The interrupted program is ended before the stop is released, so that its move cannot go on;
    nothing is ever played.

    Returns:
        What was done, as a clause; empty if nothing had to be.

    Raises:
        ControllerError: A person has to do something first; says what.
    """
    dashboard = _dial(address)
    try:
        _stop(dashboard)
        status = _safety(dashboard)
        if status == PROTECTIVE_STOP:
            _unlock(dashboard, address)
            with contextlib.suppress(RuntimeError):  # unknown to the older ones
                dashboard.closeSafetyPopup()
            done = "the protective stop was unlocked"
        elif words := status_in_words(status):
            raise ControllerError(f"{address}: the arm is in {words}")
        else:
            done = ""
        _stop(dashboard)
        dashboard.disconnect()
    except RuntimeError as error:
        raise ControllerError(_no_answer(address, error)) from None
    return done


def _dial(address: str) -> DashboardClient:
    """Connect; a controller that is busy, or just coming up, gets more than one chance."""
    for left in reversed(range(_TRIES)):
        dashboard = DashboardClient(address)
        try:
            dashboard.connect(_CONNECT_MS)
        except RuntimeError as error:
            if left and _TIMED_OUT in str(error):
                continue
            raise ControllerError(_no_answer(address, error)) from None
        return dashboard
    raise AssertionError("the last try returns or raises")


def _stop(dashboard: DashboardClient) -> None:
    with contextlib.suppress(RuntimeError):  # some refuse when no program is there to be ended
        dashboard.stop()


def _unlock(dashboard: DashboardClient, address: str) -> None:
    deadline = time.monotonic() + _UNLOCK_WITHIN_S
    while True:
        try:
            dashboard.unlockProtectiveStop()
        except RuntimeError as error:
            if time.monotonic() > deadline:
                raise ControllerError(
                    f"{address}: the protective stop cannot be unlocked ({error}); unlock it on "
                    "the teach pendant"
                ) from None
            time.sleep(_ASK_EVERY_S)
        else:
            break
    deadline = time.monotonic() + _RELEASED_WITHIN_S
    while (status := _safety(dashboard)) == PROTECTIVE_STOP:
        if time.monotonic() > deadline:
            raise ControllerError(
                f"{address}: the arm is still in {status_in_words(status)}, its cause persists"
            )
        time.sleep(_ASK_EVERY_S / 10)
    if words := status_in_words(status):
        raise ControllerError(f"{address}: the arm is in {words}")


def _safety(dashboard: DashboardClient) -> str:
    """Give the safety mode's name; older controllers know only one of the two questions."""
    try:
        text = str(dashboard.safetymode())
    except RuntimeError:
        text = str(dashboard.safetystatus())
    return _value(text).upper()


def _is_remote(dashboard: DashboardClient) -> bool:
    try:
        return bool(dashboard.isInRemoteControl())
    except RuntimeError:
        return True  # it does not know the question, so there is no such switch


def _value(answer: str) -> str:
    return answer.rpartition(":")[2].strip()


def _no_answer(address: str, error: Exception) -> str:
    return (
        f"{address}: no answer from a UR controller's dashboard (port 29999): {error}. "
        "See that address and network are right and the controller is on"
    )
