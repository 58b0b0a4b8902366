"""A first `why-not`: how far each clause got, and the first of its conditions that fails.

A conjunction fails in as many ways as there are bindings to try. What helps is the way that got
furthest, so each clause is told by one obstacle: the condition at which its best attempt stopped.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from icarus_lite.inference.facts import Bindings, FactStore, unify
from icarus_lite.inference.matching import Evaluator, variables_of
from icarus_lite.inference.supports import bind_pattern
from icarus_lite.language.syntax import (
    Atom,
    Call,
    ConceptClause,
    Condition,
    Constant,
    Expression,
    SkillClause,
    Variable,
)
from icarus_lite.symbols import Belief, Value

NEAREST = 3
"""How many beliefs are shown beside one that is missing."""


@dataclass(frozen=True, slots=True)
class Obstacle:
    """The condition at which the best attempt to meet a conjunction stopped.

    Args:
        condition: The condition as the domain states it.
        bound: The same with the values of that attempt filled in.
        met: How many of the conjunction's conditions and tests that attempt had met before.
        blocking: For a `not`, the belief that is in the way.
    """

    condition: Condition | Call
    bound: Condition | Call
    met: int
    blocking: Belief | None = None

    def __str__(self) -> str:
        if self.blocking is not None:
            return f"{self.bound} fails: {self.blocking} is believed"
        if isinstance(self.bound, Call):
            return f"{self.bound} is not so"
        return f"nothing matches {self.bound}"


@dataclass(frozen=True, slots=True)
class NearMiss:
    """A clause that does not apply, and what keeps it from applying.

    Args:
        clause: A clause of the concept or skill that was asked about.
        obstacle: What it failed on; None if it failed on nothing, or if its head does not fit.
        fits: Whether the head can stand for what was asked about at all.
    """

    clause: ConceptClause | SkillClause
    obstacle: Obstacle | None
    fits: bool = True

    def __str__(self) -> str:
        span = self.clause.span
        place = f"{span.in_line}, {self.clause.head}" if span.line else str(self.clause.head)
        if not self.fits:
            return f"{place}: its head cannot stand for this"
        return f"{place}: {self.obstacle or 'all its conditions hold'}"


def near_misses(
    asked: Atom,
    clauses: Sequence[ConceptClause] | Sequence[SkillClause],
    facts: FactStore,
    evaluator: Evaluator | None = None,
) -> tuple[NearMiss, ...]:
    """Say of each clause for a belief or skill what keeps it from applying.

    Args:
        asked: The belief or the skill call; its variables stand for anything.
        clauses: Concept or skill clauses; those with another name are passed over.
        facts: Percepts and beliefs.
        evaluator: Evaluates the tests of the domain.

    Raises:
        InferenceError: a test of the domain cannot be evaluated.
    """
    return tuple(
        _near_miss(asked, clause, facts, evaluator or Evaluator())
        for clause in clauses
        if clause.head.predicate == asked.predicate
    )


def first_obstacle(
    conditions: Sequence[Condition],
    tests: Sequence[Call],
    facts: FactStore,
    bindings: Bindings,
    evaluator: Evaluator,
) -> Obstacle | None:
    """Give the condition at which the best attempt stopped, or None if the conjunction holds.

    Conditions are tried in the order in which inference tries them: the positive ones as written,
    each test as soon as its variables are bound, then the negated ones. Of attempts that got
    equally far the first counts.

    Raises:
        InferenceError: a test cannot be evaluated.
    """
    order = _in_order(conditions, tests, bindings)
    best: Obstacle | None = None
    for obstacle in _attempts(order, 0, facts, dict(bindings), evaluator):
        if obstacle is None:
            return None
        if best is None or obstacle.met > best.met:
            best = obstacle
    return best


def nearest_beliefs(asked: Atom, facts: FactStore, most: int = NEAREST) -> tuple[Belief, ...]:
    """Give the beliefs of the same predicate that agree with a pattern in most arguments."""

    def agreement(fact: Belief) -> int:
        pairs = zip(asked.args, fact.args, strict=False)
        return sum(isinstance(t, Constant) and t.value == value for t, value in pairs)

    same = [fact for fact in facts if fact.predicate == asked.predicate]
    return tuple(sorted(same, key=lambda fact: (-agreement(fact), str(fact)))[:most])


_Step: TypeAlias = Condition | Call


def _near_miss(
    asked: Atom, clause: ConceptClause | SkillClause, facts: FactStore, evaluator: Evaluator
) -> NearMiss:
    head = clause.head
    if len(head.args) != len(asked.args):
        return NearMiss(clause, None, fits=False)
    known = [
        (own, term.value)
        for own, term in zip(head.args, asked.args, strict=True)
        if isinstance(term, Constant)
    ]
    bindings = unify(known)
    if bindings is None:
        return NearMiss(clause, None, fits=False)
    obstacle = first_obstacle(clause.elements, clause.tests, facts, bindings, evaluator)
    return NearMiss(clause, obstacle)


def _in_order(
    conditions: Sequence[Condition], tests: Sequence[Call], bindings: Bindings
) -> tuple[_Step, ...]:
    """Put conditions and tests into the order in which inference tries them."""
    order: list[_Step] = []
    known, waiting = set(bindings), list(tests)
    for condition in (None, *(c for c in conditions if not c.negated)):
        if condition is not None:
            order.append(condition)
            known.update(condition.atom.variables)
        ready = [test for test in waiting if known.issuperset(variables_of(test))]
        order += ready
        waiting = [test for test in waiting if test not in ready]
    return (*order, *waiting, *(c for c in conditions if c.negated))


def _attempts(
    order: Sequence[_Step], at: int, facts: FactStore, bindings: dict[str, Value], ask: Evaluator
) -> Iterator[Obstacle | None]:
    """Give, for every way to try the steps, where it stopped; None for one that met them all."""
    if at == len(order):
        yield None
        return
    step = order[at]
    if isinstance(step, Call):
        if not ask(step, bindings):
            yield Obstacle(step, _bind_call(step, bindings), at)
            return
    elif step.negated:
        for _, blocking in facts.matches(step.atom, bindings):
            yield Obstacle(step, _bind_condition(step, bindings), at, blocking)
            return
    else:
        found = False
        for extended, _ in facts.matches(step.atom, bindings):
            found = True
            yield from _attempts(order, at + 1, facts, extended, ask)
        if not found:
            yield Obstacle(step, _bind_condition(step, bindings), at)
        return
    yield from _attempts(order, at + 1, facts, bindings, ask)


def _bind_condition(condition: Condition, bindings: Bindings) -> Condition:
    return Condition(bind_pattern(condition.atom, bindings), condition.negated, condition.span)


def _bind_call(call: Call, bindings: Bindings) -> Call:
    return Call(call.function, tuple(_bind(each, bindings) for each in call.args), call.span)


def _bind(expression: Expression, bindings: Bindings) -> Expression:
    if isinstance(expression, Call):
        return _bind_call(expression, bindings)
    if isinstance(expression, Variable) and expression.name in bindings:
        return Constant(bindings[expression.name], expression.span)
    return expression
