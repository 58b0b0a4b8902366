"""Motions by force on a UR arm: force mode ordered anew with each look at the arm.

Force mode has no target and no end of its own: whoever orders it must watch it. Every look is
also a sign of life for the controller's watchdog, which ends force mode with the program.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Protocol

from runtime.drivers.force import Finish, ForceMotion, Push, Reading
from runtime.errors import DriverError
from runtime.kinematics import Joints, Pose

_KNOCKS = 2  # readings in a row above the force allowed: one may be a knock
_SAMPLES = 5  # of the state stream
_FREE_N = 5.0  # by which it may swing while the arm stands still
_FREE_NM = 1.0
_GREATEST_BIAS_N = 30.0  # a weight that the controller was not told of


class ForceArm(Protocol):
    """What a motion by force needs of an arm."""

    def timestamp_s(self) -> float:
        """Give the controller's clock, s."""

    def joints(self) -> Joints:
        """Give the measured joint angles, rad."""

    def tcp_pose(self) -> Pose:
        """Give the measured tool centre point, m and rad."""

    def wrench(self) -> Pose:
        """Give the measured force and torque on the tool, N and Nm, base frame."""

    def zero_force(self) -> None:
        """Ask the controller to take what it measures now for nothing."""

    def push(self, push: Push, frame: Pose) -> None:
        """Order force mode, or order it anew."""

    def end_push(self) -> None:
        """End force mode and brake."""


class ForceSensor:
    """The arm's measured force, less what it showed when nothing was touched.

    Zeroed twice: controllers without a force sensor estimate the force from the motors' currents,
    and whether they can zero that is not documented.
    """

    def __init__(self, arm: ForceArm) -> None:
        self._arm = arm
        self._bias: Pose = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)

    def zero(self, wait: Callable[[], None]) -> str:
        """Zero it, the arm at rest and the tool free; give the reason if that cannot be.

        Args:
            wait: Lets a moment pass.
        """
        self._arm.zero_force()
        samples: list[Pose] = []
        last_s = self._arm.timestamp_s()
        while len(samples) < _SAMPLES:
            wait()
            if (now_s := self._arm.timestamp_s()) > last_s:
                last_s = now_s
                samples.append(self._arm.wrench())
        x, y, z, rx, ry, rz = (sum(values) / _SAMPLES for values in zip(*samples, strict=True))
        self._bias = (x, y, z, rx, ry, rz)
        swing = [max(values) - min(values) for values in zip(*samples, strict=True)]
        if max(swing[:3]) > _FREE_N or max(swing[3:]) > _FREE_NM:
            return (
                f"the force sensor swings by {max(swing[:3]):.0f} N while the arm stands still; "
                "see that nothing shakes or touches it"
            )
        if math.hypot(*self._bias[:3]) > _GREATEST_BIAS_N:
            return (
                f"the force sensor shows {math.hypot(*self._bias[:3]):.0f} N with nothing touched; "
                "see that payload and centre of gravity are right and no cable pulls"
            )
        return ""

    def read(self) -> Reading:
        """Give what is measured now."""
        x, y, z, rx, ry, rz = (
            felt - zero for felt, zero in zip(self._arm.wrench(), self._bias, strict=True)
        )
        return Reading(
            self._arm.timestamp_s(),
            self._arm.tcp_pose(),
            self._arm.joints()[5],
            (x, y, z, rx, ry, rz),
        )


class Guard:
    """Tells when a moving tool has met more force than it may.

    Args:
        sensor: Zeroed before.
        most_n: The greatest force.
    """

    def __init__(self, sensor: ForceSensor, most_n: float) -> None:
        self._sensor = sensor
        self._most_n = most_n
        self._last_s = -math.inf
        self._knocks = 0

    def trips(self) -> str:
        """Look; give the reason if the tool must stop."""
        reading = self._sensor.read()
        if reading.time_s > self._last_s:
            self._last_s = reading.time_s
            self._knocks = self._knocks + 1 if reading.force_n > self._most_n else 0
        if self._knocks < _KNOCKS:
            return ""
        return (
            f"on its way down the tool met {reading.force_n:.0f} N, more than the "
            f"{self._most_n:g} N allowed"
        )


def carry_out(
    motion: ForceMotion, arm: ForceArm, sensor: ForceSensor, wait: Callable[[], None]
) -> Finish:
    """Carry a motion by force out; the arm brakes at its end, whatever that is.

    Args:
        motion: Says what to do.
        arm: Does it.
        sensor: Zeroed before.
        wait: Lets a moment pass, in which the arm is watched; raises what calls the motion off.

    Returns:
        How it ended.
    """
    x, y, z = arm.tcp_pose()[:3]
    frame = (x, y, z, 0.0, 0.0, 0.0)
    last_s = -math.inf
    try:
        while True:
            reading = sensor.read()
            if reading.time_s > last_s:
                last_s = reading.time_s
                told = motion.next(reading)
                if isinstance(told, Finish):
                    break
                arm.push(told, frame)
            wait()
    except DriverError:
        raise  # the arm no longer listens; its watchdog ends force mode with the program
    except BaseException:
        arm.end_push()
        raise
    arm.end_push()
    return told
