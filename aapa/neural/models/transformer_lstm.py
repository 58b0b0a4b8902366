"""Transformer + LSTM: the slots of a frame attend to each other; the snitch's goes to two LSTMs.

The published program hands the encoder its axes in the wrong order, so that a slot attends to
itself in all frames of all videos of the batch: neither what the paper says nor what can be
computed for a video alone. Here slots attend to the slots of their frame.

Source: Shamsian et al., Learning Object Permanence from Video, ECCV 2020 (the published code).
"""

from __future__ import annotations

from torch import Tensor, nn

from aapa.neural.models.baseline_lstm import BASELINE_FEATURES
from aapa.neural.models.recurrence import Lstm


class TransformerLstm(nn.Module):
    """An encoder over the slots of a frame, and two LSTMs over what it makes of the snitch's.

    Args:
        slot_hidden: The width of the encoder, a multiple of the heads.
        feedforward: The width of its inner layers.
        heads: How many attentions each of its layers has.
        layers: How many layers it has.
        hidden: The width of the LSTMs.
        dropout: Which share of the encoder's values is left out in training.
    """

    features = BASELINE_FEATURES
    """How many of a slot's numbers it reads."""

    def __init__(
        self,
        slot_hidden: int = 256,
        feedforward: int = 2048,
        heads: int = 2,
        layers: int = 2,
        hidden: int = 512,
        dropout: float = 0.1,
    ) -> None:
        super().__init__()
        self.slot = nn.Sequential(nn.Linear(BASELINE_FEATURES, slot_hidden, bias=False), nn.ReLU())
        layer = nn.TransformerEncoderLayer(
            slot_hidden, heads, feedforward, dropout, batch_first=True
        )
        self.encoder = nn.TransformerEncoder(layer, layers, enable_nested_tensor=False)
        self.lstms = nn.Sequential(Lstm(slot_hidden, hidden), Lstm(hidden, hidden))
        self.box = nn.Linear(hidden, 4, bias=False)

    def forward(self, features: Tensor, weights: Tensor | None = None) -> Tensor:
        """Give (batch, frames, 4) boxes, x1 y1 x2 y2 as shares of the picture.

        Args:
            features: (batch, frames, 15, 5).
            weights: Not used: it is the encoder that attends, among all slots.
        """
        del weights
        batch, frames = features.shape[:2]
        slots = self.encoder(self.slot(features).flatten(0, 1))
        snitch = slots[:, 0].unflatten(0, (batch, frames))
        boxes: Tensor = self.box(self.lstms(snitch))
        return boxes
