"""A driver without an arm: it plans the same motions and lets a virtual arm go through them.

No clock and no socket: every poll lets the same amount of robot time pass, so a run can be
repeated exactly.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Final

from runtime.config import RobotConfig
from runtime.drivers.driver import ArmState
from runtime.drivers.limits import (
    arm_solutions,
    blend,
    joint_distance,
    linear_path,
    tcp_matrix,
    travelled,
)
from runtime.drivers.stepping import StepEnd, SteppingDriver
from runtime.drivers.steps import (
    ArmStep,
    Felt,
    Grip,
    MoveJoints,
    MoveLinear,
    Press,
    Tare,
    Turn,
    duration_s,
    grip_failure,
    line_speed,
)
from runtime.errors import DriverError, UsageError
from runtime.kinematics import Joints, matrix_to_pose, pose_to_matrix
from runtime.parts import PartModel

_WHOLE: Final = 1e-9  # rad by which a whole stroke may be missed through rounding


class DryRunDriver(SteppingDriver):
    """A `Driver` whose arm exists in numbers only.

    Args:
        config: The robot.
        parts: What is known of the parts, by type.
        joints: Where the virtual arm stands at first, rad; None is the look pose.
        dt: Robot time that passes in one poll, s.

    Until `feel` is called for the first time, the gripper feels a part whenever it closes where
    the plan expects one.
    """

    def __init__(
        self,
        config: RobotConfig,
        parts: Mapping[str, PartModel],
        *,
        joints: Joints | None = None,
        dt: float = 0.1,
    ) -> None:
        if not (dt > 0 and math.isfinite(dt)):
            raise UsageError(f"dt is {dt!r} s; expected a positive time")
        super().__init__(config, parts)
        self._dt = dt
        self._joints = config.look_joints if joints is None else joints
        self._closed = False
        self._gripped = False
        self._sensor_is_fed = False
        self._time_s = 0.0
        self._step: ArmStep | None = None
        self._step_time_s = 0.0
        self._path: tuple[Joints, ...] = ()
        self._log: list[ArmStep] = []

    @property
    def log(self) -> tuple[ArmStep, ...]:
        """The steps it has begun, in order, looks left out."""
        return tuple(self._log)

    def feel(self, gripped: bool) -> None:  # noqa: FBT001 - a sensor's level
        """Set what the gripper's sensor feels, as the simulated cell does."""
        self._sensor_is_fed = True
        self._gripped = gripped

    def state(self) -> ArmState:
        """Give the state of the virtual arm."""
        return ArmState(
            self._joints,
            matrix_to_pose(tcp_matrix(self._config, self._joints)),
            self._closed,
            self._gripped,
            self._time_s,
            regrips=self._regrips,
        )

    def close(self) -> None:
        """Stop the virtual arm."""
        self.stop()

    def _notice(self) -> str:
        self._time_s += self._dt
        return ""

    def _begin(self, step: ArmStep) -> None:
        self._log.append(step)
        self._step, self._step_time_s = step, 0.0
        match step:
            case MoveJoints():
                self._path = (step.start, step.joints)
            case Grip():
                self._closed = step.close
                if not self._sensor_is_fed:
                    self._gripped = step.expect_gripped
            case Tare():
                self._path = ()
            case Turn():
                self._path = (self._joints, self._turned(step))
            case MoveLinear() | Press():
                origin = tcp_matrix(self._config, step.start)
                target = pose_to_matrix(step.pose)
                self._path = linear_path(self._config, step.start, origin, target)

    def _advance(self) -> StepEnd | None:
        self._step_time_s += self._dt
        step = self._step
        match step:
            case None | Tare():
                return StepEnd()
            case Grip():
                return self._feel_for(step)
            case _:
                return self._go(step)

    def _go(self, step: MoveJoints | MoveLinear | Press | Turn) -> StepEnd | None:
        """Move along the path by one poll's time."""
        if self._step_time_s >= self._whole_s(step):
            start, self._joints, self._step = self._path[0], self._path[-1], None
            return StepEnd(felt=_felt(step, self._joints[5] - start[5]))
        speeds, force = self._config.speeds, self._config.force
        match step:
            case MoveJoints():
                whole = joint_distance(step.start, step.joints)
                done = travelled(whole, speeds.joint, speeds.joint_acceleration, self._step_time_s)
            case MoveLinear():
                whole = step.length_m
                speed = line_speed(step, self._config)
                done = travelled(whole, speed, speeds.tool_acceleration, self._step_time_s)
            case Press():
                whole, done = step.length_m, force.descent_speed * self._step_time_s
            case Turn():
                whole, done = self._whole_s(step), self._step_time_s
        place = done / whole * (len(self._path) - 1)
        index = min(int(place), len(self._path) - 2)
        self._joints = blend(self._path[index], self._path[index + 1], place - index)
        return None

    def _whole_s(self, step: MoveJoints | MoveLinear | Press | Turn) -> float:
        if isinstance(step, Turn):  # ends where the wrist must
            return abs(self._path[-1][5] - self._path[0][5]) / self._config.force.turning_speed
        return duration_s(step, self._config)

    def _turned(self, step: Turn) -> Joints:
        """Give the joint angles at the end of a stroke: the wrist turned, down or up the thread."""
        way = step.wrist_until_rad - self._joints[5]
        turn = math.copysign(min(abs(way), step.angle_rad), way)
        tool = tcp_matrix(self._config, self._joints)
        tool[2, 3] -= step.pitch_m * turn / (2 * math.pi)
        down = arm_solutions(self._config, tool, self._joints)
        if not down:
            raise DriverError("the thread leads out of the arm's reach")
        return (*down[0][:5], down[0][5] + turn)

    def _feel_for(self, step: Grip) -> StepEnd | None:
        gripper = self._config.gripper
        if self._step_time_s < gripper.close_time_s:
            return None
        if self._gripped == step.expect_gripped:
            self._step = None
            return StepEnd()
        if self._step_time_s < gripper.close_time_s + gripper.sense_time_s:
            return None
        self._step = None
        return StepEnd(grip_failure(step))

    def _halt(self) -> None:
        self._step = None

    def _at_rest(self) -> bool:
        return self._step is None


def _felt(step: ArmStep, turn_rad: float) -> Felt | None:
    """Give what would be felt if all were as expected: a screw is tight when it is in."""
    if not isinstance(step, Turn):
        return None
    stalled = step.clockwise and abs(turn_rad) >= step.angle_rad - _WHOLE
    sunk_m = step.pitch_m * turn_rad / (2 * math.pi)
    return Felt(turned_rad=turn_rad, stalled=stalled, sunk_m=sunk_m)
