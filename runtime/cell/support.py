"""What a part comes to rest on when it is let go: height maps instead of contact dynamics.

The cell is quasi-static. A released part stays upright and falls straight down until the first
column of its underside meets something. Columns are sampled every few millimetres, which treats
stepped shafts, open boxes and lids alike. Tipping over and bouncing are left out.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache
from typing import Final

import numpy as np
from numpy.typing import NDArray

from runtime.kinematics import Matrix
from runtime.parts import PartModel, Primitive

Floats = NDArray[np.float64]

STEP_M: Final = 0.003
"""Distance between the columns of a height map, m."""

_PRESS_M: Final = 0.006  # a surface this far above an underside still counts as below it


def fall(
    model: PartModel, pose: Matrix, others: Iterable[tuple[str, PartModel, Matrix]]
) -> tuple[float, str | None]:
    """Give how far a part falls, and the name of what stops it (None: the table at z = 0).

    Args:
        model: The falling part.
        pose: (4, 4), its centre in the base frame, upright.
        others: Name, model and upright pose of everything it may land on.
    """
    columns = underside(model) @ pose[:3, :3].T + pose[:3, 3]
    stopped_by: str | None = None
    depth = float(columns[:, 2].min())
    for name, other, other_pose in others:
        tops = _tops(other, other_pose, columns)
        gap = float(np.min(columns[:, 2] - tops, initial=np.inf))
        if gap < depth:
            depth, stopped_by = gap, name
    return depth, stopped_by


@lru_cache(maxsize=64)
def underside(model: PartModel) -> Floats:
    """Give the lowest point of the part in each column, (n, 3), relative to its centre."""
    half_x, half_y = model.size[0] / 2, model.size[1] / 2
    x, y = np.meshgrid(_ticks(half_x), _ticks(half_y))
    flat = np.column_stack([x.ravel(), y.ravel()])
    lowest = np.full(len(flat), np.inf)
    for solid in model.primitives:
        inside = covers(solid, flat)
        lowest[inside] = np.minimum(lowest[inside], solid.offset[2] - solid.size[2] / 2)
    solid_columns = np.isfinite(lowest)
    return np.column_stack([flat[solid_columns], lowest[solid_columns]])


def covers(solid: Primitive, points: Floats) -> NDArray[np.bool_]:
    """Tell which points, (n, 2) m relative to the part's centre, lie over or under a solid."""
    dx = np.abs(points[:, 0] - solid.offset[0])
    dy = np.abs(points[:, 1] - solid.offset[1])
    if solid.shape == "cylinder":
        within: NDArray[np.bool_] = dx**2 + dy**2 <= (solid.size[0] / 2) ** 2
    else:
        within = (dx <= solid.size[0] / 2) & (dy <= solid.size[1] / 2)
    return within


def _tops(model: PartModel, pose: Matrix, columns: Floats) -> Floats:
    """Give the highest surface of a part below each column, -inf where there is none."""
    local = (columns - pose[:3, 3]) @ pose[:3, :3]
    tops = np.full(len(columns), -np.inf)
    near = np.abs(local[:, :2]).max(axis=1) <= max(model.size[0], model.size[1])
    if not near.any():
        return tops
    for solid in model.primitives:
        top = solid.offset[2] + solid.size[2] / 2
        under = covers(solid, local) & (local[:, 2] >= top - _PRESS_M)
        tops[under] = np.maximum(tops[under], pose[2, 3] + top)
    return tops


def _ticks(half: float) -> Floats:
    count = max(2, round(2 * half / STEP_M) + 1)
    return np.linspace(-half + 1e-6, half - 1e-6, count)
