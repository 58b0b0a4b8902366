"""Whole px, as the published labels have them."""

from __future__ import annotations

from aapa.detections import Box


def rounded(box: Box) -> Box:
    """Round a box as labels are: the corner, and by themselves the width and the height.

    Example:
        >>> rounded((0.4, 0.6, 10.8, 10.8))
        (0, 1, 10, 11)
    """
    x, y = round(box[0]), round(box[1])
    return x, y, x + round(box[2] - box[0]), y + round(box[3] - box[1])
