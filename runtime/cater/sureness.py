"""How sure a model says it is, beside how often it is right.

A model is right in a frame if its box and the true one share half of their union. One that knows
what it knows is right, of the frames in which it is 90 % sure, in 90 %.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from aapa.lacater.metric import TASKS, iou
from aapa.lacater.video import FrameMasks

RIGHT: Final = 0.5
"""The least intersection over union of a box that counts as right."""


@dataclass(frozen=True, slots=True)
class Sureness:
    """Of one model on one video, by task; NaN where no frame has that label.

    Args:
        confidence: How sure the model says it is, in [0, 1], in the mean.
        right: In which share of the frames it is right.
    """

    confidence: Mapping[str, float]
    right: Mapping[str, float]


def sureness(
    confidence: NDArray[np.float64],
    predicted: NDArray[np.float64],
    true: NDArray[np.float64],
    masks: FrameMasks,
    start: int,
) -> Sureness:
    """Compare what a model says of itself with how it does.

    Args:
        confidence: (frames,) in [0, 1].
        predicted: (frames, 4) px.
        true: (frames, 4) px.
        masks: Which frames have which label.
        start: The first frame that counts.
    """
    right = np.zeros(len(true))
    right[start:] = iou(predicted[start:], true[start:]) >= RIGHT
    every = np.ones(len(true), dtype=np.bool_)
    labels = (masks.visible, masks.occluded, masks.contained, masks.carried, every)
    counted = {
        task: np.flatnonzero(mask[start:]) + start for task, mask in zip(TASKS, labels, strict=True)
    }
    return Sureness(
        {task: _mean(confidence[frames]) for task, frames in counted.items()},
        {task: _mean(right[frames]) for task, frames in counted.items()},
    )


def _mean(values: NDArray[np.float64]) -> float:
    return float(values.mean()) if len(values) else float("nan")
