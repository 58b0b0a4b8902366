"""The facts of a cycle looked up one by one, for questions that need few of many.

A question about two objects need not take in what is believed of all others. As long as the
network stands in the cycle asked about, beliefs are looked up in it by the arguments that are
known; percepts and what is given are taken in as a whole.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence, ValuesView

from icarus_lite.inference.belief_supports import BeliefSupports, LazyFacts
from icarus_lite.inference.facts import Lineages
from icarus_lite.inference.views import Entry, Index, Key, View
from icarus_lite.symbols import Belief, Percept, Value

_Rows = Mapping[Key, Sequence[Entry]]


class PresentFacts(LazyFacts):
    """The percepts and beliefs of a cycle; of concepts only those that are asked for.

    Args:
        percepts: What is perceived.
        lineages: Each percept type with all types that its percepts belong to.
        beliefs: The beliefs of the same cycle.
        concepts: The predicates to look up one by one.
    """

    __slots__ = ("_one_by_one", "_rows_by_args", "_rows_by_view")

    def __init__(
        self,
        percepts: Sequence[Percept],
        lineages: Lineages,
        beliefs: BeliefSupports,
        concepts: frozenset[str],
    ) -> None:
        super().__init__(percepts, lineages, beliefs)
        self._one_by_one = concepts - set(self._perceived)
        self._rows_by_args: dict[str, _ByArguments] = {}
        self._rows_by_view: dict[View, _ByView] = {}

    def rows(self, predicate: str) -> _Rows:
        """Give the facts of a predicate by all their arguments, as entries that bind nothing."""
        if predicate in self._known or predicate not in self._one_by_one:
            return super().rows(predicate)
        rows = self._rows_by_args.get(predicate)
        if rows is None:
            rows = self._rows_by_args[predicate] = _ByArguments(self, predicate)
        return rows

    def index(self, view: View) -> _Rows:
        """Give the hash index of a view, or what answers in its place."""
        known = tuple(place for place in view.places if place < view.arity)
        taken_in = view.predicate in self._known or view.predicate not in self._one_by_one
        if taken_in or not known:
            self._take_in(view.predicate)
            return super().index(view)
        rows = self._rows_by_view.get(view)
        if rows is None:
            rows = self._rows_by_view[view] = _ByView(self, view, known)
        return rows

    def whole(self, predicate: str) -> _Rows:
        """Take in all facts of a predicate, and give them by all their arguments."""
        return super().rows(predicate)

    def like(self, predicate: str, arity: int, known: Mapping[int, Value]) -> list[Belief]:
        """Give the beliefs that have these values among their arguments, in order."""
        return self._beliefs.like(predicate, arity, known)

    def believed(self, predicate: str) -> int:
        """Count the beliefs of a predicate."""
        return self._beliefs.count(predicate)


class _ByArguments(_Rows):
    """The facts of a predicate by all their arguments, each looked up when it is asked for."""

    def __init__(self, facts: PresentFacts, predicate: str) -> None:
        self._facts, self._predicate = facts, predicate
        self._found: dict[Key, Sequence[Entry]] = {}

    def __getitem__(self, key: Key) -> Sequence[Entry]:
        found = self._found.get(key)
        if found is None:
            args = key if isinstance(key, tuple) else (key,)
            beliefs = self._facts.like(self._predicate, len(args), dict(enumerate(args)))
            found = self._found[key] = tuple(((), belief, 0) for belief in beliefs)
        if not found:
            raise KeyError(key)
        return found

    def __iter__(self) -> Iterator[Key]:
        return iter(self._facts.whole(self._predicate))

    def __len__(self) -> int:
        return self._facts.believed(self._predicate)

    def values(self) -> ValuesView[Sequence[Entry]]:
        return self._facts.whole(self._predicate).values()


class _ByView(_Rows):
    """The facts of a view by its key, those with the same known arguments looked up at once."""

    def __init__(self, facts: PresentFacts, view: View, known: tuple[int, ...]) -> None:
        self._facts, self._view, self._known = facts, view, known
        self._single = len(view.places) == 1
        self._parts: dict[tuple[Value, ...], Index] = {}

    def __getitem__(self, key: Key) -> Sequence[Entry]:
        cells = (key,) if self._single or not isinstance(key, tuple) else key
        known: dict[int, Value] = {
            place: value
            for place, value in zip(self._view.places, cells, strict=True)
            if place in self._known and not isinstance(value, tuple)
        }
        name = tuple(known.values())
        part = self._parts.get(name)
        if part is None:
            part = self._parts[name] = {}
            view = self._view
            for number, fact in enumerate(self._facts.like(view.predicate, view.arity, known)):
                view.insert(part, fact, number)
        return part[key]

    def __iter__(self) -> Iterator[Key]:
        self._facts.whole(self._view.predicate)
        return iter(self._facts.index(self._view))

    def __len__(self) -> int:
        self._facts.whole(self._view.predicate)
        return len(self._facts.index(self._view))
