"""OPNet: one recurrent network says whom to follow, a second one where the snitch then is.

Who: an LSTM reads all slots and gives each its share of the attention. What is attended to is the
mean of the slots' features, weighted by these shares. Where: an LSTM reads that one box, and
gives the snitch's. Nothing says where the attention has to be; it is learned along with the boxes.

OPNet+AA is the same network with a matrix W that multiplies the attention (`guidance.py`).

Source: Shamsian et al., Learning Object Permanence from Video, ECCV 2020, section 4 and the
published code; Liang et al. 2021, Fig. 3.
"""

from __future__ import annotations

from typing import Literal

import torch
from torch import Tensor, nn

from aapa.neural.features import FEATURES, SLOTS
from aapa.neural.models.recurrence import Lstm


class WhoToTrack(nn.Module):
    """Shares of the attention, frame by frame.

    Args:
        hidden: The width of the LSTM.
    """

    def __init__(self, hidden: int) -> None:
        super().__init__()
        self.lstm = Lstm(SLOTS * FEATURES, hidden)
        self.slots = nn.Linear(hidden, SLOTS, bias=False)

    def forward(self, features: Tensor) -> Tensor:
        """Give (batch, frames, 15) shares, which add up to 1, of (batch, frames, 15, 6)."""
        shares: Tensor = self.slots(self.lstm(features.flatten(2))).softmax(dim=-1)
        return shares


class OPNet(nn.Module):
    """Who to track, and where it is.

    Args:
        who_hidden: The width of the LSTM that attends.
        where_hidden: The width of what gives the box.
        where: "lstm", or "mlp" for the published variant that has no memory there.
    """

    features = FEATURES
    """How many of a slot's numbers it reads."""

    def __init__(
        self,
        who_hidden: int = 256,
        where_hidden: int = 512,
        *,
        where: Literal["lstm", "mlp"] = "lstm",
    ) -> None:
        super().__init__()
        self.renormalise = False
        """With weights: divide the weighted attention by its sum, so that it remains one."""
        self.who = WhoToTrack(who_hidden)
        self.where: nn.Module = (
            Lstm(FEATURES, where_hidden)
            if where == "lstm"
            else nn.Sequential(nn.Linear(FEATURES, where_hidden, bias=False), nn.ReLU())
        )
        self.box = nn.Linear(where_hidden, 4, bias=False)

    def forward(self, features: Tensor, weights: Tensor | None = None) -> Tensor:
        """Give (batch, frames, 4) boxes, x1 y1 x2 y2 as shares of the picture.

        Args:
            features: (batch, frames, 15, 6).
            weights: (batch, frames, 15) W, or None.
        """
        return self.locate(features, self.who(features), weights)

    def locate(self, features: Tensor, shares: Tensor, weights: Tensor | None = None) -> Tensor:
        """Give the boxes where the attention is known.

        Args:
            features: (batch, frames, 15, 6).
            shares: (batch, frames, 15) what `who` gives.
            weights: (batch, frames, 15) W, or None.
        """
        if weights is not None:
            shares = shares * weights
            if self.renormalise:
                shares = shares / shares.sum(dim=-1, keepdim=True)
        attended = torch.einsum("bts,btsf->btf", shares, features)
        boxes: Tensor = self.box(self.where(attended))
        return boxes
