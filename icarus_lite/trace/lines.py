"""The lines of a trace: found at once, read one by one."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Final, TypeVar

import msgspec

from icarus_lite.errors import TraceError
from icarus_lite.outcomes import Outcome
from icarus_lite.symbols import Action, Percept
from icarus_lite.trace.record import FORMAT, VERSION
from icarus_lite.trace.schema import ChangeLine, InputLine, OutcomeRow

_Line = TypeVar("_Line")

_CHANGES: Final = msgspec.json.Decoder(ChangeLine)
_INPUTS: Final = msgspec.json.Decoder(InputLine)
_ANYTHING: Final = msgspec.json.Decoder(dict[str, object])


class TraceLines:
    """The lines of a trace, its header read and its cycles found.

    Args:
        data: The bytes of the file.
        path: Its name, for messages.

    Raises:
        TraceError: it is not a trace, or of another version.
    """

    __slots__ = ("_cycles", "_data", "header", "path", "warning")

    def __init__(self, data: bytes, path: str) -> None:
        self.path = path
        self._data = bytearray(data)
        first, *rest = self._found() or [(0, 0)]
        self.header = self._header(*first)
        self.warning = ""
        self._cycles = rest
        if rest and not self._is_whole(*rest[-1]):
            number = len(rest) + 1
            self.warning = f"{path}:{number}: the last line was cut off and is left out"
            self._cycles.pop()

    @classmethod
    def read(cls, path: str | Path) -> TraceLines:
        """Read a trace file. Raises TraceError also if it cannot be read."""
        try:
            return cls(Path(path).read_bytes(), str(path))
        except OSError as error:
            raise TraceError(f"cannot be read: {error.strerror}", path=str(path)) from error

    def __len__(self) -> int:
        return len(self._cycles)

    def append(self, record: Mapping[str, object]) -> None:
        """Add a cycle to what is held here; no file is written."""
        start = len(self._data)
        self._data += json.dumps(record, ensure_ascii=False, allow_nan=False).encode() + b"\n"
        self._cycles.append((start, len(self._data) - 1))

    def changes(self) -> Iterator[ChangeLine]:
        """Read what each cycle changed, in order. Raises TraceError as `change` does."""
        for place in range(len(self._cycles)):
            yield self.change(place)

    def change(self, place: int) -> ChangeLine:
        """Read what a cycle changed, by its place in the trace.

        Raises:
            TraceError: the line is damaged; the message names it and the key.
        """
        return self._read(place, _CHANGES)

    def inputs(self, place: int) -> tuple[tuple[Percept, ...], tuple[Outcome, ...], InputLine]:
        """Read what entered a cycle, to derive its beliefs anew. Raises TraceError likewise."""
        line = self._read(place, _INPUTS)
        percepts = tuple(Percept(row.type, row.name, row.attributes) for row in line.percepts)
        return percepts, tuple(map(outcome_of, line.outcomes)), line

    def record(self, place: int) -> Mapping[str, object]:
        """Read the whole line of a cycle, by its place in the trace. Raises TraceError likewise."""
        return self._read(place, _ANYTHING)

    def damaged(self, place: int, message: str) -> TraceError:
        """Give the error for a cycle that cannot be used."""
        return TraceError(message, path=self.path, line=place + 2)

    def _found(self) -> list[tuple[int, int]]:
        """Find where each line begins and ends."""
        data, found, start = self._data, list[tuple[int, int]](), 0
        while start < len(data):
            end = data.find(b"\n", start)
            end = len(data) if end < 0 else end
            found.append((start, end))
            start = end + 1
        return found

    def _header(self, start: int, end: int) -> Mapping[str, object]:
        try:
            header = _ANYTHING.decode(self._data[start:end])
        except (msgspec.DecodeError, UnicodeDecodeError):
            header = {}
        if header.get("format") != FORMAT:
            message = "is not a trace: its first line is no header"
            raise TraceError(message, path=self.path, line=1)
        if header.get("version") != VERSION:
            message = f"is a trace of version {header.get('version')}; "
            message += f"this icarus reads version {VERSION}"
            raise TraceError(message, path=self.path, line=1)
        return header

    def _is_whole(self, start: int, end: int) -> bool:
        try:
            _ANYTHING.decode(self._data[start:end])
        except (msgspec.DecodeError, UnicodeDecodeError):
            return False
        return True

    def _read(self, place: int, decoder: msgspec.json.Decoder[_Line]) -> _Line:
        start, end = self._cycles[place]
        try:
            return decoder.decode(self._data[start:end])
        except msgspec.ValidationError as error:
            raise self.damaged(place, f"is not a line of a trace: {error}") from None
        except (msgspec.DecodeError, UnicodeDecodeError):
            raise self.damaged(place, "is not a line of a trace") from None


def outcome_of(row: OutcomeRow) -> Outcome:
    """Give a recorded outcome."""
    return Outcome(Action(row.name, row.args), row.status, row.reason)
