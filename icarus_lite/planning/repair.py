"""What still works of a plan when the world is not as the plan had it.

What a rest of the plan needs is looked up in its links, which costs next to nothing. What is to be
trusted after a surprise is carried out in the mind as well.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence

from icarus_lite.inference import FactStore
from icarus_lite.planning.causes import Requirement
from icarus_lite.planning.links import with_links
from icarus_lite.planning.plan import Plan
from icarus_lite.planning.projection import Projection, project, rebound
from icarus_lite.planning.situation import Imagination
from icarus_lite.planning.steps import PlanStep
from icarus_lite.records import dataclass
from icarus_lite.symbols import Action


@dataclass(frozen=True, slots=True)
class Rest:
    """A rest of a plan that leads to its goals from now.

    Args:
        plan: The plan; another than before where the rest works for other reasons than before,
            without the steps that are behind it.
        position: The step of it, from 0, to go on with.
        start: The step of the plan as it was, from 0, with which the rest begins.
        projection: How the rest was carried out in the mind.
        left_out: How many of the steps from `start` on it does without.
    """

    plan: Plan
    position: int
    start: int
    projection: Projection
    left_out: int = 0


def unmet(plan: Plan, position: int, facts: FactStore) -> tuple[Requirement, ...]:
    """Give what the rest of a plan needs now, from a step on, and does not find."""
    return tuple(each for each in plan.required(position) if not each.holds(facts))


def later_start(
    imagination: Imagination, plan: Plan, position: int, excluded: Collection[Action] = ()
) -> Rest | None:
    """Find the latest step from which the plan works, past the one that is next: somebody helped.

    Only steps whose needs are met as the plan has them come into question.
    """
    facts = imagination.facts(imagination.start)
    starts = range(len(plan.steps) - 1, position, -1)
    return _first(imagination, plan, (s for s in starts if not unmet(plan, s, facts)), excluded)


def working_rest(
    imagination: Imagination, plan: Plan, excluded: Collection[Action] = ()
) -> Rest | None:
    """Find the shortest rest of a plan that works from now, in whatever way.

    That may be the one that is due, a later one, or one that begins with a step done before.
    """
    return _first(imagination, plan, range(len(plan.steps) - 1, -1, -1), excluded)


def sparse_rest(
    imagination: Imagination, plan: Plan, position: int, excluded: Collection[Action] = ()
) -> Rest | None:
    """Find out whether the rest of a plan works without the steps that cannot start now.

    Somebody may have done what they were for. Steps that then serve nothing are left out as well.
    """
    steps = _possible(imagination, plan.steps[position:], excluded)
    projection = project(imagination, steps, plan.goals)
    if not projection.valid:
        return None
    linked = with_links(imagination, Plan(projection.steps, plan.goals), projection)
    needed = _serving(linked)
    if len(needed) < len(steps):
        fewer = project(imagination, [linked.steps[each] for each in needed], plan.goals)
        if fewer.valid:
            projection = fewer
            linked = with_links(imagination, Plan(fewer.steps, plan.goals), fewer)
    if not linked.steps:
        return None
    left_out = len(plan.steps) - position - len(linked.steps)
    return Rest(linked, 0, position, projection, left_out)


def _possible(
    imagination: Imagination, steps: Sequence[PlanStep], excluded: Collection[Action]
) -> list[PlanStep]:
    """Give the steps that can start one after the other."""
    situation, possible = imagination.start, list[PlanStep]()
    for step in steps:
        facts = imagination.facts(situation)
        again = None if step.action in excluded else rebound(imagination, step, facts)
        if again is not None:
            possible.append(again)
            situation = imagination.after(situation, again)
    return possible


def _serving(plan: Plan) -> list[int]:
    """Give the steps that serve a goal, directly or through others."""
    links = plan.links
    serving = {link.producer for link in links if link.consumer is None}
    before = -1
    while before != len(serving):
        before = len(serving)
        serving |= {x.producer for x in links if x.consumer is not None and x.consumer in serving}
    return sorted(each for each in serving if each is not None)


def _first(
    imagination: Imagination, plan: Plan, starts: Iterable[int], excluded: Collection[Action]
) -> Rest | None:
    for start in starts:
        steps = plan.steps[start:]
        if any(step.action in excluded for step in steps):
            continue
        projection = project(imagination, steps, plan.goals)
        if projection.valid:
            return _rest(imagination, plan, start, projection)
    return None


def _rest(imagination: Imagination, plan: Plan, start: int, projection: Projection) -> Rest:
    if unmet(plan, start, projection.stages[0].facts):
        fresh = with_links(imagination, Plan(projection.steps, plan.goals), projection)
        return Rest(fresh, 0, start, projection)
    return Rest(plan.rebound(start, projection.steps), start, start, projection)
