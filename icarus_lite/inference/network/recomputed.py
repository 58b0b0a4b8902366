"""Recursion that computes attributes: the whole component again when anything it reads changes.

Which derivation decides on an attribute can depend on the attribute of another belief of the same
component, so that what is there cannot be mended piece by piece. It is derived from scratch, by
the rules of `Closure`, and compared.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from icarus_lite.inference.closure import Closure, Limits
from icarus_lite.inference.facts import FactStore
from icarus_lite.inference.network.attributed import Key, Telling
from icarus_lite.inference.network.history import Kind, key_of
from icarus_lite.symbols import Belief, Value


class Recomputed:
    """The concepts of one component, derived from scratch.

    Args:
        kinds: For each head of the component its number and kind.
        closure: The component's clauses.
        limits: What deriving from them may cost.
        given: Gives the facts that the clauses read: percepts, beliefs of other concepts, and
            what is given of these concepts; what decides on attributes comes first.
        is_asserted: Tells whether a fact that is given is a belief, and not a percept only.
        tellings: For each head the relations that hold its rows.
        record: Is told of the changes of each cycle.

    Attributes:
        attributes: For each head the attributes of each of its facts.
        believed: For each head the facts that are beliefs.
    """

    __slots__ = (
        "_closure",
        "_given",
        "_is_asserted",
        "_kinds",
        "_limits",
        "_record",
        "_tellings",
        "attributes",
        "believed",
    )

    def __init__(
        self,
        kinds: Sequence[tuple[int, Kind]],
        closure: Closure,
        limits: Limits,
        given: Callable[[], Iterable[Belief]],
        is_asserted: Callable[[Belief], bool],
        tellings: Sequence[Sequence[Telling]],
        record: Callable[[Any], None],
    ) -> None:
        self._kinds, self._closure, self._limits, self._given = kinds, closure, limits, given
        self._is_asserted, self._tellings, self._record = is_asserted, tellings, record
        self.attributes: list[dict[Key, Mapping[str, Value]]] = [{} for _ in kinds]
        self.believed: list[dict[Key, None]] = [{} for _ in kinds]

    def settle(self) -> None:
        """Derive everything again and let the rules see what has changed."""
        for place, (facts, believed, stages) in enumerate(self._derive()):
            number, _ = self._kinds[place]
            before, believed_before = self.attributes[place], self.believed[place]
            main, *others = self._tellings[place]
            for key in [key for key in before if key not in facts]:
                for telling in (*others, main):
                    telling.follow(key, before[key], None)
            for key, attributes in facts.items():
                old = before.get(key)
                if old is not None:
                    main.rows[key] = stages[key]
                if old != attributes:
                    for telling in (main, *others):
                        telling.follow(key, old, attributes)
                    main.rows[key] = stages[key]
            gained = [key for key in believed if key not in believed_before]
            lost = [key for key in believed_before if key not in believed]
            altered: list[tuple[Key, Any, Any]] = [(key, None, facts[key]) for key in gained]
            altered += [(key, before[key], None) for key in lost]
            altered += [
                (key, before[key], facts[key])
                for key in believed
                if key in believed_before and before[key] != facts[key]
            ]
            self.attributes[place], self.believed[place] = facts, believed
            if altered:
                self._record((number, gained, lost, altered))

    def load(self) -> None:
        """Derive everything, telling no one."""
        for place, (facts, believed, stages) in enumerate(self._derive()):
            main, *others = self._tellings[place]
            for key, attributes in facts.items():
                main.insert(key, stages[key])
                for telling in others:
                    value = telling.value(attributes)
                    if value is not None:
                        telling.insert(key, value)
            self.attributes[place], self.believed[place] = facts, believed

    def _derive(
        self,
    ) -> list[tuple[dict[Key, Mapping[str, Value]], dict[Key, None], dict[Key, int]]]:
        """Give for each head its facts with attributes, its beliefs, and the order they came in."""
        store = FactStore(self._given())
        derived = self._closure.derive(store, limits=self._limits)
        found = []
        for _, kind in self._kinds:
            facts: dict[Key, Mapping[str, Value]] = {}
            believed: dict[Key, None] = {}
            stages: dict[Key, int] = {}
            for ((_, fact, number),) in store.rows(kind[0]).values():
                if len(fact.args) != kind[1]:
                    continue
                key = key_of(fact.args)
                facts[key], stages[key] = fact.attributes, number
                if fact in derived or self._is_asserted(fact):
                    believed[key] = None
            found.append((facts, believed, stages))
        return found
