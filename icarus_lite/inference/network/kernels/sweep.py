"""Which pairs can be close enough: objects put into the cells of a grid.

Where a rule bounds the distance of two objects along an axis, only neighbours need be tested. The
axes along which the objects spread widest, compared with what is near, are cut into strips at
least as wide as the bound: one axis or two, so that each object meets those in 3 strips or 9 cells.
Sorted by cell, the objects of three cells in a row are one stretch, found by a table of where cells
begin (cell lists: Allen and Tildesley 1987, sec. 5.3).
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from icarus_lite.inference.network.kernels.columns import Numbers
from icarus_lite.records import dataclass

Slots = NDArray[np.intp]

_WIDER = 1 + 1e-6  # strips a little wider than the bound, whatever the rounding of the division
_SLACK = 1e-150  # where the square of a difference underflows, the difference is not yet zero
_FINEST = 250.0  # strips along one of two axes: 252**2 cells have 16-bit numbers, sorted fast


@dataclass(frozen=True, slots=True)
class Stretch:
    """The places of both sides on one axis, and how far apart a pair may be.

    Args:
        left: (n_left,) places.
        right: (n_right,) places; the very same array where the sides are one.
        reach: The greatest distance along this axis.
    """

    left: Numbers
    right: Numbers
    reach: float


@dataclass(frozen=True, slots=True)
class _Cut:
    """How an axis would be cut: where it begins and how far it goes, and into how many strips."""

    axis: Stretch
    low: float
    extent: float
    count: float

    def strips(self, finest: float) -> tuple[Slots, Slots, int]:
        """Give the strip of each left and each right object, from 1 on, and how many there are."""
        axis = self.axis
        width = max(axis.reach * _WIDER + _SLACK, self.extent / finest)
        right = ((axis.right - self.low) / width).astype(np.intp) + 1
        left = right
        if axis.left is not axis.right:
            left = ((axis.left - self.low) / width).astype(np.intp) + 1
        return left, right, int(self.extent / width) + 1


def candidates(
    axes: Sequence[Stretch], few: int, *, mirrored: bool = False
) -> tuple[Slots, Slots] | None:
    """Give all pairs that may be within reach along every axis, as two arrays of places.

    Args:
        axes: The axes that are bounded, over objects of which both sides have at least one.
        few: Not worth it unless the strips along the best axis are at least so many.
        mirrored: Both sides are the same objects, and of two pairs that mirror one another one
            will do; an object is then paired with itself as well.

    Returns:
        The places of the left and the right objects of the pairs, each pair once; None where the
        objects are too close together for strips to help.
    """
    cuts = sorted(map(_cut, axes), key=lambda cut: -cut.count)
    if not cuts or cuts[0].count < few:
        return None
    objects = len(axes[0].left) + len(axes[0].right)
    if len(cuts) == 1 or cuts[1].count < few:
        left, right, count = cuts[0].strips(4.0 * objects)
        return _neighbours((left, right), count + 2, 0, mirrored=mirrored)
    # About as many cells as objects: more of them would cost more to lay out than they save.
    finest = min(_FINEST, max(float(few), 1.5 * math.sqrt(objects)))
    left, right, rows = cuts[0].strips(finest)
    left_across, right_across, columns = cuts[1].strips(finest)
    width = columns + 2
    cells = left * width + left_across, right * width + right_across
    return _neighbours(cells, (rows + 2) * width, width, mirrored=mirrored)


def _cut(axis: Stretch) -> _Cut:
    low, high = float(axis.right.min()), float(axis.right.max())
    if axis.left is not axis.right:
        low, high = min(low, float(axis.left.min())), max(high, float(axis.left.max()))
    extent = high - low
    return _Cut(axis, low, extent, extent / (axis.reach * _WIDER + _SLACK))


def _neighbours(
    cells: tuple[Slots, Slots], count: int, width: int, *, mirrored: bool
) -> tuple[Slots, Slots]:
    """Pair each left object with the right ones in the cells beside its own.

    Args:
        cells: The cell of each left and each right object, none on the edge of the grid.
        count: How many cells there are.
        width: How many cells a row has; 0 where there is one row only.
        mirrored: See `candidates`; both arrays of cells are then the same.
    """
    left, right = cells
    small = right.astype(np.uint16) if count < 65536 else right
    order = np.argsort(small, kind="stable")
    begins = np.zeros(count + 3, dtype=np.intp)
    np.cumsum(np.bincount(right, minlength=count + 2), out=begins[1:])
    if mirrored:
        # In the order of cells each object is paired with itself and what follows: the rest of its
        # own cell, the next cell, and three cells of the next row.
        left = left[order]
        first = [np.arange(len(left), dtype=np.intp)]
        rows = [left]
        if width:
            rows.append(left + width)
            first.append(begins[rows[1] - 1])
        own = order
    else:
        rows = [left - width, left, left + width] if width else [left]
        first = [begins[row - 1] for row in rows]
        own = np.arange(len(left), dtype=np.intp)
    begin, end = np.concatenate(first), begins[np.concatenate(rows) + 2]
    counts = end - begin
    skipped = begin - (np.cumsum(counts) - counts)
    places = np.arange(int(counts.sum()), dtype=np.intp) + np.repeat(skipped, counts)
    return np.repeat(np.tile(own, len(rows)), counts), order[places]
