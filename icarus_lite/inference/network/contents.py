"""What a network holds, as it is asked about: concepts, objects, and what is given."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from typing import Any

from icarus_lite.inference.network.attributed import Attributes
from icarus_lite.inference.network.design import Design, Head, Keeping
from icarus_lite.inference.network.history import Kind, belief_of, key_of
from icarus_lite.inference.network.parts import Parts
from icarus_lite.inference.network.recomputed import Recomputed
from icarus_lite.symbols import Belief, Value

_NOTHING: Mapping[str, Value] = {}


class Contents:
    """The rows of one network.

    Args:
        design: The network's design.

    Attributes:
        heads: The concepts by kind.
        parts: The stores.
        objects: For each percept type its objects with all their attributes.
        given: For each kind the facts that are given, by key and rank.
        attributes: For each head with attributes, by number, the derivations that decide on them.
        recomputed: For each component that is derived from scratch what it holds.
    """

    parts: Parts
    objects: dict[str, dict[Value, Mapping[str, Value]]]

    def __init__(self, design: Design) -> None:
        self.heads: dict[Kind, Head] = {
            (head.facts.predicate, head.facts.arity): head for head in design.heads
        }
        self.given: dict[Kind, dict[Any, dict[int, Mapping[str, Value]]]] = {}
        self.attributes: dict[int, Attributes] = {}
        self.recomputed: dict[int, Recomputed] = {}
        components: dict[int, list[int]] = {}
        for head in design.heads:
            components.setdefault(head.component, []).append(head.number)
        self._places = {n: own.index(n) for own in components.values() for n in own}

    def keys(self, kind: Kind) -> Collection[Any]:
        """Give the keys of the beliefs of a concept."""
        head = self.heads[kind]
        if head.keeping is Keeping.PAIRS:
            return self.parts.pairs[head.relation.name]
        if head.keeping is Keeping.ATTRIBUTED:
            return self.attributes[head.number].believed
        if head.keeping is Keeping.RECOMPUTED:
            return self.recomputed[head.component].believed[self._places[head.number]]
        return self.parts.rows[head.facts.name]

    def holds(self, kind: Kind, key: Any) -> bool:
        """Tell whether a belief of a concept is held."""
        return kind in self.heads and key in self.keys(kind)

    def count(self, kind: Kind) -> int:
        """Count the beliefs of a concept."""
        return len(self.keys(kind))

    def attributes_of(self, kind: Kind, key: Any) -> Mapping[str, Value]:
        """Give the attributes of a fact of a concept that is there."""
        head = self.heads[kind]
        if head.keeping is Keeping.ATTRIBUTED:
            return self.attributes[head.number][key]
        if head.keeping is Keeping.RECOMPUTED:
            place = self._places[head.number]
            return self.recomputed[head.component].attributes[place][key]
        return _NOTHING

    def fact(self, predicate: str, args: tuple[Value, ...]) -> Belief | None:
        """Give a fact of any kind with its attributes; None if it is not there."""
        kind, key = (predicate, len(args)), key_of(args)
        head = self.heads.get(kind)
        if head is not None:
            if head.keeping in (Keeping.ATTRIBUTED, Keeping.RECOMPUTED):
                known = self._with_attributes(head)
                return Belief(predicate, args, known[key]) if key in known else None
            return Belief(predicate, args) if key in self.keys(kind) else None
        if len(args) == 1:
            attributes = self.objects.get(predicate, {}).get(key)
            if attributes is not None:
                return Belief(predicate, args, dict(attributes))
        ranked = self.given.get(kind, {}).get(key)
        return None if ranked is None else Belief(predicate, args, ranked[min(ranked)])

    def facts(self, kind: Kind) -> Iterator[Belief]:
        """Give all facts of a kind, objects included, with their attributes."""
        head = self.heads.get(kind)
        if head is None:
            if kind[1] == 1:
                for name, attributes in self.objects.get(kind[0], {}).items():
                    yield belief_of(kind, name, dict(attributes))
            for key, ranked in self.given.get(kind, {}).items():
                yield belief_of(kind, key, ranked[min(ranked)])
        elif head.keeping in (Keeping.ATTRIBUTED, Keeping.RECOMPUTED):
            for key, attributes in self._with_attributes(head).items():
                yield belief_of(kind, key, attributes)
        else:
            for key in self.keys(kind):
                yield belief_of(kind, key)

    def _with_attributes(self, head: Head) -> Mapping[Any, Mapping[str, Value]]:
        """Give all facts of a concept by key, those included that are percepts of its name."""
        if head.keeping is Keeping.ATTRIBUTED:
            return self.attributes[head.number]
        return self.recomputed[head.component].attributes[self._places[head.number]]

    def like(self, kind: Kind, known: Mapping[int, Value]) -> Iterator[Belief]:
        """Give the facts of a kind that have these values at these places of their arguments."""
        head = self.heads.get(kind)
        if head is None:
            for fact in self.facts(kind):
                if all(fact.args[place] == value for place, value in known.items()):
                    yield fact
            return
        keys: Iterable[Any]
        if len(known) == kind[1]:
            key = key_of(tuple(known[place] for place in range(kind[1])))
            keys = [key] if self.holds(kind, key) else []
        elif head.keeping is Keeping.PAIRS and known:
            store = self.parts.pairs[head.relation.name]
            if 0 in known:
                keys = [(known[0], other) for other in store.of_left(known[0])]
            else:
                keys = [(one, known[1]) for one in store.of_right(known[1])]
        else:
            wanted = tuple(known.items())
            keys = [
                key
                for key in self.keys(kind)
                if all(key[place] == value for place, value in wanted)
            ]
        for key in keys:
            yield belief_of(kind, key, self.attributes_of(kind, key))
