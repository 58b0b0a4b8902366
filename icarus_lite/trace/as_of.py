"""The chronicle of a whole run as it stood at one of its cycles: nothing later is known."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from icarus_lite.inference import Chronicle, Period, Withdrawal
from icarus_lite.language.syntax import Atom
from icarus_lite.outcomes import Outcome
from icarus_lite.symbols import Belief


class ChronicleAsOf(Chronicle):
    """What a chronicle would have said in a cycle of the past.

    Args:
        whole: The chronicle of the run, that cycle included.
        cycle: The cycle.
        last_perceived: Gives the last cycle, up to this one, in which an object was perceived;
            None if it never was, or is.
    """

    __slots__ = ("_last_perceived", "_whole")

    def __init__(
        self, whole: Chronicle, cycle: int, last_perceived: Callable[[str], int | None]
    ) -> None:
        super().__init__()
        self._whole = whole
        self._last_perceived = last_perceived
        self.cycle = cycle

    def periods(self, belief: Belief) -> tuple[Period, ...]:
        """Give the periods in which a belief had been held, oldest first."""
        return self._until(self._whole.periods(belief))

    def held(self, *predicates: str) -> Iterator[tuple[Belief, tuple[Period, ...]]]:
        """Give each belief on record with its periods; of some predicates, or of all."""
        for belief, periods in self._whole.held(*predicates):
            known = self._until(periods)
            if known:
                yield belief, known

    def matching(self, pattern: Atom) -> Iterator[tuple[Belief, tuple[Period, ...]]]:
        """Give each belief held so far that matches a pattern."""
        for belief, periods in self._whole.matching(pattern):
            known = self._until(periods)
            if known:
                yield belief, known

    def outcomes(self, cycle: int) -> tuple[Outcome, ...]:
        """Give what had become of actions just before a cycle."""
        return self._whole.outcomes(cycle) if cycle <= self.cycle else ()

    def reports(self) -> Iterator[tuple[int, Outcome]]:
        """Give all outcomes so far with their cycles, latest first."""
        for cycle, outcome in self._whole.reports():
            if cycle <= self.cycle:
                yield cycle, outcome

    def gone(self, cycle: int) -> frozenset[str]:
        """Give the names of the objects that were perceived until just before a cycle."""
        return self._whole.gone(cycle) if cycle <= self.cycle else frozenset()

    def withdrawals(self) -> Iterator[tuple[int, Withdrawal]]:
        """Give all that had been withdrawn, with the cycles in which it was, earliest first."""
        return (each for each in self._whole.withdrawals() if each[0] <= self.cycle)

    def last_perceived(self, name: str) -> int | None:
        """Give the last cycle in which an object was perceived; None if it is, or never was."""
        return self._last_perceived(name)

    def _until(self, periods: tuple[Period, ...]) -> tuple[Period, ...]:
        now = self.cycle
        known = [period for period in periods if period.first <= now]
        if known and (known[-1].last is None or known[-1].last >= now):
            known[-1] = Period(known[-1].first)
        return tuple(known)
