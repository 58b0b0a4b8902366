"""What it costs to take a detection for an anchor: the exchangeable part of the alignment.

The paper leaves the formula open. Squared centre distance is the reading of its thresholds that
reproduces its tables, and the default; the others are for scenes in which boxes say more than
their middles, such as few frames a second or objects of one type and different sizes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from aapa.detections import Box

Rows: TypeAlias = NDArray[np.float64]
"""(k, d) one object a row, its features in the columns."""


class Place(NamedTuple):
    """What alignment looks at: a type, a centre in px (two numbers) or m (three), and the box."""

    type: str
    centre: tuple[float, ...]
    box: Box | None = None


@dataclass(frozen=True, slots=True)
class Cost:
    """A way to compare anchors with detections of the same type.

    Args:
        name: By which parameters choose it.
        features: What it needs to know of an object, as numbers.
        pairs: From (k, d) features of anchors and (k, d) of detections the (k,) costs, at least 0.
        reach: From tau the distance of centres beyond which every cost exceeds tau; None where
            there is no such bound, which makes large scenes slow.
    """

    name: str
    features: Callable[[Place], tuple[float, ...]]
    pairs: Callable[[Rows, Rows], NDArray[np.float64]]
    reach: Callable[[float], float] | None = None


def _centre(place: Place) -> tuple[float, ...]:
    return place.centre


def _box(place: Place) -> tuple[float, ...]:
    return place.box or (*place.centre[:2], *place.centre[:2])


def _squared_distances(old: Rows, new: Rows) -> NDArray[np.float64]:
    offsets = old - new
    if (
        offsets.ndim == offsets.shape[-1] == 2
    ):  # listed pairs in the image: the same, ten times as fast
        x, y = offsets[:, 0], offsets[:, 1]
        return x * x + y * y
    squares: NDArray[np.float64] = np.einsum("...k,...k->...", offsets, offsets)
    return squares


def _distance_and_size(old: Rows, new: Rows) -> NDArray[np.float64]:
    offsets = (old[..., :2] + old[..., 2:] - new[..., :2] - new[..., 2:]) / 2
    areas = [np.prod(boxes[..., 2:] - boxes[..., :2], axis=-1) for boxes in (old, new)]
    costs: NDArray[np.float64] = np.hypot(offsets[..., 0], offsets[..., 1]) + np.abs(
        np.sqrt(areas[0]) - np.sqrt(areas[1])
    )
    return costs**2


def _one_less_overlap(old: Rows, new: Rows) -> NDArray[np.float64]:
    low = np.maximum(old[..., :2], new[..., :2])
    high = np.minimum(old[..., 2:], new[..., 2:])
    shared = np.prod(np.maximum(high - low, 0.0), axis=-1)
    areas = [np.prod(boxes[..., 2:] - boxes[..., :2], axis=-1) for boxes in (old, new)]
    union = areas[0] + areas[1] - shared
    costs: NDArray[np.float64] = 1.0 - np.divide(
        shared, union, out=np.zeros_like(union), where=union > 0
    )
    return costs


CENTRE: Final = Cost("centre", _centre, _squared_distances, math.sqrt)
"""The squared distance of the centres: px² between boxes, m² between positions."""

CENTRE_AND_SIZE: Final = Cost("centre-and-size", _box, _distance_and_size, math.sqrt)
"""The square of: the distance of the centres and the difference of the mean sides, px²."""

OVERLAP: Final = Cost("overlap", _box, _one_less_overlap)
"""1 less the boxes' intersection over union; tau is at most 1."""

COSTS: Final[Mapping[str, Cost]] = MappingProxyType(
    {cost.name: cost for cost in (CENTRE, CENTRE_AND_SIZE, OVERLAP)}
)
"""The costs that parameters can name."""
