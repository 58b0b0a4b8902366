"""The dashboard port: one command a line, one answer a line.

Clients compare some answers word for word. Source: Universal Robots, "Dashboard Server,
CB-Series" and "Dashboard Server, e-Series".
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from runtime.controller.connections import Connection, ProtocolViolation
from runtime.controller.control_box import ControlBox
from runtime.controller.ports import BANNER, NAME
from runtime.controller.safety import RuntimeState

_LONGEST: Final = 4096
_STATES: Final = {
    RuntimeState.STOPPED: "STOPPED",
    RuntimeState.PLAYING: "PLAYING",
    RuntimeState.PAUSED: "PAUSED",
}


class DashboardServer:
    """Answers dashboard commands for one control box."""

    def __init__(self, box: ControlBox) -> None:
        self._box = box
        self._exact: dict[str, Callable[[], str]] = {
            "play": self._play,
            "stop": self._stop,
            "pause": self._pause,
            "shutdown": lambda: f"Refused: this is a {BANNER}; end its process instead",
            "running": self._running,
            "robotmode": lambda: f"Robotmode: {box.safety.robot_mode.name}",
            "safetymode": lambda: f"Safetymode: {box.safety.mode.name}",
            "safetystatus": lambda: f"Safetystatus: {box.safety.mode.name}",
            "get loaded program": lambda: "No program loaded",
            "programstate": lambda: f"{_STATES[box.runtime_state]} {self._program()}",
            "isprogramsaved": lambda: f"true {self._program()}",
            "polyscopeversion": lambda: f"URSoftware {box.version} ({NAME})",
            "version": lambda: str(box.version),
            "get robot model": box.model.name.upper,
            "get serial number": lambda: "0",
            "is in remote control": lambda: "true",
            "power on": self._power_on,
            "power off": self._power_off,
            "brake release": self._release_brakes,
            "unlock protective stop": self._unlock,
            "close popup": lambda: "closing popup",
            "close safety popup": lambda: "closing safety popup",
            "restart safety": lambda: "Restarting safety",
        }
        self._prefixed: dict[str, Callable[[str], str]] = {
            "load": lambda name: f"File not found: {name} (a {NAME} has no files)",
            "popup": self._popup,
            "addtolog": self._add_to_log,
            "setuserrole": lambda role: f"Setting user role: {role}",
        }

    def accept(self, connection: Connection) -> _DashboardSession:
        """Greet a new client."""
        session = _DashboardSession(self, connection)
        connection.send(f"Connected: Dashboard Server of a {BANNER}\n".encode())
        return session

    def answer(self, line: str) -> str:
        """Carry out one command and give the answer, without its newline."""
        command = " ".join(line.split())
        exact = self._exact.get(command.lower())
        if exact is not None:
            return exact()
        word, _, rest = command.partition(" ")
        prefixed = self._prefixed.get(word.lower())
        if prefixed is not None:
            return prefixed(rest)
        return f"could not understand: '{command[:80]}'"

    def _program(self) -> str:
        program = self._box.program
        return "null" if program is None else program.name

    def _play(self) -> str:
        return "Starting program" if self._box.play() else "Failed to execute: play"

    def _stop(self) -> str:
        self._box.stop_program("stopped from the dashboard")
        return "Stopped"

    def _pause(self) -> str:
        return "Pausing program" if self._box.pause() else "Failed to execute: pause"

    def _running(self) -> str:
        playing = self._box.runtime_state is RuntimeState.PLAYING
        return f"Program running: {'true' if playing else 'false'}"

    def _power_on(self) -> str:
        return "Powering on" if self._box.safety.power_on() else self._stopped()

    def _power_off(self) -> str:
        self._box.power_off()
        return "Powering off"

    def _release_brakes(self) -> str:
        return "Brake releasing" if self._box.release_brakes() else self._stopped()

    def _unlock(self) -> str:
        return self._box.unlock_refusal() or "Protective stop releasing"

    def _stopped(self) -> str:
        return "Failed: the emergency stop is pressed"

    def _popup(self, text: str) -> str:
        self._box.log(f"popup: {text}")
        return "showing popup"

    def _add_to_log(self, text: str) -> str:
        self._box.log(f"dashboard: {text}")
        return "Added log message"


class _DashboardSession:
    """One client and its unfinished line."""

    def __init__(self, server: DashboardServer, connection: Connection) -> None:
        self._server = server
        self._connection = connection
        self._buffer = bytearray()

    def received(self, data: bytes) -> None:
        self._buffer += data
        *lines, rest = bytes(self._buffer).split(b"\n")
        self._buffer = bytearray(rest)
        if len(rest) > _LONGEST:
            raise ProtocolViolation(f"a dashboard command of more than {_LONGEST} bytes")
        for line in lines:
            command = line.decode("utf-8", "replace").strip()
            if command.lower() == "quit":
                self._connection.send(b"Disconnected\n")
                self._connection.finish()
                return
            if command:
                self._connection.send(f"{self._server.answer(command)}\n".encode())

    def closed(self) -> None:
        """Nothing is kept for a client that has gone."""
