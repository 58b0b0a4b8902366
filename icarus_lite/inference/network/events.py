"""The events of a cycle that no rule tells of: what is only given, what a load has changed."""

from __future__ import annotations

from collections.abc import Container, Mapping
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
