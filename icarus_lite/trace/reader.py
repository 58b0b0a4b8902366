"""Reading a trace back, also one whose last line was cut off."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from pathlib import Path

from icarus_lite.errors import TraceError
from icarus_lite.outcomes import Outcome
from icarus_lite.records import dataclass
from icarus_lite.symbols import Percept
from icarus_lite.trace.frames import outcome_from_json
from icarus_lite.trace.record import FORMAT, VERSION


@dataclass(frozen=True, slots=True)
class Trace:
    """A recorded run.

    Args:
        header: Its first line.
        cycles: One record a cycle, in order.
        warning: Set when the last line was cut off; everything before it is here.
    """

    header: Mapping[str, object]
    cycles: tuple[Mapping[str, object], ...]
    warning: str = ""


def read_trace(path: str | Path) -> Trace:
    """Read a whole trace.

    Raises:
        TraceError: the file cannot be read, is not a trace, is of another version, or is damaged
            anywhere but in its last line.
    """
    try:
        lines = Path(path).read_bytes().splitlines(keepends=True)
    except OSError as error:
        raise TraceError(f"cannot be read: {error.strerror}", path=str(path)) from error
    records: list[Mapping[str, object]] = []
    warning = ""
    for number, line in enumerate(lines, 1):
        try:
            record = json.loads(line.decode("utf-8"))
        except ValueError:  # what json and the codec raise are both ValueErrors
            if number == len(lines) and number > 1:
                warning = f"{path}:{number}: the last line was cut off and is left out"
                break
            raise TraceError("is not a line of a trace", path=str(path), line=number) from None
        if not isinstance(record, dict):
            raise TraceError("is not a line of a trace", path=str(path), line=number)
        records.append(record)
    _check_header(records[0] if records else {}, str(path))
    return Trace(records[0], tuple(records[1:]), warning)


def stream_trace(path: str | Path) -> Iterator[Mapping[str, object]]:
    """Read a trace line by line, header first, however long it is; only one line is held at a time.

    A last line that is cut off ends it: the run may still be writing.

    Raises:
        TraceError: as for `read_trace`, when the line is come to.
    """
    try:
        with Path(path).open("rb") as file:
            for number, line in enumerate(file, 1):
                if not line.endswith(b"\n"):
                    return
                yield _record(line, number, str(path))
    except OSError as error:
        raise TraceError(f"cannot be read: {error.strerror}", path=str(path)) from error


def _record(line: bytes, number: int, path: str) -> Mapping[str, object]:
    try:
        record = json.loads(line.decode("utf-8"))
    except ValueError:  # what json and the codec raise are both ValueErrors
        raise TraceError("is not a line of a trace", path=path, line=number) from None
    if not isinstance(record, dict):
        raise TraceError("is not a line of a trace", path=path, line=number)
    if number == 1:
        _check_header(record, path)
    return record


def _check_header(record: Mapping[str, object], path: str) -> None:
    if record.get("format") != FORMAT:
        raise TraceError("is not a trace: its first line is no header", path=path, line=1)
    if record.get("version") != VERSION:
        message = f"is a trace of version {record.get('version')}"
        raise TraceError(f"{message}; this icarus reads version {VERSION}", path=path, line=1)


def inputs_of(record: Mapping[str, object]) -> tuple[tuple[Percept, ...], tuple[Outcome, ...]]:
    """Give what entered a recorded cycle: its percepts and outcomes, to replay it."""
    rows = record.get("percepts")
    outcomes = record.get("outcomes")
    percepts = tuple(
        Percept(row["type"], row["name"], row["attributes"])
        for row in (rows if isinstance(rows, list) else ())
    )
    found = outcomes if isinstance(outcomes, list) else ()
    return percepts, tuple(outcome_from_json(row) for row in found)
