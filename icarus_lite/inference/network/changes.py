"""What goes into a network in one cycle, what comes out, and how much it may cost."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from icarus_lite.records import dataclass
from icarus_lite.symbols import Belief, Percept


@dataclass(frozen=True, slots=True)
class Delta:
    """What has changed since the last cycle.

    Args:
        percepts: Objects that are new, or whose attributes are no longer what they were; each
            with all of its attributes.
        gone: Objects that are no longer perceived: type and name of each.
        asserted: Beliefs that are given from now on, such as the effects of an action. One that
            is given already gets the attributes it comes with now.
        withdrawn: Beliefs that are no longer given. A belief that is both withdrawn and
            asserted stays.
    """

    percepts: tuple[Percept, ...] = ()
    gone: tuple[tuple[str, str], ...] = ()
    asserted: tuple[Belief, ...] = ()
    withdrawn: tuple[Belief, ...] = ()


class Changes:
    """The net changes of the beliefs, derived and asserted, that one update brought about.

    The beliefs are made when they are first asked for: a cycle in which nobody asks pays nothing.

    Args:
        cycle: The number of the cycle, counted by the network from 0.
        read: Gives the beliefs that a cycle added, removed, and changed in their attributes alone.
    """

    __slots__ = ("_read", "_sorted", "cycle")

    def __init__(
        self,
        cycle: int,
        read: Callable[[int], tuple[Sequence[Belief], Sequence[Belief], Sequence[Belief]]],
    ) -> None:
        self.cycle = cycle
        self._read = read
        self._sorted: tuple[tuple[Belief, ...], ...] | None = None

    @property
    def added(self) -> tuple[Belief, ...]:
        """The beliefs that were not held before, in canonical order: as they are written."""
        return self._in_order()[0]

    @property
    def removed(self) -> tuple[Belief, ...]:
        """The beliefs that are no longer held, in canonical order."""
        return self._in_order()[1]

    @property
    def altered(self) -> tuple[Belief, ...]:
        """The beliefs held before and after, but now with other attributes."""
        return self._in_order()[2]

    def _in_order(self) -> tuple[tuple[Belief, ...], ...]:
        if self._sorted is None:
            self._sorted = tuple(tuple(sorted(part, key=str)) for part in self._read(self.cycle))
        return self._sorted

    def __repr__(self) -> str:
        return f"Changes(cycle={self.cycle}, added={self.added}, removed={self.removed})"


@dataclass(frozen=True, slots=True)
class Budget:
    """What one cycle may cost before it is stopped and taken back, and what may be kept of it.

    Args:
        facts: How many beliefs one concept may have.
        seconds: How long a cycle may take; None for as long as it needs.
        changes_kept: How many changes of past cycles are remembered: of beliefs, percepts and
            assertions, some hundred bytes each. Older ones are forgotten; None keeps all.
    """

    facts: int = 5_000_000
    seconds: float | None = 30.0
    changes_kept: int | None = 200_000
