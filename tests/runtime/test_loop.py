"""The loop on a scripted body and scripted eyes: every way in which a run can end."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pytest

from aapa import Anchor, Anchoring, Camera, Detection
from icarus_lite import Action, Agent, Outcome, Status, load_domain
from icarus_lite.trace import TraceWriter, header, inputs_of, read_trace
from runtime.config import load_robot
from runtime.cycle_report import CycleReport
from runtime.drivers import PARK, ArmState
from runtime.errors import DriverError
from runtime.loop import Loop, LoopLimits
from runtime.run import anchoring_parameters

CONFIG = load_robot("ur5")
CAMERA = Camera(
    320, 240, 233.0, (0.4, 0.0, 0.6), np.array([[0.0, -1.0, 0.0], [-1.0, 0, 0], [0, 0, -1.0]])
)
PLACES = {"hubcover": (0.40, 0.10, 0.01), "case": (0.42, -0.10, 0.04)}
PICK = Action("pick-up", ("hand1", "hubcover"))
INSERT = Action("insert", ("hubcover", "case"))


class Body:
    """Does what it is told in a given number of polls; whatever is in `fails` fails."""

    commands = frozenset({"grasp", "insert", "place", "take-out", "rest"})

    def __init__(
        self,
        polls: int = 2,
        fails: Mapping[str, str] | None = None,
        quick: Sequence[str] = (),
    ) -> None:
        self.polls, self.fails, self.quick = polls, dict(fails or {}), quick
        self.started: list[str] = []
        self.stops = 0
        self.held: str | None = None
        self.inserted: set[str] = set()
        self.hand = (0.3, 0.0, 0.42)
        self.dies_at: int | None = None
        self._left, self._action, self._time = 0, None, 0.0

    def state(self) -> ArmState:
        if self.dies_at is not None and self._time >= self.dies_at:
            raise DriverError("the controller no longer answers; the arm was stopped")
        pose = (*self.hand, 0.0, 3.14159, 0.0)
        return ArmState((0.0,) * 6, pose, self.held is not None, self.held is not None, self._time)

    def start(
        self, action: Action, commands: Sequence[Action], anchors: Mapping[str, Anchor]
    ) -> None:
        assert self._action is None, "one action at a time"
        assert commands
        self.started.append(str(action))
        self._action, self._left = action, 1 if action.name in self.quick else self.polls
        self._anchors = anchors

    def poll(self, anchors: Mapping[str, Anchor]) -> Outcome | None:
        del anchors
        self._time += 1
        action, self._left = self._action, self._left - 1
        if action is None:
            return None
        if self._left > 0:
            return Outcome(action, Status.RUNNING)
        self._action = None
        if action.name in self.fails:
            return Outcome(action, Status.FAILED, self.fails[action.name])
        if action == PICK:
            self.held, self.hand = "hubcover", PLACES["hubcover"]
        elif action == INSERT:
            self.held, self.hand = None, PLACES["case"]
            self.inserted.add("hubcover")
        elif action == PARK:
            self.hand = (0.3, 0.0, 0.42)
        return Outcome(action)

    def stop(self) -> None:
        self.stops += 1
        self._action = None

    def close(self) -> None:
        self.stop()


class Eyes:
    """Sees the parts that lie open on the table; what is held or inserted is out of sight."""

    def __init__(self, body: Body, parts: Sequence[str] = ("hubcover", "case")) -> None:
        self.body, self.parts = body, list(parts)

    def update(self, arm: ArmState) -> None:
        self.hand = arm.tcp_pose[:3]

    def look(self) -> tuple[list[Detection], Camera]:
        hidden = {self.body.held, *self.body.inserted}
        return [self._see(p) for p in self.parts if p not in hidden], CAMERA

    def _see(self, part: str) -> Detection:
        u, v, _ = CAMERA.project(PLACES[part])
        return Detection(part, (u - 8, v - 8, u + 8, v + 8), 0.9, PLACES[part], (0.04, 0.02))


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
