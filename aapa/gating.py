"""The assignment problem with many objects: only pairs that are near enough are looked at.

A dense cost matrix of 5,000 by 5,000 takes a second to solve. Here the pairs within reach come
from a k-d tree; those that must belong to the optimum are taken; what is left is solved, densely
where it is little, as a sparse problem where it is much. The result is the same optimum.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from aapa.costs import Cost, Rows

_CAP = 1 + 1e-9
"""An object that stays alone costs a hair more than tau: a pair at exactly tau is formed."""

_DENSE_SIDE = 150

_SAMPLES = 16
_CROWD = 0.1
"""Share of all pairs that is near. Beyond, listing the pairs costs more than a full matrix."""

Pairs = NDArray[np.int64]
"""(k, 2) rows and columns."""


def cheapest_near_pairs(
    centres: tuple[Rows, Rows], features: tuple[Rows, Rows], tau: float, cost: Cost
) -> list[tuple[int, int]]:
    """Give the pairs of the capped optimum among many anchors and detections of one type.

    Args:
        centres: (n, d) of the anchors, and (m, d) of the detections.
        features: What the cost looks at, (n, f) and (m, f).
        tau: Pairs that cost more are not formed; each anchor that stays alone costs this.
        cost: One with a reach.
    """
    assert cost.reach is not None
    reach = cost.reach(tau) * _CAP
    if _are_crowded(centres, reach):
        costs = cost.pairs(features[0][:, None], features[1][None])
        return [(row, column) for row, column in cheapest_of_all(costs, tau).tolist()]
    rows, columns, costs = _within_reach(centres, features, tau, cost, reach)
    certain = _certain(rows, columns, costs, tau)
    pairs = np.stack([rows[certain], columns[certain]], axis=1)
    left = ~np.isin(rows, rows[certain]) & ~np.isin(columns, columns[certain])
    if left.any():
        solved = _solved(rows[left], columns[left], costs[left], tau)
        pairs = np.concatenate([pairs, solved])
    return [(row, column) for row, column in pairs.tolist()]


def cheapest_of_all(costs: NDArray[np.float64], tau: float) -> Pairs:
    """Give the pairs of the capped optimum, looking at all of them.

    Args:
        costs: (n, m) of each pair; infinite where there can be none.
        tau: Pairs that cost more are not formed; each anchor that stays alone costs this.
    """
    from scipy.optimize import linear_sum_assignment  # noqa: PLC0415 - a third of a second to load

    rows, columns = linear_sum_assignment(np.where(costs > tau, tau * _CAP, costs))
    formed = costs[rows, columns] <= tau
    return np.stack([rows[formed], columns[formed]], axis=1).astype(np.int64)


def _are_crowded(centres: tuple[Rows, Rows], reach: float) -> bool:
    """Tell from a sample whether much of everything is near much of everything."""
    anchors, detections = centres
    sample = anchors[:: max(1, len(anchors) // _SAMPLES)]
    offsets = sample[:, None] - detections[None]
    return float((np.einsum("...k,...k->...", offsets, offsets) <= reach**2).mean()) > _CROWD


def _within_reach(
    centres: tuple[Rows, Rows],
    features: tuple[Rows, Rows],
    tau: float,
    cost: Cost,
    reach: float,
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]:
    from scipy.spatial import cKDTree  # noqa: PLC0415 - as above

    trees = [cKDTree(side) for side in centres]
    near = trees[0].sparse_distance_matrix(trees[1], reach, output_type="ndarray")
    rows, columns = near["i"].astype(np.int64), near["j"].astype(np.int64)
    # In an order of its own: the tree's depends on where things are.
    order = np.lexsort((columns, rows))
    rows, columns = rows[order], columns[order]
    costs = cost.pairs(features[0][rows], features[1][columns])
    allowed = costs <= tau
    return rows[allowed], columns[allowed], costs[allowed]


def _certain(
    rows: NDArray[np.int64],
    columns: NDArray[np.int64],
    costs: NDArray[np.float64],
    tau: float,
) -> NDArray[np.bool_]:
    """Tell which pairs belong to an optimum whatever the others do.

    Let a pair be the cheapest of both its sides. If in some optimum both sides were paired
    otherwise, for at least the second cheapest of each, one could pair them with each other
    and leave one of the two others alone for tau. Where that costs no more, the pair is safe.
    """
    best_of_row, next_of_row = _two_cheapest(rows, costs)
    best_of_column, next_of_column = _two_cheapest(columns, costs)
    # With the hair, so that two pairs at exactly tau are not given up for one.
    safe = costs + tau * _CAP <= next_of_row[rows] + next_of_column[columns]
    chosen = safe & (costs <= best_of_row[rows]) & (costs <= best_of_column[columns])
    # Of pairs that cost the same, the first of a row and of a column.
    chosen[np.flatnonzero(chosen)[~_first(rows[chosen])]] = False
    chosen[np.flatnonzero(chosen)[~_first(columns[chosen])]] = False
    return chosen


def _two_cheapest(
    sides: NDArray[np.int64], costs: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Give the cheapest and the second cheapest cost of each row (or column); ∞ if none."""
    count = int(sides.max()) + 1 if len(sides) else 0
    best, second = np.full(count, np.inf), np.full(count, np.inf)
    np.minimum.at(best, sides, costs)
    dearer = costs > best[sides]
    np.minimum.at(second, sides[dearer], costs[dearer])
    tied = np.bincount(sides[~dearer], minlength=count) > 1
    second[tied] = best[tied]
    return best, second


