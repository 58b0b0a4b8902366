"""Which pairs are near enough to be looked at, when there are too many to look at all.

Of 5,000 anchors and 5,000 detections, 25 million pairs could be formed, and a few ten thousand are
within reach. A grid of cells as wide as the reach finds them: whoever is within reach lies in the
same cell or in one of the eight around it.
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from aapa.costs import Rows

Pairs: TypeAlias = tuple[NDArray[np.int64], NDArray[np.int64]]
"""(k) rows, ascending, and (k) columns."""

_CELLS_EACH = 8
"""A table of more cells than this for each object would take longer than a tree."""

_ROOM = 1 + 1e-6
"""By how much cells are wider than the reach, so that rounding loses no pair at their borders."""

_SAMPLES = 16
_CROWD = 0.1
"""Share of all pairs that is near. Beyond, listing the pairs costs more than a full matrix."""

_AROUND = 9 / 3.14
"""By how much nine cells are larger than a circle as wide as the reach."""


def pairs_within(anchors: Rows, detections: Rows, reach: float) -> Pairs | None:
    """Give the pairs of which the centres are at most a distance apart, and some beyond it.

    Args:
        anchors: (n, d) centres, n above 0.
        detections: (m, d) centres, m above 0.
        reach: The distance, in the unit of the centres, above 0.

    Returns:
        None where so many are near that looking at all pairs is faster.
    """
    if anchors.shape[1] == 2:
        low = np.minimum(anchors.min(axis=0), detections.min(axis=0))
        high = np.maximum(anchors.max(axis=0), detections.max(axis=0))
        with np.errstate(over="ignore"):  # infinitely many are too many as well
            cells = np.floor((high - low) / (reach * _ROOM)) + 3
            count = cells.prod()
        if count <= _CELLS_EACH * (len(anchors) + len(detections)) + 1024:
            return _by_grid(anchors, detections, reach, low, int(cells[1]))
    sample = anchors[:: max(1, len(anchors) // _SAMPLES)]
    offsets = sample[:, None] - detections[None]
    if (np.einsum("...k,...k->...", offsets, offsets) <= reach**2).mean() > _CROWD:
        return None
    return _by_tree(anchors, detections, reach)


def _by_grid(anchors: Rows, detections: Rows, reach: float, low: Rows, high: int) -> Pairs | None:
    """Look a cell's neighbours up in a table.

    Args:
        anchors: (n, 2).
        detections: (m, 2).
        reach: The distance.
        low: (2) the corner of the grid.
        high: How many cells there are along y, an empty one at either end included.
    """
    count = len(anchors)
    scale = 1 / (reach * _ROOM)
    places = [((side - low) * scale).astype(np.int64) for side in (anchors, detections)]
    cells = [place[:, 0] * high + place[:, 1] for place in places]
    # Column by column, and in it from the bottom up: three neighbours follow one another.
    own, others = (cell + high + 1 for cell in cells)
    last = int(max(own.max(), others.max())) + high + 3
    # Numbers of two bytes are sorted many times as fast.
    order = np.argsort(others.astype(np.uint16) if last < 2**16 else others, kind="stable")
    begins = np.zeros(last, dtype=np.int64)
    np.cumsum(np.bincount(others, minlength=last - 1), out=begins[1:])
    lowest = (own[:, None] + np.array([-high - 1, -1, high - 1])).ravel()
    start = begins[lowest]
    counts = begins[lowest + 3] - start
    ends = np.cumsum(counts)
    if ends[-1] > _CROWD * _AROUND * count * len(detections):
        return None
    each = counts.reshape(-1, 3).sum(axis=1)
    numbers = np.repeat(start - (ends - counts), counts)
    numbers += np.arange(len(numbers))
    # Row by row the same anchor, so that it is repeated; the detections lie as the table has them.
    x, y = (
        first.repeat(each) - second[order].take(numbers)
        for first, second in zip(anchors.T, detections.T, strict=True)
    )
    x *= x
    y *= y
    x += y
    near = (x <= reach * reach * _ROOM).nonzero()[0]
    return np.arange(count).repeat(each)[near], order.take(numbers[near])


def _by_tree(anchors: Rows, detections: Rows, reach: float) -> Pairs:
    from scipy.spatial import cKDTree  # noqa: PLC0415 - a third of a second to load

    trees = [
        cKDTree(side, compact_nodes=False, balanced_tree=False) for side in (anchors, detections)
    ]
    near = trees[0].sparse_distance_matrix(trees[1], reach * _ROOM, output_type="ndarray")
    rows, columns = near["i"].astype(np.int64), near["j"].astype(np.int64)
    # In an order of its own: the tree's depends on where things are.
    order = np.lexsort((columns, rows))
    return rows[order], columns[order]
