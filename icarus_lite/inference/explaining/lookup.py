"""Patterns looked up by whatever happens to be known of them.

A plan fixes once which cells of a pattern are known when it is reached. Whoever explains a failure
drops conditions and tries the others in any order, so that here each combination of known cells
gets its own view of the facts, and with it a hash index, when it is first met.
"""

from __future__ import annotations

from collections.abc import Mapping, MutableSequence, Sequence
from typing import Protocol

from icarus_lite.inference.views import Entry, Key, View
from icarus_lite.language.syntax import Atom, Constant
from icarus_lite.symbols import Belief, Value

Slots = Mapping[str, int]
"""Where in a row each variable stands."""

OpenRow = MutableSequence[Value | None]
"""The value of each variable; None for one that is not bound."""


class Facts(Protocol):
    """Facts that can be looked up through views, such as a `FactStore`."""

    def rows(self, predicate: str) -> Mapping[Key, Sequence[Entry]]:
        """Give the facts of a predicate by all their arguments."""

    def index(self, view: View) -> Mapping[Key, Sequence[Entry]]:
        """Give the hash index of a view."""


class Pattern:
    """One pattern and the ways in which it has been looked up so far.

    Args:
        atom: The pattern.
        slots: Where each of its variables stands in a row.
        facts: What it is matched with.
    """

    __slots__ = ("_arity", "_cells", "_facts", "_ways", "atom", "slots")

    def __init__(self, atom: Atom, slots: Slots, facts: Facts) -> None:
        self.atom = atom
        self._facts = facts
        self._arity = len(atom.args)
        terms = (*atom.args, *(term for _, term in atom.attributes))
        self._cells = tuple(
            (-1, term.value) if isinstance(term, Constant) else (slots[term.name], None)
            for term in terms
        )
        self.slots = frozenset(slot for slot, _ in self._cells if slot >= 0)
        self._ways: dict[int, tuple[Mapping[Key, Sequence[Entry]], bool, tuple[int, ...]]] = {}

    def find(self, row: OpenRow) -> tuple[Sequence[Entry], tuple[int, ...]]:
        """Give the facts that match, and the slots that the values of each are for."""
        key: list[Value] = []
        known = 0
        for place, (slot, constant) in enumerate(self._cells):
            value = constant if slot < 0 else row[slot]
            if value is not None:
                key.append(value)
                known |= 1 << place
        way = self._ways.get(known)
        if way is None:
            way = self._ways[known] = self._way(known)
        index, single, free = way
        return index.get(key[0] if single else tuple(key), ()), free

    def estimate(self, row: OpenRow) -> int:
        """Give how many facts match, or where nothing is known of it, how many there are."""
        if any(slot < 0 or row[slot] is not None for slot, _ in self._cells):
            return len(self.find(row)[0])
        return len(self._facts.rows(self.atom.predicate))

    def namesake(self, row: OpenRow) -> Belief | None:
        """Give the fact with these arguments whatever its attributes; None unless all are known."""
        args = tuple([self._value(place, row) for place in range(self._arity)])
        if None in args:
            return None
        found = self._facts.rows(self.atom.predicate).get(args)  # type: ignore[arg-type]
        return found[0][1] if found else None

    def bind_attributes(self, fact: Belief, row: OpenRow) -> list[int]:
        """Bind what is still free of the attributes to those of a fact; give the slots bound."""
        bound = []
        for (name, _), (slot, _) in zip(
            self.atom.attributes, self._cells[self._arity :], strict=True
        ):
            if slot >= 0 and row[slot] is None and name in fact.attributes:
                row[slot] = fact.attributes[name]
                bound.append(slot)
        return bound

    def _value(self, place: int, row: OpenRow) -> Value | None:
        slot, constant = self._cells[place]
        return constant if slot < 0 else row[slot]

    def _way(self, known: int) -> tuple[Mapping[Key, Sequence[Entry]], bool, tuple[int, ...]]:
        key, values, equal = [], [], []
        first: dict[int, int] = {}
        for place, (slot, _) in enumerate(self._cells):
            if known >> place & 1:
                key.append(place)
            elif slot in first:
                equal.append((first[slot], place))
            else:
                first[slot] = place
                values.append(place)
        atom = self.atom
        if not atom.attributes and len(key) == self._arity:
            return self._facts.rows(atom.predicate), False, ()
        names = tuple(name for name, _ in atom.attributes)
        view = View(atom.predicate, self._arity, names, tuple(key), tuple(values), tuple(equal))
        return self._facts.index(view), len(key) == 1, tuple(first)


def matching(atom: Atom, facts: Facts) -> list[Belief]:
    """Give all facts that match a pattern, in the order in which they came to be believed."""
    slots: dict[str, int] = {}
    for name in atom.variables:
        slots.setdefault(name, len(slots))
    entries, _ = Pattern(atom, slots, facts).find([None] * len(slots))
    return [fact for _, fact, _ in entries]
