"""Recorded frames in, beliefs out: the JSON Lines of `icarus infer`.

A frame is `{"cycle": 0, "percepts": [{"type", "name", "attributes"}], "action": {"name", "args",
"status"} | null}`. Unknown keys are kept by whoever wrote them and ignored here.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from icarus_lite.errors import FrameError
from icarus_lite.outcomes import Outcome, Status
from icarus_lite.records import dataclass
from icarus_lite.symbols import Action, Percept, Value, is_number


@dataclass(frozen=True, slots=True)
class Frame:
    """One recorded cycle: what was perceived, and what became of the action before it."""

    cycle: int
    percepts: tuple[Percept, ...]
    outcomes: tuple[Outcome, ...]
    line: int


def read_frames(path: str | Path) -> Iterator[Frame]:
    """Read a frames file, one frame a line, blank lines skipped.

    Raises:
        FrameError: the file cannot be read, a line is malformed (the message names file, line and
            key), or cycles do not increase.
    """
    last = -1
    for number, document in read_json_lines(path):
        try:
            frame = _frame(document, number)
        except FrameError as error:
            raise FrameError(error.message, path=str(path), line=number) from None
        if frame.cycle <= last:
            message = f'key "cycle": {frame.cycle} comes after {last}; cycles must increase'
            raise FrameError(message, path=str(path), line=number)
        last = frame.cycle
        yield frame


def read_json_lines(path: str | Path) -> Iterator[tuple[int, object]]:
    """Read a JSON Lines file; give each line's number and document.

    Raises:
        FrameError: the file cannot be read, is not UTF-8, or a line is not JSON.
    """
    try:
        with Path(path).open("rb") as file:
            for number, raw in enumerate(file, 1):
                if raw.strip():
                    yield number, _json(raw, str(path), number)
    except OSError as error:
        raise FrameError(f"cannot be read: {error.strerror}", path=str(path)) from error


def _json(raw: bytes, path: str, number: int) -> object:
    try:
        return json.loads(raw.decode("utf-8"), parse_constant=_refuse_constant)
    except UnicodeDecodeError as error:
        message = f"is not UTF-8 text (byte {error.start + 1} of the line)"
        raise FrameError(message, path=path, line=number) from error
    except json.JSONDecodeError as error:
        message = f"is not JSON: {error.msg} (column {error.colno})"
        raise FrameError(message, path=path, line=number) from error
    except (ValueError, RecursionError) as error:
        raise FrameError(f"is not usable JSON: {error}", path=path, line=number) from error


def _refuse_constant(name: str) -> float:
    message = f"{name} is not a finite number"
    raise ValueError(message)


def _frame(document: object, line: int) -> Frame:
    row = _object(document, "a frame")
    cycle = row.get("cycle")
    if not isinstance(cycle, int) or isinstance(cycle, bool) or cycle < 0:
        raise FrameError(f'key "cycle": expected an integer from 0, got {_short(cycle)}')
    percepts = row.get("percepts")
    if not isinstance(percepts, list):
        raise FrameError(f'key "percepts": expected a list, got {_short(percepts)}')
    action = row.get("action")
    outcomes = () if action is None else (outcome_from_json(action),)
    return Frame(cycle, tuple(_percept(p, i) for i, p in enumerate(percepts)), outcomes, line)


def _percept(document: object, index: int) -> Percept:
    where = f'key "percepts", entry {index + 1}'
    row = _object(document, where)
    for key in ("type", "name"):
        if not isinstance(row.get(key), str) or not row[key]:
            raise FrameError(f'{where}, key "{key}": expected text, got {_short(row.get(key))}')
    attributes = _object(row.get("attributes", {}), f'{where}, key "attributes"')
    for key, value in attributes.items():
        if not isinstance(value, str) and not is_number(value):
            message = f'{where}, attribute "{key}": expected text or a number, got {_short(value)}'
            raise FrameError(message)
    return Percept(str(row["type"]), str(row["name"]), attributes)  # type: ignore[arg-type]


def outcome_from_json(document: object) -> Outcome:
    """Read an action with its status.

    Raises:
        FrameError: it is malformed; the message names the key.
    """
    row = _object(document, 'key "action"')
    name = row.get("name")
    if not isinstance(name, str) or not name:
        raise FrameError(f'key "action.name": expected text, got {_short(name)}')
    args = row.get("args", [])
    if not isinstance(args, list) or not all(isinstance(a, str) or is_number(a) for a in args):
        raise FrameError(f'key "action.args": expected a list of names, got {_short(args)}')
    status = row.get("status", "succeeded")
    try:
        status = Status(str(status))
    except ValueError:
        legal = ", ".join(Status)
        message = f'key "action.status": expected one of {legal}, got {_short(status)}'
        raise FrameError(message) from None
    reason = row.get("reason", "")
    return Outcome(Action(name, tuple(args)), status, reason if isinstance(reason, str) else "")


def _object(document: object, what: str) -> Mapping[str, Value | object]:
    if not isinstance(document, dict):
        raise FrameError(f"{what}: expected a JSON object, got {_short(document)}")
    return document


def _short(value: object) -> str:
    text = json.dumps(value, ensure_ascii=False, default=str)
    return text if len(text) <= 40 else text[:37] + "…"


def beliefs_line(cycle: int, beliefs: Iterable[object]) -> str:
    """Write one line of the beliefs file, without its newline.

    Example:
        >>> beliefs_line(0, ["(attached o1 hand1)"])
        '{"cycle": 0, "beliefs": ["(attached o1 hand1)"]}'
    """
    row = {"cycle": cycle, "beliefs": sorted(map(str, beliefs))}
    return json.dumps(row, ensure_ascii=False)