def _first(values: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Tell where a value occurs for the first time."""
    first = np.zeros(len(values), dtype=np.bool_)
    first[np.unique(values, return_index=True)[1]] = True
    return first


def _solved(
    rows: NDArray[np.int64],
    columns: NDArray[np.int64],
    costs: NDArray[np.float64],
    tau: float,
) -> Pairs:
    """Give the optimum of what is left."""
    row_names, row = np.unique(rows, return_inverse=True)
    column_names, column = np.unique(columns, return_inverse=True)
    if max(len(row_names), len(column_names)) <= _DENSE_SIDE:
        matched = _dense(row, column, costs, (len(row_names), len(column_names)), tau)
    else:
        matched = _sparse(row, column, costs, (len(row_names), len(column_names)), tau)
    return np.stack([row_names[matched[:, 0]], column_names[matched[:, 1]]], axis=1)


def _dense(
    row: NDArray[np.int64],
    column: NDArray[np.int64],
    costs: NDArray[np.float64],
    shape: tuple[int, int],
    tau: float,
) -> Pairs:
    matrix = np.full(shape, np.inf)
    matrix[row, column] = costs
    return cheapest_of_all(matrix, tau)


def _sparse(
    row: NDArray[np.int64],
    column: NDArray[np.int64],
    costs: NDArray[np.float64],
    shape: tuple[int, int],
    tau: float,
) -> Pairs:
    from scipy.sparse import coo_array  # noqa: PLC0415 - as above
    from scipy.sparse.csgraph import min_weight_full_bipartite_matching  # noqa: PLC0415

    count, width = shape
    # Each row has a column of its own to stay alone in. The solver takes a weight of 0 for no
    # edge at all, so that all are shifted alike, which changes no optimum.
    alone = np.arange(count)
    weights = np.concatenate([costs, np.full(count, tau * _CAP)]) + tau
    graph = coo_array(
        (
            weights,
            (np.concatenate([row, alone]), np.concatenate([column, width + alone])),
        ),
        shape=(count, width + count),
    )
    rows_, columns_ = min_weight_full_bipartite_matching(graph.tocsr())
    found: Pairs = np.stack([rows_, columns_], axis=1).astype(np.int64)
    return found[found[:, 1] < width]
