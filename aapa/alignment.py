"""The assignment problem: which detection is which anchor."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from aapa.errors import AnchoringError


class Place(NamedTuple):
    """What alignment looks at: a type, and a centre in px (two numbers) or m (three)."""

    type: str
    centre: tuple[float, ...]


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
    total = 0.0
    for a, b in zip(first, second, strict=True):
        total += (a - b) * (a - b)
    return total


def align(anchors: Sequence[Place], detections: Sequence[Place], tau: float) -> Alignment:
    """Match detections to anchors of the same type at least total cost.

    The cost of a pair is its squared centre distance, and each pair that could be formed but is
    not costs tau. The result is the optimum of that; solving without the cap and dropping the
    bad pairs afterwards would give another one.

    Args:
        anchors: (n) where the anchors were.
        detections: (m) where something was detected, centres of the same length and unit.
        tau: Pairs that cost more stay unmatched, squared unit of the centres, above 0.

    Raises:
        AnchoringError: tau is not above 0.

    Source: Liang et al. 2021, section III-B b; Munkres 1957.

    Example:
        >>> align([Place("cone", (0, 0))], [Place("cone", (3, 4)), Place("ball", (0, 0))], 100)
        Alignment(pairs=((0, 0),), lost=(), appeared=(1,))
    """
    if not tau > 0:
        raise AnchoringError(f"tau is {tau}; it has to be above 0")
    pairs: list[tuple[int, int]] = []
    by_type = _by_type(detections)
    # Types never mix, so that each is an assignment problem of its own.
    for name, rows in _by_type(anchors).items():
        columns = by_type.get(name)
        if columns is None:
            continue
        if len(rows) == len(columns) == 1:
            # The common case, where each thing has a type of its own, needs no solver.
            row, column = rows[0], columns[0]
            if squared_distance(anchors[row].centre, detections[column].centre) <= tau:
                pairs.append((row, column))
            continue
        costs = _costs([anchors[row] for row in rows], [detections[column] for column in columns])
        pairs.extend((rows[row], columns[column]) for row, column in _cheapest(costs, tau))
    pairs.sort()
    matched = {anchor for anchor, _ in pairs}
    used = {detection for _, detection in pairs}
    return Alignment(
        tuple(pairs),
        tuple(index for index in range(len(anchors)) if index not in matched),
        tuple(index for index in range(len(detections)) if index not in used),
    )


def _by_type(places: Sequence[Place]) -> dict[str, list[int]]:
    groups: dict[str, list[int]] = {}
    for index, place in enumerate(places):
        groups.setdefault(place.type, []).append(index)
    return groups


def _costs(anchors: Sequence[Place], detections: Sequence[Place]) -> NDArray[np.float64]:
    """Give the (n, m) squared centre distances."""
    old = np.array([anchor.centre for anchor in anchors], dtype=np.float64)
    new = np.array([detection.centre for detection in detections], dtype=np.float64)
    offsets = old[:, None, :] - new[None, :, :]
    squares: NDArray[np.float64] = np.einsum("ijk,ijk->ij", offsets, offsets)
    return squares


def _cheapest(costs: NDArray[np.float64], tau: float) -> list[tuple[int, int]]:
    """Give the pairs of the capped optimum, as row and column of the (n, m) costs."""
    from scipy.optimize import linear_sum_assignment  # noqa: PLC0415 - a third of a second to load

    # The cap lies a hair above tau, so that a pair at exactly tau is taken rather than left.
    capped = np.where(costs > tau, tau * (1 + 1e-9), costs)
    rows, columns = linear_sum_assignment(capped)
    return [
        (row, column)
        for row, column in zip(rows.tolist(), columns.tolist(), strict=True)
        if costs[row, column] <= tau
    ]
