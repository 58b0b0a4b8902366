"""The RTDE port: recipes agreed with each client, states streamed out, inputs taken in.

Protocols 1 and 2. Source: Universal Robots, "Real-Time Data Exchange (RTDE) Guide".
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from runtime.controller.connections import Connection, ProtocolViolation
from runtime.controller.control_box import ControlBox
from runtime.controller.rtde_inputs import input_types, write_inputs
from runtime.controller.rtde_variables import Read, outputs
from runtime.controller.rtde_wire import (
    DataType,
    PackageType,
    Recipe,
    Value,
    WireError,
    frame,
    take_packages,
)
from runtime.controller.signals import REGISTERS

_MOST_RECIPES: Final = 255
_REFUSALS: Final = frozenset(("NOT_FOUND", "IN_USE"))
_FULL: Final = 256 * 1024  # bytes a client may leave unread before states are dropped


@dataclass(frozen=True, slots=True)
class _Stream:
    """An agreed output recipe: send it every `every` cycles of wall time."""

    recipe: Recipe
    sources: tuple[Read, ...]
    every: int


class RtdeServer:
    """All RTDE clients of one control box.

    Args:
        box: Whose state is streamed.
    """

    def __init__(self, box: ControlBox) -> None:
        self.box: Final = box
        self.outputs: Final = outputs(box.version)
        self.input_types: Final = input_types()
        self._sessions: dict[_RtdeSession, None] = {}
        self._owners: dict[str, _RtdeSession | None] = {}
        self._tick = 0

    def accept(self, connection: Connection) -> _RtdeSession:
        """Begin with a new client."""
        session = _RtdeSession(self, connection)
        self._sessions[session] = None
        return session

    def publish(self) -> None:
        """Send the state, once a control period of wall time, to whom it is due."""
        self._tick += 1
        # Each source is read once a tick, however many clients and variables want it.
        values: dict[Read, Value] = {}
        for session in tuple(self._sessions):
            session.publish(self._tick, values)

    def drop_all(self) -> None:
        """Cut every client's connection."""
        for session in tuple(self._sessions):
            session.connection.close()

    def send_to_all(self, data: bytes) -> None:
        """Send every client bytes that need not mean anything."""
        for session in tuple(self._sessions):
            session.connection.send(data)

    def occupy(self, which: str) -> None:
        """Let a fieldbus own the "lower", "upper" or "all" input registers that are still free."""
        half = REGISTERS // 2
        first, end = {"lower": (0, half), "upper": (half, REGISTERS)}.get(which, (0, REGISTERS))
        for index in range(first, end):
            for kind in ("int", "double"):
                self._owners.setdefault(f"input_{kind}_register_{index}", None)

    def vacate(self) -> None:
        """Let the fieldbus give back what it owns."""
        self._owners = {name: at for name, at in self._owners.items() if at is not None}

    def claim(self, names: Sequence[str], session: _RtdeSession) -> tuple[str, ...]:
        """Make a client the owner of input variables; the types, or why each is refused."""
        answers: list[str] = []
        for name in names:
            if name not in self.input_types:
                answers.append("NOT_FOUND")
            elif self._owners.get(name, session) is not session:
                answers.append("IN_USE")
            else:
                answers.append(self.input_types[name])
        if not _REFUSALS.intersection(answers):
            for name in names:
                self._owners[name] = session
        return tuple(answers)

    def forget(self, session: _RtdeSession) -> None:
        """Free what a client owned."""
        self._sessions.pop(session, None)
        control = session in self._owners.values()
        self.box.journal.note("link_lost", "control" if control else "state only")
        self._owners = {name: at for name, at in self._owners.items() if at is not session}


