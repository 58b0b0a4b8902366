"""The arm itself: joints that follow motions, brakes, limits, a tool and what it feels."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from runtime.controller.motions import (
    MAX_JOINT_SPEED,
    JointState,
    JointVector,
    Motion,
    MotionError,
    approach,
    is_resting,
)
from runtime.controller.tokens import ScriptError
from runtime.controller.tool_motions import Tool, ToolSpeed
from runtime.kinematics import JOINT_LIMIT, ArmModel, Joints, Pose, matrix_to_pose, pose_to_matrix

HOME: Final[Joints] = (0.0, -1.5708, 1.5708, -1.5708, -1.5708, 0.0)
"""Elbow up, tool down: where the arm stands unless told otherwise, rad."""

NO_TOOL: Final[Pose] = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
"""The tool centre point at the flange."""

_STILL: Final[Pose] = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
_BRAKE: Final = 15.0  # rad/s^2 when nothing commands the arm
_STEADY_S: Final = 0.5  # URScript: steady is at rest for this long
_SLIDER_PER_S: Final = 2.0  # so that the slider changes the speed without a jump
_HISTORY: Final = 1000

# Force control: an admittance, force error to speed. Real force dynamics are not imitated.
_YIELD: Final = np.array([0.002] * 3 + [0.02] * 3)  # m/s per N, rad/s per Nm
_YIELD_ACCELERATION: Final = 2.0


@dataclass(frozen=True, slots=True)
class ForceMode:
    """What `force_mode` asks for.

    Args:
        frame: The task frame in the base frame.
        compliant: For each axis of it, whether the tool yields along or about it.
        wrench: What the tool should press with, N and Nm in the task frame.
        limits: The greatest speed along each compliant axis, m/s and rad/s.
    """

    frame: Pose
    compliant: tuple[bool, ...]
    wrench: Pose
    limits: Pose


class Arm:
    """A kinematic arm: it follows exactly and weighs nothing.

    Args:
        model: Its geometry.
        joints: Where it stands at first, rad.
    """

    def __init__(self, model: ArmModel, joints: Joints) -> None:
        self.model: Final = model
        self.state = JointState(np.array(joints), np.zeros(6))
        self.tool = Tool(model, NO_TOOL)
        self.payload_kg = 0.0
        self.payload_cog: tuple[float, float, float] = (0.0, 0.0, 0.0)
        self.speed_fraction = 1.0
        self.scaling = 1.0
        self.held = False
        self.force_mode: ForceMode | None = None
        self.external_wrench: Pose = NO_TOOL
        self._zero_wrench: Pose = NO_TOOL
        self._motion: Motion | None = None
        self._owner: object = None
        self._still_s = _STEADY_S
        # A resting arm is asked for its pose at every tick: it is worked out once.
        self._pose_at = (self.state, self.tool, matrix_to_pose(self.tool.pose(self.state.q)))
        self._history: deque[JointVector] = deque(maxlen=_HISTORY)

    def command(self, motion: Motion, owner: object) -> None:
        """Give the arm to a motion; it keeps the arm until `release`, done or not.

        Args:
            motion: What moves it from the next cycle on.
            owner: Who commands: one thread of a program.

        Raises:
            ScriptError: Another owner's motion is still running.
        """
        if self._motion is not None and self._owner != owner:
            raise ScriptError("another thread is already controlling the robot")
        self._motion, self._owner = motion, owner

    def release(self, motion: Motion | None = None) -> None:
        """Take the arm from a motion, or from whichever has it; a moving arm then brakes."""
        if motion is None or self._motion is motion:
            self._motion = None

    def hold(self) -> None:
        """Brake and stay, whatever is commanded, until `unhold`."""
        self.held = True

    def unhold(self) -> None:
        """Let the interrupted motion go on from where the arm stands."""
        self.held = False
        if self._motion is not None:
            self._motion.interrupt()

    def step(self, dt: float) -> None:
        """Advance by one control cycle of `dt` seconds.

        Raises:
            MotionError: The motion cannot go on. The arm is where it was; hold it.
        """
        self._history.append(self.state.q)
        change = self.speed_fraction - self.scaling
        self.scaling += max(-_SLIDER_PER_S * dt, min(_SLIDER_PER_S * dt, change))
        after = self._next(dt)
        if float(np.abs(after.q).max()) > JOINT_LIMIT:
            self.state = JointState(self.state.q, np.zeros(6))
            raise MotionError("a joint would leave its range of +-360 degrees")
        if float(np.abs(after.qd).max()) > MAX_JOINT_SPEED * 1.05:
            raise MotionError("a joint would turn faster than it may")
        self.state = after
        self._still_s = self._still_s + dt if is_resting(after.qd) else 0.0

    def _next(self, dt: float) -> JointState:
        if self._motion is not None and not self.held and self.scaling > 0:
            # The slider slows the motion's own time; its speeds are undone and done again.
            own = JointState(self.state.q, self.state.qd / self.scaling)
            after = self._motion.step(own, dt * self.scaling)
            return JointState(after.q, after.qd * self.scaling)
        if self.force_mode is not None and not self.held:
            return self._yield(self.force_mode, dt)
        if is_resting(self.state.qd):
            return self.state
        return approach(self.state, np.zeros(6), _BRAKE, dt)

    def _yield(self, mode: ForceMode, dt: float) -> JointState:
        turn = np.kron(np.eye(2), pose_to_matrix(mode.frame)[:3, :3])
        felt = turn.T @ np.array(self.wrench)
        limits = np.abs(np.array(mode.limits))
        speed = np.clip(_YIELD * (np.array(mode.wrench) + felt), -limits, limits)
        x, y, z, rx, ry, rz = (turn @ (speed * np.array(mode.compliant))).tolist()
        motion = ToolSpeed(
            self.tool, (x, y, z, rx, ry, rz), _YIELD_ACCELERATION, _YIELD_ACCELERATION
        )
        return motion.step(self.state, dt)

    @property
    def joints(self) -> Joints:
        """Joint angles, rad."""
        return _joints(self.state.q)

    @property
    def tcp_pose(self) -> Pose:
        """The tool centre point in the base frame."""
        state, tool, pose = self._pose_at
        if state is not self.state or tool is not self.tool:
            pose = matrix_to_pose(self.tool.pose(self.state.q))
            self._pose_at = self.state, self.tool, pose
        return pose

    @property
    def tcp_speed(self) -> Pose:
        """Linear and angular velocity of the tool centre point, m/s and rad/s."""
        if is_resting(self.state.qd):
            return _STILL
        return _joints(self.tool.velocity(self.state))

    @property
    def wrench(self) -> Pose:
        """The force on the tool since it was last zeroed, N and Nm in the base frame."""
        pairs = zip(self.external_wrench, self._zero_wrench, strict=True)
        fx, fy, fz, mx, my, mz = (felt - zero for felt, zero in pairs)
        return fx, fy, fz, mx, my, mz

    @property
    def is_steady(self) -> bool:
        """Whether the arm has been at rest for half a second."""
        return self._still_s >= _STEADY_S

    def zero_wrench(self) -> None:
        """Count what the tool feels now as nothing."""
        self._zero_wrench = self.external_wrench

    def set_tcp(self, pose: Pose) -> None:
        """Put another tool on the flange; a running motion keeps the one it began with."""
        self.tool = Tool(self.model, pose)

    def joints_before(self, cycles: int) -> Joints:
        """Give the joint angles some cycles ago, as far back as is known, rad."""
        if cycles <= 0 or not self._history:
            return self.joints
        return _joints(self._history[-min(cycles, len(self._history))])

    def is_within_limits(self, joints: Sequence[float]) -> bool:
        """Whether every joint is within its range."""
        return all(abs(q) <= JOINT_LIMIT for q in joints)


def _joints(vector: JointVector) -> Joints:
    q1, q2, q3, q4, q5, q6 = vector.tolist()
    return q1, q2, q3, q4, q5, q6
