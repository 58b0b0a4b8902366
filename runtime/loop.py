"""The loop: detections, anchors, beliefs, decision, motion; one trace line a cycle."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from enum import Enum, auto
from itertools import pairwise
from typing import Protocol

from aapa import Anchor, Anchoring, Attachment, Camera, Detection
from icarus_lite import Action, Agent, Decision, DecisionKind, Outcome, Percept, Request, Status
from icarus_lite.execution import NO_ANSWER, patience_s
from icarus_lite.planning import PlanStep
from icarus_lite.trace import TraceWriter, cycle_record
from runtime.config import RobotConfig
from runtime.drivers import PARK, ArmState, Driver
from runtime.errors import ControllerError, DriverError
from runtime.percepts import HAND, hand_detection, percepts_of


class PerceptSource(Protocol):
    """Whatever reports detections: a camera with a detector, or the simulated cell."""

    def update(self, arm: ArmState) -> None:
        """Take note of where the arm is and what its gripper does."""

    def look(self) -> tuple[Sequence[Detection], Camera]:
        """Give the next frame's detections and the camera that took it."""


@dataclass(frozen=True, slots=True)
class LoopLimits:
    """When the loop gives up.

    Args:
        patience: Cycles in a row without a plan, arm at rest, before the task has failed.
        confirm: Cycles in a row, arm back at the look pose, in which the goals must be believed.
        cycles: The most cycles of one run.
    """

    patience: int = 15
    confirm: int = 8
    cycles: int = 3000


@dataclass(frozen=True, slots=True)
class CycleReport:
    """One finished cycle, for the trace and for whoever watches."""

    decision: Decision
    outcomes: tuple[Outcome, ...]
    percepts: tuple[Percept, ...]
    anchors: tuple[Anchor, ...]
    detections: tuple[Detection, ...]
    arm: ArmState

    def record(self, **extra: object) -> dict[str, object]:
        """Give the cycle as a line of the trace."""
        return cycle_record(
            self.decision,
            self.percepts,
            self.outcomes,
            detections=[detection_row(d) for d in self.detections],
            anchors=[anchor_row(a) for a in self.anchors],
            arm={
                "joints": list(self.arm.joints),
                "tcp_pose": list(self.arm.tcp_pose),
                "gripper_closed": self.arm.gripper_closed,
                "gripped": self.arm.gripped,
                "timestamp_s": self.arm.timestamp_s,
            },
            **extra,
        )


@dataclass(frozen=True, slots=True)
class _End:
    """The end of a run."""

    reason: str
    achieved: bool = False


class _Resting(Enum):
    """Whether the arm is where it sees everything."""

    NO = auto()
    ON_THE_WAY = auto()
    AT_LOOK_POSE = auto()


def detection_row(detection: Detection) -> dict[str, object]:
    """Give a detection as JSON."""
    row: dict[str, object] = {
        "type": detection.type,
        "box": [round(v, 2) for v in detection.box],
        "score": round(detection.score, 3),
    }
    if detection.position is not None:
        row["position"] = [round(v, 5) for v in detection.position]
    return row


def anchor_row(anchor: Anchor) -> dict[str, object]:
    """Give an anchor as JSON, as in the anchors file, with its position and reason beside."""
    return {
        "name": anchor.name,
        "type": anchor.type,
        "box": [round(v, 2) for v in anchor.box],
        "status": str(anchor.status),
        "parent": anchor.parent,
        "confidence": round(anchor.confidence, 3),
        "position": None if anchor.position is None else [round(v, 5) for v in anchor.position],
        "reason": anchor.reason,
    }


@dataclass(frozen=True, slots=True)
class ActionRecord:
    """An action that was started, and how it ended."""

    cycle: int
    action: str
    status: str


@dataclass(frozen=True, slots=True)
class LoopResult:
    """How a run ended: achieved or not, why, after how many cycles, by which actions."""

    achieved: bool
    reason: str
    cycles: int
    actions: tuple[ActionRecord, ...]


