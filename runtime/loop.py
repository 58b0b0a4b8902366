"""The loop: detections, anchors, beliefs, decision, motion; one trace line a cycle."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from enum import Enum, auto
from itertools import pairwise
from typing import Protocol

from aapa import Anchor, Anchoring, Attachment, Camera, Detection
from icarus_lite import Action, Agent, Decision, DecisionKind, Outcome, Request, Status
from icarus_lite.execution import NO_ANSWER, patience_s
from icarus_lite.planning import PlanStep
from icarus_lite.trace import LOST, RESUMED, TraceWriter
from runtime.config import RobotConfig
from runtime.cycle_report import CycleReport
from runtime.drivers import PARK, ArmState, Driver, Recoverable
from runtime.errors import ControllerError, DriverError
from runtime.interruption import Interruption
from runtime.people import People
from runtime.percepts import HAND, PERSON_TYPE, hand_detection, percepts_of


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
        patience_s: The least time of that, on the arm's clock, s: whoever carries a part off may
            bring it back.
        confirm: Cycles in a row, arm back at the look pose, in which the goals must be believed:
            enough for what is seen to speak against it.
        confirm_s: The least time of that, on the arm's clock, s.
        company_s: How much longer that look may last while the hand of a person is in sight: who
            knows what it is about to do. On the arm's clock, s.
        cycles: The most cycles of one run.
    """

    patience: int = 15
    patience_s: float = 8.0
    confirm: int = 16
    confirm_s: float = 1.0
    company_s: float = 30.0
    cycles: int = 3000


@dataclass(frozen=True, slots=True)
class _End:
    """The end of a run."""

    reason: str
    achieved: bool = False


@dataclass(frozen=True, slots=True)
class TakenUp:
    """Where a run was cut off that is gone on with.

    Args:
        anchors: What was anchored last.
        interrupted: The action that was under way, failed; None if there was none.
    """

    anchors: tuple[Anchor, ...]
    interrupted: Outcome | None


class _Resting(Enum):
    """Whether the arm is where it sees everything."""

    NO = auto()
    ON_THE_WAY = auto()
    AT_LOOK_POSE = auto()


@dataclass(frozen=True, slots=True)
class ActionRecord:
    """An action that was started, and how it ended."""

    cycle: int
    action: str
    status: str


@dataclass(frozen=True, slots=True)
class LoopResult:
    """How a run ended: achieved or not, why, after how many cycles, by which actions.

    `recoveries` are the reasons for which the arm had stopped and was set going again.
    """

    achieved: bool
    reason: str
    cycles: int
    actions: tuple[ActionRecord, ...]
    recoveries: tuple[str, ...] = ()


