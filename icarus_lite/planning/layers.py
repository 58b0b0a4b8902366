"""Facts in two layers, so that what stays as it is need not be taken over from state to state."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence

from icarus_lite.inference import FactStore
from icarus_lite.inference.views import Entry, Key, View
from icarus_lite.language.syntax import Domain
from icarus_lite.planning.relevance import signs_of_effects
from icarus_lite.symbols import Belief


class LayeredFacts(FactStore):
    """Facts that may change, above those that stay as they are.

    Args:
        below: All facts of now.
        fluents: The predicates whose facts may change; those below are not seen.
    """

    __slots__ = ("_below", "_fluents")

    def __init__(self, below: FactStore, fluents: Collection[str]) -> None:
        super().__init__()
        self._below, self._fluents = below, fluents

    def __contains__(self, fact: Belief) -> bool:
        if fact.predicate in self._fluents:
            return super().__contains__(fact)
        return fact in self._below

    def __iter__(self) -> Iterator[Belief]:
        yield from (fact for fact in self._below if fact.predicate not in self._fluents)
        yield from super().__iter__()

    @property
    def changing(self) -> Iterator[Belief]:
        """The facts that may change."""
        return super().__iter__()

    def rows(self, predicate: str) -> Mapping[Key, Sequence[Entry]]:
        """Give the facts of a predicate by all their arguments, as entries that bind nothing."""
        if predicate in self._fluents:
            return super().rows(predicate)
        return self._below.rows(predicate)

    def index(self, view: View) -> Mapping[Key, Sequence[Entry]]:
        """Give the hash index of a view."""
        if view.predicate in self._fluents:
            return super().index(view)
        return self._below.index(view)


def fluents_of(domain: Domain) -> frozenset[str]:
    """Give the predicates whose beliefs skills may change, directly or through concepts."""
    fluents = {sign for clause in domain.skills for sign, _ in signs_of_effects(domain, clause)}
    before = -1
    while before != len(fluents):
        before = len(fluents)
        for concept in domain.concepts:
            if any(c.atom.predicate in fluents for c in concept.elements):
                fluents.add(concept.head.predicate)
    return frozenset(fluents)
