"""The detections of a frame as columns."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain
from typing import cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from aapa.costs import Rows
from aapa.detections import Box, Detection
from aapa.errors import AnchoringError

LARGEST_COORDINATE = 1e9
"""px. What lies farther away is a mistake."""


class DetectionColumns:
    """What a detector reports in one frame, for detectors that report arrays.

    Args:
        types: (n) the detector's classes, or one for all of them.
        boxes: (n, 4) where they were seen, x1 y1 x2 y2 in px, origin at the top left.
        scores: (n) the detector's confidences in [0, 1]; 1 if left out.

    Raises:
        AnchoringError: The columns are of different lengths, or boxes or scores no numbers.
            What is wrong with a single detection is said by `Anchoring.update_columns`.

    Example:
        >>> found = DetectionColumns("cone", [[10, 10, 30, 40], [50, 10, 70, 40]])
        >>> len(found), found.objects()[1].box
        (2, (50.0, 10.0, 70.0, 40.0))
    """

    __slots__ = ("boxes", "scores", "tuples", "types")

    def __init__(
        self, types: str | Sequence[str], boxes: ArrayLike, scores: ArrayLike | None = None
    ) -> None:
        self.boxes: Rows = _array("boxes", boxes)
        if self.boxes.size == 0:
            self.boxes = self.boxes.reshape(0, 4)
        if self.boxes.ndim != 2 or self.boxes.shape[1] != 4:
            raise AnchoringError(
                f"the boxes have the shape {self.boxes.shape}; expected (n, 4): x1, y1, x2, y2"
            )
        count = len(self.boxes)
        self.tuples: Sequence[Box] | None = None
        """The boxes once more, where they came one by one."""
        self.types: Sequence[str] = [types] * count if isinstance(types, str) else list(types)
        self.scores: NDArray[np.float64] = (
            np.ones(count) if scores is None else _array("scores", scores)
        )
        if len(self.types) != count or self.scores.shape != (count,):
            raise AnchoringError(
                f"there are {count} boxes, {len(self.types)} types and scores of the shape "
                f"{self.scores.shape}; expected as many of each"
            )

    def __len__(self) -> int:
        return len(self.boxes)

    @property
    def are_sound(self) -> bool:
        """Whether all boxes, scores and types are what they have to be."""
        try:
            different = set(self.types)
        except TypeError:  # what has no hash is no name
            return False
        names = set(map(type, different)) <= {str} and "" not in different
        return names and _in_range(self.boxes, self.scores)

    def objects(self) -> list[Detection]:
        """Give the detections one by one."""
        return [
            Detection(type_, (x1, y1, x2, y2), score)
            for type_, (x1, y1, x2, y2), score in zip(
                self.types, self.boxes.tolist(), self.scores.tolist(), strict=True
            )
        ]


def columns_of(detections: Sequence[object]) -> DetectionColumns | None:
    """Give detections as columns; None if one is not as most are, or malformed.

    Most have nothing to convert, no position, no size and no name.

    Args:
        detections: Of one frame, at least one.
    """
    if set(map(type, detections)) != {Detection}:
        return None
    given = cast("Sequence[Detection]", detections)
    count = len(given)
    # One attribute after the other: each loop is short, and the interpreter specialises it.
    if any(d.position is not None or d.size is not None or d.name is not None for d in given):
        return None
    boxes = [detection.box for detection in given]
    scores = [detection.score for detection in given]
    if set(map(type, boxes)) != {tuple} or set(map(type, scores)) != {float}:
        return None
    if not _are_boxes(boxes):
        return None
    columns = DetectionColumns.__new__(DetectionColumns)
    columns.types = [detection.type for detection in given]
    numbers = np.fromiter(list(chain.from_iterable(boxes)), np.float64, 4 * count)
    columns.boxes = numbers.reshape(count, 4)
    columns.scores = np.fromiter(scores, np.float64, count)
    columns.tuples = boxes
    return columns if columns.are_sound else None


def _are_boxes(boxes: Sequence[Box]) -> bool:
    """Tell whether tuples are of four numbers, with nothing to convert."""
    try:
        odd = [
            0
            for x1, y1, x2, y2 in boxes
            if not (
                type(x1) is float and type(y1) is float and type(x2) is float and type(y2) is float
            )
        ]
    except ValueError:  # not of four
        return False
    return not odd


def _in_range(boxes: Rows, scores: NDArray[np.float64]) -> bool:
    # NaN fails every comparison.
    return bool(
        (boxes[:, :2] <= boxes[:, 2:]).all()
        and (boxes[:, :2] >= -LARGEST_COORDINATE).all()
        and (boxes[:, 2:] <= LARGEST_COORDINATE).all()
        and (scores >= 0.0).all()
        and (scores <= 1.0).all()
    )


def _array(what: str, values: ArrayLike) -> NDArray[np.float64]:
    """Give numbers as an array of one's own, which nobody changes later."""
    try:
        given = np.asarray(values)
    except ValueError:  # rows of different lengths
        given = np.array(None)
    if given.dtype.kind not in "fiu" and (given.size or given.dtype.kind != "O"):
        raise AnchoringError(f"the {what} are not all numbers, in rows of one length")
    # A copy, which nobody else changes.
    numbers = given.astype(np.float64)
    numbers.setflags(write=False)
    return numbers
