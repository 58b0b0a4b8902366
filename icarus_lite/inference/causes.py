"""Which action asserted what, in each cycle on record: the log that goes with the network's own.

The network remembers what was given, but not by whom. Whoever asks about a past cycle is told by
which action, and in which cycle its success was reported.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping

from icarus_lite.inference.supports import Support
from icarus_lite.symbols import Belief

Given = Mapping[Belief, tuple[Support, ...]]
"""The beliefs that rest on actions, each with what asserted it."""


class Causes:
    """What was given in each cycle of one run, kept as what each cycle has changed."""

    __slots__ = ("_ahead", "_began", "_changes", "_given", "_last")

    def __init__(self) -> None:
        self._given: Given = {}
        self._changes: deque[tuple[int, dict[Belief, tuple[Support, ...] | None]]] = deque()
        self._ahead = 0
        self._began, self._last = 0, -1

    def note(self, cycle: int, number: int, given: Given, first: int) -> None:
        """Put a cycle on record.

        Cycles that do not follow one another belong to different runs; the last run counts.

        Args:
            cycle: The cycle.
            number: Its number as the network counts.
            given: What is given in it.
            first: The first cycle that the network has on record, as it counts.
        """
        if cycle - number != self._ahead or self._last < self._began:
            self._ahead, self._began = cycle - number, cycle
            self._changes.clear()
        elif given != self._given:
            before = {b: was for b, was in self._given.items() if given.get(b) != was}
            new: dict[Belief, None] = {b: None for b in given if b not in self._given}
            self._changes.append((cycle, {**before, **new}))
        self._given, self._last = given, cycle
        while self._changes and self._changes[0][0] <= first + self._ahead:
            self._changes.popleft()

    def number(self, cycle: int) -> int:
        """Give the number by which the network knows a cycle of this run.

        Raises:
            ForgottenError: it is no cycle of this run.
        """
        if not self._began <= cycle <= self._last:
            from icarus_lite.inference.network import ForgottenError  # noqa: PLC0415 - seldom

            raise ForgottenError(cycle, self._began, self._last)
        return cycle - self._ahead

    def at(self, cycle: int) -> dict[Belief, tuple[Support, ...]]:
        """Give what was given in a cycle on record."""
        found = dict(self._given)
        for later, written_over in reversed(self._changes):
            if later <= cycle:
                break
            for belief, was in written_over.items():
                found.pop(belief, None)  # it may have had other attributes
                if was is not None:
                    found[belief] = was
        return found
