"""How the snitch looks where it stands freely: larger than a ball by what its spikes add.

One box cut to whole px tells that to half a px at best. But the snitch looks much the same from
place to place, as large as its depth makes it, so that every new box is one more measurement; the
nearer, the more it counts, for it is seen from another side elsewhere.
"""

from __future__ import annotations

import math
from typing import Final

from aapa.detections import Box
from aapa.lacater.models.plus.ground import GroundView, Place
from aapa.lacater.models.plus.solids import SNITCH_SOLID

_Measured = tuple[Place, float, float]

_MOST: Final = 48
_WORST_PX: Final = 2.0
_ALIKE: Final = 0.7
_DOUBT: Final = 0.2
"""How many boxes the ball itself is worth."""


class Appearance:
    """The boxes in which the snitch was seen upon the floor, one for each place."""

    __slots__ = ("_boxes", "_measured", "_view")

    def __init__(self) -> None:
        self._boxes: list[Box] = []
        self._view: GroundView | None = None
        self._measured: dict[Box, _Measured | None] = {}

    def forget(self) -> None:
        """It has been turned, and may look different from now on."""
        self._boxes.clear()

    def add(self, box: Box, *, again: bool) -> None:
        """Take in a box, px.

        Args:
            box: As well as it is known.
            again: It stands where it stood: this is what is known of that place by now.
        """
        if again and self._boxes:
            self._measured.pop(self._boxes[-1], None)
            self._boxes[-1] = box
        elif not self._boxes or box != self._boxes[-1]:
            if len(self._boxes) == _MOST:
                del self._boxes[0]
            self._boxes.append(box)

    def more(self, view: GroundView, where: Place) -> tuple[float, float]:
        """Give how much farther than the ball it reaches to a side, and up and down.

        Args:
            view: The camera.
            where: The place at which it is asked for.

        Returns:
            In units of the scene, at its depth; 0 where it was never seen in full.
        """
        if view != self._view:
            self._view = view
            self._measured.clear()
        wide = tall = count = 0.0
        for box in self._boxes:
            if box not in self._measured:
                self._measured[box] = _measured(view, box)
            measured = self._measured[box]
            if measured is None:
                continue
            place, across, down = measured
            far = math.dist(place, where) / _ALIKE
            weight = 1.0 / (1.0 + far * far)
            wide, tall = wide + weight * across, tall + weight * down
            count += weight
        return wide / (count + _DOUBT), tall / (count + _DOUBT)


def _measured(view: GroundView, box: Box) -> _Measured | None:
    """Give where the ball stands that has a box, and how much farther the box reaches than it.

    None where that is no box of it upon the floor, seen in full.
    """
    place = view.place(SNITCH_SOLID, box) if min(view.free_edges(box)) else None
    if place is None:
        return None
    try:
        a, b, c, d = view.box(SNITCH_SOLID, place)
    except ValueError:
        return None
    across, down = (box[2] - box[0] - c + a) / 2, (box[3] - box[1] - d + b) / 2
    if max(abs(across), abs(down)) > _WORST_PX:
        return None  # Lifted off the floor, or half of it out of sight.
    scale = view.depth(place, SNITCH_SOLID.low) / view.focal
    return place, across * scale, down * scale
