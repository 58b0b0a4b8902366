"""Why nothing leads on: the named reasons of execution and planning."""

from __future__ import annotations

from enum import StrEnum

from icarus_lite.records import dataclass


class FailureReason(StrEnum):
    """The name of a reason, for programs; the sentence beside it is for people."""

    NO_SKILL_FOR_GOAL = "no-skill-for-goal"  # no skill of that name, or with such an effect
    CONDITIONS_UNSATISFIED = "conditions-unsatisfied"  # :elements or :tests do not hold
    WHILE_BROKEN = "while-broken"  # what a running skill relies on is no longer believed
    UNBOUND_ACTION_ARGS = "unbound-action-args"  # a command with a variable that nothing binds
    DRIVER_FAILED = "driver-failed"  # the body reported a failure
    EFFECT_NOT_BELIEVED = "effect-not-believed"  # carried out, or out of time, without its effect
    SUBSKILL_CALL_FAILED = "subskill-call-failed"  # a macro's next subskill cannot begin
    MACRO_EXHAUSTED = "macro-exhausted"  # all subskills are done, the macro's effects are missing
    LOOP = "loop"  # it would lead back to where it has been
    GOAL_UNREACHABLE = "goal-unreachable"  # no skill, and no sequence of skills, can achieve it
    SEARCH_LIMIT = "search-limit"  # given up before everything was tried
    REQUEST_REFUSED = "request-refused"  # another agent does not do what it was asked for
    REQUEST_UNANSWERED = "request-unanswered"  # nor has it done it in time


@dataclass(frozen=True, slots=True)
class Failure:
    """Something that did not lead on.

    Args:
        reason: Its name.
        text: What happened, as a sentence for the person who asks.
    """

    reason: FailureReason
    text: str

    def __str__(self) -> str:
        return f"{self.reason}: {self.text}"
