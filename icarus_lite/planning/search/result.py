"""What a search may cost, what it did cost, and what it has found."""

from __future__ import annotations

import math
import time
from collections.abc import Callable

from icarus_lite.records import dataclass


@dataclass(frozen=True, slots=True)
class Limits:
    """When to give up.

    Args:
        evaluations: States judged at most; None for no limit. The same limit gives the same
            result on every machine.
        seconds: Time at most, None for no limit.
        clock: What tells the time, in seconds.
    """

    evaluations: int | None = None
    seconds: float | None = None
    clock: Callable[[], float] = time.monotonic

    @property
    def most(self) -> float:
        """Evaluations at most, infinity for no limit."""
        return math.inf if self.evaluations is None else self.evaluations

    def until(self) -> float:
        """Give the time at which to give up, counted from now; infinity for no limit."""
        return math.inf if self.seconds is None else self.clock() + self.seconds


@dataclass(frozen=True, slots=True)
class Effort:
    """What a search took.

    Args:
        evaluations: States for which the distance to the goal was estimated.
        expansions: Those of them from which the goal is not out of reach, whose successors were
            therefore put in line.
    """

    evaluations: int = 0
    expansions: int = 0

    def __add__(self, other: Effort) -> Effort:
        return Effort(self.evaluations + other.evaluations, self.expansions + other.expansions)


@dataclass(frozen=True, slots=True)
class Progress:
    """A state from which the goal looked nearer than from any before it.

    Args:
        steps: How many steps lead to it.
        estimate: Steps of the relaxed plan from it.
        evaluations: States judged until then.
    """

    steps: int
    estimate: int
    evaluations: int


@dataclass(frozen=True, slots=True)
class SearchResult:
    """How a search ended.

    Args:
        plan: Numbers of the operators that lead to the goal, in order; None if none was found.
        exhausted: Whether there is no plan at all: all that can be reached has been seen, or the
            goal is out of reach even if nothing is ever made false. Without a plan, and not
            exhausted, a limit was reached.
        effort: What it took.
        unreachable: The goal atoms that no sequence of operators makes true; empty unless the
            goal is out of reach for that reason.
        progress: How the search came nearer to the goal, for explanations.
    """

    plan: tuple[int, ...] | None
    exhausted: bool
    effort: Effort
    unreachable: tuple[int, ...] = ()
    progress: tuple[Progress, ...] = ()
