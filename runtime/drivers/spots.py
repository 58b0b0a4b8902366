"""Where a part can be put down: spots on which nothing stands, seen or believed to be there."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from typing import Final

from aapa import Anchor
from runtime.config import RobotConfig
from runtime.parts import PartModel

_STEP: Final = 0.02  # m between the spots looked at
_UNKNOWN_RADIUS: Final = 0.06  # m around an object whose size nobody knows


def free_spots(
    part: PartModel,
    here: tuple[float, float],
    others: Iterable[Anchor],
    config: RobotConfig,
    parts: Mapping[str, PartModel],
) -> Iterator[tuple[float, float]]:
    """Give free spots of the put-down area, nearest first.

    A spot is free when the part, and the open gripper around it, clear every anchored object; an
    object that is hidden now is there all the same.

    Args:
        part: What is to be put down.
        here: x and y from which nearness is counted, m.
        others: The other objects; those without a place are ignored.
        config: Gives the area and the gripper's outline.
        parts: What is known of the parts, by type.
    """
    x0, x1, y0, y1 = config.workspace.put_down
    own = max(_radius(part.size), config.gripper.width_m / 2)
    taken = [
        (other.position, own + _extent(other, parts))
        for other in others
        if other.position is not None
    ]
    grid = [
        (x0 + _STEP * i, y0 + _STEP * j)
        for i in range(int((x1 - x0) / _STEP) + 1)
        for j in range(int((y1 - y0) / _STEP) + 1)
    ]
    if x0 <= here[0] <= x1 and y0 <= here[1] <= y1:
        grid.append(here)
    for spot in sorted(grid, key=lambda spot: (math.dist(spot, here), spot)):
        if all(math.dist(spot, place[:2]) > distance for place, distance in taken):
            yield spot


def _extent(anchor: Anchor, parts: Mapping[str, PartModel]) -> float:
    known = parts.get(anchor.type)
    if known is not None:
        return _radius(known.size)
    return max(anchor.size) / 2 if anchor.size is not None else _UNKNOWN_RADIUS


def _radius(size: tuple[float, float, float]) -> float:
    """Give the radius of the circle around a footprint of width and depth, m."""
    return math.hypot(size[0], size[1]) / 2
