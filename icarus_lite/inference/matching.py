"""Conditions against facts: the join behind concepts, skills and goals."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from icarus_lite.inference.evaluator import Evaluator
from icarus_lite.inference.facts import Bindings, FactStore
from icarus_lite.inference.join import Conjunction, Plan, compile_plan
from icarus_lite.inference.views import row_getter
from icarus_lite.language.syntax import Atom, Call, Condition, variables_of
from icarus_lite.records import dataclass
from icarus_lite.symbols import Belief, Value


@dataclass(frozen=True, slots=True)
class Match:
    """One way in which conditions hold.

    Args:
        bindings: What the variables are bound to.
        matched: The facts that met the positive conditions, in their order.
        absent: The patterns that nothing matches, as written.
    """

    bindings: Mapping[str, Value]
    matched: tuple[Belief, ...]
    absent: tuple[Atom, ...]


class Matcher:
    """Finds every way in which a conjunction holds.

    Positive conditions are joined in the order written, each test is tried as soon as its
    variables are bound, and negated conditions come last: a variable that is still free then
    occurs only inside its `not` and reads "there is none".
    """

    __slots__ = ("_evaluator", "_plans", "conjunction")

    def __init__(
        self,
        conditions: Sequence[Condition],
        tests: Sequence[Call] = (),
        bound: Sequence[str] = (),
        evaluator: Evaluator | None = None,
    ) -> None:
        self._evaluator = evaluator or Evaluator()
        positive = tuple(c.atom for c in conditions if not c.negated)
        negative = tuple(c.atom for c in conditions if c.negated)
        self.conjunction = Conjunction(positive, negative, _in_turn(tests, positive, bound))
        self._plans: dict[tuple[str, ...], Plan] = {}

    def matches(self, facts: FactStore, bindings: Bindings | None = None) -> Iterator[Match]:
        """Give each match, in a fixed order: that of the facts, the first condition slowest.

        Raises:
            InferenceError: a test compares what cannot be compared.
        """
        given = bindings or {}
        names = tuple(given)
        plan = self._plans.get(names)
        if plan is None:
            plan = self._plans[names] = self.plan(names)
        slots, negative = plan.slots, self.conjunction.negative
        values = row_getter(tuple(slots.values()))
        for row, entries in plan.run(facts, tuple(given.values())):
            bound = dict(zip(slots, values(row), strict=True))
            yield Match(bound, tuple(fact for _, fact, _ in entries), negative)

    def plan(
        self,
        given: tuple[str, ...] = (),
        lead: int | None = None,
        growing: frozenset[str] = frozenset(),
    ) -> Plan:
        """Compile the conjunction: see `compile_plan`."""
        functions, path = self._evaluator.functions, self._evaluator.path
        return compile_plan(self.conjunction, given, functions, path, lead, growing)


def _in_turn(
    tests: Sequence[Call], positive: Sequence[Atom], bound: Sequence[str]
) -> tuple[tuple[Call, ...], ...]:
    """Give the tests to try before the first condition, after the first, and so on."""
    known, waiting = set(bound), list(tests)
    turns: list[tuple[Call, ...]] = []
    for atom in (None, *positive):
        if atom is not None:
            known.update(atom.variables)
        ready = [test for test in waiting if known.issuperset(variables_of(test))]
        turns.append(tuple(ready))
        waiting = [test for test in waiting if test not in ready]
    turns[-1] += tuple(waiting)  # an unbound variable: evaluation says so, with place
    return tuple(turns)
