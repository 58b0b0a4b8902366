"""What a motion by force is told and what it says: readings in, pushes out, until it has ended.

The controllers of these motions are plain state machines, `runtime.drivers.pressing` and
`runtime.drivers.turning`: no arm and no clock of their own. All forces are in the base frame and
taken at the tool centre point; a force is positive when it presses on the tool that way.
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass
from typing import Final, Protocol, TypeAlias

from runtime.config import RobotConfig
from runtime.drivers.limits import MotionError, check_place
from runtime.drivers.steps import Felt
from runtime.kinematics import Pose

Axes: TypeAlias = tuple[bool, bool, bool, bool, bool, bool]
"""Along x, y, z and about x, y, z."""

BOX_SLACK_M: Final = 0.005
"""By how much a tool that yields to a force may leave its box, m."""

_SPRING_N_M: Final = 2000.0
_YIELDS_M_S_N: Final = 0.004  # how fast force mode goes for each N, roughly
_TOO_MUCH: Final = 2  # readings in a row above the greatest force: one may be a knock
_STANDS_WITHIN_M: Final = 0.0003
_STANDS_FOR_S: Final = 0.25
_READINGS: Final = 4  # at least, before it counts as standing
_GAPS: Final = 32
_BLINK_S: Final = 0.25  # the most that counts between two readings
_HORIZON_S: Final = 0.25
_THERE_M: Final = 1e-9
_SOONEST_S: Final = 0.001


@dataclass(frozen=True, slots=True)
class Reading:
    """What the arm measures at one moment.

    Args:
        time_s: The controller's clock.
        pose: The tool centre point, m and rad.
        wrist_rad: Wrist 3.
        wrench: What presses on the tool since the sensor was zeroed, N and Nm.
    """

    time_s: float
    pose: Pose
    wrist_rad: float
    wrench: Pose

    @property
    def press_n(self) -> float:
        """How hard the tool presses downward."""
        return self.wrench[2]

    @property
    def force_n(self) -> float:
        """The whole force on the tool."""
        return math.hypot(*self.wrench[:3])


@dataclass(frozen=True, slots=True)
class Push:
    """What the arm is to do until the next reading.

    Args:
        compliant: Where the tool yields.
        wrench: What it pushes with there, N and Nm.
        speeds: How fast it may yield there, m/s and rad/s.
    """

    compliant: Axes
    wrench: Pose
    speeds: Pose


@dataclass(frozen=True, slots=True)
class Finish:
    """The end of a motion by force.

    Args:
        reason: Why it failed; empty if it did not.
        felt: What was measured.
    """

    reason: str
    felt: Felt


class ForceMotion(Protocol):
    """A motion by force: asked once for each reading."""

    def next(self, reading: Reading) -> Push | Finish:
        """Say what to do now, or that it has ended."""


class Watch:
    """What every motion by force keeps an eye on.

    Args:
        config: The robot and its limits.
        place: x and y from which the tool may not be drawn far away, m.
        stray_m: How far.
        within_s: Longest time it may take, s of the controller's clock.
    """

    def __init__(
        self, config: RobotConfig, place: tuple[float, float], stray_m: float, within_s: float
    ) -> None:
        self._config = config
        self._place = place
        self._stray_m = stray_m
        self._within_s = within_s
        self._last_s: float | None = None
        self._elapsed_s = 0.0
        self._too_much = 0
        self._gaps: deque[float] = deque(maxlen=_GAPS)
        self._heights: deque[tuple[float, float]] = deque()
        self.greatest_n = 0.0

    @property
    def elapsed_s(self) -> float:
        """How long it has taken so far, leaving out what this machine has slept through."""
        return self._elapsed_s

    @property
    def gap_s(self) -> float:
        """The longest of the last times between two readings."""
        return max(self._gaps, default=0.0)

    @property
    def horizon_s(self) -> float:
        """For how long what is ordered now may have to last."""
        return max(_HORIZON_S, 4 * self.gap_s)

    @property
    def step_s(self) -> float:
        """The time since the last reading, leaving out what this machine has slept through."""
        return min(self._gaps[-1], _BLINK_S) if self._gaps else 0.0

    def note(self, reading: Reading) -> str:
        """Take note of a reading; give the reason if the motion must end."""
        if self._last_s is not None:
            self._gaps.append(reading.time_s - self._last_s)
            self._elapsed_s += min(self._gaps[-1], _BLINK_S)
        self._last_s = reading.time_s
        self._heights.append((reading.time_s, reading.pose[2]))
        while (
            len(self._heights) > _READINGS and self._heights[1][0] <= reading.time_s - _STANDS_FOR_S
        ):
            self._heights.popleft()
        return self._trouble(reading)

    def stands(self) -> bool:
        """Tell whether the tool has kept its height for a while."""
        if len(self._heights) < _READINGS:
            return False
        if self._heights[-1][0] - self._heights[0][0] < _STANDS_FOR_S:
            return False
        heights = [height for _, height in self._heights]
        return max(heights) - min(heights) <= _STANDS_WITHIN_M

    def forget_heights(self) -> None:
        """Judge anew from now on whether the tool stands."""
        self._heights.clear()

    def drawn(
        self, reading: Reading, place: tuple[float, float], most_n: float
    ) -> tuple[float, float]:
        """Give the sideways force that draws the tool to a place, N."""
        dx, dy = place[0] - reading.pose[0], place[1] - reading.pose[1]
        distance = math.hypot(dx, dy)
        if distance < _THERE_M:
            return 0.0, 0.0
        # The longer an order has to last, the softer it must be, or the tool swings.
        spring = min(_SPRING_N_M, 0.5 / (_YIELDS_M_S_N * max(self.gap_s, _SOONEST_S)))
        force = min(most_n, spring * distance)
        return force * dx / distance, force * dy / distance

    def _trouble(self, reading: Reading) -> str:
        force = self._config.force
        self.greatest_n = max(self.greatest_n, reading.force_n)
        self._too_much = self._too_much + 1 if reading.force_n > force.most_n else 0
        if self._too_much >= _TOO_MUCH:
            return f"it met {reading.force_n:.0f} N, more than the {force.most_n:g} N allowed"
        x, y, z = reading.pose[:3]
        strayed = math.dist((x, y), self._place)
        if strayed > self._stray_m:
            return f"the tool was pushed {strayed * 1000:.1f} mm aside"
        try:
            check_place(self._config, (x, y, z), slack=BOX_SLACK_M)
        except MotionError as error:
            return str(error)
        if self.elapsed_s > self._within_s:
            return f"it took more than {self._within_s:g} s"
        return ""
