"""Where things stand at first: at random, apart, and none quite beside or behind another.

Source: the published generator of CATER, which took it from CLEVR (Johnson et al., CVPR 2017).
"""

from __future__ import annotations

import math
import random
from collections.abc import Sequence
from typing import Final

from aapa.lacater.generator.bodies import FEWEST, MOST, Body, drawn_bodies
from aapa.lacater.generator.viewpoint import Viewpoint

HALF_SIDE: Final = 3.0
"""Things stand and go within this of the middle, on either axis of the floor."""

_TRIES = 50
_LEAST_GAP = 0.25
_LEAST_MARGIN = 0.4


def drawn_scene(
    viewpoint: Viewpoint, chance: random.Random
) -> tuple[tuple[Body, ...], list[tuple[float, float]]]:
    """Draw what stands where on the floor, x and y.

    Where a thing finds no place in fifty tries, all things are drawn anew, and as many: a crowded
    scene therefore has smaller things.
    """
    count = chance.randint(FEWEST, MOST)
    while True:
        bodies = drawn_bodies(count, chance)
        places = _attempt(bodies, viewpoint, chance)
        if places is not None:
            return bodies, places


def _attempt(
    bodies: Sequence[Body], viewpoint: Viewpoint, chance: random.Random
) -> list[tuple[float, float]] | None:
    directions = viewpoint.directions()
    axes = (directions["left"][:2], directions["behind"][:2])
    places: list[tuple[float, float]] = []
    for body in bodies:
        for _ in range(_TRIES):
            place = (chance.uniform(-HALF_SIDE, HALF_SIDE), chance.uniform(-HALF_SIDE, HALF_SIDE))
            if all(
                _stand_apart(place, other_place, body.radius + other.radius, axes)
                for other, other_place in zip(bodies, places, strict=False)
            ):
                places.append(place)
                break
        else:
            return None
    return places


def _stand_apart(
    first: tuple[float, float],
    second: tuple[float, float],
    radii: float,
    axes: Sequence[tuple[float, float]],
) -> bool:
    dx, dy = first[0] - second[0], first[1] - second[1]
    if math.hypot(dx, dy) - radii < _LEAST_GAP:
        return False
    return all(not 0 < abs(dx * x + dy * y) < _LEAST_MARGIN for x, y in axes)
