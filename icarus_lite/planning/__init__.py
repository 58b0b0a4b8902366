"""Planning: from beliefs and goals to the next skill."""

from icarus_lite.planning.account import Account
from icarus_lite.planning.candidates import Candidate, candidates
from icarus_lite.planning.causes import CausalLink, Need, Needs, Requirement, pattern_of
from icarus_lite.planning.failures import Failure, FailureReason
from icarus_lite.planning.grounding import PlanningDomain
from icarus_lite.planning.links import with_links
from icarus_lite.planning.macros import Macro, macro
from icarus_lite.planning.plan import NoPlan, Plan
from icarus_lite.planning.planner import DEFAULT_LIMIT
from icarus_lite.planning.projection import Flaw, Projection, Stage, project, rebound, validate
from icarus_lite.planning.purposes import Purpose, purpose
from icarus_lite.planning.relevance import Relevance, can_change, relevance
from icarus_lite.planning.repair import Rest, later_start, sparse_rest, unmet, working_rest
from icarus_lite.planning.situation import Imagination, PlanStep, Situation, holds, plan_step
from icarus_lite.planning.subgoals import Ending, Subgoal, Way
from icarus_lite.planning.weighing import find_plan

__all__ = [
    "DEFAULT_LIMIT",
    "Account",
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
