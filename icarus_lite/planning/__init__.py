"""Planning: from beliefs and goals to the next skill."""

from __future__ import annotations

from icarus_lite._on_use import imported_on_use
from icarus_lite.planning.relevance import Relevance, can_change, relevance

TYPE_CHECKING = False
if TYPE_CHECKING:
    from icarus_lite.planning.account import Account
    from icarus_lite.planning.beginning import Beginning, given_beginning, holds
    from icarus_lite.planning.candidate import Candidate, candidates
    from icarus_lite.planning.causes import CausalLink, Need, Needs, Requirement, pattern_of
    from icarus_lite.planning.failures import Failure, FailureReason
    from icarus_lite.planning.grounding import PlanningDomain
    from icarus_lite.planning.links import with_links
    from icarus_lite.planning.macros import Macro, macro
    from icarus_lite.planning.plan import NoPlan, Plan
    from icarus_lite.planning.planner import DEFAULT_LIMIT
    from icarus_lite.planning.projection import Flaw, Projection, Stage, project, rebound, validate
    from icarus_lite.planning.purposes import Purpose, purpose
    from icarus_lite.planning.repair import Rest, later_start, sparse_rest, unmet, working_rest
    from icarus_lite.planning.situation import Imagination, Situation
    from icarus_lite.planning.steps import PlanStep, plan_step
    from icarus_lite.planning.subgoals import Ending, Subgoal, Way
    from icarus_lite.planning.weighing import find_plan

_HOMES = {
    "Account": "account",
    "Beginning": "beginning",
    "Candidate": "candidate",
    "CausalLink": "causes",
    "DEFAULT_LIMIT": "planner",
    "Ending": "subgoals",
    "Failure": "failures",
    "FailureReason": "failures",
    "Flaw": "projection",
    "Imagination": "situation",
    "Macro": "macros",
    "Need": "causes",
    "Needs": "causes",
    "NoPlan": "plan",
    "Plan": "plan",
    "PlanStep": "steps",
    "PlanningDomain": "grounding",
    "Projection": "projection",
    "Purpose": "purposes",
    "Requirement": "causes",
    "Rest": "repair",
    "Situation": "situation",
    "Stage": "projection",
    "Subgoal": "subgoals",
    "Way": "subgoals",
    "candidates": "candidate",
    "find_plan": "weighing",
    "given_beginning": "beginning",
    "holds": "beginning",
    "later_start": "repair",
    "macro": "macros",
    "pattern_of": "causes",
    "plan_step": "steps",
    "project": "projection",
    "purpose": "purposes",
    "rebound": "projection",
    "sparse_rest": "repair",
    "unmet": "repair",
    "validate": "projection",
    "with_links": "links",
    "working_rest": "repair",
}

__all__ = [
    "DEFAULT_LIMIT",
    "Account",
    "Beginning",
    "Candidate",
    "CausalLink",
    "Ending",
    "Failure",
    "FailureReason",
    "Flaw",
    "Imagination",
    "Macro",
    "Need",
    "Needs",
    "NoPlan",
    "Plan",
    "PlanStep",
    "PlanningDomain",
    "Projection",
    "Purpose",
    "Relevance",
    "Requirement",
    "Rest",
    "Situation",
    "Stage",
    "Subgoal",
    "Way",
    "can_change",
    "candidates",
    "find_plan",
    "given_beginning",
    "holds",
    "later_start",
    "macro",
    "pattern_of",
    "plan_step",
    "project",
    "purpose",
    "rebound",
    "relevance",
    "sparse_rest",
    "unmet",
    "validate",
    "with_links",
    "working_rest",
]

__getattr__ = imported_on_use(__name__, _HOMES)
