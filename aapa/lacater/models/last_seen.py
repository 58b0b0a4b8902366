"""The simplest model: a hidden snitch is where it was seen last."""

from __future__ import annotations

import numpy as np

from aapa.detections import Box
from aapa.lacater.classes import SNITCH
from aapa.lacater.models.model import Frame


class LastSeen:
    """Holds the last box of the snitch."""

    def __init__(self) -> None:
        self._box: Box | None = None

    def observe(self, frame: Frame) -> Box | None:
        """Take in one frame, and give the snitch's last box, px; None until it has been seen."""
        self._box = snitch_box(frame) or self._box
        return self._box


def snitch_box(frame: Frame) -> Box | None:
    """Give the surest detection of the snitch in a frame, px, or None without one."""
    found = np.flatnonzero(frame.classes == SNITCH)
    if not len(found):
        return None
    x1, y1, x2, y2 = frame.boxes[found[0]].tolist()
    return float(x1), float(y1), float(x2), float(y2)
