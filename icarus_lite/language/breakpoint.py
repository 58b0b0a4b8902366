"""Where a domain stops a run: part of its syntax tree."""

from __future__ import annotations

from enum import StrEnum

from icarus_lite.language.syntax import NOWHERE, Condition, Span
from icarus_lite.records import dataclass, field


class Moment(StrEnum):
    """When a breakpoint stops a run, by the word that `:break` has for it."""

    GAIN = "on-gain"
    LOSS = "on-loss"
    START = "on-start"
    SUCCESS = "on-success"
    FAILURE = "on-failure"


@dataclass(frozen=True, slots=True)
class Breakpoint:
    """Where to stop: `(break (attached ?obj case))`, or `:break on-gain` in a clause.

    Args:
        condition: A literal over beliefs, or the pattern of a skill.
        moment: `GAIN` when an instance of the literal begins to hold and `LOSS` when it ceases
            to; `START`, `SUCCESS` and `FAILURE` of a skill. The form gives `GAIN` for a literal
            and `START` for a skill.
        span: The literal of a form, or the word of a field.
    """

    condition: Condition
    moment: Moment = Moment.GAIN
    span: Span = field(default=NOWHERE, compare=False)
