"""The alignment of a frame with hundreds of objects: as columns of numbers, not one by one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from aapa.anchors import Anchor
from aapa.assignment import LARGEST_FULL, Side, cheapest
from aapa.boxes import box_rows
from aapa.costs import CENTRE, Rows
from aapa.detections import Detection
from aapa.parameters import Space
from aapa.singles import Aligned


def are_many(anchors: Sequence[Anchor], detections: Sequence[Detection]) -> bool:
    """Tell whether aligning them as a crowd is worth while."""
    return len(anchors) * len(detections) > LARGEST_FULL


def align_crowd(
    anchors: Sequence[Anchor], detections: Sequence[Detection], tau: float, space: Space
) -> Aligned:
    """Match detections to anchors of the same type at least total squared centre distance.

    Args:
        anchors: As they were in the last frame, at least one.
        detections: Of this one, at least one.
        tau: The largest squared distance of the centres, px² or m².
        space: In which the centres are.
    """
    types = {anchor.type for anchor in anchors}.union([each.type for each in detections])
    codes = {name: code for code, name in enumerate(sorted(types))}
    old, new = _side(anchors, codes, space), _side(detections, codes, space)
    order = _order(new, detections)
    rows, places = cheapest(old, new.only(order), tau, CENTRE)
    columns: NDArray[np.int64] = order[places]
    squares = CENTRE.pairs(old.centres[rows], new.centres[columns])
    pairs = zip(
        [anchors[row] for row in rows.tolist()],
        [detections[column] for column in columns.tolist()],
        squares.tolist(),
        strict=True,
    )
    lost = [anchors[row] for row in _others(len(anchors), rows)]
    appeared = [detections[column] for column in _others(len(detections), columns)]
    return Aligned(pairs, lost, appeared)


def _others(count: int, taken: NDArray[np.int64]) -> list[int]:
    """Give the numbers below a count that are not taken, ascending."""
    left = np.ones(count, dtype=np.bool_)
    left[taken] = False
    others: list[int] = left.nonzero()[0].tolist()
    return others


def _side(things: Sequence[Anchor | Detection], codes: Mapping[str, int], space: Space) -> Side:
    kinds = np.zeros(len(things), dtype=np.int64)
    if len(codes) > 1:
        kinds[:] = [codes[thing.type] for thing in things]
    if space == "base":
        # Base space has positions everywhere: the detections were checked for them.
        centres: Rows = np.array([thing.position for thing in things], dtype=np.float64)
    else:
        boxes = box_rows([thing.box for thing in things])
        centres = (boxes[:, :2] + boxes[:, 2:]) / 2
    return Side(kinds, centres, centres)


def _order(side: Side, detections: Sequence[Detection]) -> NDArray[np.int64]:
    """Give an order to align in, in which even ties do not depend on the detector's."""
    by_x = np.argsort(side.centres[:, 0])
    x = side.centres[by_x, 0]
    if (x[1:] > x[:-1]).all():
        return by_x
    scores = [detection.score for detection in detections]
    sizes = [detection.box[2] - detection.box[0] for detection in detections]
    return np.lexsort((scores, sizes, *side.centres.T[::-1], side.kinds))
