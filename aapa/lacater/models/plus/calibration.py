"""Self-calibration: how high the camera stands and how far it looks down, from boxes alone.

A solid of known size has four edges and but two unknowns, its place. What is left over tells
of the camera, which is the same for all. Gauss and Newton's method, the places eliminated.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from aapa.detections import Box
from aapa.lacater.models.plus.ground import GroundView
from aapa.lacater.models.plus.solids import Solid

_STEPS: Final = 6
_DELTA: Final = 1e-4
_WORST_PX: Final = 3.0
_PITCHES: Final = (0.1, 1.4)


def calibrated(guess: GroundView, seen: Sequence[tuple[Solid, Box]]) -> GroundView | None:
    """Give the camera that explains boxes best.

    Args:
        guess: Where to start; its focal length and image are kept.
        seen: Solids at rest and their boxes, px; the more places, the better.

    Returns:
        None where the boxes do not determine a camera.
    """
    view = guess
    used = list(seen)
    for step in range(_STEPS):
        rows = [row for row in (_row(view, solid, box) for solid, box in used) if row is not None]
        if len(rows) < 2:
            return None
        table = np.array(rows)
        rest, jacobian = table[:, :, 0], table[:, :, 1:]
        if step >= _STEPS // 2:
            # By now the camera is nearly right: what still fits badly is no such solid.
            fits = np.abs(rest).max(axis=1) < _WORST_PX
            if fits.sum() < 2:
                return None
            rest, jacobian = rest[fits], jacobian[fits]
        change = _step(rest, jacobian)
        if change is None:
            return None
        pitch = view.pitch + float(np.clip(change[0], -0.2, 0.2))
        height = view.height * math.exp(float(np.clip(change[1], -0.4, 0.4)))
        if not _PITCHES[0] < pitch < _PITCHES[1]:
            return None
        view = replace(view, pitch=pitch, height=height)
        if step >= _STEPS // 2 and np.abs(change).max() < 1e-5:
            break
    return view


def _row(view: GroundView, solid: Solid, box: Box) -> NDArray[np.float64] | None:
    """Give (4, 5): what is left over of each edge, px, and its slopes by place and camera."""
    if min(view.free_edges(box)) == 0:
        return None
    place = view.place(solid, box)
    if place is None:
        return None
    across, ahead = place
    lower = replace(view, pitch=view.pitch + _DELTA)
    higher = replace(view, height=view.height * (1 + _DELTA))
    try:
        now = np.array(view.box(solid, place))
        moved = (
            view.box(solid, (across + _DELTA, ahead)),
            view.box(solid, (across, ahead + _DELTA)),
            lower.box(solid, place),
            higher.box(solid, place),
        )
    except ValueError:
        return None
    slopes = (np.array(moved) - now).T / _DELTA
    row: NDArray[np.float64] = np.column_stack([np.array(box) - now, slopes])
    return row


def _step(rest: NDArray[np.float64], jacobian: NDArray[np.float64]) -> NDArray[np.float64] | None:
    """Give the change of pitch and the logarithm of the height that the left-overs ask for."""
    place, camera = jacobian[:, :, :2], jacobian[:, :, 2:]
    turned = place.transpose(0, 2, 1)
    try:
        onto = place @ np.linalg.solve(turned @ place, turned)
        free = camera - onto @ camera
        normal = np.einsum("nij,nik->jk", free, free)
        change: NDArray[np.float64] = np.linalg.solve(normal, np.einsum("nij,ni->j", free, rest))
    except np.linalg.LinAlgError:
        return None
    return change if np.isfinite(change).all() else None
