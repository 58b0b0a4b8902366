"""The watch over a cycle: it stops one that believes too much or takes too long."""

from __future__ import annotations

from collections.abc import Sequence
from time import perf_counter

from icarus_lite.errors import InferenceError
from icarus_lite.inference.network.changes import Budget


class BudgetError(InferenceError):
    """A cycle was stopped: it would have gone beyond its budget."""


class Watch:
    """Watches over the budget of a network.

    Args:
        budget: What one cycle may cost.
        places: Where each clause stands, with its head, in the order of the text.
    """

    __slots__ = ("_deadline", "_places", "_rests", "budget")

    def __init__(self, budget: Budget, places: Sequence[str]) -> None:
        self.budget = budget
        self._places = places
        self._deadline = float("inf")
        self._rests = False

    def start(self) -> None:
        """Begin a cycle."""
        self._rests = False
        if self.budget.seconds is not None:
            self._deadline = perf_counter() + self.budget.seconds

    def rest(self) -> None:
        """Let what comes now cost what it does: what was there is put back.

        What a network came to step by step may go beyond the budget when it is loaded at once.
        """
        self._deadline = float("inf")
        self._rests = True

    def tick(self, clause: int) -> None:
        """Look at the clock while a clause, by its number, is joined.

        Raises:
            BudgetError: the cycle has taken too long.
        """
        if perf_counter() > self._deadline:
            raise BudgetError(
                f"{self._places[clause]} was being joined when the cycle had taken "
                f"{self.budget.seconds} s, its budget; make its conditions more selective, "
                "or raise the budget"
            )

    def too_many(self, clause: int) -> None:
        """Stop: a clause, by its number, concludes more than the budget allows.

        Raises:
            BudgetError: always, unless it rests.
        """
        if self._rests:
            return
        raise BudgetError(
            f"{self._places[clause]} concludes more than {self.budget.facts:,} beliefs, "
            "the budget; make its conditions more selective, or raise the budget"
        )
