"""The capped assignment problem over one type or many: least total cost, by the fastest way.

Few objects are solved with the full matrix of costs. With many, the pairs within reach are listed
first, and a matching over them is proved the best; what is too contested for that goes to scipy's
sparse solver. Every way gives the same optimum.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from aapa.costs import Cost, Rows
from aapa.gating import Pairs, pairs_within
from aapa.matching import Offers, best_matching

_CAP = 1 + 1e-9
"""An object that stays alone costs a hair more than tau: a pair at exactly tau is formed."""

LARGEST_FULL = 150 * 150
"""Cells of a matrix of costs. Beyond, looking for near pairs first is faster than filling it."""


@dataclass(frozen=True, slots=True, eq=False)
class Side:
    """The anchors, or the detections, of an assignment problem.

    Args:
        kinds: (n) numbers that stand for the types; only equal ones are compared.
        centres: (n, d) in px or m.
        features: (n, f) what the cost looks at.
    """

    kinds: NDArray[np.int64]
    centres: Rows
    features: Rows

    def only(self, which: NDArray[np.int64]) -> Side:
        """Give the side with some of its objects, by their numbers."""
        centres = self.centres.take(which, axis=0)
        same = self.features is self.centres
        features = centres if same else self.features.take(which, axis=0)
        return Side(self.kinds[which], centres, features)


def prepare() -> None:
    """Load the solver now, so that no frame has to wait a third of a second for it."""
    from scipy.optimize import linear_sum_assignment  # noqa: F401, PLC0415 - as below


def cheapest(anchors: Side, detections: Side, tau: float, cost: Cost) -> Pairs:
    """Give the pairs of the capped optimum, of all types at once.

    Args:
        anchors: One side.
        detections: The other one.
        tau: Pairs that cost more are not formed; each anchor that stays alone costs this.
        cost: Of a pair.
    """
    cells = len(anchors.kinds) * len(detections.kinds)
    if not cells:
        return _none()
    if cells > LARGEST_FULL and cost.reach is not None:
        near = pairs_within(anchors.centres, detections.centres, cost.reach(tau) * _CAP)
        if near is not None:
            return _cheapest_near(near, anchors, detections, tau, cost)
    if len(np.union1d(anchors.kinds, detections.kinds)) == 1:
        costs = cost.pairs(anchors.features[:, None], detections.features[None])
        return cheapest_of_all(costs, tau)
    # Type by type, in which there may be no crowd.
    kinds = np.intersect1d(anchors.kinds, detections.kinds).tolist()
    found = [_none(), *[_of_kind(kind, anchors, detections, tau, cost) for kind in kinds]]
    rows, columns = (np.concatenate([each[side] for each in found]) for side in (0, 1))
    order = np.argsort(rows)
    return rows[order], columns[order]


def cheapest_of_all(costs: NDArray[np.float64], tau: float) -> Pairs:
    """Give the pairs of the capped optimum, looking at all of them.

    Args:
        costs: (n, m) of each pair; infinite where there can be none.
        tau: Pairs that cost more are not formed; each anchor that stays alone costs this.
    """
    from scipy.optimize import linear_sum_assignment  # noqa: PLC0415 - a third of a second to load

    rows, columns = linear_sum_assignment(np.where(costs > tau, tau * _CAP, costs))
    formed = costs[rows, columns] <= tau
    return rows[formed], columns[formed]


def _of_kind(kind: int, anchors: Side, detections: Side, tau: float, cost: Cost) -> Pairs:
    rows, columns = (np.flatnonzero(side.kinds == kind) for side in (anchors, detections))
    row, column = cheapest(anchors.only(rows), detections.only(columns), tau, cost)
    return rows[row], columns[column]


def _cheapest_near(near: Pairs, anchors: Side, detections: Side, tau: float, cost: Cost) -> Pairs:
    rows, columns = near
    # Of whole rows `take` is faster than an index, many times.
    costs = cost.pairs(
        anchors.features.take(rows, axis=0), detections.features.take(columns, axis=0)
    )
    allowed = costs <= tau
    kind = anchors.kinds[0]
    if (anchors.kinds != kind).any() or (detections.kinds != kind).any():
        allowed &= anchors.kinds[rows] == detections.kinds[columns]
    if not allowed.all():
        rows, columns, costs = rows[allowed], columns[allowed], costs[allowed]
    cap = tau * _CAP
    offers = Offers(rows, columns, cap - costs, (len(anchors.kinds), len(detections.kinds)), cap)
    column_of = best_matching(offers)
    if column_of is None:
        return _by_sparse_solver(offers)
    formed = np.flatnonzero(column_of >= 0)
    return formed, column_of[formed]


def _by_sparse_solver(offers: Offers) -> Pairs:
    from scipy.sparse import coo_array  # noqa: PLC0415 - as above
    from scipy.sparse.csgraph import min_weight_full_bipartite_matching  # noqa: PLC0415

    count, width = offers.shape
    # Each row has a column of its own to stay alone in. The solver takes a weight of 0 for no
    # edge at all, so that all are shifted alike, which changes no optimum.
    alone = np.arange(count)
    weights = np.concatenate([2 * offers.most - offers.gains, np.full(count, 2 * offers.most)])
    places = (
        np.concatenate([offers.rows, alone]),
        np.concatenate([offers.columns, width + alone]),
    )
    graph = coo_array((weights, places), shape=(count, width + count))
    rows, columns = min_weight_full_bipartite_matching(graph.tocsr())
    formed = columns < width
    return rows[formed].astype(np.int64), columns[formed].astype(np.int64)


def _none() -> Pairs:
    return np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64)
