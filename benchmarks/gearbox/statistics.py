"""Rates with their intervals, and the few other figures that the page needs."""

from __future__ import annotations

import math
import statistics
from collections.abc import Iterable
from dataclasses import dataclass

_Z = statistics.NormalDist().inv_cdf(0.975)


@dataclass(frozen=True, slots=True)
class Rate:
    """How often something happened.

    Args:
        hits: In how many runs.
        runs: Of how many.
    """

    hits: int
    runs: int

    @property
    def share(self) -> float:
        """The share of the runs, in [0, 1]; not a number where there are none."""
        return self.hits / self.runs if self.runs else math.nan

    @property
    def interval(self) -> tuple[float, float]:
        """The 95 % interval of the rate behind it.

        Wilson's score interval: it stays inside [0, 1], and is of use at 0 of n and n of n, where
        the usual one has no width.

        Source: Wilson 1927; Brown, Cai and DasGupta 2001, Interval estimation for a binomial.
        """
        if not self.runs:
            return 0.0, 1.0
        n, p = self.runs, self.share
        middle = p + _Z**2 / (2 * n)
        half = _Z * math.sqrt(p * (1 - p) / n + _Z**2 / (4 * n**2))
        whole = 1 + _Z**2 / n
        low = 0.0 if not self.hits else (middle - half) / whole
        high = 1.0 if self.hits == n else (middle + half) / whole
        return low, high

    def __str__(self) -> str:
        """Give it as it stands in a table: `49 of 50 (89-100 %)`."""
        if not self.runs:
            return "-"
        low, high = self.interval
        return f"{self.hits} of {self.runs} ({100 * low:.0f}-{100 * high:.0f} %)"


def median(values: Iterable[float]) -> float:
    """Give the median; not a number where there are no values."""
    found = list(values)
    return statistics.median(found) if found else math.nan


def shown(value: float, digits: int = 1) -> str:
    """Give a figure for a table; a dash where there is none."""
    return "-" if math.isnan(value) else f"{value:,.{digits}f}"
