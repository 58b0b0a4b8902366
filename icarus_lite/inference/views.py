"""Views: how a pattern looks at the facts of a predicate, and the hash index behind it.

When a pattern such as `(object ?o ^type plug ^x ?x)` is reached in a join, some of its places are
known (constants, and variables bound before) and the others are not. The known places are the key
of a hash index, the others are what a fact found there adds to the bindings. A view says which
place is which; it is fixed when a clause is compiled, and patterns that look alike share one.
"""

from __future__ import annotations

from collections.abc import Callable
from operator import itemgetter

from icarus_lite.symbols import Belief, Value

Row = tuple[Value, ...]
"""Values in the order of a plan's slots: its constants, then its variables as they are bound."""

Key = Value | Row
"""What a fact is looked up by: the bare value where it is only one."""

Entry = tuple[Row, Belief, int]
"""A fact in an index: the values it adds to a row, the fact, and its number in its store."""

Index = dict[Key, list[Entry]]
"""Entries by key, each list in the order in which the facts came to be believed."""


class View:
    """One way to look at the facts of a predicate.

    The cells of a fact are its arguments followed by the attributes that the pattern names; a fact
    with another number of arguments, or without one of these attributes, is not seen.

    Args:
        predicate: Whose facts.
        arity: How many arguments they must have.
        attributes: The attributes that they must have.
        key: The cells they are looked up by.
        values: The cells that bind variables.
        equal: Pairs of cells that must agree: a variable repeated inside one pattern.
    """

    __slots__ = ("_equal", "_hash", "_identity", "_key", "_values", "arity", "attributes")

    def __init__(
        self,
        predicate: str,
        arity: int,
        attributes: tuple[str, ...],
        key: tuple[int, ...],
        values: tuple[int, ...],
        equal: tuple[tuple[int, int], ...],
    ) -> None:
        self.arity = arity
        self.attributes = attributes
        self._key = key_getter(key)
        self._values = row_getter(values)
        self._equal = equal
        self._identity = (predicate, arity, attributes, key, values, equal)
        self._hash = hash(self._identity)

    @property
    def predicate(self) -> str:
        """The predicate whose facts are looked at."""
        return self._identity[0]

    @property
    def places(self) -> tuple[int, ...]:
        """The cells that facts are looked up by: arguments first, then attributes."""
        return self._identity[3]

    def __hash__(self) -> int:
        return self._hash

    def __eq__(self, other: object) -> bool:
        return isinstance(other, View) and self._identity == other._identity

    def insert(self, index: Index, fact: Belief, number: int) -> None:
        """Put a fact into this view's index, unless the view does not see it."""
        if len(fact.args) != self.arity:
            return
        if self.attributes and not all(name in fact.attributes for name in self.attributes):
            return
        cells = self._cells(fact)
        if any(cells[one] != cells[other] for one, other in self._equal):
            return
        entry = (self._values(cells), fact, number)
        key = self._key(cells)
        entries = index.get(key)
        if entries is None:
            index[key] = [entry]
        else:
            entries.append(entry)

    def binds(self, fact: Belief) -> Row:
        """Give the values that a fact which it sees adds to a row."""
        return self._values(self._cells(fact))

    def _cells(self, fact: Belief) -> Row:
        if not self.attributes:
            return fact.args
        return fact.args + tuple([fact.attributes[name] for name in self.attributes])


def row_getter(positions: tuple[int, ...]) -> Callable[[Row], Row]:
    """Give a function that picks these positions out of a row, always as a tuple."""
    if len(positions) > 1:
        return itemgetter(*positions)
    first = positions[0] if positions else 0
    return itemgetter(slice(first, first + len(positions)))


def key_getter(positions: tuple[int, ...]) -> Callable[[Row], Key]:
    """Give a function that picks these positions out of a row; of one, the bare value."""
    return itemgetter(*positions) if positions else row_getter(positions)
