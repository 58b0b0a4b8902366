"""What could hide an object: among many things, those whose boxes overlap its own."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from aapa.anchors import Anchor
from aapa.boxes import overlaps
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
        self._boxes: NDArray[np.float64] | None = None
        if len(things) >= _MANY:
            self._boxes = np.array([thing.box for thing in things], dtype=np.float64)

    def __bool__(self) -> bool:
        return bool(self._things)

    def first_hiding(self, anchor: Anchor) -> str | None:
        """Give the name of the first thing that hides an anchor, or None if nothing does."""
        behind = (anchor.box, anchor.position)
        for other in self._near(anchor):
            if self._view.hides((other.box, other.position), behind):
                return other.name
        return None

    def _near(self, anchor: Anchor) -> Sequence[Anchor]:
        if self._boxes is None:
            return self._things
        margin = self._view.parameters.margin_px
        found = np.flatnonzero(overlaps(self._boxes, anchor.box, margin))
        return [self._things[index] for index in found.tolist()]
