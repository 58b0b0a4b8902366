"""What became of actions, as the body tells it."""

from __future__ import annotations

from enum import StrEnum

from icarus_lite.records import dataclass
from icarus_lite.symbols import Action


class Status(StrEnum):
    """How far an action has come."""

    SUCCEEDED = "succeeded"
    FAILED = "failed"
    RUNNING = "running"


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of the last action, as the body measured it.

    Args:
        action: The action this is about.
        status: Succeeded and failed actions have ended; a running one has not.
        reason: Why it failed, in words; empty otherwise.
    """

    action: Action
    status: Status = Status.SUCCEEDED
    reason: str = ""
