"""Grounding: from beliefs, skills and goals to a planning problem without variables."""

from icarus_lite.planning.grounding.prepared import PlanningDomain
from icarus_lite.planning.grounding.task import Grounding, ground_goals, ground_task

__all__ = ["Grounding", "PlanningDomain", "ground_goals", "ground_task"]
