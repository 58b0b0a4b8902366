"""Finding a plan: the beliefs of now are ground, and the ground problem is searched."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from icarus_lite.inference import FactStore
from icarus_lite.language.syntax import Condition, Constant, Domain
from icarus_lite.planning.failures import FailureReason
from icarus_lite.planning.focus import Focus
from icarus_lite.planning.grounding import Grounding, PlanningDomain, ground_goals
from icarus_lite.planning.hopeless import why_hopeless
from icarus_lite.planning.plan import NoPlan, Plan
from icarus_lite.planning.relevance import relevance
from icarus_lite.planning.search import Limits, SearchResult
from icarus_lite.planning.situation import Imagination
from icarus_lite.planning.solving import solve
from icarus_lite.records import replace
from icarus_lite.symbols import Action

DEFAULT_LIMIT = 5_000
"""Situations judged before the search gives up."""

DEFAULT_IMPROVEMENT = 500
"""Situations judged to make a plan shorter."""


def find_plan(
    domain: Domain,
    imagination: Imagination,
    goals: Sequence[Condition],
    *,
    excluded: Collection[Action] = (),
    limit: int | None = DEFAULT_LIMIT,
    seconds: float | None = None,
    improvement: int | None = DEFAULT_IMPROVEMENT,
    improvement_s: float | None = None,
    prepared: PlanningDomain | None = None,
) -> Plan | NoPlan:
    """Find a plan, and make it shorter as far as that is cheap.

    The same question gives the same plan, unless a limit of seconds is reached. Where little is
    possible, the plan is a shortest one.

    Args:
        domain: Skills, concepts and attachments.
        imagination: The beliefs of now, and what would follow from actions.
        goals: The conjunction to achieve.
        excluded: Actions that must not be used, for example because they failed too often.
        limit: How many situations to judge at most; None for no limit.
        seconds: How long to search at most, in s; None for no limit.
        improvement: How many situations to judge in order to make the plan shorter; None for no
            limit but that of seconds.
        improvement_s: How long to go on making it shorter, in s; None for `seconds`.
        prepared: The same domain, kept from call to call: what planning makes of it once and for
            all is then not made again.

    Raises:
        InferenceError: a test of the domain cannot be evaluated for what is believed now.
    """
    facts = imagination.now
    if imagination.holds(goals, facts):
        return Plan((), tuple(goals))
    kept = prepared or PlanningDomain(domain, imagination.evaluator)
    grounding = ground_goals(kept, imagination.beginning, goals, excluded=excluded)
    if grounding.hopeless:
        if excluded and not ground_goals(kept, imagination.beginning, goals).hopeless:
            wanted = " ".join(map(str, grounding.hopeless))
            return NoPlan(f"no other way leads to {wanted}", final=True)
        return NoPlan(_hopeless(domain, imagination, grounding, facts), final=True)
    limits = Limits(limit, seconds)
    shortening = Limits(improvement, seconds if improvement_s is None else improvement_s)
    solution = solve(grounding.task, limits, shortening)
    if solution.plan is None:
        assert solution.search is not None, "it is asked wherever means-ends analysis fails"
        none = _without_plan(
            domain, imagination, goals, excluded, grounding, solution.search, limits
        )
        return replace(none, account=solution.account)
    steps = tuple(grounding.task.operators[number].step for number in solution.plan)
    focus = Focus(imagination, domain, grounding.closure(), grounding.fluents)
    flaw = focus.bears_out(steps, goals)
    if flaw:  # never seen; but an arm is not moved on a plan that imagination does not bear out
        reason = f"the plan that was found does not work: {flaw}"
        return NoPlan(reason, final=False, account=solution.account)
    return Plan(steps, tuple(goals), account=solution.account)


def _without_plan(
    domain: Domain,
    imagination: Imagination,
    goals: Sequence[Condition],
    excluded: Collection[Action],
    grounding: Grounding,
    found: SearchResult,
    limits: Limits,
) -> NoPlan:
    """Say why the search has found no plan."""
    if not found.exhausted:
        judged = found.effort.evaluations
        reason = f"no plan among the first {judged} situations imagined"
        if judged != limits.evaluations:
            reason += f", in {limits.seconds:g} s"
        return NoPlan(reason, final=False, failure=FailureReason.SEARCH_LIMIT)
    dead_end = _dead_end(domain, imagination, goals, excluded)
    atoms = [str(grounding.task.atoms[atom]) for atom in found.unreachable]
    known = [atom for atom in atoms if " " not in atom.split("(")[-1].split()[0]]
    if known:
        return replace(dead_end, reason=f"no skill can ever make {known[0]} true")
    return dead_end


def _hopeless(
    domain: Domain, imagination: Imagination, grounding: Grounding, facts: FactStore
) -> str:
    """Say why the first hopeless goal is hopeless."""
    for goal in grounding.hopeless:
        unknown = _unknown(goal, facts)
        if unknown:
            return f"{goal} speaks of {unknown}, which is not perceived"
    return why_hopeless(domain, imagination, grounding, grounding.hopeless[0])


def _unknown(goal: Condition, facts: FactStore) -> str:
    """Name the first constant of a goal that no fact speaks of; empty if all are known."""
    constants = [term for term in goal.atom.args if isinstance(term, Constant)]
    if goal.negated or not constants:
        return ""
    known = {value for fact in facts for value in fact.args}
    return next((str(term) for term in constants if term.value not in known), "")


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
