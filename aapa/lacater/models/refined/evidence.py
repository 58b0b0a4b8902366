"""What a correction is made from: how several ways to tell the snitch's box differ from the box.

The box of `aapa-plus` is one of them. Others are the detector's box of this frame, the ball that
fits best on the floor, the same with the spikes it was seen with, the place that its move is
planned to pass, and the middle of the container. None is right in itself, but each is wrong in its
own way, and how they differ tells something of what is wrong.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from aapa.boxes import centre_of
from aapa.detections import Box
from aapa.lacater.generator.motion import LIFT
from aapa.lacater.models.plus.carrying import trimmed
from aapa.lacater.models.plus.ground import GroundView, Place
from aapa.lacater.models.plus.insight import Insight
from aapa.lacater.models.plus.reasons import Ground
from aapa.lacater.models.plus.solids import SNITCH_SOLID
from aapa.lacater.video import FRAMES, HEIGHT, WIDTH

_GROUNDS: Final = tuple(Ground)
_FARTHEST_PX: Final = 8.0
_SCALE_PX: Final = 2.0
_SIDE_PX: Final = 25.0
_LONG: Final = 30.0

WIDTH_OF_EVIDENCE: Final = 6 * 5 + len(_GROUNDS) + 17
"""How many numbers `Evidence.numbers` gives."""


class Evidence:
    """Gathers it, frame by frame; the camera is found out anew as more is seen."""

    def __init__(self) -> None:
        self._view: GroundView | None = None
        self._asked = 1
        self._last: Box | None = None

    def numbers(self, insight: Insight, frame: int) -> NDArray[np.float64]:
        """Give (WIDTH_OF_EVIDENCE,) numbers, about 1 in size.

        Args:
            insight: What the tracker knows after this frame; its box has to be known.
            frame: The frame's number, from 0.
        """
        box = insight.box
        assert box is not None
        self._look(insight, frame)
        view = self._view
        before, self._last = self._last, box
        lift = _lift(insight, frame)
        place = None if view is None else view.place(SNITCH_SOLID, box, lift)
        row: list[float] = []
        for other in (
            self._seen(insight),
            before,
            _ball(view, place, lift),
            _spiked(view, place, lift, insight),
            _planned(view, insight, frame),
            _container(view, insight),
        ):
            row += _differs(other, box)
        row += [float(insight.ground is ground) for ground in _GROUNDS]
        row += self._circumstances(insight, box, place, frame)
        return np.array(row)

    def _look(self, insight: Insight, frame: int) -> None:
        if frame + 1 >= self._asked or self._view is None:
            self._asked = max(2 * self._asked, frame + 1)
            self._view = insight.scenery.estimate(self._view) or self._view

    def _seen(self, insight: Insight) -> Box | None:
        thing = insight.scenery.things.get(insight.snitch)
        return None if thing is None or thing.missed or thing.last is None else thing.last

    def _circumstances(
        self, insight: Insight, box: Box, place: Place | None, frame: int
    ) -> list[float]:
        scenery, view = insight.scenery, self._view
        thing = scenery.things.get(insight.snitch)
        root = scenery.things.get(insight.outermost)
        path = insight.path
        (u, v), free = centre_of(box), GroundView.free_edges
        edges = (1.0,) * 4 if view is None else free(view, box)
        wide, tall = (0.0, 0.0)
        if view is not None and place is not None:
            scale = view.focal / max(view.depth(place, SNITCH_SOLID.low), 1.0)
            wide, tall = (side * scale for side in insight.appearance.more(view, place))
        return [
            float(scenery.is_noisy),
            u / WIDTH - 0.5,
            v / HEIGHT - 0.5,
            (box[2] - box[0]) / _SIDE_PX - 1.0,
            (box[3] - box[1]) / _SIDE_PX - 1.0,
            wide,
            tall,
            *edges,
            0.0 if thing is None else math.log1p(thing.seen) / 3.0,
            0.0 if thing is None else min(thing.missed, _LONG) / _LONG,
            float(root is not None and (root.moving or root.roaming)),
            0.0 if path is None else path.share(frame),
            0.0 if path is None else path.height(frame),
            frame / FRAMES,
        ]


def _differs(other: Box | None, box: Box) -> list[float]:
    """Give by how much the edges differ, and whether there is anything to compare with."""
    if other is None:
        return [0.0] * 5
    offs = [a - b for a, b in zip(other, box, strict=True)]
    return [*(min(max(off, -_FARTHEST_PX), _FARTHEST_PX) / _SCALE_PX for off in offs), 1.0]


def _lift(insight: Insight, frame: int) -> float:
    """Give how high the snitch itself is lifted, in units of the scene."""
    if insight.path is None or insight.outermost != insight.snitch:
        return 0.0
    return LIFT * insight.path.height(frame)


def _ball(view: GroundView | None, place: Place | None, lift: float) -> Box | None:
    return None if view is None or place is None else _box(view, place, lift)


def _spiked(
    view: GroundView | None, place: Place | None, lift: float, insight: Insight
) -> Box | None:
    if view is None or place is None:
        return None
    wide, tall = insight.appearance.more(view, place)
    return trimmed(view, place, (-wide, -tall, wide, tall), lift)


def _planned(view: GroundView | None, insight: Insight, frame: int) -> Box | None:
    path = insight.path
    place = None if path is None else path.place(frame)
    if view is None or path is None or place is None:
        return None
    return trimmed(view, place, insight.trim, _lift(insight, frame))


def _container(view: GroundView | None, insight: Insight) -> Box | None:
    name = insight.outermost
    solid = insight.scenery.solids.get(name)
    if view is None or solid is None or insight.scenery.things[name].missed:
        return None
    seen = insight.scenery.box_of(name)
    place = None if seen is None else view.place(solid, seen)
    return None if place is None else _box(view, place, 0.0)


def _box(view: GroundView, place: Place, lift: float) -> Box | None:
    try:
        return view.clipped(view.box(SNITCH_SOLID, place, lift))
    except ValueError:
        return None
