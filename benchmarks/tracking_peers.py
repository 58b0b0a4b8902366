"""The trackers that are measured side by side, each fed what it likes best."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import norfair
import numpy as np
import supervision
import trackers

from aapa import Anchoring, AnchoringParameters, Detection
from aapa.lacater.classes import CLASS_NAMES
from aapa.lacater.layout import PerceptionKind
from aapa.lacater.models import Frame, model_named
from aapa.lacater.reading import Dataset
from icarus_lite import load_domain
from runtime.cater.attachments import AttachmentEngine, timed_actions
from runtime.cater.evaluation import cast_of, frames_of


@dataclass(frozen=True, slots=True)
class Recorded:
    """A video to be followed.

    Args:
        frames: Boxes, classes, and what is reported of the actions.
        cast: The class of each object that the actions name.
    """

    frames: Sequence[Frame]
    cast: Mapping[str, int]

    @property
    def detections(self) -> int:
        """How many there are in all frames together."""
        return sum(len(frame.boxes) for frame in self.frames)


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
    fresh: Callable[[Recorded], Callable[[Any], object]]


def recorded(root: Path, domain: Path) -> list[Recorded]:
    """Read the videos of a data set, perfect perception and reported actions."""
    dataset, engine = Dataset(root), AttachmentEngine(load_domain(domain))
    videos = []
    for path in sorted((root / "perfect_perception").glob("*.pkl")):
        video = dataset.video(path.stem)
        assert video.scene is not None
        seen = dataset.perception(video, PerceptionKind.PP)
        reports = engine.reports(timed_actions(video.scene), seen.frames)
        videos.append(Recorded(frames_of(seen, reports), cast_of(video.scene)))
    return videos


def ours() -> list[Peer]:
    """Give plain anchoring, and the model that goes beyond it.

    The first gets no attachments, as the others know none. The second cannot do without reported
    actions: it gets them, and what the engine infers from them, with its frames.
    """
    return [
        Peer(
            "AAPA (this project)",
            _as_detections,
            lambda _: Anchoring(AnchoringParameters(tau=6500, image_size=(320, 240))).update,
        ),
        Peer(
            "aapa-plus (this project)",
            lambda frame: frame,
            lambda video: model_named("aapa-plus").start(video.cast).observe,
        ),
    ]


def others() -> list[Peer]:
    """Give the peers, with the settings they come with."""

    def as_supervision(frame: Frame) -> object:
        return supervision.Detections(
            xyxy=frame.boxes.astype(np.float64),
            confidence=np.full(len(frame.boxes), 0.9),
            class_id=frame.classes,
        )

    def as_norfair(frame: Frame) -> object:
        return [
            norfair.Detection(points=box.reshape(2, 2), scores=np.array([0.9, 0.9]), label=number)
            for box, number in zip(frame.boxes.astype(np.float64), frame.classes, strict=True)
        ]

    def norfair_update(_: Recorded) -> Callable[[Any], object]:
        tracker = norfair.Tracker(distance_function="iou", distance_threshold=0.7)
        return lambda detections: tracker.update(detections=detections)

    return [
        Peer("ByteTrack (trackers)", as_supervision, lambda _: trackers.ByteTrackTracker().update),
        Peer("SORT (trackers)", as_supervision, lambda _: trackers.SORTTracker().update),
        Peer("norfair", as_norfair, norfair_update),
    ]


def _as_detections(frame: Frame) -> Sequence[Detection]:
    return [
        Detection(CLASS_NAMES[number], (x1, y1, x2, y2))
        for (x1, y1, x2, y2), number in zip(
            frame.boxes.astype(np.float64).tolist(), frame.classes.tolist(), strict=True
        )
    ]
