"""Motions of the tool in space, followed by the joints through the Jacobian.

The joints are found by Newton steps from where they are, not by the closed-form inverse, so
that the arm never jumps from one branch to another in the middle of a line.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from runtime.controller.arm_frames import jacobian, joint_axes
from runtime.controller.motions import (
    MAX_JOINT_SPEED,
    JointState,
    JointVector,
    MotionError,
    approach,
    is_resting,
)
from runtime.controller.profile import Trapezoid
from runtime.kinematics import (
    ArmModel,
    Joints,
    Matrix,
    Pose,
    inverse,
    matrix_to_pose,
    nearest,
    pose_to_matrix,
)

_ON_THE_LINE: Final = 1e-9  # m and rad
_AT_THE_END: Final = 1e-12
_NEWTON_STEPS: Final = 12
_GREATEST_STEP: Final = 0.5  # rad in one Newton step: more means a singularity
_DAMPING: Final = 1e-8  # squared; keeps a speed finite in a singularity, unseen elsewhere
_BRAKING: Final = 10.0  # rad/s^2, where a new line has to stop what was moving before


class Tool:
    """An arm with a tool on its flange.

    Args:
        model: The arm.
        tcp: The tool centre point in the flange frame.
    """

    def __init__(self, model: ArmModel, tcp: Pose) -> None:
        self.model: Final = model
        self.tcp: Final = tcp
        self._offset = pose_to_matrix(tcp)
        self._back = np.linalg.inv(self._offset)

    def pose(self, q: JointVector) -> Matrix:
        """Give the tool in the base frame, (4, 4)."""
        at: Matrix = joint_axes(self.model, q.tolist()).flange @ self._offset
        return at

    def jacobian(self, q: JointVector) -> tuple[Matrix, Matrix]:
        """Give the tool's pose (4, 4) and its velocity per joint velocity (6, 6)."""
        axes = joint_axes(self.model, q.tolist())
        pose: Matrix = axes.flange @ self._offset
        x, y, z = pose[:3, 3].tolist()
        return pose, jacobian(axes, (x, y, z))

    def velocity(self, state: JointState) -> JointVector:
        """Give the tool's linear and angular velocity, (6,) m/s and rad/s."""
        twist: JointVector = self.jacobian(state.q)[1] @ state.qd
        return twist

    def solve(self, target: Matrix, near: JointVector, within: float) -> JointVector:
        """Give the joints for a tool pose close to where they are.

        Args:
            target: Where the tool should be, (4, 4).
            near: Where to begin, rad.
            within: How close is close enough, m and rad.

        Raises:
            MotionError: They do not converge: a singularity is in the way.
        """
        q = near.copy()
        for _ in range(_NEWTON_STEPS):
            pose, jacobian = self.jacobian(q)
            error = np.concatenate(
                (target[:3, 3] - pose[:3, 3], _rotation_vector(target[:3, :3] @ pose[:3, :3].T))
            )
            if float(np.abs(error).max()) < within:
                return q
            try:
                step = np.linalg.solve(jacobian, error)
            except np.linalg.LinAlgError:
                break
            if float(np.abs(step).max()) > _GREATEST_STEP:
                break
            q += step
        raise MotionError("the arm cannot follow the line: it passes a singularity")

    def reach(self, target: Matrix, near: JointVector) -> Joints | None:
        """Give the nearest of all joints for a tool pose, or None out of reach."""
        flange = target @ self._back
        return nearest(
            inverse(self.model, flange, free_wrist3=float(near[5])), tuple(near.tolist())
        )


