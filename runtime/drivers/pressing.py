"""Bringing a part home by force: down to contact, feeling for the opening, pressing it in.

What a blind hand does. The tool comes down gently, yielding to every slope, until it stands on
something. If that is higher than the seat, it presses harder for a moment; if it goes no further,
it is drawn over the place in a widening spiral, pressed lightly, until it drops. It counts as
seated only when the force that seats it was measured and it stays as low as expected once the hand
lets up: fingers, part and seat give way under force, and what sticks on its way comes back up.
Standing too high, it found no opening; standing there after a drop, held at its sides, or coming
back, it is jammed.
"""

from __future__ import annotations

import math
from collections import deque
from enum import Enum, auto
from typing import Final

from runtime.config import RobotConfig
from runtime.drivers.force import Axes, Finish, Push, Reading, Watch
from runtime.drivers.steps import Felt, Press
from runtime.kinematics import Pose

_AXES: Final[Axes] = (True, True, True, False, False, False)
_TILT_RAD: Final = 0.17  # by which axes that do not yield may be bent away
_TOUCH: Final = 0.3  # of the descent force: less than that is not standing on anything
_DROP_M: Final = 0.0008  # below the rim: the opening may be found
_TRUE_DROP_M: Final = 0.002  # below where it stood first it is in, and jammed if it stands
_BELOW_M: Final = 0.004  # below the seat there is nothing
_STRAY_M: Final = 0.006  # beyond the search
_EXTRA: Final = 1.1  # of the force that seats it, and
_EXTRA_N: Final = 1.0  # so that it is reached for certain
_REACHED: Final = 0.95  # of it counts
_HOME_FOR_S: Final = 0.4
_READINGS: Final = 4
_HOME_WITHIN_S: Final = 3.0
_LET_UP_WITHIN_S: Final = 2.0
_HARDER_FOR_S: Final = 0.8  # before a part that stands too high is drawn about
_SIDEWAYS: Final = 0.6  # of the force downward at most: a chamfer must not be climbed again
_ARC_M: Final = 0.001  # along the spiral at most between two readings
_HELD: Final = 0.4  # of the search so far: a tool that went no farther is held at its sides
_SLOWEST_GAP_S: Final = 0.01


class _Phase(Enum):
    DOWN = auto()
    HARDER = auto()
    SEARCH = auto()
    HOME = auto()
    LETTING_UP = auto()


