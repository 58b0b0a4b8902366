"""Motions in joint space. A motion is stepped once a control cycle until it is done.

All start from whatever speed the arm has: none makes the joint speeds jump.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final, Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

from runtime.controller.profile import Trapezoid
from runtime.kinematics import Joints

JointVector: TypeAlias = NDArray[np.float64]  # (6,)

MAX_JOINT_SPEED: Final = math.pi
"""No joint turns faster, rad/s (UR5 data sheet: 180 degrees/s)."""

MAX_JOINT_ACCELERATION: Final = 40.0
"""The greatest joint acceleration a program may ask for, rad/s^2."""

_RESTING: Final = 1e-9


@dataclass(frozen=True, slots=True)
class JointState:
    """Where the joints are and how fast they turn.

    Args:
        q: (6,) rad.
        qd: (6,) rad/s.
    """

    q: JointVector
    qd: JointVector


class MotionError(Exception):
    """The arm cannot follow; the text says why. It leads to a protective stop."""


class Motion(Protocol):
    """What moves the arm."""

    done: bool

    def step(self, state: JointState, dt: float) -> JointState:
        """Give the state one cycle of `dt` seconds later. Raises MotionError."""

    def interrupt(self) -> None:
        """Learn that the arm was stopped on the way: plan anew at the next step."""


def approach(state: JointState, target_qd: JointVector, most: float, dt: float) -> JointState:
    """Bring the joint speeds nearer to a target, all in proportion.

    Args:
        state: From where.
        target_qd: (6,) rad/s.
        most: Acceleration of the leading joint, rad/s^2.
        dt: Cycle, s.
    """
    change = target_qd - state.qd
    leading = float(np.abs(change).max())
    # A remainder of rounding is not worth another cycle.
    share = 1.0 if leading <= most * dt * (1 + 1e-9) else most * dt / leading
    qd = target_qd if share == 1.0 else state.qd + share * change
    return JointState(state.q + (state.qd + qd) * (dt / 2), qd)


def is_resting(qd: JointVector) -> bool:
    """Whether no joint turns."""
    return float(np.abs(qd).max()) <= _RESTING


class JointMove:
    """`movej`: all joints start and arrive together, the leading one within the limits.

    Args:
        target: Where to, rad.
        acceleration: Of the leading joint, rad/s^2, > 0.
        speed: Of the leading joint, rad/s, > 0.
        duration_s: If > 0, how long the way takes; the limits then do not count.
    """

    def __init__(
        self, target: Joints, acceleration: float, speed: float, duration_s: float = 0.0
    ) -> None:
        self.done = False
        self._target: JointVector = np.array(target)
        self._acceleration = min(acceleration, MAX_JOINT_ACCELERATION)
        self._speed = min(speed, MAX_JOINT_SPEED)
        self._duration_s = duration_s
        self._start: JointVector | None = None
        self._way = Trapezoid.limited(0.0, 1.0, 1.0)
        self._at_s = 0.0

    def step(self, state: JointState, dt: float) -> JointState:
        """Give the state one cycle later; the very target in the last."""
        if self._start is None:
            if not is_resting(state.qd):
                return approach(state, np.zeros(6), self._acceleration, dt)
            self._plan(state.q)
        assert self._start is not None
        self._at_s += dt
        if self._at_s >= self._way.duration_s:
            self.done = True
            return JointState(self._target.copy(), np.zeros(6))
        direction = (self._target - self._start) / self._way.length
        return JointState(
            self._start + direction * self._way.position(self._at_s),
            direction * self._way.speed(self._at_s),
        )

    def interrupt(self) -> None:
        """Plan anew from where the arm was stopped."""
        self._start = None

    def _plan(self, start: JointVector) -> None:
        self._start = start.copy()
        self._at_s = 0.0
        length = float(np.abs(self._target - start).max())
        if self._duration_s > 0 and length > 0:
            self._way = Trapezoid.timed(length, self._duration_s)
        else:
            self._way = Trapezoid.limited(length, self._speed, self._acceleration)


class JointSpeed:
    """`speedj`, and `stopj` with a target of zero: reach a joint velocity and hold it.

    Args:
        target_qd: Joint velocity, rad/s.
        acceleration: Of the leading joint, rad/s^2, > 0.
    """

    def __init__(self, target_qd: Joints, acceleration: float) -> None:
        self.done = False
        self._target: JointVector = np.array(target_qd)
        self._acceleration = min(acceleration, MAX_JOINT_ACCELERATION)

    def step(self, state: JointState, dt: float) -> JointState:
        """Give the state one cycle later; done once the velocity is reached."""
        after = approach(state, self._target, self._acceleration, dt)
        self.done = bool(np.array_equal(after.qd, self._target))
        return after

    def interrupt(self) -> None:
        """Nothing is planned ahead: the velocity is taken up again from rest."""


class JointServo:
    """`servoj`: follow a joint target that the program renews every few milliseconds.

    An exponential approach with the look-ahead time as its constant, within the speed and
    acceleration limits: real servo dynamics and the gain are not imitated.

    Args:
        target: Where to, rad.
        lookahead_s: Time constant, s, > 0.
    """

    def __init__(self, target: Joints, lookahead_s: float) -> None:
        self.done = False
        self._target: JointVector = np.array(target)
        self._lookahead_s = lookahead_s

    def step(self, state: JointState, dt: float) -> JointState:
        """Give the state one cycle later. It never ends by itself: the program renews it."""
        error = self._target - state.q
        most = MAX_JOINT_ACCELERATION
        # No faster than can still be braked before the target.
        within = np.minimum(np.abs(error) / max(self._lookahead_s, dt), np.sqrt(most * abs(error)))
        wanted = np.sign(error) * np.minimum(within, MAX_JOINT_SPEED)
        return approach(state, wanted, most, dt)

    def interrupt(self) -> None:
        """Nothing is planned ahead."""
