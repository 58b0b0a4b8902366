"""Safety mode, robot mode and program state, with the rules of passing from one to another.

Sources: Universal Robots, "RTDE Guide" (the bit fields) and "Dashboard Server" (what is refused
when, the five seconds after a protective stop among it).
"""

from __future__ import annotations

from enum import IntEnum
from typing import Final

UNLOCK_AFTER_S: Final = 5.0
"""A protective stop cannot be unlocked sooner than this after it occurred, robot time."""


BOOTING_S: Final = 1.0
"""How long powering the arm takes, and releasing its brakes again as long, robot time. A real one
takes some seconds."""


class SafetyMode(IntEnum):
    """The state stream's `safety_mode`, as far as the stand-in knows it."""

    NORMAL = 1
    PROTECTIVE_STOP = 3
    ROBOT_EMERGENCY_STOP = 7


class RobotMode(IntEnum):
    """The state stream's `robot_mode`, as far as the stand-in knows it."""

    POWER_OFF = 3
    POWER_ON = 4
    IDLE = 5
    RUNNING = 7


class RuntimeState(IntEnum):
    """The state stream's `runtime_state`: what the program is doing."""

    STOPPED = 1
    PLAYING = 2
    PAUSED = 4


_SAFETY_BITS: Final = {
    SafetyMode.NORMAL: 1 << 0,
    # protective stop; stopped due to safety
    SafetyMode.PROTECTIVE_STOP: 1 << 2 | 1 << 10,
    # robot emergency stop; any emergency stop; stopped due to safety
    SafetyMode.ROBOT_EMERGENCY_STOP: 1 << 6 | 1 << 7 | 1 << 10,
}


class Safety:
    """The safety system: it knows why the arm may not move."""

    __slots__ = ("_goal", "_ready_at_s", "_stopped_at_s", "mode", "reason", "robot_mode")

    def __init__(self) -> None:
        self.mode = SafetyMode.NORMAL
        self.robot_mode = RobotMode.RUNNING
        self.reason = ""
        self._stopped_at_s = 0.0
        self._goal = RobotMode.RUNNING
        self._ready_at_s = 0.0

    @property
    def may_move(self) -> bool:
        """Whether the arm is powered, released and not stopped."""
        return self.mode is SafetyMode.NORMAL and self.robot_mode is RobotMode.RUNNING

    @property
    def status_bits(self) -> int:
        """The state stream's `safety_status_bits`."""
        return _SAFETY_BITS[self.mode]

    def protective_stop(self, now_s: float, reason: str) -> bool:
        """Stop the arm for protection; False when something already holds it."""
        if not self.may_move:
            return False
        self.mode = SafetyMode.PROTECTIVE_STOP
        self.reason = reason
        self._stopped_at_s = now_s
        return True

    def unlock_refusal(self, now_s: float) -> str | None:
        """Unlock a protective stop; None when done, else the controller's refusal."""
        if self.mode is SafetyMode.ROBOT_EMERGENCY_STOP:
            return "Cannot unlock protective stop: the emergency stop is pressed"
        if self.mode is SafetyMode.PROTECTIVE_STOP:
            if now_s - self._stopped_at_s < UNLOCK_AFTER_S:
                return (
                    "Cannot unlock protective stop until 5s after occurrence. "
                    "Always inspect cause of protective stop before unlocking"
                )
            self.mode = SafetyMode.NORMAL
            self.reason = ""
        return None

    def emergency_stop(self) -> None:
        """Press the emergency stop: power goes, the brakes close."""
        self.mode = SafetyMode.ROBOT_EMERGENCY_STOP
        self.power_off()
        self.reason = "the emergency stop was pressed"

    def release_emergency_stop(self) -> bool:
        """Pull the emergency stop out again; the arm stays without power. False if it was out."""
        if self.mode is not SafetyMode.ROBOT_EMERGENCY_STOP:
            return False
        self.mode = SafetyMode.NORMAL
        self.reason = ""
        return True

    def power_on(self, now_s: float) -> bool:
        """Begin to power the arm; False while the emergency stop is pressed."""
        return self._begin(RobotMode.IDLE, now_s)

    def release_brakes(self, now_s: float) -> bool:
        """Begin to power the arm, if need be, and to release its brakes; as `power_on`."""
        return self._begin(RobotMode.RUNNING, now_s)

    def power_off(self) -> None:
        """Take the power away."""
        self.robot_mode = self._goal = RobotMode.POWER_OFF

    def step(self, now_s: float) -> bool:
        """Go on with powering up; True in the cycle in which the brakes are released."""
        if self.robot_mode >= self._goal or now_s < self._ready_at_s:
            return False
        if self.robot_mode is RobotMode.POWER_ON:
            self.robot_mode = RobotMode.IDLE
            self._ready_at_s = now_s + BOOTING_S
            return False
        self.robot_mode = RobotMode.RUNNING
        return True

    def _begin(self, goal: RobotMode, now_s: float) -> bool:
        if self.mode is SafetyMode.ROBOT_EMERGENCY_STOP:
            return False
        if self.robot_mode is RobotMode.POWER_OFF:
            self.robot_mode = RobotMode.POWER_ON
            self._ready_at_s = now_s + BOOTING_S
        elif self.robot_mode is RobotMode.IDLE and self._goal is RobotMode.IDLE:
            self._ready_at_s = now_s + BOOTING_S
        self._goal = max(self._goal, goal)
        return True
