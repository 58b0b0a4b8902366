"""A pinhole camera with a pose: between pixels and the base frame."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from aapa.detections import Position


@dataclass(frozen=True, slots=True, eq=False)
class Camera:
    """Intrinsics and pose of a camera without distortion.

    Args:
        width: Image width, px.
        height: Image height, px.
        focal_px: Focal length, px; square pixels, principal point at the image centre.
        position: Optical centre in the base frame, m.
        rotation: (3, 3), columns are the camera's right, down and forward axes in the base frame.
        near_m: Nothing closer than this (along the optical axis) can be detected.
    """

    width: int
    height: int
    focal_px: float
    position: Position
    rotation: NDArray[np.float64]
    near_m: float = 0.0

    def project(self, point: Position) -> tuple[float, float, float]:
        """Give u, v (px) and depth (m, along the optical axis; negative behind) of a point."""
        # As Python floats, since a point in the optical centre itself is no reason to warn.
        x, y, z = (self.rotation.T @ (np.asarray(point) - np.asarray(self.position))).tolist()
        scale = self.focal_px / z if abs(z) > 1e-9 else float("inf")
        return self.width / 2 + x * scale, self.height / 2 + y * scale, z

    def back_project(self, u: float, v: float, depth: float) -> Position:
        """Give the point of the base frame seen at u, v (px) at a depth (m)."""
        x = (u - self.width / 2) * depth / self.focal_px
        y = (v - self.height / 2) * depth / self.focal_px
        point = np.asarray(self.position) + self.rotation @ np.array([x, y, depth])
        return float(point[0]), float(point[1]), float(point[2])
