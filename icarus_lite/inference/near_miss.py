"""How far each clause got, and the first of its conditions that fails, in one line each.

This is `why-not` for whoever has many clauses to tell of and one line for each: the planner's
candidates, a domain test that failed. The whole answer is in `explaining`.
"""

from __future__ import annotations

from collections.abc import Sequence

from icarus_lite.inference.evaluator import Evaluator
from icarus_lite.inference.explaining.attempts import nearest_attempt
from icarus_lite.inference.explaining.diagnosis import nearest_beliefs
from icarus_lite.inference.explaining.fitting import fit
from icarus_lite.inference.facts import Bindings, FactStore
from icarus_lite.inference.supports import Literal
from icarus_lite.language.syntax import Atom, Call, ConceptClause, Condition, SkillClause
from icarus_lite.records import dataclass
from icarus_lite.symbols import Belief

__all__ = ["NearMiss", "Obstacle", "first_obstacle", "near_misses", "nearest_beliefs"]


@dataclass(frozen=True, slots=True)
class Obstacle:
    """The first condition that fails in the nearest attempt to meet a conjunction.

    Args:
        condition: The condition as the domain states it.
        bound: The same with the values of that attempt filled in.
        met: How many of the conjunction's conditions and tests that attempt meets.
        blocking: For a `not`, the belief that is in the way.
        error: For a test that has no value, why.
    """

    condition: Literal
    bound: Literal
    met: int
    blocking: Belief | None = None
    error: str = ""

    def __str__(self) -> str:
        if self.blocking is not None:
            return f"{self.bound} fails: {self.blocking} is believed"
        if self.error:
            return f"{self.bound} cannot be asked: {self.error}"
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
    """Give the first condition that fails in the nearest attempt, or None if all of it holds.

    Conditions are told in the order in which inference asks them: the positive ones as written,
    each test as soon as its variables are bound, then the negated ones. See `nearest_attempt`.
    """
    attempt = nearest_attempt(conditions, tests, facts, bindings, evaluator)
    failure = attempt.failure
    if failure is None:
        return None
    negated = isinstance(failure.condition, Condition) and failure.condition.negated
    blocking = failure.fact if negated else None
    return Obstacle(failure.condition, failure.bound, attempt.met, blocking, failure.error)


def _near_miss(
    asked: Atom, clause: ConceptClause | SkillClause, facts: FactStore, evaluator: Evaluator
) -> NearMiss:
    stands = fit(clause.head, asked, clause.binds if isinstance(clause, ConceptClause) else ())
    if stands is None:
        return NearMiss(clause, None, fits=False)
    tests = (*clause.tests, *stands.demands)
    return NearMiss(
        clause, first_obstacle(clause.elements, tests, facts, stands.bindings, evaluator)
    )