class _RtdeSession:
    """One client."""

    def __init__(self, server: RtdeServer, connection: Connection) -> None:
        self.connection = connection
        self._server = server
        self._buffer = bytearray()
        self._protocol = 1
        self._streaming = False
        self._streams: list[_Stream] = []
        self._inputs: dict[int, Recipe] = {}

    def received(self, data: bytes) -> None:
        self._buffer += data
        try:
            for kind, payload in take_packages(self._buffer):
                self._handle(kind, payload)
        except WireError as error:
            raise ProtocolViolation(str(error)) from error

    def closed(self) -> None:
        self._server.forget(self)

    def publish(self, tick: int, values: dict[Read, Value]) -> None:
        if not self._streaming or self.connection.backlog > _FULL:
            return
        for stream in self._streams:
            if tick % stream.every == 0:
                for read in stream.sources:
                    if read not in values:
                        values[read] = read(self._server.box)
                packed = stream.recipe.pack([values[read] for read in stream.sources])
                head = bytes([stream.recipe.number]) if self._protocol == 2 else b""
                self.connection.send(frame(PackageType.DATA, head + packed))

    def _handle(self, kind: int, payload: bytes) -> None:
        match kind:
            case PackageType.PROTOCOL_VERSION:
                wanted = int.from_bytes(payload[:2], "big")
                accepted = wanted in (1, 2)
                if accepted:
                    self._protocol = wanted
                self._answer(PackageType.PROTOCOL_VERSION, bytes([accepted]))
            case PackageType.CONTROLLER_VERSION:
                version = self._server.box.version
                self._answer(
                    PackageType.CONTROLLER_VERSION,
                    struct.pack(">4I", version.major, version.minor, version.bugfix, version.build),
                )
            case PackageType.SETUP_OUTPUTS:
                self._set_up_outputs(payload)
            case PackageType.SETUP_INPUTS:
                self._set_up_inputs(payload)
            case PackageType.START:
                if not self._streaming:
                    self._server.box.journal.note("link_opened", self.connection.peer)
                self._streaming = bool(self._streams)
                self._answer(PackageType.START, bytes([self._streaming]))
            case PackageType.PAUSE:
                self._streaming = False
                self._answer(PackageType.PAUSE, b"\x01")
            case PackageType.DATA:
                self._take_inputs(payload)
            case _:
                self._server.box.log(
                    f"RTDE client {self.connection.peer}: a package of unknown type {kind}"
                )

    def _set_up_outputs(self, payload: bytes) -> None:
        rate = self._server.box.model.frequency_hz
        frequency = rate
        if self._protocol == 2:
            if len(payload) < 8:
                raise ProtocolViolation("an output set-up without its frequency")
            (frequency,) = struct.unpack_from(">d", payload)
            payload = payload[8:]
        if not frequency >= 1.0:  # not a number included
            frequency = rate
        names = _names(payload)
        answers = [
            self._server.outputs[name].kind.value if name in self._server.outputs else "NOT_FOUND"
            for name in names
        ]
        number = 0
        if names and "NOT_FOUND" not in answers and len(self._streams) < _MOST_RECIPES:
            number = len(self._streams) + 1 if self._protocol == 2 else 1
            found = [self._server.outputs[name] for name in names]
            sources = tuple(output.read for output in found)
            recipe = Recipe(number, names, tuple(output.kind for output in found))
            if self._protocol == 1:
                self._streams.clear()  # it knows one recipe, the latest
            self._streams.append(_Stream(recipe, sources, max(1, round(rate / frequency))))
        head = bytes([number]) if self._protocol == 2 else b""
        self._answer(PackageType.SETUP_OUTPUTS, head + ",".join(answers).encode())

    def _set_up_inputs(self, payload: bytes) -> None:
        names = _names(payload)
        answers = self._server.claim(names, self)
        number = 0
        agreed = not _REFUSALS.intersection(answers)
        if names and agreed and len(self._inputs) < _MOST_RECIPES:
            number = len(self._inputs) + 1
            kinds = tuple(DataType(answer) for answer in answers)
            self._inputs[number] = Recipe(number, names, kinds)
        self._answer(PackageType.SETUP_INPUTS, bytes([number]) + ",".join(answers).encode())

    def _take_inputs(self, payload: bytes) -> None:
        recipe = self._inputs.get(payload[0]) if payload else None
        box = self._server.box
        if recipe is None:
            box.log(f"RTDE client {self.connection.peer}: data for a recipe never agreed")
            return
        try:
            values = recipe.unpack(payload[1:])
        except WireError as error:
            box.warn(f"RTDE client {self.connection.peer}: {error}; the package is ignored")
            return
        write_inputs(box, dict(zip(recipe.names, values, strict=True)))

    def _answer(self, kind: PackageType, payload: bytes) -> None:
        self.connection.send(frame(kind, payload))


def _names(payload: bytes) -> tuple[str, ...]:
    """Split a list of names; a trailing comma is usual."""
    text = payload.decode("ascii", "replace")
    return tuple(name.strip() for name in text.split(",") if name.strip())
