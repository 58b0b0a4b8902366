"""Exchanges: rows that change their columns, one taking another's, so that all in all they gain."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

_NOBODY = -1
_CIRCLE = -2


class Bidding(NamedTuple):
    """Who is paired with whom, and who would rather be.

    Args:
        bidder_of: By column, the row that offered most for it; -1 where nobody offers anything.
        column_of: By row, its column; -1 where it is alone.
        row_of: By column, its row; -1 where it is free.
    """

    bidder_of: Sequence[int]
    column_of: Sequence[int]
    row_of: Sequence[int]


class Exchanges(NamedTuple):
    """What changes; a row and a column occur once at most.

    Args:
        rows: Those that change, or find, their columns.
        columns: Their new ones.
        left: The columns that are free afterwards.
        ousted: The rows that are alone afterwards.
    """

    rows: list[int]
    columns: list[int]
    left: list[int]
    ousted: list[int]


def disjoint_exchanges(wanted: Iterable[int], rising: Iterable[int], bidding: Bidding) -> Exchanges:
    """Find exchanges that gain and have nothing in common.

    Of two that share a row or a column the first is taken: what the other is worth then has to be
    found out anew.

    Args:
        wanted: Columns for which more is offered than they gain where they are.
        rising: Columns that may owe their price to rows that outbid each other in a circle.
        bidding: The offers.
    """
    found = Exchanges([], [], [], [])
    rows: set[int] = set()
    columns: set[int] = set()
    bidder_of, _, row_of = bidding
    for column, is_wanted in [*((c, True) for c in wanted), *((c, False) for c in rising)]:
        if column in columns or bidder_of[column] in rows:
            continue  # most of them: many want what one exchange settles
        trail, end = _trail(column, bidding, columns)
        if not trail or not (is_wanted or end == _CIRCLE):
            continue
        owner = row_of[column] if end != _CIRCLE else _NOBODY
        movers = [bidder_of[each] for each in trail]
        if owner in rows or not rows.isdisjoint(movers):
            continue
        found.rows.extend(movers)
        found.columns.extend(trail)
        if end >= 0:
            found.left.append(end)
        if owner >= 0:
            found.ousted.append(owner)
        rows.update(movers, found.ousted[-1:])
        columns.update(trail, found.left[-1:])
    return found


def leads_round(columns: Iterable[int], bidding: Bidding) -> bool:
    """Tell whether one of some columns owes its price to a circle."""
    return any(_trail(column, bidding, set())[1] == _CIRCLE for column in columns)


def _trail(column: int, bidding: Bidding, taken: set[int]) -> tuple[list[int], int]:
    """Follow who outbid whom, from a column back to where it began.

    Args:
        column: Where to start.
        bidding: The offers.
        taken: Columns that no trail may touch; those from which all trails lead there are added.

    Returns:
        The columns that would change hands, and the one that would be free then, or that there is
        none, or that the columns form a circle. No columns at all if one of them is taken.
    """
    bidder_of, column_of, _ = bidding
    trail: dict[int, None] = {}
    while column >= 0:
        if column in taken:
            taken.update(trail)
            return [], _NOBODY
        if column in trail:
            columns = list(trail)
            return columns[columns.index(column) :], _CIRCLE
        row = bidder_of[column]
        if row < 0:
            break
        trail[column] = None
        column = column_of[row]
    return list(trail), column
