"""Instances as literals over numbered facts: what an operator needs, adds and deletes.

A literal is the number of a fact, or `~number` for "it does not hold". A negated condition becomes
the absence of every fact it speaks of; if these are many, of one made-up fact that follows from
all these absences.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from icarus_lite.inference.canonical import canonical
from icarus_lite.language.syntax import Atom
from icarus_lite.planning.grounding.clauses import GroundedClause
from icarus_lite.planning.grounding.hierarchy import NumberedEvent
from icarus_lite.planning.grounding.views import Attributes, Cells
from icarus_lite.records import dataclass, field
from icarus_lite.symbols import Value

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

_MOST_ABSENCES = 4
"""Facts that a negated condition speaks of before a made-up fact stands for their absence."""

NONE = "no "
"""Begins the name of such a made-up fact."""


@dataclass(slots=True)
class Instance:
    """A skill instance as literals.

    Args:
        clause: Its clause.
        row: What the variables of the clause are bound to.
        conditions: The literals it needs.
        adds: The facts it makes true.
        deletes: The facts it ends; what it also adds is true.
        hierarchy: What it does to attachments, where that must be done step by step: for each
            `Attach` the number of the pair, for a `Detach` the numbers of all it may end.
        expected: For beliefs that concepts may derive as well: the fact that it is asserted.
        ended: Likewise for what it ends: the derived fact, and that nothing has ended it.
    """

    clause: GroundedClause
    row: Cells
    conditions: tuple[int, ...]
    adds: tuple[int, ...]
    deletes: tuple[int, ...]
    hierarchy: tuple[NumberedEvent, ...] = ()
    expected: tuple[int, ...] = ()
    ended: tuple[tuple[int, int], ...] = ()

    @property
    def depends_on_state(self) -> bool:
        """Whether what it does may depend on the state."""
        return bool(self.hierarchy or self.expected or self.ended)

    @property
    def effects(self) -> tuple[object, ...]:
        """What it does."""
        return self.adds, self.deletes, self.hierarchy, self.expected, self.ended


@dataclass(frozen=True, slots=True)
class Derivation:
    """A way in which a derived fact follows.

    Args:
        head: The fact.
        conditions: The literals that it follows from.
        rank: Where clauses compete for the value of an attribute, the first to hold wins.
    """

    head: int
    conditions: tuple[int, ...]
    rank: tuple[Any, ...] = ()


@dataclass(slots=True)
class Literals:
    """A planning problem in literals, before anything is left out.

    Args:
        atoms: What each fact is.
        instances: The operators.
        derivations: The derivations of each derived fact.
        initial: The facts that hold now, derived ones left out.
        constant: The facts that hold now and always.
        variants: For a belief that may have several values of its attributes: the facts, each
            with all of them.
        hierarchy: The facts of the attachment hierarchy, each with child and parent.
        recursive: The concepts that are used in their own definition, those alike that are
            defined by one another.
    """

    atoms: list[tuple[str, Cells, Attributes]]
    instances: list[Instance] = field(default_factory=list)
    derivations: dict[int, list[Derivation]] = field(default_factory=dict)
    initial: set[int] = field(default_factory=set)
    constant: set[int] = field(default_factory=set)
    variants: dict[int, tuple[int, ...]] = field(default_factory=dict)
    hierarchy: Mapping[int, tuple[Value, Value]] = field(default_factory=dict)
    recursive: Mapping[str, int] = field(default_factory=dict)


def fact_of(literal: int) -> int:
    """Give the fact that a literal is about."""
    return literal if literal >= 0 else ~literal


class Absences:
    """Negated conditions as literals."""

    __slots__ = ("_literals", "_made")

    def __init__(self, literals: Literals) -> None:
        self._literals = literals
        self._made: dict[tuple[int, ...], int] = {}

    def of(self, numbers: Sequence[int], pattern: Atom) -> tuple[int, ...] | None:
        """Give the literals that say that none of these facts holds; None if one always does."""
        literals = self._literals
        if not literals.constant.isdisjoint(numbers):
            return None
        if len(numbers) <= _MOST_ABSENCES:
            return tuple([~number for number in numbers])
        key = tuple(numbers)
        made = self._made.get(key)
        if made is None:
            made = self._made[key] = len(literals.atoms)
            literals.atoms.append((f"{NONE}{pattern} {len(self._made)}", (), ()))
            absent = tuple([~number for number in numbers])
            literals.derivations[made] = [Derivation(made, absent)]
        return (made,)


def rank_of(clause: GroundedClause, attributes: Mapping[str, Any], number: int) -> tuple[Any, ...]:
    """Give the order in which clauses and values compete for an attribute."""
    written = [name for name, _ in clause.clause.head.attributes]
    return number, canonical(attributes[name] for name in written)
