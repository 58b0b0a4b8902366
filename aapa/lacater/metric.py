"""How the snitch's predicted boxes are scored, as the authors of data set and paper do it.

Boxes are cut to whole px towards zero, and their sides counted with both ends (+1). A video's
score is the mean over its frames of a label, from the frame on at which the detector first
reports the snitch; a table's is the mean over the videos that have such frames, and its error
the standard deviation over those videos by the square root of their number.

Source: Shamsian et al. 2020 (the published code); Liang et al. 2021, section IV-C, for the first
frame and the distance of centres.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from aapa.errors import AnchoringError
from aapa.lacater.classes import SNITCH
from aapa.lacater.video import FrameMasks, Perception

TASKS: Final = ("visible", "occluded", "contained", "carried", "overall")
"""The columns of the table: the four labels, and all frames."""


@dataclass(frozen=True, slots=True)
class VideoScore:
    """One model's score on one video, by task; NaN where no frame has that label.

    Args:
        miou: Mean intersection over union, in [0, 1].
        ml2: Mean distance of the box centres, px.
    """

    miou: Mapping[str, float]
    ml2: Mapping[str, float]


class Mean(NamedTuple):
    """A mean over videos, its standard error, and how many videos it is over.

    Both are NaN without a video, and the error with a single one.
    """

    mean: float
    sem: float
    videos: int


def first_sighting(perception: Perception) -> int | None:
    """Give the frame at which the snitch is first detected, or None if it never is."""
    for frame, classes in enumerate(perception.classes):
        if (classes == SNITCH).any():
            return frame
    return None


def iou(predicted: NDArray[np.float64], true: NDArray[np.float64]) -> NDArray[np.float64]:
    """Give (frames,) intersections over unions, in [0, 1].

    Args:
        predicted: (frames, 4) px, x1 y1 x2 y2; fractions of a px are cut off.
        true: As above.

    Example:
        >>> iou(np.array([[0, 0, 9.9, 9.9]]), np.array([[5.0, 0, 14, 9]])).round(4).tolist()
        [0.3333]
    """
    first, second = predicted.astype(np.int64), true.astype(np.int64)
    low = np.maximum(first[:, :2], second[:, :2])
    high = np.minimum(first[:, 2:], second[:, 2:])
    shared = np.prod(np.maximum(high - low + 1, 0), axis=1, dtype=np.int64)
    areas = [
        np.prod(box[:, 2:] - box[:, :2] + 1, axis=1, dtype=np.int64) for box in (first, second)
    ]
    ratio: NDArray[np.float64] = shared / (areas[0] + areas[1] - shared)
    return ratio


def exact_iou(predicted: NDArray[np.float64], true: NDArray[np.float64]) -> NDArray[np.float64]:
    """Give (frames,) intersections over unions of boxes as they are: nothing cut off, no +1.

    This is not the published metric; it shows what is left of an error once rounding is set aside.
    """
    low = np.maximum(predicted[:, :2], true[:, :2])
    high = np.minimum(predicted[:, 2:], true[:, 2:])
    shared = np.prod(np.maximum(high - low, 0.0), axis=1)
    areas = [np.prod(box[:, 2:] - box[:, :2], axis=1) for box in (predicted, true)]
    union = areas[0] + areas[1] - shared
    ratio: NDArray[np.float64] = np.divide(shared, union, out=np.zeros_like(union), where=union > 0)
    return ratio


def centre_distances(
    predicted: NDArray[np.float64], true: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Give (frames,) distances of the box centres, px; nothing is cut off here."""
    offsets = (predicted[:, :2] + predicted[:, 2:] - true[:, :2] - true[:, 2:]) / 2
    distances: NDArray[np.float64] = np.hypot(offsets[:, 0], offsets[:, 1])
    return distances


def score_video(
    predicted: NDArray[np.float64],
    true: NDArray[np.float64],
    masks: FrameMasks,
    start: int,
    *,
    exact: bool = False,
) -> VideoScore:
    """Score one model on one video.

    Args:
        predicted: (frames, 4) px; the rows before the start are not looked at.
        true: (frames, 4) px, the snitch's true boxes.
        masks: Which frames have which label.
        start: The first frame that counts, that of the first sighting.
        exact: Take `exact_iou` in place of the published one.

    Raises:
        AnchoringError: A predicted box that counts is not finite or inverted.
    """
    counted, truth = predicted[start:], true[start:].astype(np.float64)
    if not np.isfinite(counted).all() or (counted[:, 2:] < counted[:, :2]).any():
        wrong = ~np.isfinite(counted).all(axis=1) | (counted[:, 2:] < counted[:, :2]).any(axis=1)
        frame = start + int(np.flatnonzero(wrong)[0])
        raise AnchoringError(
            f"frame {frame} has no proper box: {predicted[frame].tolist()}; from the first "
            "sighting on, a model gives one for every frame"
        )
    overlaps = (exact_iou if exact else iou)(counted, truth)
    distances = centre_distances(counted, truth)
    frames = _task_frames(masks, start)
    return VideoScore(
        {task: _mean(overlaps[mask]) for task, mask in frames.items()},
        {task: _mean(distances[mask]) for task, mask in frames.items()},
    )


def mean_over_videos(values: Iterable[float]) -> Mean:
    """Give the mean over videos and its standard error; videos without such a frame are NaN.

    Example:
        >>> mean_over_videos([0.5, 0.7, float("nan")])
        Mean(mean=0.6, sem=0.1, videos=2)
    """
    given = np.array([value for value in values if not np.isnan(value)], dtype=np.float64)
    count = len(given)
    mean = float(given.mean()) if count else float("nan")
    sem = float(given.std(ddof=1) / np.sqrt(count)) if count > 1 else float("nan")
    return Mean(round(mean, 12), round(sem, 12), count)


def table_row(
    scores: Sequence[VideoScore],
) -> tuple[dict[str, Mean], dict[str, Mean]]:
    """Give a model's row, mIoU in % and mL2 in px, by task."""
    miou = {task: mean_over_videos(100 * score.miou[task] for score in scores) for task in TASKS}
    ml2 = {task: mean_over_videos(score.ml2[task] for score in scores) for task in TASKS}
    return miou, ml2


def _task_frames(masks: FrameMasks, start: int) -> dict[str, NDArray[np.bool_]]:
    labels = (masks.visible, masks.occluded, masks.contained, masks.carried)
    everything = np.ones(len(masks.visible) - start, dtype=np.bool_)
    return dict(zip(TASKS, (*(mask[start:] for mask in labels), everything), strict=True))


def _mean(values: NDArray[np.float64]) -> float:
    return float(values.mean()) if len(values) else float("nan")
