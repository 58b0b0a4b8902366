"""The trackers that are measured side by side, each fed what it likes best."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import norfair
import numpy as np
import supervision
import trackers
from numpy.typing import NDArray

from aapa import Anchoring, AnchoringParameters, Detection
from aapa.lacater.classes import CLASS_NAMES

Frame = tuple[NDArray[np.float64], NDArray[np.int64]]
"""(n, 4) boxes in px, and (n,) class numbers."""


@dataclass(frozen=True, slots=True)
class Peer:
    """A tracker under measurement.

    Args:
        name: As it stands in the tables.
        given: Turns a frame into what the tracker takes; not part of the measured time.
        fresh: Makes a new tracker for a video, and gives its update.
    """

    name: str
    given: Callable[[Frame], Any]
    fresh: Callable[[], Callable[[Any], object]]


def aapa() -> Peer:
    """Give the anchoring of this project, plain: no attachments, as the others know none."""
    return Peer(
        "AAPA (this project)",
        _as_detections,
        lambda: Anchoring(AnchoringParameters(tau=6500, image_size=(320, 240))).update,
    )


def others() -> list[Peer]:
    """Give the peers, with the settings they come with."""

    def as_supervision(frame: Frame) -> object:
        boxes, classes = frame
        return supervision.Detections(
            xyxy=boxes, confidence=np.full(len(boxes), 0.9), class_id=classes
        )

    def as_norfair(frame: Frame) -> object:
        return [
            norfair.Detection(points=box.reshape(2, 2), scores=np.array([0.9, 0.9]), label=number)
            for box, number in zip(*frame, strict=True)
        ]

    def norfair_update() -> Callable[[Any], object]:
        tracker = norfair.Tracker(distance_function="iou", distance_threshold=0.7)
        return lambda detections: tracker.update(detections=detections)

    return [
        Peer("ByteTrack (trackers)", as_supervision, lambda: trackers.ByteTrackTracker().update),
        Peer("SORT (trackers)", as_supervision, lambda: trackers.SORTTracker().update),
        Peer("norfair", as_norfair, norfair_update),
    ]


def _as_detections(frame: Frame) -> Sequence[Detection]:
    return [
        Detection(CLASS_NAMES[number], (x1, y1, x2, y2))
        for (x1, y1, x2, y2), number in zip(frame[0].tolist(), frame[1].tolist(), strict=True)
    ]
