"""The assignment problem: which detection is which anchor."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from aapa.assignment import LARGEST_FULL, Side, cheapest, cheapest_of_all
from aapa.costs import CENTRE, Cost, Place
from aapa.errors import AnchoringError

__all__ = ["Alignment", "Place", "align", "squared_distance"]


@dataclass(frozen=True, slots=True)
class Alignment:
    """Who is who; every index of either side occurs exactly once.

    Args:
        pairs: (anchor, detection) indices, in the order of the anchors.
        lost: Indices of the anchors without a detection, ascending.
        appeared: Indices of the detections without an anchor, ascending.
    """

    pairs: tuple[tuple[int, int], ...]
    lost: tuple[int, ...]
    appeared: tuple[int, ...]


def squared_distance(first: Sequence[float], second: Sequence[float]) -> float:
    """Give the squared Euclidean distance of two points, in the square of their unit."""
    if len(first) == len(second) == 2:  # the image: written out, since it is asked most often
        x, y = first[0] - second[0], first[1] - second[1]
        return x * x + y * y
    total = 0.0
    for a, b in zip(first, second, strict=True):
        total += (a - b) * (a - b)
    return total


def align(
    anchors: Sequence[Place], detections: Sequence[Place], tau: float, cost: Cost = CENTRE
) -> Alignment:
    """Match detections to anchors of the same type at least total cost.

    Each pair that could be formed but is not costs tau. The result is the optimum of that;
    solving without the cap and dropping the bad pairs afterwards would give another one.

    Args:
        anchors: (n) where the anchors were.
        detections: (m) where something was detected, centres of the same length and unit.
        tau: Pairs that cost more stay unmatched, in the unit of the cost, above 0.
        cost: Of a pair; the squared centre distance if left out.

    Raises:
        AnchoringError: tau is not above 0.

    Source: Liang et al. 2021, section III-B b; Munkres 1957.

    Example:
        >>> align([Place("cone", (0, 0))], [Place("cone", (3, 4)), Place("ball", (0, 0))], 100)
        Alignment(pairs=((0, 0),), lost=(), appeared=(1,))
    """
    if not tau > 0:
        raise AnchoringError(f"tau is {tau}; it has to be above 0")
    many = len(anchors) * len(detections) > LARGEST_FULL
    pairs = (_pairs_of_many if many else _pairs_type_by_type)(anchors, detections, tau, cost)
    return Alignment(
        tuple(pairs),
        _others(len(anchors), [row for row, _ in pairs]),
        _others(len(detections), [column for _, column in pairs]),
    )


def _others(count: int, taken: Sequence[int]) -> tuple[int, ...]:
    """Give the numbers below a count that are not taken, ascending."""
    if len(taken) == count:
        return ()
    known = set(taken)
    return tuple([number for number in range(count) if number not in known])


def _by_type(places: Sequence[Place]) -> dict[str, list[int]]:
    groups: dict[str, list[int]] = {}
    for index, place in enumerate(places):
        group = groups.get(place[0])
        if group is None:
            groups[place[0]] = [index]
        else:
            group.append(index)
    return groups


def _pairs_type_by_type(
    anchors: Sequence[Place], detections: Sequence[Place], tau: float, cost: Cost
) -> list[tuple[int, int]]:
    """Give the pairs of the capped optimum among a few objects."""
    pairs: list[tuple[int, int]] = []
    by_type = _by_type(detections)
    # Types never mix, so that each is an assignment problem of its own.
    for name, rows in _by_type(anchors).items():
        columns = by_type.get(name)
        if columns is None:
            continue
        if len(rows) == len(columns) == 1 and cost is CENTRE:
            # The common case, where each thing has a type of its own, needs no solver.
            row, column = rows[0], columns[0]
            if squared_distance(anchors[row].centre, detections[column].centre) <= tau:
                pairs.append((row, column))
            continue
        features = [
            np.array([cost.features(side[index]) for index in indices], dtype=np.float64)
            for side, indices in ((anchors, rows), (detections, columns))
        ]
        found = cheapest_of_all(cost.pairs(features[0][:, None], features[1][None]), tau)
        for row, column in zip(*(side.tolist() for side in found), strict=True):
            pairs.append((rows[row], columns[column]))
    pairs.sort()
    return pairs


def _pairs_of_many(
    anchors: Sequence[Place], detections: Sequence[Place], tau: float, cost: Cost
) -> list[tuple[int, int]]:
    """Give the pairs of the capped optimum among many objects, of all types at once."""
    codes: dict[str, int] = {}
    sides = []
    for places in (anchors, detections):
        kinds = [codes.setdefault(place[0], len(codes)) for place in places]
        centres = np.array([place[1] for place in places], dtype=np.float64)
        features = centres
        if cost is not CENTRE:
            features = np.array([cost.features(place) for place in places], dtype=np.float64)
        sides.append(Side(np.array(kinds, dtype=np.int64), centres, features))
    rows, columns = cheapest(sides[0], sides[1], tau, cost)
    return list(zip(rows.tolist(), columns.tolist(), strict=True))
