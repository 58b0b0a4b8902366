"""The floor as the camera sees it: from a place to a box, and from a box back to the place.

Places are across (to the right of the camera) and ahead of it along the floor, in units of the
scene. The camera stands at a height above the floor and looks down by an angle, without roll.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from aapa.detections import Box
from aapa.lacater.models.plus.solids import Solid

Place = tuple[float, float]
"""Across and ahead, in units of the scene."""

_STEPS = 3
_DELTA = 1e-4


@dataclass(frozen=True, slots=True)
class GroundView:
    """A camera above a floor.

    Args:
        height: Above the floor, in units of the scene.
        pitch: How far it looks down, rad.
        focal: Focal length, px.
        size: Width and height of the image, px; its middle is the principal point.
    """

    height: float
    pitch: float
    focal: float
    size: tuple[int, int]

    def depth(self, place: Place, above: float) -> float:
        """Give how far along the camera's axis a point above a place is."""
        return place[1] * math.cos(self.pitch) + (self.height - above) * math.sin(self.pitch)

    def box(self, solid: Solid, place: Place, lift: float = 0.0) -> Box:
        """Give the box of a solid at a place, px, not cut off at the border.

        Args:
            solid: What stands there.
            place: Where.
            lift: How high it is lifted off the floor.

        Raises:
            ValueError: It is not before the camera.
        """
        across, ahead = place
        cos, sin = math.cos(self.pitch), math.sin(self.pitch)
        down = self.height - solid.low - lift
        depth, up, radius = ahead * cos + down * sin, ahead * sin - down * cos, solid.radius
        if depth <= 2 * radius:
            raise ValueError("a solid has to be before the camera")
        if solid.is_cone:
            left, right = _tangents(across, depth, radius, cos)
            low = (up - radius * sin) / (depth - radius * cos)
            drop = self.height - solid.top - lift
            high = (ahead * sin - drop * cos) / (ahead * cos + drop * sin)
        else:
            left, right = _tangents(across, depth, radius, 1.0)
            low, high = _tangents(up, depth, radius, 1.0)
        f, (width, tall) = self.focal, self.size
        return (
            width / 2 + f * left,
            tall / 2 - f * high,
            width / 2 + f * right,
            tall / 2 - f * low,
        )

    def place(self, solid: Solid, box: Sequence[float], lift: float = 0.0) -> Place | None:
        """Give where a solid stands that has a box, px, by least squares over its free edges.

        An edge at the border of the image is cut off there, and left out of account.

        Returns:
            None where too few edges are free, or no place has such a box.
        """
        weights = self.free_edges(box)
        if sum(weights) < 3:
            return None
        across, ahead = self._guess(solid, box, lift)
        for _ in range(_STEPS):
            try:
                now = self.box(solid, (across, ahead), lift)
                right = self.box(solid, (across + _DELTA, ahead), lift)
                away = self.box(solid, (across, ahead + _DELTA), lift)
            except ValueError:
                return None
            aa = ab = bb = ra = rb = 0.0
            for weight, seen, here, by_across, by_ahead in zip(
                weights, box, now, right, away, strict=True
            ):
                a, b = (by_across - here) / _DELTA, (by_ahead - here) / _DELTA
                rest = (seen - here) * weight
                aa, ab, bb = aa + weight * a * a, ab + weight * a * b, bb + weight * b * b
                ra, rb = ra + rest * a, rb + rest * b
            scale = aa * bb - ab * ab
            if scale <= 0:
                return None
            across += (bb * ra - ab * rb) / scale
            ahead += (aa * rb - ab * ra) / scale
        return across, ahead

    def free_edges(self, box: Sequence[float]) -> tuple[float, float, float, float]:
        """Give 1 for each edge of a box that is within the image, 0 for one at its border."""
        width, tall = self.size
        return (
            float(box[0] > 1),
            float(box[1] > 1),
            float(box[2] < width - 1),
            float(box[3] < tall - 1),
        )

    def clipped(self, box: Box) -> Box:
        """Give what of a box is within the image, px."""
        width, tall = self.size
        return (
            min(max(box[0], 0.0), width),
            min(max(box[1], 0.0), tall),
            min(max(box[2], 0.0), width),
            min(max(box[3], 0.0), tall),
        )

    def _guess(self, solid: Solid, box: Sequence[float], lift: float) -> Place:
        wide = max(box[2] - box[0], 1.0)
        depth = 2 * solid.radius * self.focal / wide
        across = ((box[0] + box[2]) / 2 - self.size[0] / 2) * depth / self.focal
        down = self.height - solid.low - lift
        return across, (depth - down * math.sin(self.pitch)) / math.cos(self.pitch)


def _tangents(across: float, depth: float, radius: float, shape: float) -> tuple[float, float]:
    """Give the least and largest slope across/depth of a ball (shape 1), or of a flat circle.

    For a circle that lies along the floor the shape is the cosine of the camera's pitch, by which
    its extent in depth is shortened.
    """
    below = depth * depth - (radius * shape) ** 2
    middle = across * depth
    # The roots of (across - t depth)² = radius² (1 + t² shape²).
    spread = radius * math.sqrt(across * across * shape * shape + below)
    return (middle - spread) / below, (middle + spread) / below
