"""What stands on the floor, as far as its box in the image goes: cones, and balls.

Both look the same from all sides, so that a place on the floor is all there is to know of one.
Sizes are in units of the scene; that of CATER's classes is part of their names.

Source: measured on the meshes of CATER's Blender assets (a cone hovers 0.18 above the floor).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from aapa.lacater.classes import CLASS_NAMES, SNITCH

_RADII: Final = {"large": 0.75, "medium": 0.5, "small": 0.25}
_HOVER: Final = 0.1809
# A cone's foot has 32 corners; turned any way, it is as wide as a circle a little smaller.
_FOOT: Final = 0.9984


@dataclass(frozen=True, slots=True)
class Solid:
    """A cone or a ball upon the floor.

    Args:
        is_cone: A cone, its point up; else a ball.
        radius: Of the cone's foot, or of the ball.
        low: How high the cone's foot, or the middle of the ball, is above the floor.
        top: How high the cone's point is above the floor; of no meaning for a ball.
    """

    is_cone: bool
    radius: float
    low: float
    top: float = 0.0


SNITCH_SOLID: Final = Solid(is_cone=False, radius=0.3 * 1.16, low=0.342)
"""The snitch has spikes; this ball comes nearest to it."""


def solid_of(number: int) -> Solid | None:
    """Give the solid of a class, or None where it is neither a cone nor a ball.

    Example:
        >>> solid_of(0)
        Solid(is_cone=True, radius=0.7488, low=0.1809, top=1.6809)
    """
    if number == SNITCH:
        return SNITCH_SOLID
    size, _, shape, _ = CLASS_NAMES[number].split("_")
    radius = _RADII[size]
    if shape == "cone":
        return Solid(
            is_cone=True, radius=round(radius * _FOOT, 9), low=_HOVER, top=_HOVER + 2 * radius
        )
    if shape == "sphere":
        return Solid(is_cone=False, radius=radius, low=radius)
    return None
