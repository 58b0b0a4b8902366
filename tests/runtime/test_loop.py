"""The loop on a scripted body and scripted eyes: every way in which a run can end."""

from __future__ import annotations

from pathlib import Path

import pytest
from scripted_assembly import CONFIG, INSERT, PICK, Body, Eyes

from aapa import Anchoring
from icarus_lite import Agent, load_domain
from icarus_lite.trace import TraceWriter, header, inputs_of, read_trace
from runtime.cycle_report import CycleReport
from runtime.drivers import PARK, ArmState
from runtime.errors import ControllerError
from runtime.loop import Loop
from runtime.run import anchoring_parameters
from runtime.second_look import LoopLimits


def loop(body: Body, gearbox: Path, eyes: Eyes | None = None, **options: object) -> Loop:
    agent = Agent(load_domain(gearbox), ["(attached hubcover case)"])
    return Loop(
        agent, Anchoring(anchoring_parameters()), body, eyes or Eyes(body), CONFIG, **options
    )


def test_the_task_ends_with_a_second_look(gearbox: Path) -> None:
    body = Body()
    result = loop(body, gearbox).run()
    assert result.achieved
    assert body.started == [str(PICK), str(INSERT), str(PARK)]
    assert [(a.action, a.status) for a in result.actions] == [
        (str(PICK), "succeeded"),
        (str(INSERT), "succeeded"),
    ]
    assert body.stops >= 1


def test_what_is_held_is_believed_though_unseen(gearbox: Path) -> None:
    reports: list[CycleReport] = []
    body = Body(polls=20)
    assert loop(body, gearbox, observers=[reports.append]).run().achieved
    carried = [
        r for r in reports if any(str(b) == "(carried hubcover hand1)" for b in r.decision.beliefs)
    ]
    assert len(carried) >= 19
    for report in carried[1:]:
        (cover,) = [a for a in report.anchors if a.name == "hubcover"]
        assert (cover.status, cover.parent) == ("attached", "hand1")


def test_without_attachments_the_belief_is_lost_and_the_action_aborted(gearbox: Path) -> None:
    from dataclasses import replace  # noqa: PLC0415 - this one test

    body = Body(polls=20)
    agent = Agent(load_domain(gearbox), ["(attached hubcover case)"])
    parameters = replace(anchoring_parameters(), use_attachments=False)
    result = Loop(agent, Anchoring(parameters), body, Eyes(body), CONFIG).run()
    assert not result.achieved
    assert "hubcover is no longer anchored since cycle" in result.reason
    assert result.actions[-1].status == "failed"


def test_a_skill_that_fails_three_times_is_given_up_with_its_reason(gearbox: Path) -> None:
    body = Body(fails={"pick-up": "the gripper closed on nothing"})
    result = loop(body, gearbox).run()
    assert not result.achieved
    assert [a.status for a in result.actions] == ["failed"] * 3
    assert "failed 3 times: the gripper closed on nothing" in result.reason


def test_a_goal_about_something_that_is_not_there(gearbox: Path) -> None:
    body = Body()
    result = loop(
        body, gearbox, Eyes(body, ["case"]), limits=LoopLimits(patience=5, patience_s=0.0)
    ).run()
    assert not result.achieved
    assert result.reason == "(attached hubcover case) speaks of hubcover, which is not perceived"
    assert result.cycles == 5
    assert body.started == []


def test_a_dead_controller_ends_the_run_with_its_reason_and_a_whole_trace(
    gearbox: Path, tmp_path: Path
) -> None:
    body = Body(polls=50)
    body.dies_at = 10
    with TraceWriter(tmp_path / "run.jsonl", header(load_domain(gearbox), [])) as trace:
        result = loop(body, gearbox, trace=trace).run()
    assert not result.achieved
    assert result.reason == "the controller no longer answers; the arm was stopped"
    assert body.stops == 1
    cycles = read_trace(tmp_path / "run.jsonl").cycles
    assert [c["cycle"] for c in cycles] == list(range(10))
    assert cycles[-1]["decision"]["reason"] == result.reason
    assert cycles[-1]["outcomes"][0]["status"] == "failed"
    assert result.actions[-1].status == "failed"


