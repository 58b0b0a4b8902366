"""How the light changes, and with it what a detector makes of the same view.

Both are smooth functions of the frame's number that look random: normal numbers drawn for every so
many frames, and a mixture of two of them in between whose spread is that of each.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

_STEADY_FRAMES: Final = 12  # how long what is half recognised stays as it is, roughly
_LIGHT: Final = 8
_LUCK: Final = 9
_ROOT_2: Final = math.sqrt(2)


def brightness(seed: int, frame: int, frames: int) -> float:
    """Give the light at a frame, from 0 (worst) to 1, changing within about `frames` frames."""
    [normal] = _wandering(seed, _LIGHT, frame, frames, 1)
    return _share(normal)


def persistent_chances(seed: int, frame: int, count: int) -> NDArray[np.float64]:
    """Give a number in [0, 1] for each part, evenly spread over time, changing slowly."""
    wandering = _wandering(seed, _LUCK, frame, _STEADY_FRAMES, count)
    return np.array([_share(normal) for normal in wandering])


def _wandering(seed: int, kind: int, frame: int, frames: int, count: int) -> list[float]:
    knot, rest = divmod(frame, max(1, frames))
    share = rest / max(1, frames)
    one, other = (
        np.random.default_rng([seed, kind, number]).standard_normal(count)
        for number in (knot, knot + 1)
    )
    mixed: list[float] = (
        ((1 - share) * one + share * other) / math.hypot(1 - share, share)
    ).tolist()
    return mixed


def _share(normal: float) -> float:
    """Give the share of a normal distribution below a value."""
    return (1 + math.erf(normal / _ROOT_2)) / 2
