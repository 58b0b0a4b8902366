"""What stops a UR arm, and what a person must do about it: the safety modes in words.

Source: Universal Robots, "Remote Control Via TCP/IP", `safety_mode` of the state stream;
"Dashboard Server", `safetymode` and `safetystatus`.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

SAFE: Final = (1, 2)
"""Safety modes in which the arm may move: normal, reduced."""

ONLY_ON_YOUR_WORD: Final = (
    "; then let the run go on with --recover, or start it again: nothing is recovered without "
    "your word"
)
"""What stands at the end of each reason for which the arm cannot be driven any more."""

PROTECTIVE_STOP: Final = "PROTECTIVE_STOP"
"""The only stop that is released from here, and only at the operator's word."""

_EMERGENCY: Final = (
    "an emergency stop: clear the danger, release the button, power the arm on and release its "
    "brakes on the teach pendant"
)
_SAFEGUARD: Final = "a safeguard stop: clear the safeguarded space and reset the safeguard"

_MODES: Final[Mapping[int, tuple[str, str]]] = MappingProxyType(
    {
        1: ("NORMAL", ""),
        2: ("REDUCED", ""),
        3: (
            PROTECTIVE_STOP,
            "a protective stop: find its cause, wait 5 s, unlock it on the teach pendant",
        ),
        4: (
            "RECOVERY",
            "recovery mode: move the arm back within its limits on the teach pendant",
        ),
        5: ("SAFEGUARD_STOP", _SAFEGUARD),
        6: ("SYSTEM_EMERGENCY_STOP", _EMERGENCY),
        7: ("ROBOT_EMERGENCY_STOP", _EMERGENCY),
        8: (
            "VIOLATION",
            "a safety violation: restart the safety system on the teach pendant",
        ),
        9: ("FAULT", "a safety fault: restart the safety system on the teach pendant"),
    }
)
_BY_NAME: Final = dict(_MODES.values())


def stop_in_words(mode: int) -> str:
    """Say what stops the arm in a safety mode of the state stream; empty if nothing does."""
    if mode in SAFE:
        return ""
    known = _MODES.get(mode)
    return known[1] if known else f"safety mode {mode}: see the teach pendant"


def status_in_words(name: str) -> str:
    """Say what stops the arm in a safety mode as the dashboard names it; empty if nothing does."""
    words = _BY_NAME.get(name)
    if words is None and "SAFEGUARD" in name:
        return _SAFEGUARD
    return f"safety mode {name}: see the teach pendant" if words is None else words