class LinearMove:
    """`movel`: the tool on a straight line, turning evenly on the way.

    The limits hold for the way in m or for the turn in rad, whichever is the greater number.

    Args:
        tool: The arm and its tool.
        target: Where to.
        acceleration: m/s^2, > 0.
        speed: m/s, > 0.
        duration_s: If > 0, how long the way takes; the limits then do not count.
    """

    def __init__(
        self,
        tool: Tool,
        target: Pose,
        acceleration: float,
        speed: float,
        duration_s: float = 0.0,
    ) -> None:
        self.done = False
        self._tool = tool
        self._target = pose_to_matrix(target)
        self._acceleration = acceleration
        self._speed = speed
        self._duration_s = duration_s
        self._start: Matrix | None = None
        self._turn = np.zeros(3)
        self._way = Trapezoid.limited(0.0, 1.0, 1.0)
        self._at_s = 0.0

    def step(self, state: JointState, dt: float) -> JointState:
        """Give the state one cycle later; at the very target in the last."""
        if self._start is None:
            if not is_resting(state.qd):
                return approach(state, np.zeros(6), _BRAKING, dt)
            self._plan(state)
        self._at_s += dt
        ended = self._at_s >= self._way.duration_s
        before = self._way.position(self._at_s - dt)
        if ended:
            q = self._tool.solve(self._target, state.q, _AT_THE_END)
        else:
            q = self._tool.solve(self._between(), state.q + state.qd * dt, _ON_THE_LINE)
        if float(np.abs(q - state.q).max()) > MAX_JOINT_SPEED * 1.05 * dt:
            raise MotionError("the line needs a joint to turn faster than it can")
        self.done = ended
        if ended:
            return JointState(q, np.zeros(6))
        # The mean speed of the cycle, scaled to the speed at its end.
        covered = self._way.position(self._at_s) - before
        qd = (q - state.q) / covered * self._way.speed(self._at_s) if covered > 0 else q - q
        return JointState(q, qd)

    def interrupt(self) -> None:
        """Plan anew from where the arm was stopped."""
        self._start = None

    def _plan(self, state: JointState) -> None:
        start = self._tool.pose(state.q)
        if self._tool.reach(self._target, state.q) is None:
            raise MotionError("the target of the line is out of reach")
        self._start = start
        self._at_s = 0.0
        self._turn = _rotation_vector(start[:3, :3].T @ self._target[:3, :3])
        distance = float(np.linalg.norm(self._target[:3, 3] - start[:3, 3]))
        length = max(distance, float(np.linalg.norm(self._turn)))
        if self._duration_s > 0 and length > 0:
            self._way = Trapezoid.timed(length, self._duration_s)
        else:
            self._way = Trapezoid.limited(length, self._speed, self._acceleration)

    def _between(self) -> Matrix:
        assert self._start is not None
        share = self._way.position(self._at_s) / self._way.length
        turned = pose_to_matrix((0.0, 0.0, 0.0, *(self._turn * share).tolist()))
        between = np.eye(4)
        between[:3, :3] = self._start[:3, :3] @ turned[:3, :3]
        between[:3, 3] = self._start[:3, 3] + share * (self._target[:3, 3] - self._start[:3, 3])
        return between


class ToolSpeed:
    """`speedl`, and `stopl` with a target of zero: reach a tool velocity and hold it.

    Args:
        tool: The arm and its tool.
        target: Linear and angular velocity in the base frame, m/s and rad/s.
        acceleration: m/s^2, > 0.
        turning: Angular acceleration, rad/s^2, > 0.
    """

    def __init__(self, tool: Tool, target: Pose, acceleration: float, turning: float) -> None:
        self.done = False
        self._tool = tool
        self._target = np.array(target)
        self._acceleration = acceleration
        self._turning = turning
        self._twist: JointVector | None = None

    def step(self, state: JointState, dt: float) -> JointState:
        """Give the state one cycle later; done once the velocity is reached."""
        # Half a cycle ahead, so that the way through the cycle does not bend to one side.
        _, jacobian = self._tool.jacobian(state.q + state.qd * (dt / 2))
        # The commanded velocity, not the joints' own: what the ramp leaves to correct along the
        # line may not delay the correction beside it.
        twist = jacobian @ state.qd if self._twist is None else self._twist
        change = self._target - twist
        share = min(
            1.0,
            self._acceleration * dt / max(float(np.linalg.norm(change[:3])), 1e-12),
            self._turning * dt / max(float(np.linalg.norm(change[3:])), 1e-12),
        )
        self.done = share == 1.0
        if self.done and not self._target.any():
            qd = np.zeros(6)
        else:
            self._twist = self._target if self.done else twist + share * change
            qd = joint_speeds(jacobian, self._twist)
        return JointState(state.q + qd * dt, qd)

    def interrupt(self) -> None:
        """Take the velocity up again from rest."""
        self._twist = None


def joint_speeds(jacobian: Matrix, twist: JointVector) -> JointVector:
    """Give the joint velocities, (6,) rad/s, for a tool velocity; finite in a singularity too."""
    damped = jacobian @ jacobian.T + _DAMPING * np.eye(6)
    speeds: JointVector = jacobian.T @ np.linalg.solve(damped, twist)
    return speeds


def _rotation_vector(rotation: Matrix) -> JointVector:
    placed = np.eye(4)
    placed[:3, :3] = rotation
    return np.array(matrix_to_pose(placed)[3:])
