"""Forward search over imagined situations: a shortest sequence of skills to a goal."""

from __future__ import annotations

from collections import deque
from collections.abc import Collection, Sequence
from dataclasses import dataclass

from icarus_lite.inference import FactStore
from icarus_lite.language.syntax import Condition, Constant, Domain
from icarus_lite.planning.failures import FailureReason
from icarus_lite.planning.relevance import can_change, relevance
from icarus_lite.planning.situation import Imagination, PlanStep, Situation
from icarus_lite.symbols import Action

DEFAULT_LIMIT = 5_000
"""Situations expanded before the search gives up."""


@dataclass(frozen=True, slots=True)
class Plan:
    """The steps that lead from now to the goal; none if it holds already."""

    steps: tuple[PlanStep, ...]


@dataclass(frozen=True, slots=True)
class NoPlan:
    """Why there is no plan.

    Args:
        reason: A sentence for the person who asked.
        final: True when no plan can exist for these percepts, False when a limit was reached.
        failure: The name of the reason.
    """

    reason: str
    final: bool
    failure: FailureReason = FailureReason.GOAL_UNREACHABLE


def find_plan(
    domain: Domain,
    imagination: Imagination,
    goals: Sequence[Condition],
    *,
    excluded: Collection[Action] = (),
    limit: int = DEFAULT_LIMIT,
) -> Plan | NoPlan:
    """Find a shortest plan, breadth first over the skills that can serve the goal.

    The same question gives the same plan: skills are tried in the order of the domain, their
    instances in the order of the beliefs.

    Args:
        domain: Skills, concepts and attachments.
        imagination: Expands situations from the beliefs of now.
        goals: The conjunction to achieve.
        excluded: Actions that must not be used, for example because they failed too often.
        limit: How many situations to expand at most.
    """
    facts = imagination.facts(imagination.start)
    if imagination.holds(goals, facts):
        return Plan(())
    for goal in goals:
        hopeless = _hopeless(domain, imagination, goal, facts)
        if hopeless:
            return NoPlan(hopeless, final=True)
    clauses = relevance(domain, goals).skills
    frontier: deque[tuple[Situation, tuple[PlanStep, ...]]] = deque([(imagination.start, ())])
    visited = {imagination.start.key}
    expanded = 0
    while frontier:
        if expanded >= limit:
            reason = f"no plan among the first {limit} situations imagined"
            return NoPlan(reason, final=False, failure=FailureReason.SEARCH_LIMIT)
        situation, steps = frontier.popleft()
        expanded += 1
        facts = imagination.facts(situation)
        for step in imagination.applicable(clauses, facts):
            if step.action in excluded:
                continue
            imagined = imagination.after(situation, step)
            if imagined.key in visited:
                continue
            visited.add(imagined.key)
            if imagination.holds(goals, imagination.facts(imagined)):
                return Plan((*steps, step))
            frontier.append((imagined, (*steps, step)))
    return _dead_end(domain, imagination, goals, excluded)


def _hopeless(domain: Domain, imagination: Imagination, goal: Condition, facts: FactStore) -> str:
    """Say why a goal cannot be reached whatever is tried; empty if nothing speaks against it."""
    unknown = _unknown(goal, facts)
    if unknown:
        return f"{goal} speaks of {unknown}, which is not perceived"
    if not imagination.holds([goal], facts) and not can_change(domain, goal):
        return f"no skill can ever make {goal} true"
    return ""


def _unknown(goal: Condition, facts: FactStore) -> str:
    """Name the first constant of a goal that no fact speaks of; empty if all are known."""
    known = {value for fact in facts for value in fact.args}
    for term in goal.atom.args:
        if isinstance(term, Constant) and not goal.negated and term.value not in known:
            return str(term)
    return ""


def _dead_end(
    domain: Domain,
    imagination: Imagination,
    goals: Sequence[Condition],
    excluded: Collection[Action],
) -> NoPlan:
    wanted = " ".join(str(goal) for goal in goals)
    facts = imagination.facts(imagination.start)
    possible = imagination.applicable(relevance(domain, goals).skills, facts)
    names = sorted({str(step.action) for step in possible if step.action not in excluded})
    if names:
        shown = ", ".join(names[:3]) + (", …" if len(names) > 3 else "")
        reason = f"no sequence of skills reaches {wanted}, though {shown} could start now"
        return NoPlan(reason, final=True)
    reason = f"no skill that serves {wanted} can start now"
    return NoPlan(reason, final=True, failure=FailureReason.CONDITIONS_UNSATISFIED)
