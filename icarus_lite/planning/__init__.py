"""Planning: from beliefs and goals to the next skill."""

from icarus_lite.planning.candidates import Candidate, candidates
from icarus_lite.planning.failures import Failure, FailureReason
from icarus_lite.planning.planner import DEFAULT_LIMIT, NoPlan, Plan, find_plan
from icarus_lite.planning.relevance import Relevance, can_change, relevance
from icarus_lite.planning.situation import Imagination, PlanStep, Situation, holds, plan_step

__all__ = [
    "DEFAULT_LIMIT",
    "Candidate",
    "Failure",
    "FailureReason",
    "Imagination",
    "NoPlan",
    "Plan",
    "PlanStep",
    "Relevance",
    "Situation",
    "can_change",
    "candidates",
    "find_plan",
    "holds",
    "plan_step",
    "relevance",
]
