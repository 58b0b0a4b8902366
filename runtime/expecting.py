"""What should be seen here: a part that showed in its place, and does not show there any more.

That a part is attached to another says where it is, not that it is hidden there. If it showed in
its place while it was attached, it should show there again whenever the camera looks from about the
same side, sees what the part is attached to, and nothing has come in between. That it does not is
evidence as good as a sighting elsewhere: it has been taken out.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Final

from aapa import Anchor, AnchorStatus, Box, Camera, Detection, Position
from runtime.percepts import HAND, HAND_TYPE

_SURE: Final = 0.9  # the score from which on a part is recognised whatever the light
_SEES_LESS: Final = 0.06  # so much less of a score may be noise; more, and it is half hidden
_MOST_VIEWS: Final = 12
_ASIDE: Final = math.cos(math.radians(12))
_FARTHER: Final = 1.25
_MOVED_M: Final = 0.03


@dataclass(frozen=True, slots=True)
class _View:
    """From where a part was seen in its place, and what else was to be seen around it.

    Args:
        away: From the part to the camera, m.
        score: How surely that was recognised which the part is attached to; `_SURE` at most, and
            that too where it could not be seen for the part.
        beside: What overlapped the part in the image.
    """

    away: Position
    score: float
    beside: frozenset[str]

    def is_like(self, away: Position) -> bool:
        """Tell whether the camera looks from about this side, and from no farther."""
        near, far = math.hypot(*self.away), math.hypot(*away)
        along = sum(a * b for a, b in zip(self.away, away, strict=True))
        return along >= _ASIDE * near * far and far <= _FARTHER * near


@dataclass(frozen=True, slots=True)
class _Showing:
    """A part that shows in its place.

    Args:
        parent: What it is attached to.
        offset: From there to the part, m.
        views: From where it was seen, the latest last.
    """

    parent: str
    offset: Position
    views: tuple[_View, ...] = ()


@dataclass(frozen=True, slots=True)
class _Frame:
    """What is needed of a frame."""

    anchors: Mapping[str, Anchor]
    scores: Mapping[tuple[str, Box], float]
    camera: Camera

    def score(self, anchor: Anchor) -> float:
        """Give how surely an anchor's object was recognised; 0 if it was not."""
        if anchor.status is not AnchorStatus.VISIBLE:
            return 0.0
        return self.scores.get((anchor.type, anchor.box), 0.0)

    def beside(self, anchor: Anchor, parent: str, held: frozenset[str]) -> frozenset[str]:
        """Give what overlaps an anchor in the image, but for what it is attached to."""
        return frozenset(
            other.name
            for other in self.anchors.values()
            if other.name not in {anchor.name, parent}
            and (other.status is AnchorStatus.VISIBLE or other.name in held)
            and _overlap(other.box, anchor.box)
        )

    def shows_whole(self, box: Box) -> bool:
        """Tell whether a box is within the image."""
        x1, y1, x2, y2 = box
        return x1 >= 0 and y1 >= 0 and x2 <= self.camera.width and y2 <= self.camera.height


class Expectation:
    """Remembers which attached parts show in their places, and notices when one does not."""

    def __init__(self) -> None:
        self._showing: dict[str, _Showing] = {}

    @property
    def shown(self) -> frozenset[str]:
        """The attached parts that have shown in their places."""
        return frozenset(name for name, showing in self._showing.items() if showing.views)

    def update(
        self,
        anchors: Iterable[Anchor],
        detections: Iterable[Detection],
        attachments: Iterable[tuple[str, str]],
        camera: Camera,
        *,
        company: bool,
    ) -> frozenset[str]:
        """Take in a frame; give the parts that should be seen in it, and are not.

        Args:
            anchors: What is anchored in this frame.
            detections: What the detector has reported in it.
            attachments: (child, parent) pairs that were believed when it was taken.
            camera: The camera that took it.
            company: Whether a person's hand is in sight: it hides more than is seen of it.
        """
        frame = _Frame(
            {anchor.name: anchor for anchor in anchors},
            {(each.type, each.box): each.score for each in detections},
            camera,
        )
        parents = dict(attachments)
        held = frozenset(child for child, parent in parents.items() if parent == HAND)
        self._showing = {
            child: known
            for child, known in self._showing.items()
            if parents.get(child) == known.parent
        }
        amiss = []
        for child, name in parents.items():
            anchor, parent = frame.anchors.get(child), frame.anchors.get(name)
            if anchor is None or parent is None or parent.type == HAND_TYPE:
                continue
            if anchor.status is AnchorStatus.VISIBLE:
                self._learn(anchor, parent, frame, held)
            elif not company and self._is_amiss(anchor, parent, frame, held):
                amiss.append(child)
        return frozenset(amiss)

    def _learn(self, anchor: Anchor, parent: Anchor, frame: _Frame, held: frozenset[str]) -> None:
        offset = _way(parent.position, anchor.position)
        if offset is None or anchor.position is None:
            return
        known = self._showing.get(anchor.name)
        if known is None or math.dist(known.offset, offset) > _MOVED_M:
            known = self._showing[anchor.name] = _Showing(parent.name, offset)
        if frame.score(anchor) < _SURE:
            return
        away = _way(anchor.position, frame.camera.position)
        assert away is not None, "both places are known"
        score = min(_SURE, frame.score(parent) or _SURE)
        view = _View(away, score, frame.beside(anchor, parent.name, held))
        others = [
            each for each in known.views if not (each.is_like(away) and view.is_like(each.away))
        ]
        views = (*others, view)[-_MOST_VIEWS:]
        self._showing[anchor.name] = _Showing(parent.name, known.offset, views)

    def _is_amiss(
        self, anchor: Anchor, parent: Anchor, frame: _Frame, held: frozenset[str]
    ) -> bool:
        known = self._showing.get(anchor.name)
        away = _way(anchor.position, frame.camera.position)
        if known is None or away is None or anchor.status is not AnchorStatus.ATTACHED:
            return False
        if not frame.shows_whole(anchor.box):
            return False
        score, beside = frame.score(parent), frame.beside(anchor, parent.name, held)
        return any(
            view.is_like(away) and score >= view.score - _SEES_LESS and beside <= view.beside
            for view in known.views
        )


def _way(start: Position | None, end: Position | None) -> Position | None:
    if start is None or end is None:
        return None
    return end[0] - start[0], end[1] - start[1], end[2] - start[2]


def _overlap(one: Box, other: Box) -> bool:
    return one[0] < other[2] and other[0] < one[2] and one[1] < other[3] and other[1] < one[3]
