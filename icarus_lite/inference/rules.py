"""Rules: a concept clause compiled to plans, and what follows from facts by it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from icarus_lite.errors import InferenceError
from icarus_lite.inference.evaluator import Evaluator
from icarus_lite.inference.expressions import compile_bind
from icarus_lite.inference.facts import FactStore
from icarus_lite.inference.join import Plan, Tick
from icarus_lite.inference.matching import Matcher
from icarus_lite.inference.supports import Derivation, bind_pattern
from icarus_lite.inference.views import Entry, Row, row_getter
from icarus_lite.language.syntax import Atom, ConceptClause, Constant, Variable
from icarus_lite.records import dataclass
from icarus_lite.symbols import Belief, Value


class Rule:
    """One clause of a concept, compiled.

    Args:
        clause: The clause.
        growing: The predicates that are inferred together with its head: facts of these come to be
            while the rule is in use.
        evaluator: Evaluates the tests and binds of the domain.
    """

    __slots__ = ("_head", "_plan", "_updates", "clause")

    def __init__(
        self, clause: ConceptClause, growing: frozenset[str], evaluator: Evaluator
    ) -> None:
        self.clause = clause
        matcher = Matcher(clause.elements, clause.tests, evaluator=evaluator)
        self._plan = matcher.plan()
        self._head = _Head.of(clause, self._plan, evaluator)
        self._updates = tuple(
            matcher.plan(lead=place, growing=growing)
            for place, atom in enumerate(matcher.conjunction.positive)
            if atom.predicate in growing
        )

    def all(
        self, facts: FactStore, tick: Tick | None = None
    ) -> Iterator[tuple[Belief, Derivation]]:
        """Give everything that follows, in the order of the facts, the first condition slowest.

        Args:
            facts: What to join.
            tick: Is called now and then, to look at the clock.

        Raises:
            InferenceError: a test or a bind cannot be evaluated.
        """
        for row, entries in self._plan.run(facts, tick=tick):
            yield self._head.conclude(row, entries)

    def new(
        self, facts: FactStore, since: int, tick: Tick | None = None
    ) -> Iterator[tuple[Belief, Derivation]]:
        """Give what follows and rests on a fact numbered `since` or higher, in the same order.

        Args:
            facts: What to join.
            since: What is old: the facts with smaller numbers.
            tick: Is called now and then, to look at the clock.

        Raises:
            InferenceError: a test or a bind cannot be evaluated.
        """
        found = [
            tuple([entries[place] for place in plan.places])
            for plan in self._updates
            for _, entries in plan.run(facts, since=since, tick=tick)
        ]
        found.sort(key=_numbers)  # no two matches rest on the same facts
        for entries in found:
            yield self._head.conclude(self._plan.row(entries), entries)


def _numbers(entries: tuple[Entry, ...]) -> tuple[int, ...]:
    return tuple([number for _, _, number in entries])


@dataclass(frozen=True, slots=True)
class _Head:
    """Turns a match into the belief that follows, and its derivation.

    Args:
        clause: The clause.
        negative: Its negated conditions.
        binds: What is computed, in order; each value is appended to the row.
        constants: The constants of the head, appended after that.
        args: Picks the arguments out of the row.
        attributes: Picks the values of the head's attributes.
        slots: Where each variable stands in the row.
        values: Picks the values of these variables.
        unbound: Whether a variable of the head is bound by nothing, so that nothing can follow.
    """

    clause: ConceptClause
    negative: tuple[Atom, ...]
    binds: tuple[Callable[[Row], Value], ...]
    constants: Row
    args: Callable[[Row], Row]
    attributes: Callable[[Row], Row]
    slots: Mapping[str, int]
    values: Callable[[Row], Row]
    unbound: bool

    @classmethod
    def of(cls, clause: ConceptClause, plan: Plan, evaluator: Evaluator) -> _Head:
        slots = dict(plan.slots)
        width = len(plan.constants) + len(slots)
        binds = []
        for bind in clause.binds:
            compiled = compile_bind(
                bind.expression, dict(slots), evaluator.functions, evaluator.path
            )
            binds.append(compiled)
            slots[bind.variable.name] = width
            width += 1
        head, constants, unbound = clause.head, [], False

        def place(term: Variable | Constant) -> int:
            nonlocal unbound
            if isinstance(term, Constant):
                constants.append(term.value)
                return width + len(constants) - 1
            unbound |= term.name not in slots
            return slots.get(term.name, 0)

        args = row_getter(tuple([place(term) for term in head.args]))
        attributes = row_getter(tuple([place(term) for _, term in head.attributes]))
        return cls(
            clause,
            tuple(c.atom for c in clause.elements if c.negated),
            tuple(binds),
            tuple(constants),
            args,
            attributes,
            slots,
            row_getter(tuple(slots.values())),
            unbound,
        )

    def conclude(self, row: Row, entries: tuple[Entry, ...]) -> tuple[Belief, Derivation]:
        for bind in self.binds:
            row = (*row, bind(row))
        clause, head = self.clause, self.clause.head
        if self.unbound:
            raise InferenceError(f"a variable of the head {head} is never bound")
        bindings = dict(zip(self.slots, self.values(row), strict=True))
        row += self.constants
        attributes: dict[str, Value] = {}
        if head.attributes:
            names = (name for name, _ in head.attributes)
            attributes = dict(zip(names, self.attributes(row), strict=True))
        belief = Belief(head.predicate, self.args(row), attributes)
        matched = tuple([fact for _, fact, _ in entries])
        absent = tuple([bind_pattern(atom, bindings) for atom in self.negative])
        return belief, Derivation(clause, bindings, matched, absent)
