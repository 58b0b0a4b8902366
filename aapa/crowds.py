"""The alignment of a frame with hundreds of objects: as columns of numbers, not one by one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence, Sized

import numpy as np
from numpy.typing import ArrayLike, NDArray

from aapa.anchors import Anchor
from aapa.assignment import LARGEST_FULL, Side, cheapest
from aapa.boxes import box_rows
from aapa.columns.detections import DetectionColumns
from aapa.costs import CENTRE, Rows
from aapa.detections import Detection
from aapa.parameters import Space
from aapa.singles import Aligned


def are_many(anchors: Sized, detections: Sized) -> bool:
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
    old, new = _sides(anchors, detections, space)
    rows, columns, squares = matched(old, new, detections, tau)
    pairs = zip(
        [anchors[row] for row in rows.tolist()],
        [detections[column] for column in columns.tolist()],
        squares.tolist(),
        strict=True,
    )
    lost = [anchors[row] for row in others(len(anchors), rows)]
    appeared = [detections[column] for column in others(len(detections), columns)]
    return Aligned(pairs, lost, appeared)


def matched(
    old: Side, new: Side, detections: Sequence[Detection] | DetectionColumns, tau: float
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]:
    """Give the pairs of least total squared centre distance.

    Args:
        old: The anchors.
        new: The detections.
        detections: The same, to be put into an order.
        tau: The largest squared distance, px² or m².

    Returns:
        (k) anchors, ascending, (k) detections, and (k) their squared distances.
    """
    order = _order(new, detections)
    rows, places = cheapest(old, new.only(order), tau, CENTRE)
    columns: NDArray[np.int64] = order[places]
    ends = old.centres.take(rows, axis=0), new.centres.take(columns, axis=0)
    return rows, columns, CENTRE.pairs(*ends)


def others(count: int, taken: NDArray[np.int64]) -> list[int]:
    """Give the numbers below a count that are not taken, ascending."""
    left = np.ones(count, dtype=np.bool_)
    left[taken] = False
    numbers: list[int] = left.nonzero()[0].tolist()
    return numbers


def kinds_of(
    old: Sequence[str], new: Sequence[str]
) -> tuple[NDArray[np.int64], NDArray[np.int64]] | None:
    """Give numbers for the types of both sides; None if no type occurs twice on either."""
    types = set(old), set(new)
    if len(types[0]) == len(old) and len(types[1]) == len(new):
        return None
    codes = {name: code for code, name in enumerate(sorted(types[0] | types[1]))}
    return _numbered(old, codes), _numbered(new, codes)


def side_of_boxes(kinds: NDArray[np.int64], boxes: Rows) -> Side:
    """Give a side of which the centres of (n, 4) boxes are compared, px."""
    centres: Rows = (boxes[:, :2] + boxes[:, 2:]) / 2
    return Side(kinds, centres, centres)


def _numbered(types: Sequence[str], codes: Mapping[str, int]) -> NDArray[np.int64]:
    if len(codes) == 1:
        return np.zeros(len(types), dtype=np.int64)
    return np.array(list(map(codes.__getitem__, types)), dtype=np.int64)


def _sides(
    anchors: Sequence[Anchor], detections: Sequence[Detection], space: Space
) -> tuple[Side, Side]:
    types = [anchor.type for anchor in anchors], [each.type for each in detections]
    codes = {name: code for code, name in enumerate(sorted({*types[0], *types[1]}))}
    return (
        _side(_numbered(types[0], codes), anchors, space),
        _side(_numbered(types[1], codes), detections, space),
    )


def _side(
    kinds: NDArray[np.int64], things: Sequence[Anchor] | Sequence[Detection], space: Space
) -> Side:
    if space == "image":
        return side_of_boxes(kinds, box_rows([thing.box for thing in things]))
    # Base space has positions everywhere: the detections were checked for them.
    centres: Rows = np.array([thing.position for thing in things], dtype=np.float64)
    return Side(kinds, centres, centres)


def _order(side: Side, detections: Sequence[Detection] | DetectionColumns) -> NDArray[np.int64]:
    """Give an order to align in, in which even ties do not depend on the detector's."""
    by_x = np.argsort(side.centres[:, 0])
    x = side.centres[by_x, 0]
    if (x[1:] > x[:-1]).all():
        return by_x
    scores, widths = _scores_and_widths(detections)
    return np.lexsort((scores, widths, *side.centres.T[::-1], side.kinds))


def _scores_and_widths(
    detections: Sequence[Detection] | DetectionColumns,
) -> tuple[ArrayLike, ArrayLike]:
    if isinstance(detections, DetectionColumns):
        return detections.scores, detections.boxes[:, 2] - detections.boxes[:, 0]
    return (
        [detection.score for detection in detections],
        [detection.box[2] - detection.box[0] for detection in detections],
    )
