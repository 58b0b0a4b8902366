"""The facts that a pattern of a clause speaks of, given an instance; and what its effects end."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from operator import itemgetter

from icarus_lite.language.syntax import Atom, Constant, Term
from icarus_lite.planning.grounding.clauses import GroundedClause
from icarus_lite.planning.grounding.facts import GIVEN, FactBase
from icarus_lite.planning.grounding.prepared import Prepared
from icarus_lite.planning.grounding.views import Cells, Index, view_of
from icarus_lite.records import dataclass
from icarus_lite.symbols import ATTACHED

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any


@dataclass(frozen=True, slots=True)
class Lookup:
    """Facts that a pattern of a clause speaks of, given an instance.

    Args:
        pattern: The pattern.
        index: The facts.
        key: Makes the key of the index out of a row.
    """

    pattern: Atom
    index: Index
    key: Callable[[Cells], Any]

    def of(self, row: Cells) -> Sequence[int]:
        """Give the numbers of the facts."""
        return self.index.get(self.key(row), ())


def lookup(base: FactBase, pattern: Atom, names: Sequence[str]) -> Lookup:
    """Give how a clause with these variables looks up the facts that a pattern speaks of."""
    view, terms, _ = view_of(pattern, names, binding=False)
    return Lookup(pattern, base.index(view), key_getter(terms, names))


class Removals:
    """What the effects of one clause end."""

    __slots__ = ("_derived", "_given")

    def __init__(self, clause: GroundedClause, prepared: Prepared, base: FactBase) -> None:
        given, derived = [], []
        for pattern in clause.removals:
            predicate = pattern.predicate
            if predicate in prepared.concepts:
                named = Atom(GIVEN + predicate, pattern.args, pattern.attributes)
                given.append(lookup(base, named, clause.variables))
                derived.append(lookup(base, pattern, clause.variables))
            if predicate == ATTACHED:
                held = Atom(prepared.hierarchy, pattern.args, pattern.attributes)
                given.append(lookup(base, held, clause.variables))
            elif predicate not in prepared.concepts:
                given.append(lookup(base, pattern, clause.variables))
        self._given, self._derived = tuple(given), tuple(derived)

    @property
    def of_concepts(self) -> bool:
        """Whether it ends what concepts may derive."""
        return bool(self._derived)

    def of(self, row: Cells) -> Sequence[int]:
        """Give the asserted facts that an instance ends."""
        if len(self._given) == 1:
            return self._given[0].of(row)
        return [number for each in self._given for number in each.of(row)]

    def derived(self, row: Cells) -> list[int]:
        """Give the derived facts that an instance ends."""
        return [number for each in self._derived for number in each.of(row)]


def key_getter(terms: Sequence[Term], names: Sequence[str]) -> Callable[[Cells], Any]:
    """Give a function that makes the key of an index out of a row: one cell bare, else a tuple."""
    places = {name: place for place, name in enumerate(names)}
    if not terms:
        return lambda _: ()
    if all(not isinstance(term, Constant) for term in terms):
        return itemgetter(*(places[term.name] for term in terms if not isinstance(term, Constant)))
    parts = [
        (None, term.value) if isinstance(term, Constant) else (places[term.name], "")
        for term in terms
    ]
    if len(parts) == 1:
        value = parts[0][1]
        return lambda _: value
    return lambda row: tuple([v if place is None else row[place] for place, v in parts])
