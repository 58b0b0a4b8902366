"""The score on the dev split is the metric of the table."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
import torch

from aapa.lacater.metric import iou
from aapa.neural import predict
from aapa.neural.features import scaled
from aapa.neural.models import build_network
from aapa.neural.training.arrays import Seen, TrainingArrays
from aapa.neural.training.hyperparameters import Hyperparameters
from aapa.neural.training.scoring import score


class Told(torch.nn.Module):
    """Gives the box in slot 1 a little smaller, whatever it has to do with the snitch."""

    features = 6

    def __init__(self) -> None:
        super().__init__()
        self.nothing = torch.nn.Parameter(torch.zeros(1))

    def forward(self, features: torch.Tensor, weights: torch.Tensor | None) -> torch.Tensor:
        del weights
        return features[:, :, 1, :4] * 0.98 + self.nothing


def test_it_is_the_mean_over_videos_of_the_mean_over_frames(
    arrays: Callable[[int, int], TrainingArrays],
):
    made = arrays(5, 1)
    first = np.array([0, 3, -1, 14, 0], dtype=np.int16)
    seen = Seen(made.seen["od"].tables, made.seen["od"].tracked, first)
    made = TrainingArrays(made.boxes, made.labels, {"od": seen})
    found = score(Told(), made, "od", Hyperparameters(), guided=False)
    overall, visible, contained = [], [], []
    for number in (0, 1, 3, 4):
        boxes = predict(Told(), scaled(seen.tables[number]))[first[number] :]
        overlaps = iou(boxes, made.boxes[number, first[number] :].astype(float))
        labels = made.labels[number, first[number] :]
        overall.append(overlaps.mean())
        visible.append(overlaps[labels == 0].mean())
        contained.append(overlaps[labels == 2].mean())
    assert found.overall == pytest.approx(100 * np.mean(overall), abs=1e-3)
    assert found.by_label[0] == pytest.approx(100 * np.mean(visible), abs=1e-3)
    assert found.by_label[2] == pytest.approx(100 * np.mean(contained), abs=1e-3)
    assert found.by_label[1] is None
    assert found.by_label[3] is None


def test_boxes_that_are_inside_out_score_nothing(arrays: Callable[[int, int], TrainingArrays]):
    made = arrays(3, 1)
    model = build_network("opnet", {"who_hidden": 2, "where_hidden": 2})
    with torch.no_grad():
        for parameter in model.parameters():
            parameter.fill_(-9.0)
    assert 0 <= score(model, made, "od", Hyperparameters(), guided=False).overall < 5
