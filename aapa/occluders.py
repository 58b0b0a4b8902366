"""What could hide an object: among many things, those whose boxes overlap its own."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from aapa.anchors import Anchor
from aapa.boxes import box_rows, overlaps
from aapa.view import View

_MANY = 24
"""From here on it is faster to ask all boxes at once than one after the other."""


class Occluders:
    """Things in front, to be asked which of them hides something.

    Args:
        things: In the order in which they are asked.
        view: The image of this frame.
    """

    def __init__(self, things: Sequence[Anchor], view: View) -> None:
        self._things = things
        self._view = view

    def __bool__(self) -> bool:
        return bool(self._things)

    def first_hiding(self, anchor: Anchor) -> str | None:
        """Give the name of the first thing that hides an anchor, or None if nothing does."""
        return self._first(anchor, self._things)

    def first_hiding_each(self, anchors: Sequence[Anchor]) -> list[str | None]:
        """Give for each of some anchors the name of the first thing that hides it, or None."""
        if len(self._things) < _MANY or not anchors:
            return [self._first(anchor, self._things) for anchor in anchors]
        behind, number = self._overlapping(anchors)
        hiding: list[str | None] = [None] * len(anchors)
        for row, index in zip(behind.tolist(), number.tolist(), strict=True):
            if hiding[row] is None:
                hiding[row] = self._first(anchors[row], self._things[index : index + 1])
        return hiding

    def _first(self, anchor: Anchor, things: Sequence[Anchor]) -> str | None:
        view = self._view
        if view.is_flat:
            # `overlap`, written out: it is asked of every thing that may stand in front.
            x1, y1, x2, y2 = anchor.box
            if not (x2 > x1 and y2 > y1):
                return None
            margin = view.parameters.margin_px
            right, bottom = x2 + margin, y2 + margin
            for other in things:
                a, b, c, d = other.box
                if (
                    a < right
                    and x1 < c + margin
                    and b < bottom
                    and y1 < d + margin
                    and c > a
                    and d > b
                ):
                    return other.name
            return None
        behind = (anchor.box, anchor.position)
        for other in things:
            if view.hides((other.box, other.position), behind):
                return other.name
        return None

    def _overlapping(
        self, anchors: Sequence[Anchor]
    ) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Give the numbers of anchors and of things whose boxes overlap, in ascending order."""
        margin = self._view.parameters.margin_px
        boxes = box_rows([thing.box for thing in self._things])
        asked = box_rows([anchor.box for anchor in anchors])
        return _overlapping(boxes, asked, margin)


def first_overlapping(
    things: NDArray[np.float64], asked: NDArray[np.float64], margin_px: float
) -> NDArray[np.int64]:
    """Give (m) the number of the first thing that overlaps each box, -1 where none does.

    Args:
        things: (n, 4) boxes, px, in the order in which they are asked.
        asked: (m, 4) boxes that may lie behind them, px.
        margin_px: Boxes closer than this overlap.
    """
    first = np.full(len(asked), -1, dtype=np.int64)
    if len(things) and len(asked):
        behind, number = _overlapping(things, asked, margin_px)
        # Backwards, so that of several the first one stays.
        first[behind[::-1]] = number[::-1]
    return first


def _overlapping(
    boxes: NDArray[np.float64], asked: NDArray[np.float64], margin: float
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Give the numbers of asked boxes, and of the others, that overlap, in ascending order."""
    # Along x only what begins neither behind a box's end, nor a whole box before it; and a
    # pixel more, so that rounding leaves nothing out that is then compared exactly.
    order = np.argsort(boxes[:, 0])
    begins = boxes[order, 0]
    widest = (boxes[:, 2] - boxes[:, 0]).max()
    first = np.searchsorted(begins, asked[:, 0] - margin - widest - 1, side="left")
    counts = np.searchsorted(begins, asked[:, 2] + margin + 1, side="right") - first
    ends = counts.cumsum()
    behind = np.arange(len(asked)).repeat(counts)
    number = order[(first - ends + counts).repeat(counts) + np.arange(ends[-1])]
    fronts = boxes.take(number, axis=0), asked.take(behind, axis=0)
    hiding = overlaps(*fronts, margin).nonzero()[0]
    behind, number = behind[hiding], number[hiding]
    sorted_ = np.lexsort((number, behind))
    return behind[sorted_], number[sorted_]
