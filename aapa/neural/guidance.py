"""OPNet+AA: which slot the network is told to look at, and how loudly.

A vector v holds for each frame the slot of the object to follow: the snitch, or the top-most
parent it is attached to. W is 1 everywhere but at v, where it is w. It multiplies the attention
after the softmax, and nothing is renormalised: where the slot to follow is empty in a frame, the
product is 0 there and the network has to remember. The paper's best is w = 100 and no softmax.

Source: Liang et al. 2021, section III-A and IV-B; its discussion of products that are 0.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from aapa.errors import AnchoringError
from aapa.neural.features import SLOTS

GuidanceMode = Literal["product", "softmax", "renormalised"]
"""How W acts on the attention.

product: W is multiplied with it, as published. softmax: the same, W normalised by a softmax over
the slots first, the paper's option. renormalised: W is multiplied with it, and what comes of it
divided by its sum, so that it remains an attention.
"""

GUIDANCE_MODES: Final[tuple[GuidanceMode, ...]] = get_args(GuidanceMode)
"""All ways in which W may act."""

PAPER_WEIGHT: Final = 100.0
"""The paper's w."""

NO_SLOT: Final = -1
"""Stands in v where there is nothing to be told: the object to follow has no slot."""


def tracked_slots(classes: NDArray[np.integer], order: Sequence[int]) -> NDArray[np.int8]:
    """Give (frames,) v, the slots of what is to be looked at.

    Args:
        classes: (frames,) the class of what is to be looked at; any other number for nothing.
        order: The classes of the video in the order of their slots.

    Returns:
        `NO_SLOT` where the class is never detected, or comes after those that have a slot.

    Example:
        >>> tracked_slots(np.array([140, 3, 7]), (140, 3)).tolist()
        [0, 1, -1]
    """
    slots = np.full(len(classes), NO_SLOT, dtype=np.int8)
    for slot, number in enumerate(order[:SLOTS]):
        slots[classes == number] = slot
    return slots


def attention_weights(
    v: NDArray[np.integer], w: float = PAPER_WEIGHT, mode: GuidanceMode = "product"
) -> NDArray[np.float32]:
    """Give W.

    Args:
        v: (…, frames) the slot to follow. A number that is no slot tells nothing: the row of W
            stays 1, as in the published code.
        w: How loudly, above 0.
        mode: See `GuidanceMode`. The renormalised W is the same as the product's: it is the
            network that divides, once it knows its attention.

    Returns:
        (…, frames, 15).

    Raises:
        AnchoringError: The weight is not above 0, or there is no such mode.

    Example:
        >>> attention_weights(np.array([0, 2]), 100.0)[:, :4].tolist()
        [[100.0, 1.0, 1.0, 1.0], [1.0, 1.0, 100.0, 1.0]]
    """
    if not (w > 0 and np.isfinite(w)):
        raise AnchoringError(f"the weight of the guidance is {w}; it has to be above 0")
    if mode not in GUIDANCE_MODES:
        known = ", ".join(GUIDANCE_MODES)
        raise AnchoringError(f"there is no guidance {mode!r}; known are {known}")
    told = v[..., None] == np.arange(SLOTS)
    weights = np.where(told, np.float32(w), np.float32(1))
    if mode != "softmax":
        return weights
    powers = np.exp(weights.astype(np.float64) - weights.max(axis=-1, keepdims=True))
    normalised: NDArray[np.float32] = (powers / powers.sum(axis=-1, keepdims=True)).astype(
        np.float32
    )
    return normalised
