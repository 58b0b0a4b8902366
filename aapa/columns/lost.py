"""The reasoning about lost anchors, over columns: without attachments, in the image.

The hypotheses and their order are those of `aapa.hypotheses`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from aapa.boxes import reach_out
from aapa.columns.anchors import Objects
from aapa.columns.rounding import rounded_each
from aapa.costs import Rows
from aapa.occluders import first_overlapping
from aapa.reasons import Why
from aapa.view import View


class Lost(NamedTuple):
    """The anchors of the last frame that no detection was aligned with, sorted by name.

    Args:
        names: (n) their symbols.
        boxes: (n, 4) where they were, px.
        confidences: (n) what they were.
        streaks: (n) for how many frames in a row each had been seen, or, below 0, missed.
    """

    names: Objects
    boxes: Rows
    confidences: NDArray[np.float64]
    streaks: NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class Explained:
    """What became of them, in their order.

    Args:
        confidences: (n) what is left; below 0 where an anchor is given up.
        streaks: (n) below 0, for how many frames in a row each has been missed.
        whys: (n) numbers of `Why`.
        occluders: (n) the name of what stands in front, or None.
    """

    confidences: NDArray[np.float64]
    streaks: NDArray[np.int64]
    whys: NDArray[np.int8]
    occluders: Objects


def explained(lost: Lost, seen: tuple[Objects, Rows], view: View) -> Explained:
    """Find the hypothesis for each lost anchor, and what follows from it.

    Args:
        lost: The anchors, which nothing is attached to, nor they to anything.
        seen: Names and (m, 4) boxes of the anchors with a detection, sorted by name.
        view: The image of this frame, in which nothing is known of depth.
    """
    parameters = view.parameters
    count = len(lost.names)
    weak = lost.confidences < parameters.min_anchor_confidence
    whys = np.where(weak, Why.SEEN_TOO_LITTLE, Why.UNEXPLAINED).astype(np.int8)
    occluders = np.full(count, None, dtype=object)
    pending = np.flatnonzero(~weak)
    kept = _out_of_view(pending, lost.boxes, view, whys)
    names, boxes = seen
    while len(pending):
        asked = pending[~kept]
        first = first_overlapping(boxes, lost.boxes[asked], parameters.margin_px)
        hidden = first >= 0
        whys[asked[hidden]] = Why.OCCLUDED
        occluders[asked[hidden]] = names[first[hidden]]
        kept[~kept] = hidden
        found, pending = pending[kept], pending[~kept]
        if not len(found):
            break
        # The next round asks only about what this one has added: the rest has been asked.
        names, boxes = lost.names[found], lost.boxes[found]
        kept = np.zeros(len(pending), dtype=np.bool_)
    missing = (whys == Why.SEEN_TOO_LITTLE) | (whys == Why.UNEXPLAINED)
    confidences = lost.confidences.copy()
    confidences[missing] = rounded_each(confidences[missing] - parameters.confidence_loss)
    return Explained(confidences, np.minimum(lost.streaks, 0) - 1, whys, occluders)


def _out_of_view(
    pending: NDArray[np.int64], boxes: Rows, view: View, whys: NDArray[np.int8]
) -> NDArray[np.bool_]:
    """Tell of each pending anchor whether the camera cannot see it, and note why."""
    size = view.image_size
    if size is None:
        return np.zeros(len(pending), dtype=np.bool_)
    places = boxes[pending]
    out = reach_out(places, size, view.parameters.margin_px)
    wholly = (
        (places[:, 2] <= 0)
        | (places[:, 3] <= 0)
        | (places[:, 0] >= size[0])
        | (places[:, 1] >= size[1])
    )
    whys[pending[out]] = np.where(wholly[out], Why.OUTSIDE, Why.REACHES_OUT)
    return out
