"""The script ports: programs arrive as plain text, line by line, and nothing is sent back.

A program is complete when its first `def` has found its `end`; a line outside of any `def` is a
program of its own, as on the real ports.
"""

from __future__ import annotations

import re
from typing import Final

from runtime.controller.connections import Connection, ProtocolViolation
from runtime.controller.control_box import ControlBox
from runtime.controller.tokens import ScriptError

_LONGEST: Final = 1 << 20
_BLOCK: Final = re.compile(r'"[^"]*"|#.*|\b(def|sec|thread|if|while|end)\b')


class ScriptServer:
    """Takes programs for one control box."""

    def __init__(self, box: ControlBox) -> None:
        self.box: Final = box

    def accept(self, connection: Connection) -> _ScriptSession:
        """Begin with a new client."""
        return _ScriptSession(self.box, connection)


class _ScriptSession:
    """One client: its unfinished line and unfinished program."""

    def __init__(self, box: ControlBox, connection: Connection) -> None:
        self._box = box
        self._connection = connection
        self._line = bytearray()
        self._program: list[str] = []
        self._size = 0
        self._depth = 0

    def received(self, data: bytes) -> None:
        self._line += data
        *lines, rest = bytes(self._line).split(b"\n")
        self._line = bytearray(rest)
        for line in lines:
            self._take(line.decode("utf-8", "replace"))
        if len(self._line) + self._size > _LONGEST:
            raise ProtocolViolation(f"a program of more than {_LONGEST} bytes")

    def closed(self) -> None:
        """Forget an unfinished program, which is all there is to do."""

    def _take(self, line: str) -> None:
        if not self._program and not line.strip():
            return
        self._program.append(line)
        self._size += len(line)
        for word in _BLOCK.finditer(line):
            if word[1] is not None:
                self._depth += -1 if word[1] == "end" else 1
        if self._depth <= 0:
            text, self._program = "\n".join(self._program) + "\n", []
            self._size = self._depth = 0
            self._start(text)

    def _start(self, text: str) -> None:
        try:
            self._box.load(text)
        except ScriptError as error:
            self._box.last_failure = str(error)
            self._box.warn(f"script from {self._connection.peer}: {error}")
