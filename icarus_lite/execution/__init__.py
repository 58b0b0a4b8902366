"""Execution: from goals and intentions, through skills, to the action of this cycle."""

from icarus_lite.execution.decision import Decision, DecisionKind, GoalStatus, IntentionStatus
from icarus_lite.execution.executor import Choice, Executor
from icarus_lite.execution.experience import MAX_ATTEMPTS
from icarus_lite.execution.moment import Moment
from icarus_lite.execution.path import Aim, Level, SkillPath

__all__ = [
    "MAX_ATTEMPTS",
    "Aim",
    "Choice",
    "Decision",
    "DecisionKind",
    "Executor",
    "GoalStatus",
    "IntentionStatus",
    "Level",
    "Moment",
    "SkillPath",
]
