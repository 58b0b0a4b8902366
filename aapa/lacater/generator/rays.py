"""Rays from the camera, and how far along them a body is: a z-buffer without pixels.

A ray is given by its direction, whose depth is 1; how far along it a body is is then its depth.
The shapes are those of `bodies`, but for edges and spikes: a cube with sharp edges, a cylinder
with sharp rims, a ball for the snitch.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from aapa.lacater.generator.bodies import Body
from aapa.lacater.generator.outlines import rotations

_BALLS: Final = {"sphere": 0.9995, "spl": 1.16}
_HALF_HEIGHT = 0.65
_TINY = 1e-12


def depths(
    body: Body,
    places: NDArray[np.float64],
    tilts: NDArray[np.float64],
    eye: NDArray[np.float64],
    directions: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Give the depth (p, k) at which rays meet a body at p poses; infinity where they miss it.

    Args:
        body: What it is.
        places: (p, 3) where its origin is.
        tilts: (p,) how far it is tilted about its own y axis, rad.
        eye: (3,) the camera's place.
        directions: (p, k, 3) the rays of each pose.
    """
    start, along = local_rays(body, places, tilts, eye, directions)
    if body.shape in _BALLS:
        return _ball(start, along, _BALLS[body.shape])
    if body.shape == "cube":
        return _slab(start, along, (0, 1, 2), 1.0)[0]
    if body.shape == "cylinder":
        return _cylinder(start, along)
    return _cone(start, along)


def local_rays(
    body: Body,
    places: NDArray[np.float64],
    tilts: NDArray[np.float64],
    eye: NDArray[np.float64],
    directions: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Give start (p, 1, 3) and direction (p, k, 3) of rays as a body of radius 1 has them."""
    turn = rotations(body.yaw, tilts)
    start = (eye - places)[:, None, :] @ turn / body.radius
    return start, directions @ turn / body.radius


def _ball(
    start: NDArray[np.float64], along: NDArray[np.float64], radius: float
) -> NDArray[np.float64]:
    a = np.einsum("...i,...i->...", along, along)
    b = np.einsum("...i,...i->...", np.broadcast_to(start, along.shape), along)
    c = np.einsum("...i,...i->...", start, start) - radius**2
    return _nearer_root(a, b, c)


def _slab(
    start: NDArray[np.float64],
    along: NDArray[np.float64],
    axes: tuple[int, ...],
    half: float,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Give where rays enter the box |axis| <= half, infinity where they miss it, and leave it."""
    entry = np.full(along.shape[:-1], -np.inf)
    leave = np.full(along.shape[:-1], np.inf)
    for axis in axes:
        speed = np.where(np.abs(along[..., axis]) < _TINY, _TINY, along[..., axis])
        one = (-half - start[..., axis]) / speed
        two = (half - start[..., axis]) / speed
        entry = np.maximum(entry, np.minimum(one, two))
        leave = np.minimum(leave, np.maximum(one, two))
    return np.where(entry <= leave, entry, np.inf), leave


def _cylinder(start: NDArray[np.float64], along: NDArray[np.float64]) -> NDArray[np.float64]:
    a = along[..., 0] ** 2 + along[..., 1] ** 2 + _TINY
    b = start[..., 0] * along[..., 0] + start[..., 1] * along[..., 1]
    c = start[..., 0] ** 2 + start[..., 1] ** 2 - 1.0
    square = b**2 - a * c
    root = np.sqrt(np.maximum(square, 0.0))
    low, high = _slab(start, along, (2,), _HALF_HEIGHT)
    entry = np.maximum((-b - root) / a, low)
    leave = np.minimum((-b + root) / a, high)
    return np.where((square >= 0.0) & (entry <= leave), entry, np.inf)


def _cone(start: NDArray[np.float64], along: NDArray[np.float64]) -> NDArray[np.float64]:
    # Side: x² + y² = ((1 - z) / 2)² for z from -1 to 1; below it the base.
    rest, fall = (1.0 - start[..., 2]) / 2.0, -along[..., 2] / 2.0
    a = along[..., 0] ** 2 + along[..., 1] ** 2 - fall**2
    b = start[..., 0] * along[..., 0] + start[..., 1] * along[..., 1] - rest * fall
    c = start[..., 0] ** 2 + start[..., 1] ** 2 - rest**2
    a = np.where(np.abs(a) < _TINY, _TINY, a)
    square = b**2 - a * c
    root = np.sqrt(np.maximum(square, 0.0))
    best = np.full(np.broadcast_shapes(a.shape, b.shape), np.inf)
    for sign in (-1.0, 1.0):
        found = (-b + sign * root) / a
        height = start[..., 2] + found * along[..., 2]
        good = (square >= 0.0) & (np.abs(height) <= 1.0) & (found > 0.0)
        best = np.where(good & (found < best), found, best)
    speed = np.where(np.abs(along[..., 2]) < _TINY, _TINY, along[..., 2])
    base = (-1.0 - start[..., 2]) / speed
    x = start[..., 0] + base * along[..., 0]
    y = start[..., 1] + base * along[..., 1]
    good = (x**2 + y**2 <= 1.0) & (base > 0.0)
    return np.where(good & (base < best), base, best)


def _nearer_root(
    a: NDArray[np.float64], b: NDArray[np.float64], c: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Give the smaller solution of a t² + 2 b t + c = 0, infinity where there is none."""
    square = b**2 - a * c
    return np.where(square >= 0.0, (-b - np.sqrt(np.maximum(square, 0.0))) / a, np.inf)
