"""Runs models on videos and scores them."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass
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
from aapa.lacater.models import Footage, Frame, Model, Network, SureTracker, models_named
from aapa.lacater.reading import Dataset
from aapa.lacater.scene import Scene
from aapa.lacater.video import Perception, Video
from icarus_lite import load_domain
from runtime.cater.attachments import AttachmentEngine, FrameReports, timed_actions
from runtime.cater.guidance import classes_looked_at
from runtime.cater.sureness import Sureness, sureness

_NOWHERE = (float("nan"),) * 4


@dataclass(frozen=True, slots=True)
class Job:
    """What is to be evaluated; the same for every video.

    Args:
        root: The data set's folder.
        domain: The domain file that says which actions attach.
        models: The models' names.
        perception: Whose detections they get.
        weights: Names of models, each with the file of its weights.
    """

    root: Path
    domain: Path
    models: tuple[str, ...]
    perception: PerceptionKind
    weights: tuple[tuple[str, Path], ...] = ()

    def followers(self) -> tuple[Model | Network, ...]:
        """Give the models themselves, in the order of their names.

        Raises:
            AnchoringError: There is no such model, or its weights cannot be used.
        """
        return models_named(self.models, dict(self.weights))


@dataclass(frozen=True, slots=True)
class VideoResult:
    """What came of one video.

    Args:
        video: Its name.
        skipped: Why it was left out; "" if it was not.
        scores: For each model, in the order of the job.
        exact_scores: The same against the boxes before rounding, where the data set has them.
        seconds: The processor time that each model took.
        sureness: How sure each model is, and how often right; None for one that does not say.
    """

    video: str
    skipped: str = ""
    scores: tuple[VideoScore, ...] = ()
    exact_scores: tuple[VideoScore, ...] = ()
    seconds: tuple[float, ...] = ()
    sureness: tuple[Sureness | None, ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class _Material:
    """A video that can be evaluated, with all that models may be handed."""

    video: Video
    start: int
    cast: dict[str, int]
    frames: tuple[Frame, ...]
    footage: Footage


@dataclass(frozen=True, slots=True, eq=False)
class _Answer:
    """What a model gives of a video.

    Args:
        boxes: (frames, 4) px; NaN where it gives none.
        confidence: (frames,) how sure it is, in [0, 1]; None from one that does not say.
        seconds: The processor time it took.
    """

    boxes: NDArray[np.float64]
    confidence: NDArray[np.float64] | None
    seconds: float


class Evaluator:
    """Evaluates videos of a data set.

    Args:
        job: Data set, domain, models and perception.

    Raises:
        AnchoringError: There is no such model, or no data set.
        DomainError: The domain cannot be loaded.
    """

    def __init__(self, job: Job) -> None:
        self._kind = job.perception
        self._models = job.followers()
        self._dataset = Dataset(job.root)
        self._engine = AttachmentEngine(load_domain(job.domain))

    def evaluate(self, names: Sequence[str]) -> tuple[VideoResult, ...]:
        """Run every model on some videos, and score it.

        A video that cannot be evaluated is skipped, and its result says why.

        Raises:
            AnchoringError: A model failed, or gave no box where one is due.
        """
        found = [self._material(name) for name in names]
        usable = [each for each in found if isinstance(each, _Material)]
        answers = [_answers(model, usable) for model in self._models]
        scored = iter([self._scored(*each) for each in zip(usable, *answers, strict=True)])
        return tuple(each if isinstance(each, VideoResult) else next(scored) for each in found)

    def _material(self, name: str) -> _Material | VideoResult:
        try:
            video = self._dataset.video(name)
            perception = self._dataset.perception(video, self._kind)
        except DatasetError as error:
            return VideoResult(name, skipped=str(error))
        start = first_sighting(perception)
        if video.labels.snitch is None or start is None:
            return VideoResult(name, skipped="the snitch is never detected")
        if video.scene is None:
            return VideoResult(name, skipped="there is no scene file, and so no actions are known")
        reports = self._engine.reports(timed_actions(video.scene), perception.frames)
        cast = cast_of(video.scene)
        frames = frames_of(perception, reports, self._dataset.camera(video.scene))
        footage = Footage(perception, classes_looked_at(reports, cast))
        return _Material(video, start, cast, frames, footage)

    def _scored(self, material: _Material, *answers: _Answer) -> VideoResult:
        video, start = material.video, material.start
        snitch = video.labels.snitch
        assert snitch is not None
        scores, exact, sure = [], [], []
        for model, answer in zip(self._models, answers, strict=True):
            try:
                true = snitch.astype(np.float64)
                scores.append(score_video(answer.boxes, true, video.masks, start))
                exact.extend(_exact_score(video, answer.boxes, start))
                sure.append(_sureness(answer, true, video, start))
            except AnchoringError as error:
                raise AnchoringError(f"model {model.name}, video {video.name}: {error}") from error
        seconds = tuple(answer.seconds for answer in answers)
        return VideoResult(video.name, "", tuple(scores), tuple(exact), seconds, tuple(sure))


def _answers(model: Model | Network, videos: Sequence[_Material]) -> list[_Answer]:
    if isinstance(model, Network):
        begun = time.process_time()
        boxes = model.predict([video.footage for video in videos])
        each = (time.process_time() - begun) / max(len(videos), 1)
        return [_Answer(found, None, each) for found in boxes]
    answers = []
    for video in videos:
        begun, name = time.process_time(), video.video.name
        try:
            found = _followed(model, video.frames, video.cast)
        except AnchoringError as error:
            raise AnchoringError(f"model {model.name}, video {name}: {error}") from error
        answers.append(_Answer(*found, time.process_time() - begun))
    return answers


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
    return _followed(model, frames, cast)[0]


def _followed(
    model: Model, frames: Sequence[Frame], cast: dict[str, int]
) -> tuple[NDArray[np.float64], NDArray[np.float64] | None]:
    """Give the boxes of a model, and how sure it is of each where it says so."""
    tracker = model.start(cast)
    sure = tracker if isinstance(tracker, SureTracker) else None
    boxes, confidence = [], []
    for frame in frames:
        boxes.append(tracker.observe(frame) or _NOWHERE)
        if sure is not None:
            confidence.append(sure.confidence)
    found = np.array(boxes, dtype=np.float64)
    return found, None if sure is None else np.array(confidence, dtype=np.float64)


def evaluate_videos(job: Job, names: Sequence[str]) -> tuple[VideoResult, ...]:
    """Evaluate some videos of a data set: what one worker process is asked to do.

    Raises:
        AnchoringError: A model failed.
        DomainError: The domain cannot be loaded.
    """
    return _evaluator(job).evaluate(names)


@lru_cache(maxsize=1)
def _evaluator(job: Job) -> Evaluator:
    # A worker gets many batches of one job; domain and frame lists are read for the first alone.
    return Evaluator(job)


def _sureness(
    answer: _Answer, true: NDArray[np.float64], video: Video, start: int
) -> Sureness | None:
    if answer.confidence is None:
        return None
    return sureness(answer.confidence, answer.boxes, true, video.masks, start)


def _exact_score(video: Video, boxes: NDArray[np.float64], start: int) -> list[VideoScore]:
    if video.exact_boxes is None:
        return []
    true = video.exact_boxes[video.labels.keys.index(SNITCH_KEY)]
    return [score_video(boxes, true, video.masks, start, exact=True)]
