"""Execution: from goals and intentions, through skills, to the action of this cycle."""

from icarus_lite.execution.action_reason import ActionReason, action_reason
from icarus_lite.execution.choice import Choice
from icarus_lite.execution.decision import (
    Decision,
    DecisionKind,
    GoalChange,
    GoalReport,
    GoalStatus,
    IntentionStatus,
    Standing,
)
from icarus_lite.execution.executor import Executor
from icarus_lite.execution.experience import MAX_ATTEMPTS
from icarus_lite.execution.moment import Moment
from icarus_lite.execution.path import Aim, Level, SkillPath
from icarus_lite.execution.plan_following import PlanCounts, PlanStatus, Verdict
from icarus_lite.execution.requests import NO_ANSWER, Request, patience_s

__all__ = [
    "MAX_ATTEMPTS",
    "NO_ANSWER",
    "ActionReason",
    "Aim",
    "Choice",
    "Decision",
    "DecisionKind",
    "Executor",
    "GoalChange",
    "GoalReport",
    "GoalStatus",
    "IntentionStatus",
    "Level",
    "Moment",
    "PlanCounts",
    "PlanStatus",
    "Request",
    "SkillPath",
    "Standing",
    "Verdict",
    "action_reason",
    "patience_s",
]
