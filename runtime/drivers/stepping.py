"""Carrying an action out step by step: what the drivers of all arms have in common.

A driver proper only knows how to carry out one step; planning, looking, planning anew and
reporting outcomes are done here.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

from aapa import Anchor
from icarus_lite import Action, Outcome, Status
from runtime.config import RobotConfig
from runtime.drivers.driver import ArmState
from runtime.drivers.limits import MotionError
from runtime.drivers.motions import COMMANDS, plan_motion
from runtime.drivers.steps import Look, MoveJoints, MoveLinear, Step
from runtime.errors import DriverError, UsageError
from runtime.parts import PartModel

PARK: Final = Action("park")
"""The action that `SteppingDriver.park` reports on."""


@dataclass(frozen=True, slots=True)
class StepEnd:
    """How a step ended: `reason` says why it failed, and is empty if it did not."""

    reason: str = ""


@dataclass(slots=True)
class _Run:
    """An action under way."""

    action: Action
    commands: tuple[Action, ...]
    steps: deque[Step] = field(default_factory=deque)
    planned: bool = False
    looked: bool = False
    looks_left: int = 0
    refusal: str = ""


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

    @abstractmethod
    def close(self) -> None:
        """Stop the arm and let go of the connection. Never raises, never hangs."""

    @abstractmethod
    def _notice(self) -> str:
        """Take note of what has happened since the last poll; say why if the arm is lost."""

    @abstractmethod
    def _begin(self, step: Step) -> None:
        """Begin a step that is not a look."""

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
            return Outcome(run.action, Status.SUCCEEDED)
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
        ended = self._advance()
        if ended is None:
            holding = isinstance(step, MoveJoints | MoveLinear) and step.holding
            return self._check_hold() if holding else ""
        if not ended.reason:
            run.steps.popleft()
            self._begin_next(run)
        return ended.reason

    def _look(self, run: _Run, look: Look, anchors: Mapping[str, Anchor]) -> str:
        run.looks_left -= 1
        if run.looks_left <= 0:
            run.commands, run.planned, run.looked = look.then, False, True
            run.steps.clear()
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
                run.commands, anchors, self.state(), self._config, self._parts, looked=run.looked
            )
        except MotionError as error:
            run.refusal = str(error)
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
        else:
            self._begin(step)
