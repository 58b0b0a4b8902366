"""The closest-object heuristic: a hidden snitch goes where the thing nearest to it goes.

Source: Shamsian et al. 2020 (the programmed baseline of the published code); Liang et al. 2021
call it the heuristic model.
"""

from __future__ import annotations

from typing import NamedTuple

from aapa.detections import Box
from aapa.lacater.classes import LARGE_CONES, SNITCH
from aapa.lacater.models.model import Frame

_LARGE_CONE_DROP = 15
"""Px by which the snitch is taken to lie below the middle of a large cone."""


class _Centre(NamedTuple):
    x: int
    y: int


class ClosestObject:
    """Tracks one class of object at a time: the snitch, or what is thought to hide it."""

    def __init__(self) -> None:
        self._tracked = SNITCH
        self._centre = _Centre(0, 0)
        self._size: tuple[int, int] | None = None
        self._hidden: list[int] = []
        self._box: Box | None = None

    def observe(self, frame: Frame) -> Box | None:
        """Take in one frame, and give the snitch's box, px; None until it has been seen."""
        boxes: dict[int, list[int]] = {}
        for number, box in zip(frame.classes.tolist(), frame.boxes.tolist(), strict=True):
            boxes.setdefault(number, box)  # only the surest of each class counts
        if SNITCH in boxes:
            self._see(boxes[SNITCH])
        elif self._size is not None and boxes:
            self._follow({number: _centre(box) for number, box in boxes.items()})
            self._box = self._around()
        return self._box

    def _see(self, box: list[int]) -> None:
        x1, y1, x2, y2 = box
        self._tracked, self._centre, self._size = SNITCH, _centre(box), (x2 - x1, y2 - y1)
        self._hidden.clear()
        self._box = float(x1), float(y1), float(x2), float(y2)

    def _follow(self, centres: dict[int, _Centre]) -> None:
        if self._tracked not in centres:
            self._hidden.append(self._tracked)
            self._tracked = min(centres, key=lambda number: self._distance(centres[number]))
        elif self._hidden and self._hidden[-1] in centres:
            self._tracked = self._hidden.pop()
        self._centre = centres[self._tracked]

    def _distance(self, centre: _Centre) -> int:
        return (centre.x - self._centre.x) ** 2 + (centre.y - self._centre.y) ** 2

    def _around(self) -> Box | None:
        """Give the snitch's last size around what is tracked."""
        if self._size is None:
            return None
        width, height = self._size
        drop = _LARGE_CONE_DROP if self._tracked in LARGE_CONES else 0
        x1 = self._centre.x - width // 2
        y1 = self._centre.y + drop - height // 2
        return float(x1), float(y1), float(x1 + width), float(y1 + height)


def _centre(box: list[int]) -> _Centre:
    return _Centre((box[0] + box[2]) // 2, (box[1] + box[3]) // 2)
