"""The assignment problem over listed pairs: a good matching, proved the best or made better.

Where objects are followed from frame to frame, nearly all pairs are obvious, and what is hard is
small and far apart. So each pair is taken that is the best of both its sides, and then a price is
sought for each column that no row would rather pay than what it has. If there are such prices the
matching is the optimum, by the duality of linear programs; where there are none, following who
outbids whom leads along an exchange that gains something. It is carried out, and the proof begins
anew. All this goes wave by wave over the whole scene at once, as numpy likes it.

Sources: Kuhn 1955, the prices; Berge 1957, the exchanges; Bellman 1958, the waves.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from aapa.exchanges import Bidding, Exchanges, disjoint_exchanges, leads_round

Numbers: TypeAlias = NDArray[np.int64]
Values: TypeAlias = NDArray[np.float64]

_PROOFS = 8
"""How often a matching is made better before another solver is asked: then it was no good one."""

_PATIENCE = 6
"""After so many waves, circles are looked for: in them prices rise for long."""

_MOST_WAVES = 200
_DUST = 1e-12
"""Gains below this share of the largest possible one are rounding."""


@dataclass(frozen=True, slots=True, eq=False)
class Offers:
    """The pairs that may be formed, and what each gains.

    Args:
        rows: (k) of each pair, ascending.
        columns: (k) of each pair; no pair occurs twice.
        gains: (k) by which it is better to form the pair than not, above 0.
        shape: How many rows and columns there are.
        most: What no gain exceeds.
    """

    rows: Numbers
    columns: Numbers
    gains: Values
    shape: tuple[int, int]
    most: float


def best_matching(offers: Offers) -> Numbers | None:
    """Give the column of each row, -1 where it stays alone, so that the gains' sum is the largest.

    Returns:
        (n); None where the pairs are so contested that another solver is faster.

    Example:
        >>> rows, columns = np.array([0, 0, 1]), np.array([0, 1, 0])
        >>> best_matching(Offers(rows, columns, np.array([9.0, 8.0, 7.0]), (2, 2), 9.0)).tolist()
        [1, 0]
    """
    matching = _Matching(offers)
    matching.take_mutual_bests()
    proof = _Proof(matching)
    for _ in range(_PROOFS):
        if proof.holds():
            return matching.column_of
        if not proof.exchange():
            return None
    return None


class _Matching:
    """Who is paired with whom, and what it gains; it changes as it gets better."""

    def __init__(self, offers: Offers) -> None:
        count, width = offers.shape
        self.offers = offers
        self.first: Numbers = np.zeros(count + 1, dtype=np.int64)
        """By row, its first pair; the next row's is behind its last."""
        np.cumsum(np.bincount(offers.rows, minlength=count), out=self.first[1:])
        self.column_of: Numbers = np.full(count, -1, dtype=np.int64)
        self.row_of: Numbers = np.full(width, -1, dtype=np.int64)
        self.gain_of: Values = np.zeros(count)
        """By row, what its pair gains; 0 where it is alone."""

    def take_mutual_bests(self) -> None:
        """Form the pairs that are the best of both sides, until none is left to be formed."""
        offers = self.offers
        rows, columns, gains = offers.rows, offers.columns, offers.gains
        while len(rows):
            best_of_row, best_of_column = np.zeros(offers.shape[0]), np.zeros(offers.shape[1])
            np.maximum.at(best_of_row, rows, gains)
            np.maximum.at(best_of_column, columns, gains)
            best = ((gains >= best_of_row[rows]) & (gains >= best_of_column[columns])).nonzero()[0]
            self._form(rows[best], columns[best], gains[best])
            left = ((self.column_of[rows] < 0) & (self.row_of[columns] < 0)).nonzero()[0]
            rows, columns, gains = rows[left], columns[left], gains[left]

    def _form(self, rows: Numbers, columns: Numbers, gains: Values) -> None:
        """Form pairs, of those that share a row or a column only one."""
        self.column_of[rows] = columns
        one = self.column_of[rows] == columns
        rows, columns, gains = rows[one], columns[one], gains[one]
        self.row_of[columns] = rows
        one = self.row_of[columns] == rows
        self.column_of[rows[~one]] = -1
        self.gain_of[rows[one]] = gains[one]

    def carry_out(self, exchanges: Exchanges, pairs: Numbers) -> None:
        """Give rows other columns.

        Args:
            exchanges: Which.
            pairs: By column, the number of its new pair.
        """
        if not exchanges.rows:
            return
        self.row_of[exchanges.left] = -1
        self.column_of[exchanges.ousted] = -1
        self.gain_of[exchanges.ousted] = 0.0
        rows, columns = exchanges.rows, exchanges.columns
        self.column_of[rows] = columns
        self.row_of[columns] = rows
        self.gain_of[rows] = self.offers.gains[pairs[columns]]


