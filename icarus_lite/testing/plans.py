"""The `:goal` and `:plan` of a test: the planner's own plan, step by step beside the stated one."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import zip_longest

from icarus_lite.inference import FactStore, InferenceEngine, Memory, near_misses
from icarus_lite.language.syntax import Atom, DomainTest
from icarus_lite.planning import Imagination, NoPlan, find_plan
from icarus_lite.testing.outcome import Difference, Kind


def check_plan(engine: InferenceEngine, memory: Memory, test: DomainTest) -> Iterator[Difference]:
    """Plan for the goal of a test from its last cycle; give what differs, if anything does.

    Without a `:plan`, any plan will do. With one, it has to be the planner's: the same question
    always gets the same plan, so that the test says what the agent would do.

    Raises:
        InferenceError: a test of the domain cannot be evaluated.
    """
    if not test.goals:
        return
    cycle = len(test.then)
    goal = " ".join(str(condition) for condition in test.goals)
    imagination = Imagination(engine.domain, memory, engine.closure, engine.evaluator)
    found = find_plan(engine.domain, imagination, test.goals)
    if isinstance(found, NoPlan):
        message = f"there is no plan: {found.reason}"
        yield Difference(Kind.PLAN, cycle, goal, message, (), test.goals[0].span)
        return
    if test.plan is None:
        return
    stated = [str(step) for step in test.plan]
    steps = [str(step.action) for step in found.steps]
    if stated == steps:
        return
    parting = next(i for i, (s, f) in enumerate(zip_longest(stated, steps), 1) if s != f)
    message = f"the planner's plan differs from step {parting} on"
    details = (*_side_by_side(stated, steps), _verdict(engine, imagination, test))
    span = test.plan[min(parting, len(stated)) - 1].span if test.plan else test.span
    yield Difference(Kind.PLAN, cycle, goal, message, details, span)


def _side_by_side(stated: Sequence[str], found: Sequence[str]) -> Iterator[str]:
    width = max(len(step) for step in ("stated", *stated))
    yield f"      {'stated':<{width}}  found"
    for number, (left, right) in enumerate(zip_longest(stated, found, fillvalue="-"), 1):
        mark = " " if left == right else ">"
        yield f"{mark} {number:>3} {left:<{width}}  {right}"


def _verdict(engine: InferenceEngine, imagination: Imagination, test: DomainTest) -> str:
    """Say whether the stated plan would work, and if not, which step cannot start."""
    situation = imagination.start
    primitives = [clause for clause in engine.domain.skills if clause.is_primitive]
    for number, stated in enumerate(test.plan or (), 1):
        facts = imagination.facts(situation)
        steps = imagination.applicable(primitives, facts)
        step = next((s for s in steps if str(s.action) == str(stated)), None)
        if step is None:
            why = _why_not(engine, stated, facts)
            return f"step {number} of the stated plan cannot start: {why}"
        situation = imagination.after(situation, step)
    if imagination.holds(test.goals, imagination.facts(situation)):
        return "the stated plan would reach the goal, too"
    return "the stated plan does not reach the goal"


def _why_not(engine: InferenceEngine, stated: Atom, facts: FactStore) -> str:
    clauses = [c for c in engine.domain.skills if c.head.predicate == stated.predicate]
    if not clauses:
        return f"no skill is called `{stated.predicate}`"
    if not any(clause.is_primitive for clause in clauses):
        return "it is done through subskills, and a plan names the skills that act"
    return "; ".join(str(miss) for miss in near_misses(stated, clauses, facts, engine.evaluator))
