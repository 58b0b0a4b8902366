"""A driver without an arm: it plans the same motions and lets a virtual arm go through them.

No clock and no socket: every poll lets the same amount of robot time pass, so a run can be
repeated exactly.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

from runtime.config import RobotConfig
from runtime.drivers.driver import ArmState
from runtime.drivers.limits import (
    blend,
    joint_distance,
    linear_path,
    tcp_matrix,
    travelled,
)
from runtime.drivers.stepping import StepEnd, SteppingDriver
from runtime.drivers.steps import Grip, Look, MoveJoints, Step, duration_s, grip_failure
from runtime.errors import UsageError
from runtime.kinematics import Joints, matrix_to_pose, pose_to_matrix
from runtime.parts import PartModel


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
        self._step: Step | None = None
        self._step_time_s = 0.0
        self._path: tuple[Joints, ...] = ()
        self._log: list[Step] = []

    @property
    def log(self) -> tuple[Step, ...]:
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
        )

    def close(self) -> None:
        """Stop the virtual arm."""
        self.stop()

    def _notice(self) -> str:
        self._time_s += self._dt
        return ""

    def _begin(self, step: Step) -> None:
        self._log.append(step)
        self._step, self._step_time_s = step, 0.0
        match step:
            case MoveJoints():
                self._path = (step.start, step.joints)
            case Grip():
                self._closed = step.close
                if not self._sensor_is_fed:
                    self._gripped = step.expect_gripped
            case Look():
                self._path = ()
            case _:
                origin = tcp_matrix(self._config, step.start)
                target = pose_to_matrix(step.pose)
                self._path = linear_path(self._config, step.start, origin, target)

    def _advance(self) -> StepEnd | None:
        self._step_time_s += self._dt
        step = self._step
        if isinstance(step, Grip):
            return self._feel_for(step)
        if step is None or isinstance(step, Look):
            return StepEnd()
        speeds = self._config.speeds
        if isinstance(step, MoveJoints):
            whole = joint_distance(step.start, step.joints)
            done = travelled(whole, speeds.joint, speeds.joint_acceleration, self._step_time_s)
        else:
            whole = step.length_m
            done = travelled(whole, speeds.tool, speeds.tool_acceleration, self._step_time_s)
        if self._step_time_s >= duration_s(step, self._config):
            self._joints, self._step = self._path[-1], None
            return StepEnd()
        place = done / whole * (len(self._path) - 1)
        index = min(int(place), len(self._path) - 2)
        self._joints = blend(self._path[index], self._path[index + 1], place - index)
        return None

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
