"""What can hide the snitch, and how far it can go without being seen.

What is not seen is behind something that is nearer and larger. Where it is thought to have gone
on, beyond all that could hide it, it stopped before, or another way: it is put back the shortest
way behind what hides it.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from aapa.boxes import moved
from aapa.detections import Box

STICKS_OUT: Final = 0.25
"""Hidden things stick out behind what hides them by this share of their own side at most: with
more of them free they would be seen."""

_FARTHEST_PX: Final = 30.0
_NEARER_PX: Final = 15.0


def behind(box: Box, occluders: Iterable[Box]) -> Box | None:
    """Give the nearest place for a box that is not seen at which one of the occluders hides it.

    Args:
        box: Where it is thought to be, px.
        occluders: The boxes of what is seen, px.

    Returns:
        The box itself where it is hidden already; None where nothing near could hide it.

    Example:
        >>> behind((30.0, 10.0, 40.0, 20.0), [(0.0, 0.0, 35.0, 35.0)])
        (27.5, 10.0, 37.5, 20.0)
    """
    wide, tall = box[2] - box[0], box[3] - box[1]
    least, shift = _FARTHEST_PX, None
    for x1, y1, x2, y2 in occluders:
        spare_x, spare_y = x2 - x1 - wide, y2 - y1 - tall
        if spare_x * (y2 - y1) + wide * spare_y <= 0 or y2 < box[3] - _NEARER_PX:
            continue  # Smaller than the box, or farther away.
        across = _inside(box[0], x1, x1 + spare_x, STICKS_OUT * wide)
        down = _inside(box[1], y1, y1 + spare_y, STICKS_OUT * tall)
        if across is None or down is None:
            continue
        far = (across * across + down * down) ** 0.5
        if far < least:
            least, shift = far, (across, down)
    return None if shift is None else moved(box, *shift)


def _inside(low: float, first: float, last: float, out: float) -> float | None:
    """Give by how much a value has to be moved to lie between two; None if they leave no room."""
    first, last = first - out, last + out
    if first > last:
        return None
    return min(max(low, first), last) - low