class Loop:
    """Runs an agent on a body until its goals are achieved or it has to give up.

    Args:
        agent: The mind, with its goals.
        anchoring: The eyes.
        driver: The body, at rest at its look pose. Stopped when the loop ends, never closed.
        source: Where detections come from.
        config: The robot.
        trace: Where each cycle is written, or None.
        observers: Called after each cycle.
        limits: When to give up.
        people: Who else works at the table, and who may set the arm going again; nobody if left
            out.
        taken_up: Where a run was cut off that this one goes on with.
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
        observers: Sequence[Callable[[CycleReport], None]] = (),
        limits: LoopLimits | None = None,
        people: People | None = None,
        taken_up: TakenUp | None = None,
    ) -> None:
        self._agent = agent
        self._anchoring = anchoring
        self._driver = driver
        self._source = source
        self._config = config
        self._trace = trace
        self._observers = tuple(observers)
        self._limits = limits or LoopLimits()
        self._people = people or People()
        self._anchors = () if taken_up is None else taken_up.anchors
        self._actions: list[ActionRecord] = []
        self._lost: dict[str, str] = {}
        self._aborted = None if taken_up is None else taken_up.interrupted
        self._extra: dict[str, object] = {} if taken_up is None else {RESUMED: True}
        self._outcomes: tuple[Outcome, ...] = ()
        self._last: CycleReport | None = None
        self._resting = _Resting.AT_LOOK_POSE if taken_up is None else _Resting.NO
        self._waited = 0
        self._started_s = 0.0
        self._waiting_since_s = 0.0
        self._company = False
        self._interruption = Interruption()
        self._asked_since = -1
        self._cycles = 0
        self._ended: LoopResult | None = None
        self._recoveries: list[str] = []

    def run(self) -> LoopResult:
        """Run to the end. An interruption from the keyboard stops the arm and ends the run."""
        try:
            with self._interruption:
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
            self._interruption.check()
            self._outcomes = self._poll()
            end = self._act(self._cycle(self._outcomes))
        except (ControllerError, DriverError) as error:
            end = self._recover(str(error))
        except KeyboardInterrupt:
            end = _End("interrupted by the operator; the arm was stopped")
        return None if end is None else self._end(end)

    def _end(self, end: _End) -> LoopResult:
        self._driver.stop()
        self._ended = LoopResult(
            end.achieved,
            end.reason,
            self._cycles,
            tuple(self._actions),
            tuple(self._recoveries),
        )
        return self._ended

    def _recover(self, reason: str) -> _End | None:
        """Set the arm going again if the operator says so; otherwise the run has ended."""
        operator, driver = self._people.operator, self._driver
        if operator is None or not isinstance(driver, Recoverable) or not operator(reason):
            self._record_loss(reason)
            return _End(reason)
        self._aborted = self._broken_off(reason)
        try:
            driver.recover()
        except (ControllerError, DriverError) as error:
            self._record_loss(reason)
            return _End(f"{reason}; the arm could not be set going again: {error}")
        self._recoveries.append(reason)
        self._resting, self._waited = _Resting.NO, 0
        return None

    def _broken_off(self, reason: str) -> Outcome | None:
        """Give the outcome of the action that was under way when the arm was lost."""
        failed = [each for each in self._outcomes if each.status is Status.FAILED]
        if failed:
            return None if failed[-1].action == PARK else failed[-1]
        running = None if self._last is None else self._last.decision
        if running is None or running.step is None or running.request is not None:
            return None
        return Outcome(running.step.action, Status.FAILED, reason)

    def _poll(self) -> tuple[Outcome, ...]:
        outcome, self._aborted = self._aborted or self._driver.poll(self._by_name()), None
        return () if outcome is None else (outcome,)

    def _cycle(self, outcomes: tuple[Outcome, ...]) -> CycleReport:
        """See, anchor, infer, decide; write it down."""
        times = [time.perf_counter()]
        arm = self._driver.state()
        self._source.update(arm)
        outcomes = self._outcomes = (*outcomes, *self._people.colleague.reports())
        detections, camera = self._source.look()
        times.append(time.perf_counter())
        hand = hand_detection(arm, camera, self._config)
        before = self._anchors
        self._anchors = self._anchoring.update([*detections, hand], self._attachments(), camera)
        times.append(time.perf_counter())
        acting = any(outcome.status is Status.RUNNING for outcome in outcomes)
        percepts = percepts_of(self._anchors, arm, self._config, acting=acting)
        self._company = any(percept.type == PERSON_TYPE for percept in percepts)
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
        broken_off = self._broken_off(reason)
        outcomes = self._outcomes if broken_off is None else (broken_off,)
        decision = self._agent.cycle(self._last.percepts, outcomes)
        self._note(decision.cycle, outcomes, ())
        lost = replace(
            decision, kind=DecisionKind.IMPASSE, path=(), step=None, reason=reason, request=None
        )
        self._extra[LOST] = reason
        self._publish(replace(self._last, decision=lost, outcomes=outcomes, detections=()), {})

    def _publish(self, report: CycleReport, timings: dict[str, float]) -> None:
        self._last = report
        if self._trace is not None:
            self._trace.write(report.record(**self._extra, timings=timings))
            self._extra = {}
        for observer in self._observers:
            observer(report)

    def _act(self, report: CycleReport) -> _End | None:
        """Carry a decision out; say so if the run has ended."""
        decision, step = report.decision, report.decision.step
        if decision.kind in (DecisionKind.ACHIEVED, DecisionKind.IMPASSE):
            return self._rest(decision, report.outcomes, report.arm.timestamp_s)
        self._waited = 0
        if step is None:
            return None
        if decision.request is not None:
            return self._stand_aside(decision.request, step, report)
        if decision.kind is DecisionKind.ACT:
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

    def _stand_aside(self, request: Request, step: PlanStep, report: CycleReport) -> _End | None:
        """Get the arm out of the way, ask, and keep still while another agent does its part."""
        if request.since == report.decision.cycle:
            self._actions.append(ActionRecord(request.since, str(step.action), "requested"))
        end = self._retreat(report.outcomes)
        if end is not None or self._resting is not _Resting.AT_LOOK_POSE:
            return end
        now_s = report.arm.timestamp_s
        if self._asked_since != request.since:
            self._asked_since, self._started_s = request.since, now_s
            if request.sentence:
                self._people.colleague.ask(step.action, request.sentence, self._by_name())
        limit_s = patience_s(step)
        if now_s - self._started_s > limit_s:
            reason = f"{NO_ANSWER} within {limit_s:g} s"
            self._aborted = Outcome(step.action, Status.FAILED, reason)
        return None

    def _abort(self, action: Action, reason: str) -> None:
        self._driver.stop()
        self._aborted = Outcome(action, Status.FAILED, reason)

    def _rest(self, decision: Decision, outcomes: Sequence[Outcome], now_s: float) -> _End | None:
        """With nothing to do, go back to where everything can be seen, and look again.

        A goal counts as achieved only after it has been believed there for a while, and an
        impasse only ends the run when looking again did not help.
        """
        end = self._retreat(outcomes)
        if end is not None:
            return end
        if self._resting is not _Resting.AT_LOOK_POSE:
            return None
        if self._waited == 0:
            self._waiting_since_s = now_s
        self._waited += 1
        waited_s, limits = now_s - self._waiting_since_s, self._limits
        if decision.kind is DecisionKind.ACHIEVED:
            done = self._waited >= limits.confirm and waited_s >= limits.confirm_s
            if done and self._company and waited_s < limits.confirm_s + limits.company_s:
                return None
            return _End(decision.reason, achieved=True) if done else None
        if self._waited < limits.patience or waited_s < limits.patience_s:
            return None
        wanted = [str(term) for goal in self._agent.goals for term in goal.atom.args]
        lost = [sentence for name, sentence in self._lost.items() if name in wanted]
        return _End("; ".join([decision.reason, *lost]))

    def _retreat(self, outcomes: Sequence[Outcome]) -> _End | None:
        """Go back to the look pose, or go on going there; say so if that cannot be."""
        for outcome in outcomes:
            if outcome.action == PARK and outcome.status is Status.FAILED:
                self._driver.state()  # an arm that is lost says so by itself
                return _End(f"the arm cannot go back to its look pose: {outcome.reason}")
            if outcome.action == PARK and outcome.status is Status.SUCCEEDED:
                self._resting = _Resting.AT_LOOK_POSE
        if self._resting is _Resting.NO:
            self._driver.start(PARK, (Action("rest", (HAND,)),), self._by_name())
            self._resting, self._waited = _Resting.ON_THE_WAY, 0
        return None

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
