"""Baseline LSTM: all slots of a frame at once, and the snitch's box out.

Source: Shamsian et al., Learning Object Permanence from Video, ECCV 2020 (the published code).
"""

from __future__ import annotations

from torch import Tensor, nn

from aapa.neural.features import SLOTS
from aapa.neural.models.recurrence import Lstm

BASELINE_FEATURES = 5
"""The baselines do not read the bit that says "cone"."""


class BaselineLstm(nn.Module):
    """One LSTM from slots to box.

    Args:
        hidden: Its width.
    """

    features = BASELINE_FEATURES
    """How many of a slot's numbers it reads."""

    def __init__(self, hidden: int = 512) -> None:
        super().__init__()
        self.lstm = Lstm(SLOTS * BASELINE_FEATURES, hidden)
        self.box = nn.Linear(hidden, 4, bias=False)

    def forward(self, features: Tensor, weights: Tensor | None = None) -> Tensor:
        """Give (batch, frames, 4) boxes, x1 y1 x2 y2 as shares of the picture.

        Args:
            features: (batch, frames, 15, 5).
            weights: Not used: there is no attention to guide.
        """
        del weights
        boxes: Tensor = self.box(self.lstm(features.flatten(2)))
        return boxes
