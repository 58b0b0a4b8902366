"""Non-linear + LSTM: each slot through the same small layer, then two LSTMs.

Source: Shamsian et al., Learning Object Permanence from Video, ECCV 2020 (the published code).
"""

from __future__ import annotations

from torch import Tensor, nn

from aapa.neural.features import SLOTS
from aapa.neural.models.baseline_lstm import BASELINE_FEATURES
from aapa.neural.models.recurrence import Lstm


class NonlinearLstm(nn.Module):
    """A layer for each slot, and two LSTMs over all of them.

    Args:
        slot_hidden: How many numbers the layer makes of a slot.
        hidden: The width of the LSTMs.
    """

    features = BASELINE_FEATURES
    """How many of a slot's numbers it reads."""

    def __init__(self, slot_hidden: int = 256, hidden: int = 512) -> None:
        super().__init__()
        self.slot = nn.Sequential(nn.Linear(BASELINE_FEATURES, slot_hidden, bias=False), nn.ReLU())
        self.lstms = nn.Sequential(Lstm(SLOTS * slot_hidden, hidden), Lstm(hidden, hidden))
        self.box = nn.Linear(hidden, 4, bias=False)

    def forward(self, features: Tensor, weights: Tensor | None = None) -> Tensor:
        """Give (batch, frames, 4) boxes, x1 y1 x2 y2 as shares of the picture.

        Args:
            features: (batch, frames, 15, 5).
            weights: Not used: there is no attention to guide.
        """
        del weights
        boxes: Tensor = self.box(self.lstms(self.slot(features).flatten(2)))
        return boxes