def test_an_interruption_stops_the_arm(gearbox: Path) -> None:
    def interrupt(report: CycleReport) -> None:
        if report.decision.cycle == 4:
            raise KeyboardInterrupt

    body = Body(polls=50)
    result = loop(body, gearbox, observers=[interrupt]).run()
    assert (result.achieved, body.stops) == (False, 1)
    assert "interrupted by the operator" in result.reason


def test_a_skill_that_takes_too_long_is_stopped(gearbox: Path) -> None:
    body = Body(polls=10_000, quick=("park",))
    result = loop(body, gearbox).run()
    assert not result.achieved
    assert "not done within 60 s" in result.reason


def test_the_arm_that_cannot_go_back_to_look_ends_the_run(gearbox: Path) -> None:
    body = Body(fails={"park": "joint 2 is at its limit"})
    result = loop(body, gearbox).run()
    assert result.reason == "the arm cannot go back to its look pose: joint 2 is at its limit"


def test_the_limit_of_cycles(gearbox: Path) -> None:
    result = loop(Body(polls=50), gearbox, limits=LoopLimits(cycles=20)).run()
    assert (result.cycles, result.reason) == (20, "the goal was not reached in 20 cycles")


def test_the_limit_of_time(gearbox: Path) -> None:
    body = Body(polls=10_000)
    result = loop(body, gearbox, limits=LoopLimits(run_s=30.0)).run()
    assert result.reason == "the goal was not reached in 0.5 minutes of the arm's clock"
    assert 30.0 < body.state().timestamp_s < 33.0


def test_the_trace_replays_to_the_same_decisions(gearbox: Path, tmp_path: Path) -> None:
    domain = load_domain(gearbox)
    path = tmp_path / "run.jsonl"
    with TraceWriter(path, header(domain, ["(attached hubcover case)"])) as trace:
        assert loop(Body(), gearbox, trace=trace).run().achieved
    recorded = read_trace(path)
    agent = Agent(domain, recorded.header["goals"])
    for cycle in recorded.cycles:
        decision = agent.cycle(*inputs_of(cycle))
        assert str(decision.kind) == cycle["decision"]["kind"]
        assert [row["belief"] for row in cycle["added"]] == [str(b) for b in decision.added]


@pytest.mark.parametrize("polls", [1, 3])
def test_two_runs_leave_the_same_trace_but_for_the_times(
    gearbox: Path, tmp_path: Path, polls: int
) -> None:
    texts = []
    for name in ("a", "b"):
        path = tmp_path / name
        with TraceWriter(path, header(load_domain(gearbox), [])) as trace:
            loop(Body(polls), gearbox, trace=trace).run()
        cycles = read_trace(path).cycles
        texts.append([{k: v for k, v in c.items() if k != "timings"} for c in cycles])
    assert texts[0] == texts[1]


class Wired(Eyes):
    """Eyes whose wires break while the arm picks something up."""

    def __init__(self, body: Body, *, with_the_arm: bool) -> None:
        super().__init__(body)
        self.with_the_arm = with_the_arm

    def update(self, arm: ArmState) -> None:
        super().update(arm)
        if self.body.started:
            if self.with_the_arm:
                self.body.dies_at = arm.timestamp_s
            raise ControllerError("the bench does not answer")


@pytest.mark.parametrize(
    ("with_the_arm", "reason"),
    [
        (True, "the controller no longer answers; the arm was stopped"),
        (False, "the bench does not answer"),
    ],
)
def test_a_broken_wire_ends_the_run_in_the_words_of_the_arm_if_it_is_lost_too(
    gearbox: Path, monkeypatch: pytest.MonkeyPatch, *, with_the_arm: bool, reason: str
) -> None:
    monkeypatch.setattr("runtime.loop._ARM_NOTICES_WITHIN_S", 0.1)
    body = Body(polls=5)
    result = loop(body, gearbox, Wired(body, with_the_arm=with_the_arm)).run()
    assert (result.achieved, result.reason) == (False, reason)
    assert body.stops >= 1
