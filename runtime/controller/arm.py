"""The arm itself: joints that follow motions, brakes, limits, a tool and what it feels."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Sequence
from typing import Final

import numpy as np

from runtime.controller.contact import Contact
from runtime.controller.force_control import (
    DEFAULT_DAMPING,
    DEFAULT_GAIN,
    ForceController,
    ForceMode,
)
from runtime.controller.motions import (
    MAX_JOINT_SPEED,
    JointMove,
    JointState,
    JointVector,
    Motion,
    MotionError,
    approach,
    is_resting,
)
from runtime.controller.tokens import ScriptError
from runtime.controller.tool_motions import LinearMove, Tool, joint_speeds
from runtime.controller.touch import Pressing, Touch
from runtime.kinematics import JOINT_LIMIT, ArmModel, Joints, Matrix, Pose, matrix_to_pose

HOME: Final[Joints] = (0.0, -1.5708, 1.5708, -1.5708, -1.5708, 0.0)
"""Elbow up, tool down: where the arm stands unless told otherwise, rad."""

NO_TOOL: Final[Pose] = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
"""The tool centre point at the flange."""

_STILL: Final[Pose] = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
_BRAKE: Final = 15.0  # rad/s^2 when nothing commands the arm
_STEADY_S: Final = 0.5  # URScript: steady is at rest for this long
_SLIDER_PER_S: Final = 2.0  # so that the slider changes the speed without a jump
_HISTORY: Final = 1000
_STILL_TWIST: Final = np.zeros(6)


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
        self.moves = 0
        self.external_wrench: Pose = NO_TOOL
        self.touch: Final = Touch()
        self.force_damping = DEFAULT_DAMPING
        self.force_gain = DEFAULT_GAIN
        self._pressing = Pressing()
        self._force: ForceController | None = None
        self._planned = self.state
        self._zero_wrench: Pose = NO_TOOL
        self._motion: Motion | None = None
        self._owner: object = None
        self._still_s = _STEADY_S
        # A resting arm is asked for its pose at every tick: it is worked out once.
        self._matrix_at = (self.state, self.tool, self.tool.pose(self.state.q))
        self._planned_at = self._matrix_at
        self._pose_at = (self._matrix_at[2], matrix_to_pose(self._matrix_at[2]))
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
        if motion is not self._motion and isinstance(motion, JointMove | LinearMove):
            self.moves += 1
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
        self._plan_anew()

    @property
    def force_mode(self) -> ForceMode | None:
        """What force mode asks for while it is on."""
        return None if self._force is None else self._force.mode

    @force_mode.setter
    def force_mode(self, mode: ForceMode | None) -> None:
        before = self.force_mode
        if mode == before:
            return
        self._force = None if mode is None else ForceController(mode)
        if mode is None or before is None or mode.compliant != before.compliant:
            # The program's path goes on from where the tool has yielded to.
            self._plan_anew()

    def step(self, dt: float) -> None:
        """Advance by one control cycle of `dt` seconds.

        Raises:
            MotionError: The motion cannot go on, or the tool presses too hard. Hold the arm.
        """
        self._history.append(self.state.q)
        change = self.speed_fraction - self.scaling
        self.scaling += max(-_SLIDER_PER_S * dt, min(_SLIDER_PER_S * dt, change))
        after, moment = self._next(dt)
        if float(np.abs(after.q).max()) > JOINT_LIMIT:
            self.state = JointState(self.state.q, np.zeros(6))
            self._plan_anew()
            raise MotionError("a joint would leave its range of +-360 degrees")
        if float(np.abs(after.qd).max()) > MAX_JOINT_SPEED * 1.05:
            raise MotionError("a joint would turn faster than it may")
        self.state = after
        self._still_s = self._still_s + dt if is_resting(after.qd) else 0.0
        self._feel(moment, dt)

    def _next(self, dt: float) -> tuple[JointState, float | None]:
        """Give the state a cycle later, and what a thread resists with if force mode knows."""
        if self.held:
            self._planned = self._brake(self.state, dt)
            return self._planned, None
        if self._motion is not None and self.scaling > 0:
            # The slider slows the motion's own time; its speeds are undone and done again.
            own = JointState(self._planned.q, self._planned.qd / self.scaling)
            after = self._motion.step(own, dt * self.scaling)
            self._planned = JointState(after.q, after.qd * self.scaling)
        else:
            self._planned = self._brake(self._planned, dt)
        return (self._planned, None) if self._force is None else self._yield(self._force, dt)

    def _brake(self, state: JointState, dt: float) -> JointState:
        return state if is_resting(state.qd) else approach(state, np.zeros(6), _BRAKE, dt)

    def _yield(self, force: ForceController, dt: float) -> tuple[JointState, float | None]:
        pose = self._matrix()
        programmed = self._planned_matrix()
        if force.has_turned(pose, programmed):
            self._plan_anew()
            programmed = pose
        # Half a cycle ahead, so that the way through the cycle does not bend to one side.
        _, jacobian = self.tool.jacobian(self.state.q + self.state.qd * (dt / 2))
        going = not is_resting(self._planned.qd)
        path = self.tool.velocity(self._planned) if going else _STILL_TWIST
        external = np.array(self.external_wrench) - np.array(self._zero_wrench)
        velocity, moment = force.velocity(
            pose,
            jacobian @ self.state.qd,
            (programmed, path),
            external,
            self.touch.supports(pose),
            dt,
        )
        qd = joint_speeds(jacobian, velocity)
        return JointState(self.state.q + qd * dt, qd), moment

    def _plan_anew(self) -> None:
        self._planned = self.state
        if self._motion is not None:
            self._motion.interrupt()

    def be_near(self, contact: Contact | None) -> None:
        """Learn what is near the tool from now on; None for nothing."""
        self.touch.be_near(contact, self._matrix())

    def _feel(self, moment: float | None, dt: float) -> None:
        if self.touch.contact is not None:
            self.touch.follow(self._matrix(), dt, moment)
        self.touch.count(math.hypot(*self.wrench[:3]))
        pressing = math.hypot(*self.touch.wrench[:3].tolist())
        too_hard = self._pressing.too_hard(pressing, dt, held=self.held)
        if too_hard is not None:
            raise MotionError(too_hard)

    @property
    def joints(self) -> Joints:
        """Joint angles, rad."""
        return _joints(self.state.q)

    @property
    def tcp_pose(self) -> Pose:
        """The tool centre point in the base frame."""
        at = self._matrix()
        if self._pose_at[0] is not at:
            self._pose_at = at, matrix_to_pose(at)
        return self._pose_at[1]

    def _planned_matrix(self) -> Matrix:
        # Between moves the programmed place stands still while force mode goes on.
        planned, tool, matrix = self._planned_at
        if planned is not self._planned or tool is not self.tool:
            matrix = self.tool.pose(self._planned.q)
            self._planned_at = self._planned, self.tool, matrix
        return matrix

    def _matrix(self) -> Matrix:
        state, tool, matrix = self._matrix_at
        if state is not self.state or tool is not self.tool:
            matrix = self.tool.pose(self.state.q)
            self._matrix_at = self.state, self.tool, matrix
        return matrix

    @property
    def tcp_speed(self) -> Pose:
        """Linear and angular velocity of the tool centre point, m/s and rad/s."""
        if is_resting(self.state.qd):
            return _STILL
        return _joints(self.tool.velocity(self.state))

    @property
    def wrench(self) -> Pose:
        """The force on the tool since it was last zeroed, N and Nm in the base frame."""
        pairs = zip(self.raw_wrench, self._zero_wrench, strict=True)
        fx, fy, fz, mx, my, mz = (felt - zero for felt, zero in pairs)
        return fx, fy, fz, mx, my, mz

    @property
    def raw_wrench(self) -> Pose:
        """The force on the tool, N and Nm in the base frame, whatever was zeroed."""
        pairs = zip(self.external_wrench, self.touch.wrench.tolist(), strict=True)
        fx, fy, fz, mx, my, mz = (wired + touched for wired, touched in pairs)
        return fx, fy, fz, mx, my, mz

    @property
    def is_steady(self) -> bool:
        """Whether the arm has been at rest for half a second."""
        return self._still_s >= _STEADY_S

    def zero_wrench(self) -> None:
        """Count what the tool feels now as nothing."""
        self._zero_wrench = self.raw_wrench

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
