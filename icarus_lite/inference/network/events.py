"""The events of a cycle that no rule tells of: given, loaded, or of two stretches of it."""

from __future__ import annotations

from collections.abc import Container, Mapping, Sequence
from types import MappingProxyType
from typing import Any, TypeAlias

from icarus_lite.inference.network.base import Base
from icarus_lite.inference.network.history import Event, Kind
from icarus_lite.symbols import Value

Concluded: TypeAlias = Mapping[Kind, Mapping[Any, Mapping[str, Value]]]
"""The beliefs of each concept by key, with their attributes."""

_NOTHING: Mapping[Any, Mapping[str, Value]] = MappingProxyType({})


def events_of_given(base: Base, concepts: Container[Kind]) -> list[Event]:
    """Give what became of the asserted beliefs that no clause concludes."""
    events: dict[Kind, tuple[list[Any], list[Any], list[Any]]] = {}
    for kind, key, old, now in base.changed_assertions():
        if kind in concepts:
            continue
        gained, lost, altered = events.setdefault(kind, ([], [], []))
        if old is None and now is not None:
            gained.append(key)
        elif old is not None and now is None:
            lost.append(key)
        before = None if old is None else old.attributes
        after = None if now is None else now.attributes
        if before != after and (before or after):
            altered.append((key, before, after))
    return [(kind, *each) for kind, each in events.items()]


def difference(old: Concluded, new: Concluded) -> list[Event]:
    """Give what is different between two states of the concepts."""
    events: list[Event] = []
    for kind in new:
        before, now = old.get(kind, _NOTHING), new[kind]
        gained = [key for key in now if key not in before]
        lost = [key for key in before if key not in now]
        altered: list[tuple[Any, Any, Any]] = [(key, None, now[key]) for key in gained if now[key]]
        altered += [(key, before[key], None) for key in lost if before[key]]
        altered += [
            (key, before[key], now[key]) for key in now if key in before and before[key] != now[key]
        ]
        if gained or lost or altered:
            events.append((kind, gained, lost, altered))
    return events


def together(first: Sequence[Event], second: Sequence[Event]) -> list[Event]:
    """Give what two stretches of one cycle come to, one after the other."""
    if not first or not second:
        return [*first, *second]
    turns: dict[Kind, dict[Any, _Turn]] = {}
    for kind, gained, lost, altered in (*first, *second):
        known = turns.setdefault(kind, {})
        noted = {key: (old, new) for key, old, new in altered}
        for key in gained:
            _turn(known, key, None, noted.pop(key, (None, None))[1] or _NO_ATTRIBUTES)
        for key in lost:
            _turn(known, key, noted.pop(key, (None, None))[0] or _NO_ATTRIBUTES, None)
        for key, (old, new) in noted.items():
            _turn(known, key, old, new)
    return [event for kind, known in turns.items() if (event := _net(kind, known)) is not None]


_Turn: TypeAlias = tuple[Mapping[str, Value] | None, Mapping[str, Value] | None]
"""What the attributes of a belief were and are; None where it is not held."""

_NO_ATTRIBUTES: Mapping[str, Value] = MappingProxyType({})


def _turn(
    known: dict[Any, _Turn],
    key: Any,
    before: Mapping[str, Value] | None,
    after: Mapping[str, Value] | None,
) -> None:
    known[key] = (known[key][0] if key in known else before), after


def _net(kind: Kind, known: Mapping[Any, _Turn]) -> Event | None:
    changed = [(key, old, new) for key, (old, new) in known.items() if old != new]
    if not changed:
        return None
    gained = [key for key, old, _ in changed if old is None]
    lost = [key for key, _, new in changed if new is None]
    return kind, gained, lost, [each for each in changed if each[1] or each[2]]
