"""Carrying an action out step by step: what the drivers of all arms have in common.

A driver proper only knows how to carry out one step; planning, looking, planning anew and
reporting outcomes are done here.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Final

from aapa import Anchor
from icarus_lite import Action, Outcome, Status
from runtime.config import RobotConfig
from runtime.drivers.driver import ArmState
from runtime.drivers.limits import MotionError
from runtime.drivers.motions import COMMANDS, plan_motion
from runtime.drivers.steps import (
    ArmStep,
    Felt,
    GiveUp,
    Grip,
    Look,
    Press,
    Progress,
    Step,
    Turn,
    is_holding,
)
from runtime.errors import DriverError, UsageError
from runtime.parts import PartModel

PARK: Final = Action("park")
"""The action that `SteppingDriver.park` reports on."""


@dataclass(frozen=True, slots=True)
class StepEnd:
    """How a step ended.

    Args:
        reason: Why it failed; empty if it did not.
        felt: What a step by force has measured.
    """

    reason: str = ""
    felt: Felt | None = None


@dataclass(slots=True)
class _Run:
    """An action under way."""

    action: Action
    commands: tuple[Action, ...]
    steps: deque[Step] = field(default_factory=deque)
    planned: bool = False
    progress: Progress = field(default_factory=Progress)
    looks_left: int = 0
    refusal: str = ""
    note: str = ""
    regrips: bool = False

    def plan_anew(self, commands: tuple[Action, ...], progress: Progress) -> None:
        """Forget the steps that are left: the rest is to be planned from here."""
        self.commands, self.progress, self.planned = commands, progress, False
        self.steps.clear()


class SteppingDriver(ABC):
    """A `Driver` that plans actions as steps and carries out one step after the other."""

    def __init__(self, config: RobotConfig, parts: Mapping[str, PartModel]) -> None:
        self._config: Final = config
        self._parts: Final = parts
        self._run: _Run | None = None

    @property
    def commands(self) -> frozenset[str]:
        """The names of the commands it carries out, without the star."""
        return COMMANDS

    @abstractmethod
    def state(self) -> ArmState:
        """Give the newest measured state. Raises DriverError when the link is lost."""

    @property
    def _regrips(self) -> bool:
        """Whether the part has been let go only to be taken hold of again."""
        return self._run is not None and self._run.regrips

    @abstractmethod
    def close(self) -> None:
        """Stop the arm and let go of the connection. Never raises, never hangs."""

    @abstractmethod
    def _notice(self) -> str:
        """Take note of what has happened since the last poll; say why if the arm is lost."""

    @abstractmethod
    def _begin(self, step: ArmStep) -> None:
        """Begin a step."""

    @abstractmethod
    def _advance(self) -> StepEnd | None:
        """Tell how the step ended; None while it goes on."""

    @abstractmethod
    def _halt(self) -> None:
        """Bring the arm to a standstill."""

    @abstractmethod
    def _at_rest(self) -> bool:
        """Tell whether the arm stands still, so that a motion can be planned from where it is."""

    def start(
        self, action: Action, commands: Sequence[Action], anchors: Mapping[str, Anchor]
    ) -> None:
        """Begin an action; see `Driver.start`.

        Raises:
            UsageError: Another action is under way.
            DriverError: The arm cannot be driven any more.
        """
        if self._run is not None:
            raise UsageError(f"{action} cannot begin: {self._run.action} is still under way")
        self.state()
        self._run = _Run(action, tuple(commands))
        self._carry_on(self._run, anchors)

    def park(self) -> None:
        """Begin to go up and to the look pose; `poll` reports on it as the action `(park)`."""
        self.start(PARK, (Action("rest", ("hand",)),), {})

    def poll(self, anchors: Mapping[str, Anchor]) -> Outcome | None:
        """Report on the running action; see `Driver.poll`.

        Raises:
            DriverError: The arm is lost, and no action is under way that could report it.
        """
        lost = self._notice()
        run = self._run
        if run is None:
            if lost:
                raise DriverError(lost)
            return None
        try:
            reason = run.refusal or lost or self._turn(run, anchors)
        except DriverError as error:
            reason = str(error)
        if reason:
            self._run = None
            return Outcome(run.action, Status.FAILED, reason)
        if run.planned and not run.steps:
            self._run = None
            return Outcome(run.action, Status.SUCCEEDED, run.note)
        return Outcome(run.action, Status.RUNNING)

    def stop(self) -> None:
        """Bring the arm to a standstill and drop the running action. Safe to call at any time."""
        self._run = None
        self._halt()

    def _turn(self, run: _Run, anchors: Mapping[str, Anchor]) -> str:
        """Do one cycle's part of the action; give the reason if it failed."""
        if not run.planned:
            self._carry_on(run, anchors)
            return run.refusal
        if not run.steps:
            return ""
        step = run.steps[0]
        if isinstance(step, Look):
            return self._look(run, step, anchors)
        if isinstance(step, GiveUp):
            return step.reason
        ended = self._advance()
        if ended is None:
            return self._check_hold() if is_holding(step) else ""
        return self._after(run, step, ended, anchors)

    def _after(
        self, run: _Run, step: ArmStep, ended: StepEnd, anchors: Mapping[str, Anchor]
    ) -> str:
        """Go on after a step, or come away from where one by force has failed."""
        felt = ended.felt
        if felt is not None:
            run.note = felt.words
        if isinstance(step, Grip) and step.close:
            run.regrips = False
        by_force = isinstance(step, Press | Turn)
        if ended.reason and not (by_force and self.state().gripped):
            return ended.reason
        if isinstance(step, Turn):
            felt = felt or Felt()
            turned = (run.progress.turned_rad or 0.0) + felt.turned_rad
            run.note = f"{abs(turned) / (2 * math.pi):.2f} turns in all, the last {felt.words}"
            stalled = felt.stalled or bool(step.failure and ended.reason)
            failure = step.failure or ended.reason
            sunk_m = (run.progress.sunk_m or 0.0) + felt.sunk_m
            run.plan_anew(
                step.then,
                Progress(
                    looked=True, turned_rad=turned, stalled=stalled, failure=failure, sunk_m=sunk_m
                ),
            )
        elif isinstance(step, Press) and ended.reason:
            run.plan_anew(step.then, replace(run.progress, looked=True, failure=ended.reason))
        else:
            run.steps.popleft()
            self._begin_next(run)
            return ""
        self._carry_on(run, anchors)
        return run.refusal

    def _look(self, run: _Run, look: Look, anchors: Mapping[str, Anchor]) -> str:
        run.looks_left -= 1
        if run.looks_left <= 0:
            run.plan_anew(look.then, replace(run.progress, looked=True))
            self._carry_on(run, anchors)
        return run.refusal

    def _check_hold(self) -> str:
        if self.state().gripped:
            return ""
        self._halt()
        return "the gripper no longer feels the part it held; the arm was stopped"

    def _carry_on(self, run: _Run, anchors: Mapping[str, Anchor]) -> None:
        """Plan from where the arm stands, and begin the first step."""
        if not self._at_rest():
            return
        try:
            steps = plan_motion(
                run.commands, anchors, self.state(), self._config, self._parts, run.progress
            )
        except MotionError as error:
            failure = run.progress.failure
            run.refusal = f"{failure}; then: {error}" if failure else str(error)
            return
        run.steps.extend(steps)
        run.planned = True
        self._begin_next(run)

    def _begin_next(self, run: _Run) -> None:
        if not run.steps:
            return
        step = run.steps[0]
        if isinstance(step, Look):
            run.looks_left = step.cycles
        elif not isinstance(step, GiveUp):
            run.regrips = run.regrips or (isinstance(step, Grip) and step.again)
            self._begin(step)
