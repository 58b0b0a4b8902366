"""Containment inferred from geometry: two things do not stand in one place.

Where a cone has come to rest on the very place of a smaller thing that is no longer seen, that
thing is in it. No action has to be reported for that; where one is reported, the report counts.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Final

from aapa.detections import Box
from aapa.lacater.models.plus.ground import GroundView, Place
from aapa.lacater.models.plus.solids import Solid

REACH: Final = 0.3
"""Nearer than this, in units of the scene, nothing stands beside a cone that could hold it."""

FITS_PX: Final = 2.5
"""The edges of a thing on the floor are no farther than this from where they should be."""


def distances(
    view: GroundView,
    place: Place,
    radius: float,
    cones: Iterable[tuple[str, Solid, Box]],
) -> dict[str, float]:
    """Give how far from where something vanished the cones stand that could hold it.

    Args:
        view: The camera.
        place: Where it vanished.
        radius: Its radius; a cone that holds it is larger.
        cones: Name, solid and box, px, of those that are seen and at rest.

    Returns:
        In units of the scene; without those that are not on the floor.
    """
    far = {}
    for name, solid, box in cones:
        if solid.is_cone and solid.radius > radius:
            there = on_floor(view, solid, box)
            if there is not None:
                far[name] = math.dist(there, place)
    return far


def on_floor(view: GroundView, solid: Solid, box: Box, fits: float = FITS_PX) -> Place | None:
    """Give where a solid stands; None where its box shows that it is not on the floor.

    Args:
        view: The camera.
        solid: What it is.
        box: Where it is seen, px.
        fits: How far an edge may be from where it should be, px.
    """
    place = view.place(solid, box)
    worst = None if place is None else _worst(view, solid, box, place)
    return place if worst is not None and worst < fits else None


def misfit(view: GroundView, solid: Solid, box: Box) -> float | None:
    """Give how far the worst edge of a box is from where it should be on the floor, px."""
    place = view.place(solid, box)
    return None if place is None else _worst(view, solid, box, place)


def _worst(view: GroundView, solid: Solid, box: Box, place: Place) -> float | None:
    try:
        expected = view.box(solid, place)
    except ValueError:
        return None
    free = view.free_edges(box)
    return max(
        abs(edge - other) * weight for edge, other, weight in zip(box, expected, free, strict=True)
    )
