"""How much of each body can be seen: the share of its outline that nothing nearer covers.

This is what the detector's noise depends on. The labels do not: theirs are box rules.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from aapa.lacater.generator.rays import depths
from aapa.lacater.generator.simulation import Simulation, changes

_SIDE: Final = 8
"""Rays are sent through a grid of so many by so many points of a body's box."""


def visible_shares(simulation: Simulation, contained: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Give the share (n, f) of each body's outline that is seen, in 0…1.

    Args:
        simulation: The video.
        contained: (n, f) what stands under a cone: it is not seen, and covers nothing.
    """
    boxes = simulation.boxes
    moved = np.stack(
        [
            changes(places, tilts)
            for places, tilts in zip(simulation.filmed, simulation.tilts, strict=True)
        ]
    )
    shares = np.ones(contained.shape)
    for index in range(len(boxes)):
        near = _overlapping(boxes, index) & ~contained
        relevant = near.any(axis=0) & ~contained[index]
        # What neither moved nor has anything moving before it looks as it did.
        fresh = relevant & (moved[index] | (near & moved).any(axis=0) | changes(near.T))
        fresh[1:] |= relevant[1:] & ~relevant[:-1]
        fresh[0] = relevant[0]
        frames = np.flatnonzero(fresh)
        if len(frames):
            seen = _seen(simulation, index, frames, near[:, frames])
            shares[index] = np.where(relevant, seen[np.maximum(np.cumsum(fresh) - 1, 0)], 1.0)
    shares[contained] = 0.0
    return shares


def _seen(
    simulation: Simulation,
    index: int,
    frames: NDArray[np.intp],
    near: NDArray[np.bool_],
) -> NDArray[np.float64]:
    """Give the share of a body that is seen at some frames, given what is near it at each."""
    viewpoint = simulation.viewpoint
    directions = viewpoint.rays(_grid(simulation.boxes[index, frames]))

    def depth_of(other: int, rows: NDArray[np.bool_]) -> NDArray[np.float64]:
        at = frames[rows]
        return depths(
            simulation.bodies[other],
            simulation.filmed[other, at],
            simulation.tilts[other, at],
            viewpoint.place,
            directions[rows],
        )

    own = depth_of(index, np.ones(len(frames), dtype=np.bool_))
    hit = np.isfinite(own)
    hidden = np.zeros(own.shape, dtype=np.bool_)
    for other in np.flatnonzero(near.any(axis=1)):
        rows = near[other]
        hidden[rows] |= depth_of(int(other), rows) < own[rows]
    total = np.maximum(hit.sum(axis=1), 1)
    seen: NDArray[np.float64] = (hit & ~hidden).sum(axis=1) / total
    return seen


def _overlapping(boxes: NDArray[np.float64], index: int) -> NDArray[np.bool_]:
    """Tell which other boxes (n, f) share area with one."""
    low = np.maximum(boxes[..., :2], boxes[index, :, :2])
    high = np.minimum(boxes[..., 2:], boxes[index, :, 2:])
    overlapping: NDArray[np.bool_] = np.all(low < high, axis=-1)
    overlapping[index] = False
    return overlapping


def _grid(boxes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Give points (p, k, 2) spread evenly over boxes (p, 4)."""
    steps = (np.arange(_SIDE) + 0.5) / _SIDE
    share = np.stack(np.meshgrid(steps, steps, indexing="ij"), axis=-1).reshape(-1, 2)
    corner, size = boxes[:, None, :2], boxes[:, None, 2:] - boxes[:, None, :2]
    grid: NDArray[np.float64] = corner + share * size
    return grid
