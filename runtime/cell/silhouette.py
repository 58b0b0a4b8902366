"""How a part would look if nothing stood in front of it and the image had no border."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from aapa import Box, Camera
from runtime.cell.world import PlacedPart
from runtime.parts import Primitive

Floats = NDArray[np.float64]

_RIM: Final = 24  # points on a cylinder's rim
_NEAREST_M: Final = 0.02  # a part reaching closer to the lens has no silhouette worth the name
_MOST_PIXELS: Final = 40_000  # larger silhouettes are counted on a coarser grid


@dataclass(frozen=True, slots=True)
class Silhouette:
    """A part's whole outline in the image plane.

    Args:
        box: Around it, px; may lie partly or wholly outside the image.
        pixels: How many pixels it would cover on an unbounded image, alone in the world.
    """

    box: Box
    pixels: float


def silhouette(part: PlacedPart, camera: Camera) -> Silhouette | None:
    """Give a part's unoccluded, unclipped outline; None if it is beside or behind the lens."""
    outlines: list[Floats] = []
    for solid in part.model.primitives:
        corners = _corners(solid) @ part.pose[:3, :3].T + part.pose[:3, 3]
        local = (corners - np.asarray(camera.position)) @ camera.rotation
        if local[:, 2].min() < _NEAREST_M:
            return None
        pixels = local[:, :2] * (camera.focal_px / local[:, 2:])
        outlines.append(pixels + np.array([camera.width / 2, camera.height / 2]))
    points = np.concatenate(outlines)
    x1, y1 = points.min(axis=0).tolist()
    x2, y2 = points.max(axis=0).tolist()
    stride = max(1, math.ceil(math.sqrt((x2 - x1) * (y2 - y1) / _MOST_PIXELS)))
    columns = np.arange(math.floor(x1), math.ceil(x2) + 1, stride) + 0.5
    rows = np.arange(math.floor(y1), math.ceil(y2) + 1, stride) + 0.5
    covered = np.zeros((len(rows), len(columns)), dtype=np.bool_)
    for outline in outlines:
        lower, upper = _hull(outline.tolist())
        inside = (columns >= lower[0, 0]) & (columns <= lower[-1, 0])
        top = np.interp(columns, lower[:, 0], lower[:, 1])
        bottom = np.interp(columns, upper[:, 0], upper[:, 1])
        covered |= inside & (rows[:, None] >= top) & (rows[:, None] <= bottom)
    return Silhouette((x1, y1, x2, y2), float(covered.sum()) * stride**2)


def _corners(solid: Primitive) -> Floats:
    """Give points, (n, 3) relative to the part's centre, whose convex hull is the solid."""
    half = np.asarray(solid.size) / 2
    if solid.shape == "box":
        signs = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
        corners: Floats = np.asarray(solid.offset) + signs * half
        return corners
    angles = np.arange(_RIM) * (2 * math.pi / _RIM)
    # Outside the circle by half the polygon's sagitta, so that its area is the circle's.
    radius = half[0] * (1 + (math.pi / _RIM) ** 2 / 3)
    ring = np.column_stack([radius * np.cos(angles), radius * np.sin(angles), 0 * angles])
    lift = np.array([0.0, 0.0, half[2]])
    rims: Floats = np.asarray(solid.offset) + np.concatenate([ring - lift, ring + lift])
    return rims


def _hull(points: Sequence[Sequence[float]]) -> tuple[Floats, Floats]:
    """Give the two chains of the convex hull from left to right, least y first (Andrew 1979)."""
    ordered = sorted((x, y) for x, y in points)
    chains = []
    for sign in (1.0, -1.0):
        chain: list[tuple[float, float]] = []
        for point in ordered:
            while len(chain) > 1 and sign * _turn(chain[-2], chain[-1], point) <= 0:
                chain.pop()
            chain.append(point)
        chains.append(np.array(chain))
    return chains[0], chains[1]


def _turn(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
