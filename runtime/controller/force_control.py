"""Force mode: the tool as a mass that forces push about, in the axes that are to yield.

Each control cycle solves for the velocity at its end with the contact's spring and the thread's
friction at the end of the cycle as well (backward Euler). So it comes to rest where the forces
balance, at any stiffness and cycle time: an explicit step would bounce.

The virtual mass and damping are plausible, not measured: real force dynamics are not imitated.
Source: Universal Robots, "The URScript Programming Language", `force_mode`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from runtime.controller.touch import END_STIFFNESS_NM_RAD, Engagement, Support
from runtime.kinematics import Matrix, Pose, matrix_to_pose, pose_to_matrix

Twist: TypeAlias = NDArray[np.float64]  # (6,) linear then angular, or force then moment

DEFAULT_DAMPING: Final = 0.005
"""`force_mode_set_damping`: what holds until a program sets another."""

DEFAULT_GAIN: Final = 1.0
"""`force_mode_set_gain_scaling`: what holds until a program sets another."""

_INERTIA: Final = np.array([5.0] * 3 + [0.05] * 3)  # kg, kg m^2
_DAMPING_PER_S: Final = 2000.0  # at full damping; at the default one a push fades within 0.1 s
_CORRECTION: Final = 0.2  # of the deviation from the programmed path, each cycle
_FASTEST_CORRECTION: Final = 0.05  # m/s and rad/s
_STANDING: Final = np.array([1e-6] * 3 + [1e-5] * 3)
_MUCH_TURNED: Final = 1.0 + 2.0 * math.cos(0.5)  # the trace of a rotation by half a rad
_NO_DIRECTION: Final = 1e-6
_BASE_Z: Final = 5


@dataclass(frozen=True, slots=True)
class ForceMode:
    """What `force_mode` asks for.

    Args:
        frame: The task frame in the base frame.
        compliant: For each axis of it, whether the tool yields along or about it.
        wrench: What the tool should press with, N and Nm in the task frame.
        limits: The greatest speed along each compliant axis, m/s and rad/s.
        kind: How the task frame is meant: 1 with its y axis from the tool towards its origin,
            2 as it is, 3 with its x axis along the tool's velocity in its own x-y plane.
        damping: 0 keeps the speed where no force acts, 1 loses it at once.
        gain: Scales the force error.
    """

    frame: Pose
    compliant: tuple[bool, ...]
    wrench: Pose
    limits: Pose
    kind: int = 2
    damping: float = DEFAULT_DAMPING
    gain: float = DEFAULT_GAIN


class ForceController:
    """One stretch of force mode, from its beginning to its end or to another `force_mode`.

    Args:
        mode: What is asked for.
    """

    def __init__(self, mode: ForceMode) -> None:
        self.mode: Final = mode
        self._frame = pose_to_matrix(mode.frame)
        self._turn = _doubled(self._frame[:3, :3])
        self._compliant = np.array(mode.compliant)
        self._wrench = np.array(mode.wrench)
        self._limits = np.abs(np.array(mode.limits))

    def velocity(
        self,
        pose: Matrix,
        twist: Twist,
        programmed: tuple[Matrix, Twist],
        external: Twist,
        touching: tuple[tuple[Support, ...], Engagement | None],
        dt: float,
    ) -> tuple[Twist, float | None]:
        """Give the tool's velocity at the end of a cycle.

        Args:
            pose: The tool now, (4, 4).
            twist: Its velocity now.
            programmed: Where the program's path leads in this cycle, (4, 4), and the velocity
                of it, (6,): what the axes follow that do not yield.
            external: What acts on the tool beside the contact, base frame.
            touching: The contact.
            dt: Cycle, s.

        Returns:
            The velocity in the base frame, and the moment that a thread resists with, if the
            tool is in one and may turn.
        """
        turn = self._task_axes(pose, twist)
        gain = dt * self.mode.gain / _INERTIA
        fading = 1.0 / (1.0 + dt * _DAMPING_PER_S * self.mode.damping)
        pushed = (turn.T @ twist + gain * (self._wrench + turn.T @ external)) * fading
        followed = turn.T @ (programmed[1] + _way_back(pose, *programmed, dt))
        # The greatest speeds bound what is left once the contact has pushed back, not the force.
        free = np.where(self._compliant, pushed, followed)
        velocity: Twist = turn @ free
        mobility = (turn * np.where(self._compliant, gain * fading, 0.0)) @ turn.T
        supports, engagement = touching
        moment = None
        if engagement is not None and mobility[_BASE_Z, _BASE_Z] > 0:
            velocity, moment = _resist(velocity, mobility, engagement, dt)
        for support in supports:
            velocity = _press(velocity, mobility, support, dt)
        bounded = turn.T @ velocity
        velocity = turn @ np.where(self._compliant, self._within(bounded), bounded)
        if bool(np.all(np.abs(velocity) < _STANDING)):
            velocity = np.zeros(6)  # it would creep on for ever
        return velocity, moment

    def has_turned(self, pose: Matrix, programmed: Matrix) -> bool:
        """Whether yielding has turned the tool so far that the programmed way no longer fits."""
        turns = bool(self._compliant[3:].any())
        return turns and float(np.trace(pose[:3, :3].T @ programmed[:3, :3])) < _MUCH_TURNED

    def _within(self, velocity: Twist) -> Twist:
        within: Twist = np.clip(velocity, -self._limits, self._limits)
        return within

    def _task_axes(self, pose: Matrix, twist: Twist) -> Matrix:
        """Give the axes of the task frame in the base frame, (6, 6), as its kind says."""
        match self.mode.kind:
            case 1:
                turned = _frame_towards(self._frame[:3, :3], self._frame[:3, 3] - pose[:3, 3])
            case 3:
                turned = _frame_along(self._frame[:3, :3], twist[:3])
            case _:
                return self._turn
        return _doubled(turned)


def deviation(pose: Matrix, programmed: Matrix) -> Twist:
    """Give how far a pose is from the programmed one, (6,) m and rad, base frame."""
    away = np.eye(4)
    away[:3, :3] = programmed[:3, :3] @ pose[:3, :3].T
    offset: Twist = np.concatenate((programmed[:3, 3] - pose[:3, 3], matrix_to_pose(away)[3:]))
    return offset


def _doubled(axes: Matrix) -> Matrix:
    """Give the (6, 6) that turns forces and moments, or both velocities, by a (3, 3)."""
    both: Matrix = np.zeros((6, 6))
    both[:3, :3] = both[3:, 3:] = axes
    return both


def _way_back(pose: Matrix, programmed: Matrix, path: Twist, dt: float) -> Twist:
    """Give the velocity that leads back to the programmed path: rounding adds up."""
    offset = deviation(pose, programmed) - dt * path
    back: Twist = np.clip(offset * (_CORRECTION / dt), -_FASTEST_CORRECTION, _FASTEST_CORRECTION)
    return back


def _press(velocity: Twist, mobility: Matrix, support: Support, dt: float) -> Twist:
    """Let a surface push back: a spring, and as much damping as it takes not to bounce."""
    normal = np.concatenate((support.normal, np.zeros(3)))
    yielding = mobility @ normal
    ease = float(normal @ yielding)
    closing = support.lift * float(velocity[_BASE_Z]) - float(normal @ velocity)
    push = _spring(support.stiffness_n_m, support.depth_m, closing, ease, dt)
    return velocity + yielding * push


def _resist(
    velocity: Twist, mobility: Matrix, thread: Engagement, dt: float
) -> tuple[Twist, float]:
    """Let a thread resist: a stiff end, and dry friction that holds or slips."""
    ease = float(mobility[_BASE_Z, _BASE_Z])
    spin = float(velocity[_BASE_Z])
    stop = _spring(END_STIFFNESS_NM_RAD, thread.over_rad, -spin, ease, dt)
    spin += ease * stop
    friction = max(-thread.friction_nm, min(thread.friction_nm, -spin / ease))
    return velocity + mobility[:, _BASE_Z] * (stop + friction), stop + friction


def _spring(stiffness: float, depth: float, closing: float, ease: float, dt: float) -> float:
    """Give what a one-sided spring presses with at the end of a cycle.

    Args:
        stiffness: N/m, or Nm/rad.
        depth: How far it is pressed in now, m or rad; negative before it touches.
        closing: How fast it would be pressed in if it did not press back, m/s or rad/s.
        ease: How much that speed changes in the cycle for each N or Nm.
        dt: Cycle, s.
    """
    if depth + dt * closing <= 0:
        return 0.0
    # As much damping as it takes not to bounce, for the mass that `ease` stands for.
    damper = 2.0 * math.sqrt(stiffness * dt / ease) if ease > 0 and depth > 0 else 0.0
    push = stiffness * (depth + dt * closing) + damper * closing
    return max(0.0, push / (1.0 + (stiffness * dt + damper) * ease))


def _frame_towards(axes: Matrix, towards: Twist) -> Matrix:
    """Turn axes, (3, 3), so that y points along a vector, and z as it did as far as it can."""
    length = float(np.linalg.norm(towards))
    x = np.cross(towards, axes[:, 2])
    if length < _NO_DIRECTION or float(np.linalg.norm(x)) < _NO_DIRECTION * length:
        return axes
    x, y = x / np.linalg.norm(x), towards / length
    turned: Matrix = np.column_stack((x, y, np.cross(x, y)))
    return turned


def _frame_along(axes: Matrix, velocity: Twist) -> Matrix:
    """Turn axes, (3, 3), about their z so that x points along a velocity."""
    z = axes[:, 2]
    x = velocity - z * float(z @ velocity)
    length = float(np.linalg.norm(x))
    if length < _NO_DIRECTION:
        return axes
    x = x / length
    turned: Matrix = np.column_stack((x, np.cross(z, x), z))
    return turned
