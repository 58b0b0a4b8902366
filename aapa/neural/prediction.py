"""A trained network asked about whole videos."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from aapa.errors import AnchoringError
from aapa.neural.features import BOX_SCALE, FEATURES, SLOTS

if TYPE_CHECKING:
    from torch.nn import Module


def predict(
    model: Module,
    features: NDArray[np.float32],
    weights: NDArray[np.float32] | None = None,
) -> NDArray[np.float64]:
    """Give the boxes of the snitch as a network has them.

    Args:
        model: As `load_checkpoint` gives it. It does not learn from this.
        features: (frames, 15, 6) of a video, see `tensor_of`, or (videos, frames, 15, 6) of some.
        weights: (frames, 15) W, or (videos, frames, 15), for a network with guidance.

    Returns:
        (frames, 4) px, x1 y1 x2 y2, or (videos, frames, 4). A network is free to give a box that
        is inside out, or out of the picture.

    Raises:
        AnchoringError: Features or weights are of another shape.
    """
    import torch  # noqa: PLC0415 - an extra

    if features.ndim not in {3, 4} or features.shape[-2:] != (SLOTS, FEATURES):
        raise AnchoringError(
            f"the features have the shape {features.shape}; expected (frames, {SLOTS}, {FEATURES})"
        )
    if weights is not None and weights.shape != features.shape[:-1]:
        raise AnchoringError(
            f"the weights have the shape {weights.shape}; expected {features.shape[:-1]}"
        )
    alone = features.ndim == 3
    given = torch.from_numpy(features[None] if alone else features)
    guidance = None
    if weights is not None:
        guidance = torch.from_numpy(weights[None] if alone else weights)
    numbers = model.features
    assert isinstance(numbers, int)
    device = next(model.parameters()).device
    model.eval()
    with torch.inference_mode():
        shares = model(
            given[..., :numbers].to(device), None if guidance is None else guidance.to(device)
        )
    boxes: NDArray[np.float64] = shares.double().cpu().numpy() * BOX_SCALE
    return boxes[0] if alone else boxes