class Pressing:
    """Carries a `Press` out, as a `ForceMotion`.

    Args:
        step: What to do.
        config: The robot and its limits.
        patience: By how much more time it may take: the speed slider is turned down.
    """

    def __init__(self, step: Press, config: RobotConfig, patience: float = 1.0) -> None:
        self._step = step
        self._force = config.force
        self._home_z = step.pose[2]
        self._place = (step.pose[0], step.pose[1])
        self._watch = Watch(
            config, self._place, step.search_m + _STRAY_M, config.force.press_time_s * patience
        )
        self._phase = _Phase.DOWN
        self._phase_s = 0.0
        self._first_z = -math.inf  # where it stood first
        self._rim_z = -math.inf  # where it stood last
        self._angle = 0.0
        self._went_m = 0.0
        self._presses: deque[tuple[float, float]] = deque()  # each lasted so long, s, and N
        self._pressed_n = 0.0  # what it was pressed home with
        self._goes_on: Final = {
            _Phase.DOWN: self._down,
            _Phase.HARDER: self._press_harder,
            _Phase.SEARCH: self._search,
            _Phase.HOME: self._press_home,
            _Phase.LETTING_UP: self._let_up,
        }

    def next(self, reading: Reading) -> Push | Finish:
        """Say what to do now, or that it has ended."""
        trouble = self._watch.note(reading)
        if trouble:
            return self._failed(f"{trouble}; it was {self._above(reading)}", reading)
        if reading.pose[2] < self._home_z - _BELOW_M:
            below = (self._home_z - reading.pose[2]) * 1000
            return self._failed(f"it went {below:.1f} mm below its seat and met nothing", reading)
        self._phase_s += self._watch.step_s
        return self._goes_on[self._phase](reading)

    def _down(self, reading: Reading) -> Push | Finish:
        if self._stands(reading):
            self._first_z = self._rim_z = reading.pose[2]
            return self._to(_Phase.HOME if self._is_low(reading) else _Phase.HARDER)
        return self._push(self._toward(reading, self._place), self._force.descent_n)

    def _press_harder(self, reading: Reading) -> Push | Finish:
        """Yield to the sides, pressed as hard as seating takes."""
        if self._stands(reading):
            if self._is_low(reading):
                return self._to(_Phase.HOME)
            if self._phase_s > _HARDER_FOR_S:
                self._rim_z = reading.pose[2]
                if self._first_z - reading.pose[2] >= _TRUE_DROP_M:
                    return self._failed(f"jammed {self._above(reading, force=True)}", reading)
                return self._to(_Phase.SEARCH)
        return self._push((0.0, 0.0), self._press_n)

    def _search(self, reading: Reading) -> Push | Finish:
        if self._is_low(reading) and self._watch.stands():
            return self._to(_Phase.HOME)
        if reading.pose[2] < self._rim_z - _DROP_M:
            return self._to(_Phase.HARDER)
        radius = self._step.spiral_m * self._angle / (2 * math.pi)
        self._went_m = max(self._went_m, math.dist(self._place, reading.pose[:2]))
        held = radius > self._step.search_m / 2 and self._went_m < _HELD * radius
        if held or radius > self._step.search_m or self._step.search_m <= 0:
            return self._failed(self._lost(reading, held=held), reading)
        arc = min(_ARC_M, self._force.search_speed * self._watch.step_s)
        self._angle += arc / math.hypot(radius, self._step.spiral_m)
        x = self._place[0] + radius * math.cos(self._angle)
        y = self._place[1] + radius * math.sin(self._angle)
        return self._push(self._toward(reading, (x, y)), self._force.descent_n)

    def _press_home(self, reading: Reading) -> Push | Finish:
        if reading.pose[2] > self._home_z + 2 * self._step.tolerance_m:
            return self._to(_Phase.HARDER)
        self._pressed_n = self._mean_press(reading)
        if self._pressed_n >= _REACHED * self._step.press_n:
            return self._to(_Phase.LETTING_UP)
        if self._phase_s > _HOME_WITHIN_S:
            mean_n = sum(force for _, force in self._presses) / max(len(self._presses), 1)
            return self._failed(
                f"could not be pressed home: {mean_n:.0f} of {self._step.press_n:g} N "
                f"reached, {self._above(reading)}",
                reading,
            )
        return self._push((0.0, 0.0), self._press_n)

    def _mean_press(self, reading: Reading) -> float:
        """Give the mean force of the last while, N; 0 until it has been low for as long.

        A single reading says little: the sensor is noisy, and an edge makes the tool chatter.
        """
        if not self._is_low(reading):
            self._presses.clear()
            return 0.0
        self._presses.append((self._watch.step_s, reading.press_n))
        lasted_s = sum(step_s for step_s, _ in self._presses)
        while len(self._presses) > _READINGS and lasted_s - self._presses[0][0] >= _HOME_FOR_S:
            lasted_s -= self._presses.popleft()[0]
        if lasted_s < _HOME_FOR_S or len(self._presses) < _READINGS:
            return 0.0
        return sum(force for _, force in self._presses) / len(self._presses)

    def _let_up(self, reading: Reading) -> Push | Finish:
        """Press no harder than on the way down, and look whether it has stayed where it was."""
        if not self._watch.stands() and self._phase_s <= _LET_UP_WITHIN_S:
            return self._push((0.0, 0.0), self._force.descent_n)
        if self._is_low(reading):
            return Finish("", Felt(self._words(reading, self._pressed_n)))
        back = f"it gave way to {self._pressed_n:.0f} N and came back"
        return self._failed(f"jammed {self._above(reading, force=True)}: {back}", reading)

    @property
    def _press_n(self) -> float:
        wanted = _EXTRA * self._step.press_n + _EXTRA_N
        return min(max(wanted, self._force.descent_n), 0.9 * self._force.most_n)

    def _stands(self, reading: Reading) -> bool:
        return reading.press_n >= _TOUCH * self._force.descent_n and self._watch.stands()

    def _is_low(self, reading: Reading) -> bool:
        return reading.pose[2] <= self._home_z + self._step.tolerance_m

    def _lost(self, reading: Reading, *, held: bool) -> str:
        """Say what a search without success has shown."""
        standing = self._above(reading, force=True)
        if held:
            return f"jammed {standing}: it is held at its sides"
        if self._step.search_m <= 0:
            return f"something is in the way: it stands {standing}"
        return f"found no opening within {self._step.search_m * 1000:g} mm: it stands {standing}"

    def _to(self, phase: _Phase) -> Push:
        self._phase, self._phase_s = phase, 0.0
        self._presses.clear()
        self._watch.forget_heights()
        return self._push((0.0, 0.0), self._force.descent_n)

    def _toward(self, reading: Reading, place: tuple[float, float]) -> tuple[float, float]:
        most_n = min(self._force.search_n, _SIDEWAYS * self._force.descent_n)
        return self._watch.drawn(reading, place, most_n)

    def _push(self, aside: tuple[float, float], down_n: float) -> Push:
        # Between two readings the tool must not be drawn past what it looks for.
        gap_s = max(self._watch.gap_s, _SLOWEST_GAP_S)
        sideways = min(2 * self._force.search_speed, _ARC_M / gap_s)
        down = self._force.descent_speed
        speeds: Pose = (sideways, sideways, down, _TILT_RAD, _TILT_RAD, _TILT_RAD)
        return Push(_AXES, (*aside, -down_n, 0.0, 0.0, 0.0), speeds)

    def _failed(self, reason: str, reading: Reading) -> Finish:
        return Finish(reason, Felt(self._words(reading)))

    def _above(self, reading: Reading, *, force: bool = False) -> str:
        """Say how far it is from home, and perhaps with what force it stands there."""
        above = (reading.pose[2] - self._home_z) * 1000
        where = f"{abs(above):.1f} mm {'above' if above > 0 else 'below'} its seat"
        return f"{where} at {reading.press_n:.0f} N" if force else where

    def _words(self, reading: Reading, press_n: float | None = None) -> str:
        pressed_n = reading.press_n if press_n is None else press_n
        off = (reading.pose[2] - self._home_z) * 1000
        aside = math.dist(self._place, reading.pose[:2]) * 1000
        return (
            f"pressed with {pressed_n:.0f} N, {off:+.1f} mm from the height and "
            f"{aside:.1f} mm beside the place expected, in {self._watch.elapsed_s:.1f} s"
        )
