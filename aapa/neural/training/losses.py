"""What a network is to make small: how far its boxes are off, and its attention if it is taught.

Boxes count by the mean distance of predicted and true edges (L1), over all frames, those in which
the snitch cannot be seen included.

Source: Shamsian et al. 2020 (the published code).
"""

from __future__ import annotations

from typing import Final

import torch
from torch import Tensor, nn

from aapa.neural.models.opnet import OPNet
from aapa.neural.training.batches import Batch
from aapa.neural.training.hyperparameters import Stage

_UNLIKELY: Final = 1e-6
"""A share of the attention below this is no worse: the logarithm of 0 teaches nothing."""


def losses(model: nn.Module, batch: Batch, stage: Stage) -> tuple[Tensor | None, Tensor | None]:
    """Give the loss of the boxes and that of the attention.

    Args:
        model: Any of `NETWORKS`.
        batch: What it sees.
        stage: What it is to learn. Attention is taught to OPNet alone.

    Returns:
        None for what it is not to learn; never both.
    """
    numbers = model.features
    assert isinstance(numbers, int)
    device = next(model.parameters()).device
    features = torch.from_numpy(batch.features[..., :numbers]).to(device)
    weights = None if batch.weights is None else torch.from_numpy(batch.weights).to(device)
    true = torch.from_numpy(batch.boxes).to(device)
    if batch.attend is None or not isinstance(model, OPNet):
        boxes: Tensor = model(features, weights)
        return (boxes - true).abs().mean(), None
    shares = model.who(features)
    wanted = torch.from_numpy(batch.attend).to(device)[..., None]
    taught = -shares.gather(-1, wanted).clamp_min(_UNLIKELY).log().mean() * stage.teach
    if not stage.boxes:
        return None, taught
    return (model.locate(features, shares, weights) - true).abs().mean(), taught
