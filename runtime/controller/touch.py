"""What the tool feels of its surroundings, followed from one control cycle to the next."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from runtime.controller.contact import MOST_FORCE_N, Contact, Thread
from runtime.kinematics import Matrix

END_STIFFNESS_NM_RAD: Final = 8.0
"""The moment of a thread that is tight, or jammed, for each rad turned further."""

MOST_PRESSING_N: Final = 150.0
"""The force at the tool above which the safety system stops the arm."""

PRESSING_S: Final = 0.024
"""For how long it lets more pass, s: a few cycles."""

_LEVEL_M: Final = 1e-6
_WALL: Final = 5.0
"""From this slope on a surface counts as a wall, m/m."""

_MOST_MOMENT: Final = 50.0
_NOTICEABLE_N: Final = 0.1
_STANDING: Final = 1e-6  # rad/s
_NOTHING: Final = np.zeros(6)


@dataclass(frozen=True, slots=True)
class Support:
    """Where and how a surface touches.

    Args:
        normal: (3,) unit vector out of the surface, base frame.
        depth_m: How far the tool is inside, measured along it; negative when it is above.
        stiffness_n_m: Force for each metre of depth.
        lift: How fast the surface moves along the normal for each rad/s about base z, m/rad.
    """

    normal: NDArray[np.float64]
    depth_m: float
    stiffness_n_m: float
    lift: float

    @property
    def force_n(self) -> float:
        """How hard it presses, N."""
        return min(max(self.stiffness_n_m * self.depth_m, 0.0), MOST_FORCE_N)


@dataclass(frozen=True, slots=True)
class Engagement:
    """A thread that the tool turns.

    Args:
        over_rad: How far it has been turned past its end; negative before it.
        friction_nm: The moment that turning takes.
    """

    over_rad: float
    friction_nm: float


class Touch:
    """The sense of touch: the contact, the tool's yaw since it was given, what both press with."""

    def __init__(self) -> None:
        self.wrench: NDArray[np.float64] = _NOTHING
        """(6,) what the contact presses on the tool with, N and Nm, base frame."""
        self.cycles = 0
        """For how many control cycles something has been pressing on the tool."""
        self._contact: Contact | None = None
        self._yaw: float | None = None

    @property
    def contact(self) -> Contact | None:
        """What is near the tool."""
        return self._contact

    def be_near(self, contact: Contact | None, pose: Matrix) -> None:
        """Learn what is near the tool from now on.

        Args:
            contact: That, or None.
            pose: The tool centre point, (4, 4).
        """
        self._contact = contact
        self._yaw = None
        self.follow(pose, 0.0)

    def supports(self, pose: Matrix) -> tuple[tuple[Support, ...], Engagement | None]:
        """Give what touches, or nearly does, and the thread the tool is in."""
        if self._contact is None:
            return (), None
        x, y, z = pose[:3, 3].tolist()
        thread = self._contact.thread
        if thread is not None and thread.is_under(x, y):
            turned = self._turned(thread, pose)
            height = thread.height(turned)
            lift = thread.pitch_m / (2 * math.pi) if 0 < turned < 2 * math.pi * thread.turns else 0
            support = Support(
                np.array([0.0, 0.0, 1.0]), height - z, self._contact.surface.stiffness_n_m, lift
            )
            # Above the thread, by more than play, the tool turns freely.
            engaged = z <= height + thread.pitch_m
            return (support,), (
                Engagement(turned - thread.end_rad, thread.friction_nm) if engaged else None
            )
        patch = self._contact.surface.under(x, y)
        if patch is None:
            return (), None
        slope = math.hypot(patch.slope_x, patch.slope_y)
        # A wall pushes sideways only: it does not carry what leans on it.
        up = 1.0 if slope < _WALL else 0.0
        steepness = math.hypot(up, slope)
        normal = np.array([-patch.slope_x, -patch.slope_y, up]) / steepness
        depth = (patch.height - z) / steepness
        stiffness = self._contact.surface.stiffness_n_m
        side = Support(normal, depth, stiffness, 0.0)
        floor = self._contact.surface.floor(x, y)
        if floor is None or patch.height - floor < _LEVEL_M:
            return (side,), None
        return (side, Support(np.array([0.0, 0.0, 1.0]), floor - z, stiffness, 0.0)), None

    def follow(self, pose: Matrix, dt: float, moment_nm: float | None = None) -> None:
        """Learn where the tool is now.

        Args:
            pose: The tool centre point, (4, 4).
            dt: How long ago it was last followed, s; 0 if it has not moved since.
            moment_nm: What a thread resists with about base z, if whoever moved the tool knows;
                otherwise it follows from how fast the tool turns.
        """
        if self._contact is None:
            self.wrench = _NOTHING
            return
        before = self._yaw
        self._follow_yaw(pose)
        supports, engagement = self.supports(pose)
        wrench = np.zeros(6)
        for support in supports:
            wrench[:3] += support.force_n * support.normal
        if engagement is not None:
            if moment_nm is None:
                turned = 0.0 if before is None or self._yaw is None else self._yaw - before
                turning = abs(turned) > _STANDING * dt
                moment_nm = -math.copysign(engagement.friction_nm, turned) if turning else 0.0
                moment_nm += END_STIFFNESS_NM_RAD * max(engagement.over_rad, 0.0)
            wrench[5] = max(-_MOST_MOMENT, min(_MOST_MOMENT, moment_nm))
        self.wrench = wrench

    def count(self, force_n: float) -> None:
        """Count the cycles of being pressed on, once a cycle.

        Args:
            force_n: What presses on the tool in all.
        """
        self.cycles = self.cycles + 1 if force_n > _NOTICEABLE_N else 0

    def _follow_yaw(self, pose: Matrix) -> None:
        yaw = math.atan2(pose[1, 0], pose[0, 0])
        before = self._yaw
        if before is None:
            thread = None if self._contact is None else self._contact.thread
            before = yaw if thread is None else thread.at_yaw_rad
        self._yaw = before + math.remainder(yaw - before, 2 * math.pi)

    def _turned(self, thread: Thread, pose: Matrix) -> float:
        if self._yaw is None:
            self._follow_yaw(pose)
        assert self._yaw is not None
        return thread.turned_rad + thread.at_yaw_rad - self._yaw


class Pressing:
    """The safety system's limit on the force of the tool.

    A tool that stands deep in something must be able to back out: after a stop, only more force
    than it came to rest with leads to the next.
    """

    def __init__(self) -> None:
        self._over_s = 0.0
        self._excused_n = 0.0

    def too_hard(self, force_n: float, dt: float, *, held: bool) -> str | None:
        """Say what is wrong once the tool has pressed too hard for too long.

        Args:
            force_n: What the contact presses with.
            dt: Cycle, s.
            held: Whether the arm is stopped already.
        """
        if force_n <= MOST_PRESSING_N:
            self._over_s = self._excused_n = 0.0
        elif held:
            self._excused_n = max(self._excused_n, force_n)
        elif force_n > self._excused_n + _NOTICEABLE_N:
            self._over_s += dt
        if self._over_s <= PRESSING_S or held:
            return None
        self._over_s = 0.0
        return f"the tool presses with {force_n:.0f} N, more than {MOST_PRESSING_N:g} N"