class _Proof:
    """The search for prices that prove a matching the best, or for what makes it better."""

    def __init__(self, matching: _Matching) -> None:
        offers = matching.offers
        self._matching = matching
        self._offers = offers
        self._dust = offers.most * _DUST
        self._prices: Values = np.zeros(offers.shape[1])
        self._bids: Numbers = np.full(offers.shape[1], -1, dtype=np.int64)
        """By column, the pair that gave it its price; -1 while that is 0."""
        self._wanted: list[Numbers] = []
        """Columns whose price contradicts the matching."""
        self._rising: Numbers = np.zeros(0, dtype=np.int64)
        """Columns whose price was still rising in the end."""

    def holds(self) -> bool:
        """Tell whether the matching is the best.

        A row would pay for a column what it would gain there, less what it keeps where it is:
        its own gain, less the price of its own column. Prices rise until nobody offers more.
        They prove the matching if no free column has one, and none exceeds its pair's gain.
        """
        offers, matching = self._offers, self._matching
        excess = self._own_prices() - matching.gain_of
        bids = offers.gains + excess[offers.rows]
        bidding = (bids > self._prices[offers.columns] + self._dust).nonzero()[0]
        bids = bids[bidding]
        # What contradicted before, and has nothing to do with what was exchanged, does so still.
        wrong = (self._prices > 0) & (matching.row_of < 0)
        wrong[matching.column_of[excess > self._dust]] = True
        self._wanted = [wrong.nonzero()[0]]
        patience = _PATIENCE
        for wave in range(_MOST_WAVES):
            if not len(bidding):
                return not any(map(len, self._wanted))
            raised = self._raise(bidding, bids)
            owners = matching.row_of[raised]
            excess = self._prices[raised] - matching.gain_of[owners]
            wrong = (owners < 0) | (excess > self._dust)
            if wrong.any():
                self._wanted.append(raised[wrong])
                right = ~wrong
                raised, owners, excess = raised[right], owners[right], excess[right]
            if wave == patience:
                patience *= 2
                if any(map(len, self._wanted)) or leads_round(raised.tolist(), self._bidding()):
                    self._rising = raised
                    break
            bidding, bids = self._next_bids(owners, excess)
        return False

    def exchange(self) -> bool:
        """Make the matching better where it can be, and tell whether it was at all."""
        # A column may have been noted several times; once will do.
        wanted = dict.fromkeys(np.concatenate(self._wanted).tolist())
        exchanges = disjoint_exchanges(wanted, self._rising.tolist(), self._bidding())
        if not exchanges.rows:
            return False
        outdated = self._outdated(exchanges)
        self._matching.carry_out(exchanges, self._bids)
        self._prices[outdated] = 0.0
        self._bids[outdated] = -1
        return True

    def _own_prices(self) -> Values:
        """Give by row the price of its column; 0 where it is alone."""
        column_of = self._matching.column_of
        return np.where(column_of < 0, 0.0, self._prices[column_of])

    def _outdated(self, exchanges: Exchanges) -> NDArray[np.bool_]:
        """Tell by column whether its price goes back to a row or column that is exchanged."""
        matching, bids = self._matching, self._bids
        moved = np.zeros(len(matching.column_of), dtype=np.bool_)
        moved[exchanges.rows] = moved[exchanges.ousted] = True
        bidders = self._offers.rows[bids]
        outdated = (bids >= 0) & moved[bidders]
        outdated[exchanges.columns] = outdated[exchanges.left] = True
        # The column that a bidder would leave: its price is part of the bid.
        behind = np.where(bids < 0, -1, matching.column_of[bidders])
        linked = (behind >= 0).nonzero()[0]
        behind = behind[linked]
        count = -1
        while count != (count := int(np.count_nonzero(outdated))):
            outdated[linked] |= outdated[behind]
        return outdated

    def _raise(self, bidding: Numbers, bids: Values) -> Numbers:
        """Give each column the highest price bid for it, and give the columns."""
        columns = self._offers.columns[bidding]
        np.maximum.at(self._prices, columns, bids)
        winning = (bids >= self._prices[columns]).nonzero()[0]
        columns, bidding = columns[winning], bidding[winning]
        self._bids[columns] = bidding
        # Of bids that are the same one was noted: each column once.
        each: Numbers = columns[self._bids[columns] == bidding]
        return each

    def _next_bids(self, rows: Numbers, excess: Values) -> tuple[Numbers, Values]:
        """Give the pairs, and the bids, of rows whose own columns have become dearer."""
        if not len(rows):
            return rows, excess
        start = self._matching.first[rows]
        counts = self._matching.first[rows + 1] - start
        ends = counts.cumsum()
        pairs = (start - ends + counts).repeat(counts) + np.arange(ends[-1])
        bids = self._offers.gains[pairs] + excess.repeat(counts)
        higher = (bids > self._prices[self._offers.columns[pairs]] + self._dust).nonzero()[0]
        return pairs[higher], bids[higher]

    def _bidding(self) -> Bidding:
        """Give who bid what, to be looked up one by one."""
        bidders = np.where(self._bids < 0, -1, self._offers.rows[self._bids])
        # As buffers, which give numbers of Python's own as fast as lists, and need not be copied.
        return Bidding(bidders.data, self._matching.column_of.data, self._matching.row_of.data)
