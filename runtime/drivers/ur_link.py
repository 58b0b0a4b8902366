"""What passes between a UR driver and the process that holds its connection to the robot.

Orders and reports go through a pipe; they are few. The state goes through shared memory, where the
newest one simply replaces the last, so that a driver that is not asked for a while neither blocks
the process nor reads old news afterwards.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from multiprocessing.sharedctypes import RawArray
from typing import Final, TypeAlias

from runtime.drivers.driver import ArmState
from runtime.drivers.steps import ArmStep, Felt

_READS: Final = 1000  # a reader meets a writer at work once in a while, never so often in a row


@dataclass(frozen=True, slots=True)
class Begin:
    """Order: carry a step out, and report under this number how it ended."""

    number: int
    step: ArmStep


@dataclass(frozen=True, slots=True)
class Stop:
    """Order: bring the arm to a standstill; a step under way ends unreported."""


@dataclass(frozen=True, slots=True)
class Close:
    """Order: stop the arm, end the program on the controller, and exit."""


@dataclass(frozen=True, slots=True)
class Ready:
    """Report: the connection stands, states are being published; `done` says what was released."""

    version: str
    done: str = ""


@dataclass(frozen=True, slots=True)
class Ended:
    """Report: a step has ended; `reason` is empty if it succeeded."""

    number: int
    reason: str
    felt: Felt | None = None


@dataclass(frozen=True, slots=True)
class Lost:
    """Report: the arm can no longer be driven through this connection; the process ends."""

    reason: str


Order: TypeAlias = Begin | Stop | Close
Report: TypeAlias = Ready | Ended | Lost


@dataclass(frozen=True, slots=True)
class Published:
    """A state, with what the driver needs to know beside it.

    Args:
        arm: The state.
        moving: Whether the arm moves, or an order to move is being carried out.
        at_s: When it was published, on this machine's monotonic clock, s.
    """

    arm: ArmState
    moving: bool
    at_s: float


class Silence:
    """Counts how long there has been no news, as far as this process can tell.

    Time in which this process itself did not run, because the machine was busy, says nothing about
    the other side: between two looks no more than a blink is counted.

    Args:
        blink_s: The most that is counted between two looks, s.
    """

    def __init__(self, blink_s: float) -> None:
        self._blink_s = blink_s
        self._news: float | None = None
        self._looked_at_s = 0.0
        self._silent_s = 0.0

    def since(self, news: float, now_s: float) -> float:
        """Give the time without news, s.

        Args:
            news: The other side's time stamp, seen now.
            now_s: This side's monotonic clock.
        """
        if news != self._news:
            self._news, self._silent_s = news, 0.0
        else:
            self._silent_s += min(now_s - self._looked_at_s, self._blink_s)
        self._looked_at_s = now_s
        return self._silent_s


class Lull:
    """Remembers the last long time in which no news came in, for whatever reason.

    Unlike `Silence` it counts as the controller's watchdog does: that this process did not run is
    no excuse.

    Args:
        least_s: The shortest time worth remembering, s.
    """

    def __init__(self, least_s: float) -> None:
        self._least_s = least_s
        self._news: float | None = None
        self._since_s = 0.0
        self._lull: tuple[float, float] | None = None

    def note(self, news: float, now_s: float) -> None:
        """Take note of the other side's time stamp, seen now."""
        if news == self._news:
            return
        lasted = now_s - self._since_s
        if self._news is not None and lasted >= self._least_s:
            self._lull = (lasted, now_s)
        self._news, self._since_s = news, now_s

    def lately(self, now_s: float) -> float:
        """Give how long the last one was if it ended within as long again; 0 s otherwise."""
        if self._lull is None:
            return 0.0
        lasted, ended_s = self._lull
        return lasted if now_s - ended_s <= lasted else 0.0


class StateBoard:
    """One state in shared memory, written by one process and read by another without a lock.

    A lock would be kept for ever by a process killed while it holds it. Instead the number of the
    writing stands at both ends: they differ while a writing is under way, and the reader tries
    again.
    """

    _FIELDS: Final = 18

    def __init__(self) -> None:
        self._cells = RawArray("d", self._FIELDS + 2)

    def write(self, arm: ArmState, *, moving: bool) -> None:
        """Publish a state."""
        number = self._cells[0] + 1
        self._cells[0] = number
        self._cells[1 : 1 + self._FIELDS] = [
            *arm.joints,
            *arm.tcp_pose,
            float(arm.gripper_closed),
            float(arm.gripped),
            arm.timestamp_s,
            arm.force_n,
            float(moving),
            time.monotonic(),
        ]
        self._cells[-1] = number

    def read(self) -> Published | None:
        """Give the state published last, or None if there is none yet."""
        for _ in range(_READS):
            last = self._cells[-1]
            values = self._cells[1 : 1 + self._FIELDS]
            if self._cells[0] == last:
                break
            time.sleep(0.0001)
        else:
            return None
        if last == 0:
            return None
        a, b, c, d, e, f, x, y, z, rx, ry, rz, closed, gripped, timestamp, force, moving, at = (
            values
        )
        arm = ArmState(
            (a, b, c, d, e, f), (x, y, z, rx, ry, rz), closed > 0, gripped > 0, timestamp, force
        )
        return Published(arm, moving > 0, at)
