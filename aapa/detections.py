"""What a detector reports in one frame."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

Box: TypeAlias = tuple[float, float, float, float]
"""x1, y1, x2, y2 in px, origin at the top left of the image."""

Position: TypeAlias = tuple[float, float, float]
"""x, y, z in m, in the robot's base frame."""


@dataclass(frozen=True, slots=True)
class Detection:
    """One detected object, or a body that reports its own place.

    Args:
        type: The detector's class, such as "cone" or "hubcover".
        box: Where it was seen in the image, px.
        score: The detector's confidence in [0, 1].
        position: Its centre in the base frame, m, where depth and the camera's pose are known.
        size: Its width and height, m, where known.
        name: Set only for a body whose identity is not in doubt, such as the robot's own hand,
            whose position comes from its joints: it is anchored under this name, never assigned.
    """

    type: str
    box: Box
    score: float = 1.0
    position: Position | None = None
    size: tuple[float, float] | None = None
    name: str | None = None
