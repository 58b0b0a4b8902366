"""Driving a screw: the wrist turns with limited torque, the tool follows the thread.

The tool presses lightly downward and yields in height, so that the thread sets the pace; sideways
it is drawn to where it began. It stops when the torque stops it, when it has turned as far as
asked, or when wrist 3 comes to the end of its range: the hand then opens, turns back, and takes
hold again, which is for whoever plans.
"""

from __future__ import annotations

import math
from collections import deque
from typing import Final

from runtime.config import RobotConfig
from runtime.drivers.force import Axes, Finish, Push, Reading, Watch
from runtime.drivers.steps import Felt, Turn

_AXES: Final[Axes] = (True, True, True, False, False, True)
_TILT_RAD: Final = 0.17
_SIDEWAYS_M_S: Final = 0.01
_STRAY_M: Final = 0.006
_LEAVES_M: Final = 0.005  # more height than the thread explains
_DONE_RAD: Final = 0.03
_SLOWEST_RAD_S: Final = 0.05
_STALL_S: Final = 0.6  # of turning this much less than it could, of which
_COUNTED_S: Final = 0.15  # counts between two readings: an order takes its time to arrive
_STALL_SHARE: Final = 0.15
_READINGS: Final = 5


class Turning:
    """Carries a `Turn` out, as a `ForceMotion`.

    Args:
        step: What to do.
        config: The robot and its limits.
        patience: By how much more time it may take: the speed slider is turned down.
    """

    def __init__(self, step: Turn, config: RobotConfig, patience: float = 1.0) -> None:
        self._step = step
        self._config = config
        self._patience = patience
        # Looking down, wrist 3 turns clockwise as seen from above when its angle grows.
        self._sense = 1.0 if step.clockwise else -1.0
        self._first: Reading | None = None
        self._watch: Watch | None = None
        self._speed = 0.0
        self._window: deque[tuple[float, float, float]] = deque()  # time, wrist, could have turned
        self._counted_s = 0.0
        self._could = 0.0
        self._greatest_nm = 0.0

    def next(self, reading: Reading) -> Push | Finish:
        """Say what to do now, or that it has ended."""
        first, watch = self._begin(reading)
        trouble = watch.note(reading) or self._off_the_thread(reading, first)
        counted_s = min(watch.step_s, _COUNTED_S)
        self._counted_s += counted_s
        self._could += self._speed * counted_s
        self._greatest_nm = max(self._greatest_nm, abs(reading.wrench[5]))
        turned = self._turned(reading, first)
        if trouble:
            return Finish(f"{trouble} after {_turns(turned)}", self._felt(reading, first))
        left = min(
            self._sense * (self._step.wrist_until_rad - reading.wrist_rad),
            self._step.most_rad - turned,
        )
        if left <= _DONE_RAD:
            return Finish("", self._felt(reading, first))
        if self._stalls(reading):
            return Finish("", self._felt(reading, first, stalled=True))
        force = self._config.force
        self._speed = max(_SLOWEST_RAD_S, min(force.turning_speed, left / watch.horizon_s))
        aside = watch.drawn(reading, (first.pose[0], first.pose[1]), force.search_n)
        return Push(
            _AXES,
            (*aside, -self._step.press_n, 0.0, 0.0, -self._sense * self._step.torque_nm),
            (
                _SIDEWAYS_M_S,
                _SIDEWAYS_M_S,
                force.descent_speed,
                _TILT_RAD,
                _TILT_RAD,
                self._speed,
            ),
        )

    def _begin(self, reading: Reading) -> tuple[Reading, Watch]:
        if self._first is None or self._watch is None:
            self._first = reading
            place = (reading.pose[0], reading.pose[1])
            within_s = self._config.force.turn_time_s * self._patience
            self._watch = Watch(self._config, place, _STRAY_M, within_s)
        return self._first, self._watch

    def _off_the_thread(self, reading: Reading, first: Reading) -> str:
        """Say so if the tool has come down or up by more than the thread explains."""
        turned = self._sense * self._turned(reading, first)
        expected = first.pose[2] - self._step.pitch_m * turned / (2 * math.pi)
        off = reading.pose[2] - expected
        if abs(off) <= _LEAVES_M:
            return ""
        return f"it came {abs(off) * 1000:.1f} mm {'up' if off > 0 else 'down'} beside its thread"

    def _turned(self, reading: Reading, first: Reading) -> float:
        """Give how far it has turned its way, rad."""
        return self._sense * (reading.wrist_rad - first.wrist_rad)

    def _stalls(self, reading: Reading) -> bool:
        """Tell whether it has turned much less than it could have for a while."""
        window = self._window
        window.append((self._counted_s, reading.wrist_rad, self._could))
        while len(window) > _READINGS and window[1][0] <= self._counted_s - _STALL_S:
            window.popleft()
        (then_s, then_rad, then_could), could = window[0], self._could
        if len(window) < _READINGS or self._counted_s - then_s < _STALL_S:
            return False
        return abs(reading.wrist_rad - then_rad) < _STALL_SHARE * (could - then_could)

    def _felt(self, reading: Reading, first: Reading, *, stalled: bool = False) -> Felt:
        turned = self._sense * self._turned(reading, first)
        sunk_m = first.pose[2] - reading.pose[2]
        words = (
            f"{_turns(abs(turned))} at {abs(reading.wrench[5]):.1f} Nm, "
            f"{abs(sunk_m) * 1000:.1f} mm {'down' if sunk_m >= 0 else 'up'}"
        )
        return Felt(words, turned, stalled, sunk_m)


def _turns(angle_rad: float) -> str:
    return f"{angle_rad / (2 * math.pi):.2f} turns"
