"""Watching a primitive skill: has it come to its end, does it go on, must it be broken off?

A primitive is begun when its start conditions hold (`:elements`, `:tests`), goes on as long as its
hold conditions do (`:while`; without any, its start conditions take their place each time it is
repeated), and ends when its effects are believed. Until then it is repeated: one execution need
not be enough to lower a hand onto a block.

What the body reports counts first. A body that reports nothing, as in the classical ICARUS
environments, executes a step each cycle, and beliefs alone tell when it is done.
"""

from __future__ import annotations

from collections.abc import Hashable
from enum import Enum, auto

from icarus_lite.execution.effects import missing_effect
from icarus_lite.execution.moment import Moment
from icarus_lite.execution.repertoire import Skill
from icarus_lite.outcomes import Outcome, Status
from icarus_lite.planning import Failure, FailureReason, PlanStep
from icarus_lite.records import dataclass


class Fate(Enum):
    """What becomes of a primitive skill in a cycle."""

    GOES_ON = auto()  # it is running
    REPEAT = auto()  # it was carried out; its effects are not all believed: once more
    BREAK_OFF = auto()  # it is running and has to be stopped
    FINISHED = auto()  # it is done
    LEFT = auto()  # carried out, or stopped, without its effects; it cannot be repeated from here
    FAILED = auto()  # the body reports that it has failed


@dataclass(frozen=True, slots=True)
class Execution:
    """A primitive skill under way.

    Args:
        step: The skill.
        scene: The state in which it was begun, or last repeated.
        since_s: When it was begun, in s, if the agent is told the time.
        stopping: Whether it is being broken off.
    """

    step: PlanStep
    scene: Hashable
    since_s: float | None = None
    stopping: bool = False


@dataclass(frozen=True, slots=True)
class Judgement:
    """The fate of a primitive skill.

    Args:
        fate: What becomes of it.
        failure: What went wrong, if anything did.
    """

    fate: Fate
    failure: Failure | None = None

    @property
    def disappoints(self) -> bool:
        """Whether the skill was carried out without the effects it is for."""
        reason = None if self.failure is None else self.failure.reason
        return self.fate is not Fate.BREAK_OFF and reason is FailureReason.EFFECT_NOT_BELIEVED


def judge(execution: Execution, skill: Skill, outcome: Outcome | None, moment: Moment) -> Judgement:
    """Say what becomes of a primitive skill under way.

    Args:
        execution: The skill, and how it was begun.
        skill: Its clause.
        outcome: What the body reports of it; None if it reports nothing.
        moment: What is known now.
    """
    if outcome is not None and outcome.status is Status.FAILED:
        text = f"{outcome.action}: {outcome.reason}"
        return Judgement(Fate.FAILED, Failure(FailureReason.DRIVER_FAILED, text))
    if outcome is not None and outcome.status is Status.SUCCEEDED:
        return _after_success(execution, skill, moment)
    if outcome is None:
        if execution.stopping:
            return Judgement(Fate.LEFT)
        if not skill.effects or skill.is_done(moment.facts, dict(execution.step.bindings)):
            return Judgement(Fate.FINISHED)
    failure = broken(execution, moment) or _out_of_time(execution, skill, moment)
    if failure is None and outcome is None:
        failure = _not_repeatable(execution.step, skill, moment)
    if failure is not None:
        return Judgement(Fate.BREAK_OFF, failure)
    return Judgement(Fate.GOES_ON)


def _after_success(execution: Execution, skill: Skill, moment: Moment) -> Judgement:
    step = execution.step
    if not skill.effects or skill.is_done(moment.facts, dict(step.bindings)):
        return Judgement(Fate.FINISHED)
    missing = missing_effect(skill.effects, dict(step.bindings), moment.facts)
    text = f"{step.action} has been carried out, but {missing} is not believed"
    failure = Failure(FailureReason.EFFECT_NOT_BELIEVED, text)
    over = _out_of_time(execution, skill, moment)
    if over is not None:
        return Judgement(Fate.LEFT, over)
    if broken(execution, moment) or _not_repeatable(step, skill, moment):
        return Judgement(Fate.LEFT, failure)
    return Judgement(Fate.REPEAT, failure)


def broken(execution: Execution, moment: Moment) -> Failure | None:
    """Say what a running skill relies on that is no longer so; None if all of it still is."""
    step, text = execution.step, ""
    lost = [argument for argument in step.action.args if argument in moment.lost]
    if lost:
        text = f"{lost[0]} is no longer anchored while {step.action} is running"
    else:
        for condition in step.clause.holds:
            if not moment.believes([condition], dict(step.bindings)):
                text = f"{condition} no longer holds while {step.action} is running"
                break
    return Failure(FailureReason.WHILE_BROKEN, text) if text else None


def _out_of_time(execution: Execution, skill: Skill, moment: Moment) -> Failure | None:
    limit_s = skill.clause.timeout_s
    if not moment.is_over(limit_s, execution.since_s):
        return None
    missing = missing_effect(skill.effects, dict(execution.step.bindings), moment.facts)
    awaited = f": {missing} is not believed" if missing else ""
    text = f"{execution.step.action} is not done within {limit_s:g} s{awaited}"
    return Failure(FailureReason.EFFECT_NOT_BELIEVED, text)


def _not_repeatable(step: PlanStep, skill: Skill, moment: Moment) -> Failure | None:
    """Say why a skill without `:while` cannot go on from here: its start conditions are gone."""
    clause, bindings = skill.clause, dict(step.bindings)
    if clause.holds or skill.again(moment.facts, bindings) is not None:
        return None
    obstacle = skill.obstacle(moment.facts, bindings)
    text = f"{step.action} cannot go on: {obstacle}"
    return Failure(FailureReason.CONDITIONS_UNSATISFIED, text)
