"""Requests to other agents: what is asked of whom, and what becomes of it.

A step of another agent is not carried out but asked for, or, where that agent needs no word,
expected. Either way the agent waits until the effects are believed, whoever brought them about, or
until the other one is reported to have done it. A refusal, or no answer in time, ends the wait.
"""

from __future__ import annotations

from icarus_lite.execution.moment import Moment
from icarus_lite.execution.monitoring import Execution, Fate, Judgement, broken
from icarus_lite.execution.plan_following import PlanStatus
from icarus_lite.execution.repertoire import Skill
from icarus_lite.language.teams import performer, sentence
from icarus_lite.outcomes import Outcome, Status
from icarus_lite.planning import Failure, FailureReason, PlanStep, validate
from icarus_lite.records import dataclass
from icarus_lite.symbols import Action

NO_ANSWER = "no answer"
"""How the reason of a failed outcome begins if the time for another agent's step is over."""

PATIENCE_S = 60.0
"""How long another agent is waited for, in s, if its skill states no `:timeout`."""


@dataclass(frozen=True, slots=True)
class Request:
    """Something that another agent is to do.

    Args:
        agent: The other agent.
        action: What it is to do.
        sentence: What it is told; empty where it needs no word, and is only waited for.
        since: The cycle in which it was asked, or the waiting began.
    """

    agent: str
    action: Action
    sentence: str
    since: int

    @property
    def text(self) -> str:
        """What the request is, as the reason of a decision has it."""
        if self.sentence:
            return f"asked {self.agent}: {self.sentence}"
        return f"{self.agent} is expected to do {self.action}"


def request_for(step: PlanStep, cycle: int) -> Request | None:
    """Give the request for a step; None if it is a step of one's own."""
    bindings = dict(step.bindings)
    agent = performer(step.clause, bindings)
    if agent is None:
        return None
    words = sentence(step.clause, bindings) if step.clause.is_asked else ""
    return Request(agent, step.action, words, cycle)


def patience_s(step: PlanStep) -> float:
    """Give how long a step of another agent is waited for, in s."""
    return PATIENCE_S if step.clause.timeout_s is None else step.clause.timeout_s


def is_needless(following: PlanStatus | None, moment: Moment) -> bool:
    """Tell whether a plan works without its next step: somebody has seen to it, or to its purpose.

    Args:
        following: The plan, and how far it has been followed; None where none is.
        moment: What is known now.
    """
    if following is None:
        return False
    plan, rest = following.plan, following.plan.steps[following.position + 1 :]
    return validate(moment.imagination, rest, plan.goals) is None


def judge_request(
    execution: Execution, request: Request, skill: Skill, outcome: Outcome | None, moment: Moment
) -> Judgement:
    """Say what becomes of a step that another agent is to carry out.

    Args:
        execution: The step, and since when it is waited for.
        request: What the agent was asked.
        skill: The step's clause.
        outcome: What is reported of it, by whomever; None if nothing is.
        moment: What is known now.

    Returns:
        `GOES_ON` to wait, `FINISHED` when it is done, `FAILED` when it is not going to be.
    """
    status = None if outcome is None else outcome.status
    believed = skill.is_done(moment.facts, dict(execution.step.bindings))
    if believed or (status is Status.SUCCEEDED and not skill.effects):
        return Judgement(Fate.FINISHED)
    if outcome is not None and status is Status.FAILED:
        why = f": {outcome.reason}" if outcome.reason else ""
        text = f"{request.agent} does not do {request.action}{why}"
        silent = outcome.reason.startswith(NO_ANSWER)
        name = FailureReason.REQUEST_UNANSWERED if silent else FailureReason.REQUEST_REFUSED
        return Judgement(Fate.FAILED, Failure(name, text))
    failure = broken(execution, moment)
    if failure is not None:
        return Judgement(Fate.FAILED, failure)
    limit_s = patience_s(execution.step)
    if moment.is_over(limit_s, execution.since_s):
        text = f"{request.agent} does not do {request.action}: {NO_ANSWER} within {limit_s:g} s"
        return Judgement(Fate.FAILED, Failure(FailureReason.REQUEST_UNANSWERED, text))
    return Judgement(Fate.GOES_ON)
