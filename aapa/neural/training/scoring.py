"""How good a network is on videos it does not learn from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from torch import nn

from aapa.lacater.metric import iou
from aapa.neural.prediction import predict
from aapa.neural.training.arrays import LABELS, TrainingArrays
from aapa.neural.training.batches import batches_of
from aapa.neural.training.hyperparameters import Hyperparameters


@dataclass(frozen=True, slots=True)
class Score:
    """Mean intersection over union on one detector's boxes, %, as the paper's table has it.

    Args:
        overall: Of all frames from the first sighting on.
        by_label: Of those with each label, in the order of `LABELS`; None if there are none.
    """

    overall: float
    by_label: tuple[float | None, ...]


def score(
    model: nn.Module,
    arrays: TrainingArrays,
    kind: str,
    choice: Hyperparameters,
    *,
    guided: bool,
) -> Score:
    """Score a network on all videos; those in which the snitch is never seen do not count."""
    overall: list[float] = []
    by_label: list[list[float]] = [[] for _ in LABELS]
    for videos, batch in batches_of(arrays, kind, choice, guided=guided):
        predicted = predict(model, batch.features, batch.weights)
        for number, boxes in zip(videos, predicted, strict=True):
            first = int(arrays.seen[kind].first[number])
            if first < 0:
                continue
            # A box that is inside out has no width, or no height.
            boxes[:, 2:] = np.maximum(boxes[:, 2:], boxes[:, :2])
            overlaps = iou(boxes[first:], arrays.boxes[number, first:].astype(np.float64))
            labels = arrays.labels[number, first:]
            overall.append(float(overlaps.mean()))
            for label, values in enumerate(by_label):
                if (labels == label).any():
                    values.append(float(overlaps[labels == label].mean()))
    return Score(
        _percent(overall), tuple(_percent(values) if values else None for values in by_label)
    )


def _percent(values: list[float]) -> float:
    return round(100 * float(np.mean(values)), 4)
