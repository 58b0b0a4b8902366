"""The mind of icarus-lite: a domain language, inference, planning, and the trace of both."""

from icarus_lite._version import __version__
from icarus_lite.agent import Agent, Decision, DecisionKind, GoalStatus
from icarus_lite.errors import FrameError, IcarusError, InferenceError, TraceError
from icarus_lite.language import DomainError, load_domain
from icarus_lite.symbols import Action, Belief, Outcome, Percept, Status, Value

__all__ = [
    "Action",
    "Agent",
    "Belief",
    "Decision",
    "DecisionKind",
    "DomainError",
    "FrameError",
    "GoalStatus",
    "IcarusError",
    "InferenceError",
    "Outcome",
    "Percept",
    "Status",
    "TraceError",
    "Value",
    "__version__",
    "load_domain",
]