class Loop:
    """Runs an agent on a body until its goals are achieved or it has to give up.

    Args:
        agent: The mind, with its goals.
        anchoring: The eyes.
        driver: The body, at rest at its look pose. Stopped when the loop ends, never closed.
        source: Where detections come from.
        config: The robot.
        trace: Where each cycle is written, or None.
        observer: Called after each cycle.
        limits: When to give up.
    """

    def __init__(
        self,
        agent: Agent,
        anchoring: Anchoring,
        driver: Driver,
        source: PerceptSource,
        config: RobotConfig,
        *,
        trace: TraceWriter | None = None,
        observer: Callable[[CycleReport], None] | None = None,
        limits: LoopLimits | None = None,
    ) -> None:
        self._agent = agent
        self._anchoring = anchoring
        self._driver = driver
        self._source = source
        self._config = config
        self._trace = trace
        self._observer = observer
        self._limits = limits or LoopLimits()
        self._anchors: tuple[Anchor, ...] = ()
        self._actions: list[ActionRecord] = []
        self._lost: dict[str, str] = {}
        self._aborted: Outcome | None = None
        self._outcomes: tuple[Outcome, ...] = ()
        self._last: CycleReport | None = None
        self._resting = _Resting.AT_LOOK_POSE
        self._waited = 0
        self._started_s = 0.0
        self._cycles = 0
        self._ended: LoopResult | None = None

    def run(self) -> LoopResult:
        """Run to the end. An interruption from the keyboard stops the arm and ends the run."""
        try:
            result = self.step()
            while result is None:
                result = self.step()
        finally:
            if self._ended is None:
                self._driver.stop()
        return result

    def step(self) -> LoopResult | None:
        """Run one cycle; give the result once the run has ended, None before.

        Whoever does not go on to the end stops the driver.
        """
        if self._ended is not None:
            return self._ended
        if self._cycles >= self._limits.cycles:
            return self._end(_End(f"the goal was not reached in {self._cycles} cycles"))
        self._cycles += 1
        try:
            self._outcomes = self._poll()
            end = self._act(self._cycle(self._outcomes))
        except (ControllerError, DriverError) as error:
            self._record_loss(str(error))
            end = _End(str(error))
        except KeyboardInterrupt:
            end = _End("interrupted by the operator; the arm was stopped")
        return None if end is None else self._end(end)

    def _end(self, end: _End) -> LoopResult:
        self._driver.stop()
        self._ended = LoopResult(end.achieved, end.reason, self._cycles, tuple(self._actions))
        return self._ended

    def _poll(self) -> tuple[Outcome, ...]:
        outcome, self._aborted = self._aborted or self._driver.poll(self._by_name()), None
        return () if outcome is None else (outcome,)

    def _cycle(self, outcomes: tuple[Outcome, ...]) -> CycleReport:
        """See, anchor, infer, decide; write it down."""
        times = [time.perf_counter()]
        arm = self._driver.state()
        self._source.update(arm)
        detections, camera = self._source.look()
        times.append(time.perf_counter())
        hand = hand_detection(arm, camera, self._config)
        before = self._anchors
        self._anchors = self._anchoring.update([*detections, hand], self._attachments(), camera)
        times.append(time.perf_counter())
        percepts = percepts_of(self._anchors, arm, self._config)
        decision = self._agent.cycle(percepts, outcomes)
        times.append(time.perf_counter())
        self._note(decision.cycle, outcomes, before)
        report = CycleReport(decision, outcomes, percepts, self._anchors, tuple(detections), arm)
        seconds = [round(b - a, 6) for a, b in pairwise(times)]
        self._publish(report, dict(zip(("look_s", "anchor_s", "decide_s"), seconds, strict=True)))
        return report

    def _record_loss(self, reason: str) -> None:
        """Write a last cycle for an arm that is lost: what was seen last, and what ended how."""
        if self._last is None:
            return
        running = self._last.decision.step
        outcomes = self._outcomes
        if not any(o.status is Status.FAILED for o in outcomes) and running is not None:
            outcomes = (Outcome(running.action, Status.FAILED, reason),)
        decision = self._agent.cycle(self._last.percepts, outcomes)
        self._note(decision.cycle, outcomes, ())
        lost = replace(
            decision, kind=DecisionKind.IMPASSE, path=(), step=None, reason=reason, request=None
        )
        self._publish(replace(self._last, decision=lost, outcomes=outcomes, detections=()), {})

    def _publish(self, report: CycleReport, timings: dict[str, float]) -> None:
        self._last = report
        if self._trace is not None:
            self._trace.write(report.record(timings=timings))
        if self._observer is not None:
            self._observer(report)

    def _act(self, report: CycleReport) -> _End | None:
        """Carry a decision out; say so if the run has ended."""
        decision, step = report.decision, report.decision.step
        if decision.kind in (DecisionKind.ACHIEVED, DecisionKind.IMPASSE):
            return self._rest(decision, report.outcomes)
        self._waited = 0
        if step is None:
            return None
        if decision.request is not None:
            self._stand_still(decision.request, step, report.arm.timestamp_s, decision.cycle)
        elif decision.kind is DecisionKind.ACT:
            if self._resting is _Resting.ON_THE_WAY:
                self._driver.stop()
            self._driver.start(step.action, step.commands, self._by_name())
            self._actions.append(ActionRecord(decision.cycle, str(step.action), Status.RUNNING))
            self._resting, self._started_s = _Resting.NO, report.arm.timestamp_s
        elif decision.kind is DecisionKind.ABORT:
            self._abort(step.action, decision.reason)
        else:
            limit = step.clause.timeout_s
            if limit is not None and report.arm.timestamp_s - self._started_s > limit:
                self._abort(step.action, f"not done within {limit:g} s")
        return None

    def _stand_still(self, request: Request, step: PlanStep, now_s: float, cycle: int) -> None:
        """Keep the arm where it is while another agent does its part; give up in the end."""
        if self._resting is _Resting.ON_THE_WAY:
            self._driver.stop()
            self._resting = _Resting.NO
        if request.since == cycle:
            self._actions.append(ActionRecord(cycle, str(step.action), "requested"))
            self._started_s = now_s
        limit_s = patience_s(step)
        if now_s - self._started_s > limit_s:
            reason = f"{NO_ANSWER} within {limit_s:g} s"
            self._aborted = Outcome(step.action, Status.FAILED, reason)

    def _abort(self, action: Action, reason: str) -> None:
        self._driver.stop()
        self._aborted = Outcome(action, Status.FAILED, reason)

    def _rest(self, decision: Decision, outcomes: Sequence[Outcome]) -> _End | None:
        """With nothing to do, go back to where everything can be seen, and look again.

        A goal counts as achieved only after it has been believed there for a while, and an
        impasse only ends the run when looking again did not help.
        """
        for outcome in outcomes:
            if outcome.action == PARK and outcome.status is Status.FAILED:
                return _End(f"the arm cannot go back to its look pose: {outcome.reason}")
            if outcome.action == PARK and outcome.status is Status.SUCCEEDED:
                self._resting = _Resting.AT_LOOK_POSE
        if self._resting is _Resting.NO:
            self._driver.start(PARK, (Action("rest", (HAND,)),), self._by_name())
            self._resting, self._waited = _Resting.ON_THE_WAY, 0
        if self._resting is not _Resting.AT_LOOK_POSE:
            return None
        self._waited += 1
        if decision.kind is DecisionKind.ACHIEVED:
            done = self._waited >= self._limits.confirm
            return _End(decision.reason, achieved=True) if done else None
        if self._waited < self._limits.patience:
            return None
        wanted = [str(term) for goal in self._agent.goals for term in goal.atom.args]
        lost = [sentence for name, sentence in self._lost.items() if name in wanted]
        return _End("; ".join([decision.reason, *lost]))

    def _note(self, cycle: int, outcomes: Sequence[Outcome], before: Sequence[Anchor]) -> None:
        for outcome in outcomes:
            if self._actions and self._actions[-1].action == str(outcome.action):
                self._actions[-1] = replace(self._actions[-1], status=str(outcome.status))
        names = {anchor.name for anchor in self._anchors}
        for anchor in before:
            if anchor.name not in names:
                unseen = self._anchoring.frame - anchor.last_seen
                self._lost[anchor.name] = (
                    f"{anchor.name} is no longer anchored since cycle {cycle}, after {unseen} "
                    "cycles in which it was not seen and nothing said where it went"
                )
        for name in names:
            self._lost.pop(name, None)

    def _attachments(self) -> list[Attachment]:
        pairs = self._agent.state.hierarchy.pairs()
        return [Attachment(str(child), str(parent)) for child, parent in pairs]

    def _by_name(self) -> dict[str, Anchor]:
        return {anchor.name: anchor for anchor in self._anchors}
