"""What is remembered of one object: where it was seen, and its mean box while it rests."""

from __future__ import annotations

from collections.abc import Sequence

from aapa.detections import Box

_NEAR_AT_REST_PX = 12.0
_FASTEST_PX = 40.0
_AGREE_PX = 12.0
_CONVINCING = 3
_SETTLED = 4

STILL = (0.0, 0.0)
"""The pace of what does not move."""


class Thing:
    """One object that actions may name.

    Args:
        number: Its class.
    """

    __slots__ = (
        "_far",
        "_far_count",
        "_strays",
        "_sum",
        "free",
        "last",
        "missed",
        "moving",
        "number",
        "pace",
        "roaming",
        "seen",
    )

    def __init__(self, number: int) -> None:
        self.number = number
        self.last: Box | None = None
        """The last one seen, px."""
        self.moving = False
        """An action on it, or on what it stands in, is under way."""
        self.roaming = False
        """It is seen to move, though nothing has been reported."""
        self.free = True
        """It may be seen anywhere: nobody saw where it went."""
        self.missed = 0
        self.pace = STILL
        """By how many px its middle moved from one sighting to the next, the last time."""
        self.seen = 0
        """How often it was seen since it came to rest."""
        self._sum = [0.0, 0.0, 0.0, 0.0]
        self._far: Sequence[float] = ()
        self._far_count = 0
        self._strays = 0

    @property
    def mean(self) -> Box | None:
        """The mean of its boxes since it came to rest, px; the last one if there is none."""
        if self.seen:
            x1, y1, x2, y2 = self._sum
            n = self.seen
            return x1 / n, y1 / n, x2 / n, y2 / n
        return self.last

    @property
    def is_settled(self) -> bool:
        """It is seen, and stands still."""
        return not self.missed and self.seen > 1 and not self.roaming

    def set_off(self) -> None:
        """It begins to move, or may be somewhere else."""
        self.moving, self.roaming, self.pace = True, False, STILL
        self._forget()

    def come_to_rest(self) -> None:
        """It has stopped, wherever it is."""
        self.moving, self.roaming, self.pace = False, False, STILL
        self._forget()

    def offer(
        self, boxes: Sequence[Sequence[float]], flicker: float, *, strict: bool
    ) -> int | None:
        """Look for it among the boxes of its class in a frame.

        Args:
            boxes: px, the surest first.
            strict: Believe no box that is farther away than it can be.
            flicker: By how many px the middle of a box may be off, at rest.

        Returns:
            Which box is its; None if none is.
        """
        if not boxes:
            self.missed += 1
            return None
        index = self._nearest(boxes)
        box = boxes[index]
        if strict and self.last is not None and not self.free and not self._believable(box):
            self.missed += 1
            return None
        self._take(box, flicker)
        return index

    def _believable(self, box: Sequence[float]) -> bool:
        assert self.last is not None
        if self.seen and not self.moving and not self.roaming:
            gate = _NEAR_AT_REST_PX
        else:
            gate = _FASTEST_PX * (1 + self.missed)
        if distance(self.last, box) <= gate:
            self._far_count = 0
            return True
        # What is seen again and again in one place is there, whatever was thought before.
        agrees = self._far_count and distance(self._far, box) <= _AGREE_PX
        self._far_count = self._far_count + 1 if agrees else 1
        self._far = box
        return self._far_count >= _CONVINCING

    def _nearest(self, boxes: Sequence[Sequence[float]]) -> int:
        if len(boxes) == 1 or self.last is None:
            return 0
        here = self.last
        return min(range(len(boxes)), key=lambda index: distance(here, boxes[index]))

    def _take(self, box: Sequence[float], flicker: float) -> None:
        if self._far_count >= _CONVINCING:
            self._forget()
        if self.seen and not self.moving:
            self._notice(box, flicker)
        x1, y1, x2, y2 = box
        if self.moving and self.last is not None and not self.missed:
            a, b, c, d = self.last
            self.pace = (x1 + x2 - a - c) / 2, (y1 + y2 - b - d) / 2
        self.last = x1, y1, x2, y2
        self.free, self.missed, self._far_count = False, 0, 0
        if not self.moving:
            total = self._sum
            total[0] += box[0]
            total[1] += box[1]
            total[2] += box[2]
            total[3] += box[3]
            self.seen += 1

    def _notice(self, box: Sequence[float], flicker: float) -> None:
        """Find out that it moves though it should rest, or that it has come to rest again."""
        x1, y1, x2, y2 = self._sum
        n = self.seen
        strays = distance((x1 / n, y1 / n, x2 / n, y2 / n), box) > flicker
        self._strays = self._strays + 1 if strays else 0
        if self._strays >= (1 if self.roaming or flicker < 1 else 2):
            self.roaming = True
            self._forget()
        elif self.roaming and n >= _SETTLED:
            self.roaming = False

    def _forget(self) -> None:
        self._sum, self.seen, self._strays = [0.0, 0.0, 0.0, 0.0], 0, 0


def distance(first: Sequence[float], second: Sequence[float]) -> float:
    """Give how far the centres of two boxes are apart, px."""
    across = first[0] + first[2] - second[0] - second[2]
    down = first[1] + first[3] - second[1] - second[3]
    return float((across * across + down * down) ** 0.5) / 2
