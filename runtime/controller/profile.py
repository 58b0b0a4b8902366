"""Trapezoidal speed profiles: rest to rest under a speed and an acceleration limit."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Self


@dataclass(frozen=True, slots=True)
class Trapezoid:
    """A way of a given length: accelerate, cruise, decelerate.

    Args:
        length: How far, >= 0, in any unit.
        peak: The greatest speed reached, unit/s.
        ramp_s: How long accelerating takes, and decelerating again, s.
        cruise_s: How long the peak speed is held, s.
    """

    length: float
    peak: float
    ramp_s: float
    cruise_s: float

    @classmethod
    def limited(cls, length: float, speed: float, acceleration: float) -> Self:
        """Plan the quickest profile within limits, both > 0."""
        if length <= 0.0:
            return cls(0.0, 0.0, 0.0, 0.0)
        peak = min(speed, math.sqrt(length * acceleration))
        ramp = peak / acceleration
        return cls(length, peak, ramp, max(0.0, length / peak - ramp))

    @classmethod
    def timed(cls, length: float, duration_s: float) -> Self:
        """Plan a profile of a given duration, a third of it each for ramps and cruise."""
        ramp = duration_s / 3
        return cls(length, length / (2 * ramp), ramp, ramp)

    @property
    def duration_s(self) -> float:
        """How long the whole way takes, s."""
        return 2 * self.ramp_s + self.cruise_s

    def position(self, at_s: float) -> float:
        """Give the distance covered after a time; exactly `length` at the end."""
        if at_s >= self.duration_s:
            return self.length
        if at_s < self.ramp_s:
            return self.peak * at_s * at_s / (2 * self.ramp_s)
        if at_s <= self.ramp_s + self.cruise_s:
            return self.peak * (at_s - self.ramp_s / 2)
        left = self.duration_s - at_s
        return self.length - self.peak * left * left / (2 * self.ramp_s)

    def speed(self, at_s: float) -> float:
        """Give the speed after a time; zero from the end on."""
        if at_s >= self.duration_s:
            return 0.0
        if at_s < self.ramp_s:
            return self.peak * at_s / self.ramp_s
        if at_s <= self.ramp_s + self.cruise_s:
            return self.peak
        return self.peak * (self.duration_s - at_s) / self.ramp_s
