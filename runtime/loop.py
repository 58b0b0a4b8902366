"""The loop: detections, anchors, beliefs, decision, motion; one trace line a cycle."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Final

from aapa import Anchor, Anchoring, Attachment
from icarus_lite import Action, Agent, Decision, DecisionKind, Outcome, Request, Status
from icarus_lite.execution import NO_ANSWER, patience_s
from icarus_lite.planning import PlanStep
from icarus_lite.trace import LOST, RESUMED, TraceWriter
from runtime.config import RobotConfig
from runtime.cycle_report import CycleReport
from runtime.drivers import PARK, Driver, Recoverable
from runtime.errors import ControllerError, DriverError
from runtime.interruption import Interruption
from runtime.people import People
from runtime.run_record import LoopResult, RunRecord
from runtime.second_look import LoopLimits, SecondLook
from runtime.seeing import PerceptSource, Sight

_ARM_NOTICES_WITHIN_S: Final = 3.0  # longer than a driver believes a silent controller
_LOOK_EVERY_S: Final = 0.02
_GRASP: Final = "grasp"


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
        self._sight = Sight(anchoring, source, config, () if taken_up is None else taken_up.anchors)
        self._driver = driver
        self._trace = trace
        self._observers = tuple(observers)
        self._limits = limits or LoopLimits()
        self._people = people or People()
        self._record = RunRecord()
        self._aborted = None if taken_up is None else taken_up.interrupted
        self._extra: dict[str, object] = {} if taken_up is None else {RESUMED: True}
        self._outcomes: tuple[Outcome, ...] = ()
        self._last: CycleReport | None = None
        self._second_look = SecondLook(driver, self._limits, begun=taken_up is None)
        self._started_s = 0.0
        self._interruption = Interruption()
        self._asked_since = -1
        self._cycles = 0
        self._begun_s: float | None = None
        self._lasted_s = 0.0
        self._ended: LoopResult | None = None

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
        if self._lasted_s > self._limits.run_s:
            minutes = f"{self._limits.run_s / 60:g} minutes"
            return self._end(_End(f"the goal was not reached in {minutes} of the arm's clock"))
        self._cycles += 1
        try:
            self._interruption.check()
            self._outcomes = self._poll()
            end = self._act(self._cycle(self._outcomes))
        except DriverError as error:
            end = self._recover(str(error))
        except ControllerError as error:
            end = self._recover(self._what_the_arm_says(str(error)))
        except KeyboardInterrupt:
            end = _End("interrupted by the operator; the arm was stopped")
        return None if end is None else self._end(end)

    def _end(self, end: _End) -> LoopResult:
        self._driver.stop()
        self._ended = self._record.result(end.reason, self._cycles, achieved=end.achieved)
        return self._ended

    def _what_the_arm_says(self, otherwise: str) -> str:
        """Give the arm's own reason if it is lost too: what is wired to it may notice it first."""
        self._driver.stop()
        deadline = time.monotonic() + _ARM_NOTICES_WITHIN_S
        while time.monotonic() < deadline:
            try:
                self._driver.state()
            except DriverError as error:
                return str(error)
            time.sleep(_LOOK_EVERY_S)
        return otherwise

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
        self._record.recovered(reason)
        self._second_look.lost()
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
        broken_off, self._aborted = self._aborted, None
        if broken_off is not None:
            return (self._measured(broken_off),)
        outcome = self._driver.poll(self._sight.by_name())
        return () if outcome is None else (outcome,)

    def _measured(self, broken_off: Outcome) -> Outcome:
        """Give what came of an action that was broken off, as far as it can be measured.

        Fingers that feel a part after a grasp hold it, whoever was told of it.
        """
        grasps = any(
            [command.predicate for command in clause.actions] == [_GRASP]
            for clause in self._agent.domain.skills
            if clause.head.predicate == broken_off.action.name
        )
        if broken_off.status is not Status.FAILED or not grasps:
            return broken_off
        self._sight.update(self._driver.state())
        if not self._driver.state().gripped:
            return broken_off
        return Outcome(broken_off.action, reason=f"it holds the part, though {broken_off.reason}")

    def _cycle(self, outcomes: tuple[Outcome, ...]) -> CycleReport:
        """See, anchor, infer, decide; write it down."""
        begun_s = time.perf_counter()
        arm = self._driver.state()
        self._begun_s = arm.timestamp_s if self._begun_s is None else self._begun_s
        self._lasted_s = arm.timestamp_s - self._begun_s
        self._sight.update(arm)
        reports = self._people.colleague.reports(self._sight.by_name())
        outcomes = self._outcomes = (*outcomes, *reports)
        acting = any(outcome.status is Status.RUNNING for outcome in outcomes)
        seen = self._sight.look(arm, self._attachments(), acting=acting)
        self._second_look.notice(company=self._sight.company)
        decision = self._agent.cycle(seen.percepts, outcomes)
        times = (begun_s, seen.looked_s, seen.anchored_s, time.perf_counter())
        self._note(decision.cycle, outcomes, seen.before)
        report = CycleReport(
            decision, outcomes, seen.percepts, self._sight.anchors, seen.detections, arm
        )
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
        self._second_look.interrupt()
        if step is None:
            return None
        if decision.request is not None:
            return self._stand_aside(decision.request, step, report)
        if decision.kind is DecisionKind.ACT:
            self._second_look.break_off()
            self._driver.start(step.action, step.commands, self._sight.by_name())
            self._record.started(decision.cycle, step.action)
            self._started_s = report.arm.timestamp_s
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
            self._record.started(request.since, step.action, "requested")
        no_way = self._second_look.retreat(report.outcomes, self._sight.by_name())
        if no_way is not None:
            return _End(no_way)
        if not self._second_look.there:
            return None
        now_s = report.arm.timestamp_s
        if self._asked_since != request.since:
            self._asked_since, self._started_s = request.since, now_s
            if request.sentence:
                self._people.colleague.ask(step.action, request.sentence, self._sight.by_name())
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
        look = self._second_look
        no_way = look.retreat(outcomes, self._sight.by_name())
        if no_way is not None:
            return _End(no_way)
        if not look.there:
            return None
        achieved = decision.kind is DecisionKind.ACHIEVED
        wanted = [str(term) for goal in self._agent.goals for term in goal.atom.args]
        speaks_against = bool(self._agent.state.doubts) or self._sight.shows_another_of(wanted)
        unsettled = self._sight.company or (achieved and speaks_against)
        look.count(now_s, achieved=achieved, unsettled=unsettled)
        if achieved:
            doubtful = self._sight.takes_on_trust(wanted, visited=look.visited)
            done = look.confirmed(now_s, doubtful=doubtful)
            return _End(decision.reason, achieved=True) if done else None
        if not look.in_vain(now_s):
            return None
        return _End("; ".join([decision.reason, *self._record.gone(wanted)]))

    def _note(self, cycle: int, outcomes: Sequence[Outcome], before: Sequence[Anchor]) -> None:
        self._record.cycle(cycle, outcomes, before, self._sight.anchors, self._sight.frame)

    def _attachments(self) -> list[Attachment]:
        pairs = self._agent.state.hierarchy.pairs()
        return [Attachment(str(child), str(parent)) for child, parent in pairs]
