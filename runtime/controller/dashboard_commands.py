"""The dashboard's commands: what each does and answers, and since which version.

Clients compare some answers word for word. Sources: Universal Robots, "Dashboard Server,
CB-Series" and "Dashboard Server, e-Series".
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final

from runtime.controller.control_box import ControlBox
from runtime.controller.ports import BANNER, NAME
from runtime.controller.safety import RuntimeState

NOT_ALLOWED: Final = "Command is not allowed due to safety reasons"
"""The answer of an e-Series controller in local control to whatever would act."""

SERIAL_NUMBER: Final = "20000000001"
"""Clients ask for digits."""

_ALWAYS: Final = {3: 0, 5: 0}
_E_SERIES: Final = {5: 0}
_CB3: Final = {3: 0}
_STOPPED: Final = "Failed: the emergency stop is pressed"
_STATES: Final = {
    RuntimeState.STOPPED: "STOPPED",
    RuntimeState.PLAYING: "PLAYING",
    RuntimeState.PAUSED: "PAUSED",
}


@dataclass(frozen=True, slots=True)
class Command:
    """One command.

    Args:
        answer: Carries it out; takes the words after its name.
        since: The minor version it came with, for each major one that has it.
        acts: Whether it does something, which an e-Series controller refuses in local control.
    """

    answer: Callable[[str], str]
    since: Mapping[int, int]
    acts: bool = False


def commands(box: ControlBox) -> dict[str, Command]:
    """Give what a control box's dashboard understands, by name, in small letters."""
    known = {**_questions(box), **_programs(box), **_power(box), **_notes(box)}
    return {
        name: command for name, command in known.items() if box.version.is_at_least(command.since)
    }


def _questions(box: ControlBox) -> dict[str, Command]:
    def program() -> str:
        return "null" if box.program is None else box.program.name

    def ask(question: Callable[[], str], since: Mapping[int, int] = _ALWAYS) -> Command:
        return Command(lambda _rest: question(), since)

    playing = RuntimeState.PLAYING
    return {
        "running": ask(lambda: f"Program running: {str(box.runtime_state is playing).lower()}"),
        "robotmode": ask(lambda: f"Robotmode: {box.safety.robot_mode.name}"),
        "safetymode": ask(lambda: f"Safetymode: {box.safety.mode.name}"),
        "safetystatus": ask(lambda: f"Safetystatus: {box.safety.mode.name}", {3: 11, 5: 4}),
        "get loaded program": ask(lambda: "No program loaded"),
        "programstate": ask(lambda: f"{_STATES[box.runtime_state]} {program()}"),
        "isprogramsaved": ask(lambda: f"true {program()}"),
        "polyscopeversion": ask(lambda: f"URSoftware {box.version} ({NAME})"),
        "version": ask(lambda: str(box.version), _E_SERIES),
        # An e-Series arm leaves its e out.
        "get robot model": ask(lambda: box.model.name.upper().removesuffix("E"), {3: 12, 5: 6}),
        "get serial number": ask(lambda: SERIAL_NUMBER, {3: 12, 5: 6}),
        "get operational mode": ask(lambda: "NONE", {5: 6}),
        "getuserrole": ask(lambda: "PROGRAMMER", _CB3),
        "is in remote control": ask(lambda: str(box.in_remote_control).lower(), {5: 6}),
    }


def _programs(box: ControlBox) -> dict[str, Command]:
    def stop(_rest: str) -> str:
        box.stop_program("stopped from the dashboard")
        return "Stopped"

    def play(_rest: str) -> str:
        return "Starting program" if box.play() else "Failed to execute: play"

    def pause(_rest: str) -> str:
        return "Pausing program" if box.pause() else "Failed to execute: pause"

    def load(name: str) -> str:
        return f"File not found: {name} (a {NAME} has no files)"

    return {
        "play": Command(play, _ALWAYS, acts=True),
        "stop": Command(stop, _ALWAYS, acts=True),
        "pause": Command(pause, _ALWAYS, acts=True),
        "load": Command(load, _ALWAYS, acts=True),
        "load installation": Command(load, {3: 2, 5: 0}, acts=True),
    }


def _power(box: ControlBox) -> dict[str, Command]:
    def power_off(_rest: str) -> str:
        box.power_off()
        return "Powering off"

    def restart_safety(_rest: str) -> str:
        box.power_off()
        return "Restarting safety"

    return {
        "power on": Command(
            lambda _rest: "Powering on" if box.power_on() else _STOPPED, _ALWAYS, acts=True
        ),
        "power off": Command(power_off, _ALWAYS, acts=True),
        "brake release": Command(
            lambda _rest: "Brake releasing" if box.release_brakes() else _STOPPED,
            _ALWAYS,
            acts=True,
        ),
        "unlock protective stop": Command(
            lambda _rest: box.unlock_refusal() or "Protective stop releasing",
            {3: 1, 5: 0},
            acts=True,
        ),
        "restart safety": Command(restart_safety, {3: 7, 5: 1}, acts=True),
        "shutdown": Command(
            lambda _rest: f"Refused: this is a {BANNER}; end its process instead", _ALWAYS
        ),
    }


def _notes(box: ControlBox) -> dict[str, Command]:
    def popup(text: str) -> str:
        box.log(f"popup: {text}")
        return "showing popup"

    def add_to_log(text: str) -> str:
        box.log(f"dashboard: {text}")
        return "Added log message"

    return {
        "popup": Command(popup, _ALWAYS),
        "close popup": Command(lambda _rest: "closing popup", _ALWAYS),
        "close safety popup": Command(lambda _rest: "closing safety popup", {3: 1, 5: 0}),
        "addtolog": Command(add_to_log, _ALWAYS),
        "savelog": Command(lambda _rest: "Log saved to disk", _ALWAYS),
        "setuserrole": Command(lambda role: f"Setting user role: {role}", _CB3),
        "set operational mode": Command(
            lambda mode: f"Operational mode '{mode}' is set", _E_SERIES, acts=True
        ),
        "clear operational mode": Command(
            lambda _rest: "No longer controlling the operational mode. ", _E_SERIES, acts=True
        ),
    }
