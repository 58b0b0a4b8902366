"""The camera that films a generated scene: CATER's, which looks at the middle of the floor.

Coordinates: x, y on the floor and z up, in units of the scene; u to the right and v down, px.

Source: measured on CATER's Blender scene (Girdhar and Ramanan, CATER, ICLR 2020).
"""

from __future__ import annotations

import random
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

FOCAL_LENGTH_PX: Final = 350.0
"""A 35 mm lens before a 32 mm sensor of 320 px."""

PRINCIPAL_POINT_PX: Final = (160.0, 120.0)
"""The middle of the picture."""

DEFAULT_PLACE: Final = (7.48113, -6.50764, 5.34367)
"""Where the camera is before it is shaken, in units of the scene."""

_LOOKS_AT = (0.01433, 0.00261, 0.00113)
_JITTER = 0.5


@dataclass(frozen=True, slots=True, eq=False)
class Viewpoint:
    """A camera that stands still.

    Args:
        place: (3,) where it is, in units of the scene.
        axes: (3, 3) rows right, up, forward: unit vectors of the scene.
    """

    place: NDArray[np.float64]
    axes: NDArray[np.float64]

    @classmethod
    def at(cls, x: float, y: float, z: float) -> Viewpoint:
        """Give the camera that looks from there at CATER's target."""
        place = np.array((x, y, z))
        forward = np.array(_LOOKS_AT) - place
        forward /= np.linalg.norm(forward)
        right = np.cross(forward, (0.0, 0.0, 1.0))
        right /= np.linalg.norm(right)
        return cls(place, np.stack([right, np.cross(right, forward), forward]))

    @classmethod
    def drawn(cls, chance: random.Random) -> Viewpoint:
        """Draw a camera as CATER does: its place shaken by up to half a unit on each axis."""
        x, y, z = (value + chance.uniform(-_JITTER, _JITTER) for value in DEFAULT_PLACE)
        return cls.at(x, y, z)

    def seen_from_here(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Turn points of the scene (…, 3) into the camera's right, up, forward (…, 3)."""
        return (points - self.place) @ self.axes.T

    def project(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Give u, v in px and the depth (…, 3) of points of the scene (…, 3)."""
        seen = self.seen_from_here(points)
        depth = seen[..., 2]
        u = PRINCIPAL_POINT_PX[0] + FOCAL_LENGTH_PX * seen[..., 0] / depth
        v = PRINCIPAL_POINT_PX[1] - FOCAL_LENGTH_PX * seen[..., 1] / depth
        return np.stack([u, v, depth], axis=-1)

    def rays(self, pixels: NDArray[np.float64]) -> NDArray[np.float64]:
        """Give the direction (…, 3) in the scene, of depth 1, of points of the image (…, 2) px."""
        right = (pixels[..., 0] - PRINCIPAL_POINT_PX[0]) / FOCAL_LENGTH_PX
        up = (PRINCIPAL_POINT_PX[1] - pixels[..., 1]) / FOCAL_LENGTH_PX
        directions: NDArray[np.float64] = (
            right[..., None] * self.axes[0] + up[..., None] * self.axes[1] + self.axes[2]
        )
        return directions

    def directions(self) -> dict[str, tuple[float, float, float]]:
        """Give CATER's six directions: the camera's own on the floor, and above and below."""
        behind = _along_the_floor(self.axes[2])
        right = _along_the_floor(self.axes[0])
        above = np.array((0.0, 0.0, 1.0))
        named = {
            "behind": behind,
            "front": -behind,
            "left": -right,
            "right": right,
            "above": above,
            "below": -above,
        }
        return {name: _rounded(vector) for name, vector in named.items()}


def _along_the_floor(vector: NDArray[np.float64]) -> NDArray[np.float64]:
    flat = np.array((vector[0], vector[1], 0.0))
    unit: NDArray[np.float64] = flat / np.linalg.norm(flat)
    return unit


def _rounded(vector: NDArray[np.float64]) -> tuple[float, float, float]:
    # Adding 0.0 turns -0.0 into 0.0, which reads better in a file.
    x, y, z = (round(float(value), 6) + 0.0 for value in vector)
    return x, y, z
