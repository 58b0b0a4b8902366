"""Containment inferred from geometry: two things do not stand in one place.

Where a cone has come to rest on the very place of a smaller thing that is no longer seen, that
thing is in it. No action has to be reported for that; where one is reported, the report counts.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from aapa.detections import Box
from aapa.lacater.models.plus.ground import GroundView, Place
from aapa.lacater.models.plus.solids import Solid

REACH: Final = 0.3
"""Nearer than this, in units of the scene, nothing stands beside a cone that could hold it."""

_FITS_PX: Final = 2.5


def container_at(
    view: GroundView,
    place: Place,
    radius: float,
    cones: Iterable[tuple[str, Solid, Box]],
) -> str | None:
    """Give the cone that stands where something vanished, the nearest of several.

    Args:
        view: The camera.
        place: Where it vanished.
        radius: Its radius; a cone that holds it is larger.
        cones: Name, solid and box, px, of those that are seen and at rest.
    """
    best, found = REACH, None
    for name, solid, box in cones:
        if not solid.is_cone or solid.radius <= radius:
            continue
        there = on_floor(view, solid, box)
        if there is None:
            continue
        far = ((there[0] - place[0]) ** 2 + (there[1] - place[1]) ** 2) ** 0.5
        if far < best:
            best, found = far, name
    return found


def on_floor(view: GroundView, solid: Solid, box: Box) -> Place | None:
    """Give where a solid stands; None where its box shows that it is not on the floor."""
    place = view.place(solid, box)
    if place is None:
        return None
    try:
        expected = view.box(solid, place)
    except ValueError:
        return None
    free = view.free_edges(box)
    worst = max(
        abs(edge - other) * weight for edge, other, weight in zip(box, expected, free, strict=True)
    )
    return place if worst < _FITS_PX else None
