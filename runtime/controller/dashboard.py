"""The dashboard port: one command a line, one answer a line."""

from __future__ import annotations

from typing import Final

from runtime.controller.connections import Connection, ProtocolViolation
from runtime.controller.control_box import ControlBox
from runtime.controller.dashboard_commands import NOT_ALLOWED, commands
from runtime.controller.ports import BANNER

_LONGEST: Final = 4096


class DashboardServer:
    """Answers dashboard commands for one control box, those its version knows."""

    def __init__(self, box: ControlBox) -> None:
        self._box = box
        self._commands = commands(box)
        # Of "load" and "load installation", the longer name is looked for first.
        self._names = sorted(self._commands, key=len, reverse=True)
        self._sessions: dict[_DashboardSession, None] = {}

    def accept(self, connection: Connection) -> _DashboardSession:
        """Greet a new client."""
        session = _DashboardSession(self, connection)
        self._sessions[session] = None
        connection.send(f"Connected: Dashboard Server of a {BANNER}\n".encode())
        return session

    def answer(self, line: str) -> str:
        """Carry out one command and give the answer, without its newline."""
        text = " ".join(line.split())
        small = text.lower()
        for name in self._names:
            if small == name or small.startswith(f"{name} "):
                command = self._commands[name]
                local = self._box.version.is_e_series and not self._box.in_remote_control
                if local and command.acts:
                    return NOT_ALLOWED
                return command.answer(text[len(name) + 1 :])
        return f"could not understand: '{text[:80]}'"

    def send_to_all(self, data: bytes) -> None:
        """Send every client bytes that need not mean anything."""
        for session in tuple(self._sessions):
            session.connection.send(data)

    def drop_all(self) -> None:
        """Cut every client's connection."""
        for session in tuple(self._sessions):
            session.connection.close()

    def forget(self, session: _DashboardSession) -> None:
        """Learn that a client has gone."""
        self._sessions.pop(session, None)


class _DashboardSession:
    """One client and its unfinished line."""

    def __init__(self, server: DashboardServer, connection: Connection) -> None:
        self.connection = connection
        self._server = server
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
                self.connection.send(b"Disconnected\n")
                self.connection.finish()
                return
            if command:
                self.connection.send(f"{self._server.answer(command)}\n".encode())

    def closed(self) -> None:
        self._server.forget(self)
