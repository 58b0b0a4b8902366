"""Runs models on videos and scores them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from aapa import AnchoringError
from aapa.errors import DatasetError
from aapa.lacater.camera import FloorCamera
from aapa.lacater.classes import SNITCH_KEY, class_number
from aapa.lacater.layout import PerceptionKind
from aapa.lacater.metric import VideoScore, first_sighting, score_video
from aapa.lacater.models import Frame, Model, models_named
from aapa.lacater.reading import Dataset
from aapa.lacater.scene import Scene
from aapa.lacater.video import Perception, Video
from icarus_lite import load_domain
from runtime.cater.attachments import AttachmentEngine, FrameReports, timed_actions


@dataclass(frozen=True, slots=True)
class Job:
    """What is to be evaluated; the same for every video.

    Args:
        root: The data set's folder.
        domain: The domain file that says which actions attach.
        models: The models' names.
        perception: Whose detections they get.
    """

    root: Path
    domain: Path
    models: tuple[str, ...]
    perception: PerceptionKind


@dataclass(frozen=True, slots=True)
class VideoResult:
    """What came of one video.

    Args:
        video: Its name.
        skipped: Why it was left out; "" if it was not.
        scores: For each model, in the order of the job.
        exact_scores: The same against the boxes before rounding, where the data set has them.
    """

    video: str
    skipped: str = ""
    scores: tuple[VideoScore, ...] = ()
    exact_scores: tuple[VideoScore, ...] = field(default=())


class Evaluator:
    """Evaluates the videos of a data set, one at a time.

    Args:
        job: Data set, domain, models and perception.

    Raises:
        AnchoringError: There is no such model, or no data set.
        DomainError: The domain cannot be loaded.
    """

    def __init__(self, job: Job) -> None:
        self._kind = job.perception
        self._models = models_named(job.models)
        self._dataset = Dataset(job.root)
        self._engine = AttachmentEngine(load_domain(job.domain))

    def evaluate(self, name: str) -> VideoResult:
        """Run every model on a video, and score it.

        A video that cannot be evaluated is skipped, and the result says why.

        Raises:
            AnchoringError: A model failed, or gave no box where one is due.
        """
        try:
            video = self._dataset.video(name)
            perception = self._dataset.perception(video, self._kind)
        except DatasetError as error:
            return VideoResult(name, skipped=str(error))
        start = first_sighting(perception)
        snitch = video.labels.snitch
        if snitch is None or start is None:
            return VideoResult(name, skipped="the snitch is never detected")
        if video.scene is None:
            return VideoResult(name, skipped="there is no scene file, and so no actions are known")
        reports = self._reports(video.scene, perception.frames)
        frames = frames_of(perception, reports, self._dataset.camera(video.scene))
        cast = cast_of(video.scene)
        scores, exact = [], []
        for model in self._models:
            try:
                boxes = run_model(model, frames, cast)
                scores.append(score_video(boxes, snitch.astype(np.float64), video.masks, start))
                exact.extend(_exact_score(video, boxes, start))
            except AnchoringError as error:
                raise AnchoringError(f"model {model.name}, video {name}: {error}") from error
        return VideoResult(name, "", tuple(scores), tuple(exact))

    def _reports(self, scene: Scene, frames: int) -> tuple[FrameReports, ...]:
        return self._engine.reports(timed_actions(scene), frames)


def frames_of(
    perception: Perception, reports: Sequence[FrameReports], camera: FloorCamera | None = None
) -> tuple[Frame, ...]:
    """Give what a tracker is handed, frame by frame; the camera where it is known."""
    return tuple(
        Frame(number, boxes, classes, report.actions, report.attachments, camera)
        for number, (boxes, classes, report) in enumerate(
            zip(perception.boxes, perception.classes, reports, strict=True)
        )
    )


def cast_of(scene: Scene) -> dict[str, int]:
    """Give the class of each object that actions may name, as far as the detector has one."""
    numbers = {thing.instance: class_number(thing.class_name) for thing in scene.objects}
    return {instance: number for instance, number in numbers.items() if number is not None}


def run_model(model: Model, frames: Sequence[Frame], cast: dict[str, int]) -> NDArray[np.float64]:
    """Give (frames, 4) the boxes that a model gives for the snitch, px; NaN where it gives none."""
    tracker = model.start(cast)
    nowhere = (float("nan"),) * 4
    return np.array([tracker.observe(frame) or nowhere for frame in frames], dtype=np.float64)


def evaluate_videos(job: Job, names: Sequence[str]) -> tuple[VideoResult, ...]:
    """Evaluate some videos of a data set: what one worker process is asked to do.

    Raises:
        AnchoringError: A model failed.
        DomainError: The domain cannot be loaded.
    """
    evaluator = _evaluator(job)
    return tuple(evaluator.evaluate(name) for name in names)


@lru_cache(maxsize=1)
def _evaluator(job: Job) -> Evaluator:
    # A worker gets many batches of one job; domain and frame lists are read for the first alone.
    return Evaluator(job)


def _exact_score(video: Video, boxes: NDArray[np.float64], start: int) -> list[VideoScore]:
    if video.exact_boxes is None:
        return []
    true = video.exact_boxes[video.labels.keys.index(SNITCH_KEY)]
    return [score_video(boxes, true, video.masks, start, exact=True)]
