"""The loop while another agent does its part: the arm keeps still, and the wait has an end."""

from __future__ import annotations

import io

import pytest
from rich.console import Console
from scripted_assembly import CONFIG
from scripted_push import DOMAIN, PUSH, STEP, TOUCH, Body, Eyes

from aapa import Anchoring
from icarus_lite import Agent, DecisionKind
from icarus_lite.trace import Recording, TraceWriter, header, read_trace
from icarus_lite.trace.replaying import replay
from runtime.drivers import PARK
from runtime.loop import Loop
from runtime.people import Nobody, People
from runtime.run import anchoring_parameters
from runtime.second_look import LoopLimits
from runtime.view import RunView


def run(human, limits=None, trace=None):
    """Run the task with somebody who is told what each cycle has come to."""
    body, eyes, reports = Body(), Eyes(), []

    def observe(report):
        reports.append(report)
        human(report, body, eyes)

    task = DOMAIN.tasks[0]
    agent = Agent(DOMAIN, task.goals, others=task.agents)
    parameters = Anchoring(anchoring_parameters())
    loop = Loop(
        agent, parameters, body, eyes, CONFIG, trace=trace, observers=[observe], limits=limits
    )
    return loop.run(), body, reports


def pushes_after(cycles):
    """Give a person who begins to do what is asked so many cycles later, and takes some time."""
    asked = []

    def human(report, _body, eyes):
        if report.decision.kind is DecisionKind.REQUEST:
            asked.append(report.decision.cycle)
        if asked and report.decision.cycle - asked[-1] >= cycles:
            eyes.y = min(eyes.y + STEP, -0.1)

    return human


def test_the_arm_keeps_still_until_the_other_agent_has_done_its_part():
    result, body, reports = run(pushes_after(5))
    assert result.achieved
    assert body.started == [TOUCH, str(PARK)]
    kinds = [report.decision.kind for report in reports]
    asked, acting = kinds.index(DecisionKind.REQUEST), kinds.index(DecisionKind.ACT)
    assert acting - asked > 5
    assert set(kinds[asked + 1 : acting]) == {DecisionKind.AWAIT}
    assert all(not report.decision.commands for report in reports[:acting])
    assert [(each.cycle, each.action, each.status) for each in result.actions] == [
        (asked, str(PUSH), "requested"),
        (acting, TOUCH, "succeeded"),
    ]


def test_without_an_answer_the_run_ends_with_the_reason():
    result, body, reports = run(lambda *_: None, LoopLimits(patience=3))
    assert not result.achieved
    assert "human does not do (push-here case): no answer within 20 s" in result.reason
    assert body.started == []
    assert [each.status for each in result.actions] == ["failed"]
    waits = [r for r in reports if r.decision.kind is DecisionKind.AWAIT]
    assert len(waits) == 21  # a cycle is a second on this arm's clock


def test_an_arm_gets_out_of_the_way_before_somebody_is_asked():
    body, eyes, asked, awaited = Body(), Eyes(), [], []
    eyes.y = -0.12
    body.polls = 12
    agent = Agent(DOMAIN, ["(touched case)", "(close-by case)"])
    person = pushes_after(30)

    class Listener(Nobody):
        def ask(self, action, _sentence, _anchors):
            asked.append((str(action), body.moves, body.started[-1]))

    def observe(report):
        if str(PARK) in body.started and not awaited:
            eyes.y -= STEP  # it is taken away again while the arm goes back to rest
        if report.decision.request is not None:
            awaited.append(body.moves)
        person(report, body, eyes)

    anchoring, people = Anchoring(anchoring_parameters()), People(Listener())
    Loop(agent, anchoring, body, eyes, CONFIG, observers=[observe], people=people).run()
    assert awaited[0]  # it was on its way, and went on
    assert asked == [(str(PUSH), False, str(PARK))]  # and was there when it asked
    assert not awaited[-1]


def test_the_request_is_shown_and_recorded(tmp_path):
    path = tmp_path / "trace.jsonl"
    task = DOMAIN.tasks[0]
    first = header(DOMAIN, task.goals, others=list(task.agents))
    shown = io.StringIO()
    view = RunView(Console(file=shown), "task 2.2")
    person = pushes_after(2)

    def human(report, body, eyes):
        view.show(report)
        person(report, body, eyes)

    with view, TraceWriter(path, first) as writer:
        result, _, _ = run(human, trace=writer)
    assert result.achieved
    assert "asked human: please push case closer" in shown.getvalue()
    kinds = [row["decision"]["kind"] for row in read_trace(path).cycles]
    recorded = [row["request"] for row in read_trace(path).cycles]
    asked = kinds.index("request")
    assert recorded[asked] == {
        "agent": "human",
        "action": "(push-here case)",
        "sentence": "please push case closer",
        "since": asked,
    }
    assert [row is not None for row in recorded] == [k in ("request", "await") for k in kinds]
    assert replay(Recording(path)).decisions is None


@pytest.mark.parametrize("others", [(), ("human",)])
def test_whoever_does_not_take_part_is_not_asked(others):
    agent = Agent(DOMAIN, DOMAIN.tasks[0].goals, others=others)
    body, eyes = Body(), Eyes()
    limits = LoopLimits(cycles=6)
    parameters = Anchoring(anchoring_parameters())
    result = Loop(agent, parameters, body, eyes, CONFIG, limits=limits).run()
    assert [each.action for each in result.actions] == ([str(PUSH)] if others else [])
