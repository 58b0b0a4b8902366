"""Plans in which other agents take part: what one can do oneself is not asked of them.

The search counts steps. What another agent does costs more than a step (`:cost`), so plans are made
with that agent's help and without it, and each request of a plan is questioned: is there one that
does without it, and costs less? Where the problem is small, the cheapest plan is looked for.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from typing import TypedDict, Unpack

from icarus_lite.language.syntax import Condition, Domain
from icarus_lite.language.teams import cost_of
from icarus_lite.planning import planner
from icarus_lite.planning.cheapest import cheaper_plan, least_cost
from icarus_lite.planning.grounding import PlanningDomain, ground_goals
from icarus_lite.planning.plan import NoPlan, Plan
from icarus_lite.planning.postponing import postponed
from icarus_lite.planning.situation import Imagination
from icarus_lite.planning.steps import PlanStep
from icarus_lite.records import replace
from icarus_lite.symbols import Action


class SearchOptions(TypedDict, total=False):
    """How long to search, and how long to improve a plan: see `planner.find_plan`."""

    limit: int | None
    seconds: float | None
    improvement: int | None
    improvement_s: float | None


def find_plan(
    domain: Domain,
    imagination: Imagination,
    goals: Sequence[Condition],
    *,
    excluded: Collection[Action] = (),
    prepared: PlanningDomain | None = None,
    **options: Unpack[SearchOptions],
) -> Plan | NoPlan:
    """Find a plan as `planner.find_plan` does; ask little of other agents, and ask it late.

    A domain in which every skill is one's own and counts as 1 is planned for once. Otherwise
    the limits hold for each of the plans that are compared.

    Args:
        domain: Skills, concepts and attachments.
        imagination: The beliefs of now, and what would follow from actions.
        goals: The conjunction to achieve.
        excluded: Actions that must not be used.
        prepared: The same domain, kept from call to call.
        options: How long to search.

    Raises:
        InferenceError: a test of the domain cannot be evaluated for what is believed now.
    """
    if all(clause.agent is None and cost_of(clause) == 1 for clause in domain.skills):
        return planner.find_plan(
            domain, imagination, goals, excluded=excluded, prepared=prepared, **options
        )
    kept = prepared or PlanningDomain(domain, imagination.evaluator)

    def ask(barred: Collection[Action]) -> Plan | NoPlan:
        return planner.find_plan(
            domain, imagination, goals, excluded=barred, prepared=kept, **options
        )

    found = _alone(kept, imagination, goals, excluded, options)
    task = ground_goals(kept, imagination.beginning, goals, excluded=excluded).task
    if found is not None and least_cost(task) >= cost_of_plan(found):
        return postponed(imagination, found)
    helped = ask(excluded) if found is None or _may_be_cheaper(domain, found) else found
    if isinstance(helped, NoPlan):
        return helped if found is None else found
    found = helped if found is None else min(found, helped, key=cost_of_plan)
    cheaper, is_cheapest = cheaper_plan(task, cost_of_plan(found))
    if cheaper is not None:
        found = replace(found, steps=cheaper)
    barred = [*excluded]
    while not is_cheapest:
        others = ((action, ask([*barred, action])) for action in _requests(found))
        spared = next((each for each in others if _is_cheaper(each[1], found)), None)
        if spared is None or isinstance(spared[1], NoPlan):
            break
        barred.append(spared[0])
        found = spared[1]
    return postponed(imagination, found)


def cost_of_plan(plan: Plan) -> int:
    """Give what a plan counts for: the costs of its steps."""
    return cost_of_steps(plan.steps)


def cost_of_steps(steps: Iterable[PlanStep]) -> int:
    """Give what steps count for together."""
    return sum(cost_of(step.clause) for step in steps)


def _alone(
    domain: PlanningDomain,
    imagination: Imagination,
    goals: Sequence[Condition],
    excluded: Collection[Action],
    options: SearchOptions,
) -> Plan | None:
    """Plan with one's own skills only; None where there is no such plan, or no other agent."""
    mine = domain.alone()
    if mine is domain:
        return None
    found = planner.find_plan(
        mine.domain, imagination, goals, excluded=excluded, prepared=mine, **options
    )
    return found if isinstance(found, Plan) else None


def _may_be_cheaper(domain: Domain, plan: Plan) -> bool:
    """Tell whether a plan with a request in it may cost less than one without."""
    least = min(cost_of(clause) for clause in domain.skills if clause.agent is not None)
    return cost_of_plan(plan) > least


def _is_cheaper(found: Plan | NoPlan, than: Plan) -> bool:
    return isinstance(found, Plan) and cost_of_plan(found) < cost_of_plan(than)


def _requests(plan: Plan) -> list[Action]:
    """Give what a plan asks of others, each thing once."""
    asked = [step.action for step in plan.steps if step.clause.agent is not None]
    return list(dict.fromkeys(asked))
