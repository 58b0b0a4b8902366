"""The mind of icarus-lite: a domain language, inference, planning, and the trace of both.

The names below are imported from their modules when they are first used, so that whoever needs
one of them, or only one module of the package, does not wait for all the others.
"""

from __future__ import annotations

from icarus_lite._on_use import imported_on_use
from icarus_lite._version import __version__

TYPE_CHECKING = False
if TYPE_CHECKING:
    from icarus_lite.agent import (
        Agent,
        Decision,
        DecisionKind,
        GoalReport,
        GoalStatus,
        IntentionStatus,
        Request,
        Standing,
    )
    from icarus_lite.errors import FrameError, IcarusError, InferenceError, TraceError
    from icarus_lite.execution import SkillPath
    from icarus_lite.language import DomainError, load_domain
    from icarus_lite.outcomes import Outcome, Status
    from icarus_lite.planning import Failure, FailureReason
    from icarus_lite.symbols import Action, Belief, Percept, Value

_HOMES = {
    "Action": "symbols",
    "Agent": "agent",
    "Belief": "symbols",
    "Decision": "agent",
    "DecisionKind": "agent",
    "DomainError": "language",
    "Failure": "planning",
    "FailureReason": "planning",
    "FrameError": "errors",
    "GoalReport": "agent",
    "GoalStatus": "agent",
    "IcarusError": "errors",
    "InferenceError": "errors",
    "IntentionStatus": "agent",
    "Outcome": "outcomes",
    "Percept": "symbols",
    "Request": "agent",
    "SkillPath": "execution",
    "Standing": "agent",
    "Status": "outcomes",
    "TraceError": "errors",
    "Value": "symbols",
    "load_domain": "language",
}

__all__ = [
    "Action",
    "Agent",
    "Belief",
    "Decision",
    "DecisionKind",
    "DomainError",
    "Failure",
    "FailureReason",
    "FrameError",
    "GoalReport",
    "GoalStatus",
    "IcarusError",
    "InferenceError",
    "IntentionStatus",
    "Outcome",
    "Percept",
    "Request",
    "SkillPath",
    "Standing",
    "Status",
    "TraceError",
    "Value",
    "__version__",
    "load_domain",
]

__getattr__ = imported_on_use(__name__, _HOMES)
