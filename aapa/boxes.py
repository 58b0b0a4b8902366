"""Plane geometry of boxes, in px, x1 y1 x2 y2 with the origin at the top left."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain

import numpy as np
from numpy.typing import NDArray

from aapa.detections import Box


def centre_of(box: Box) -> tuple[float, float]:
    """Give the centre of a box, px."""
    return (box[0] + box[2]) / 2, (box[1] + box[3]) / 2


def moved(box: Box, dx: float, dy: float) -> Box:
    """Give a box shifted by dx, dy (px); its size stays."""
    return box[0] + dx, box[1] + dy, box[2] + dx, box[3] + dy


def centred(u: float, v: float, width: float, height: float) -> Box:
    """Give the box of a width and height around a centre, all px."""
    return u - width / 2, v - height / 2, u + width / 2, v + height / 2


def overlap(first: Box, second: Box, margin_px: float) -> bool:
    """Tell whether two boxes share area, or come closer than a margin (px) to it.

    A box without area hides nothing and overlaps nothing.
    """
    return (
        first[0] < second[2] + margin_px
        and second[0] < first[2] + margin_px
        and first[1] < second[3] + margin_px
        and second[1] < first[3] + margin_px
        and has_area(first)
        and has_area(second)
    )


def box_rows(boxes: Sequence[Box]) -> NDArray[np.float64]:
    """Give (n, 4) the boxes as an array; in a third of the time that numpy takes by itself."""
    numbers = np.fromiter(chain.from_iterable(boxes), np.float64, 4 * len(boxes))
    return numbers.reshape(-1, 4)


def overlaps(
    first: NDArray[np.float64], second: NDArray[np.float64], margin_px: float
) -> NDArray[np.bool_]:
    """Give (n,) which of many boxes (n, 4) `overlap` with those (n, 4) of the other side."""
    (a, b, c, d), (x1, y1, x2, y2) = first.T, second.T
    near: NDArray[np.bool_] = (
        (a < x2 + margin_px)
        & (x1 < c + margin_px)
        & (b < y2 + margin_px)
        & (y1 < d + margin_px)
        & (c > a)
        & (d > b)
        & (x2 > x1)
        & (y2 > y1)
    )
    return near


def has_area(box: Box) -> bool:
    """Tell whether a box covers anything at all."""
    return box[2] > box[0] and box[3] > box[1]


def reaches_out(box: Box, image_size: tuple[int, int], margin_px: float) -> bool:
    """Tell whether part of a box lies outside the image, or within a margin (px) of its border.

    Detectors clip boxes to the image, so that what leaves it was last seen touching the border.
    """
    width, height = image_size
    return (
        box[0] < margin_px
        or box[1] < margin_px
        or box[2] > width - margin_px
        or box[3] > height - margin_px
    )


def reach_out(
    boxes: NDArray[np.float64], image_size: tuple[int, int], margin_px: float
) -> NDArray[np.bool_]:
    """Give (n) which of (n, 4) boxes `reaches_out`."""
    width, height = image_size
    x1, y1, x2, y2 = boxes.T
    out: NDArray[np.bool_] = (
        (x1 < margin_px) | (y1 < margin_px) | (x2 > width - margin_px) | (y2 > height - margin_px)
    )
    return out
