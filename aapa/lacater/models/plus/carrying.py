"""What a hidden child's box is while it stands in its container, or moves by itself.

The child is a ball on the floor. How its real box differs from the ball's, seen once while it
could be compared, goes with it, as large as it looks where it is.
"""

from __future__ import annotations

from dataclasses import dataclass

from aapa.detections import Box
from aapa.lacater.models.plus.ground import GroundView, Place
from aapa.lacater.models.plus.solids import SNITCH_SOLID

Trim = tuple[float, float, float, float]
"""How far the edges of a box are off those of the ball, in units of the scene at its depth."""

NO_TRIM: Trim = (0.0, 0.0, 0.0, 0.0)


@dataclass(slots=True)
class Bond:
    """A child in a container.

    Args:
        root: The outermost container: the one that can be seen.
        place: Where it stands on the floor, and with it the child; None if not known.
        trim: Of the child's box.
        since: The container's box when the child was bound to it, px.
        child: The child's box then, px.
        rested: The child's box when the container was last at rest, px.
    """

    root: str
    place: Place | None
    trim: Trim
    since: Box
    child: Box
    rested: Box


def trim_of(view: GroundView, place: Place, box: Box, share: float) -> Trim:
    """Give how a box differs from the ball's at a place.

    Args:
        view: The camera.
        place: Where the ball is taken to be.
        box: As it was seen, px.
        share: Which share of the difference is believed.

    Returns:
        No trim at all where the place is not before the camera.
    """
    try:
        a, b, c, d = view.box(SNITCH_SOLID, place)
    except ValueError:
        return NO_TRIM
    scale = share * view.depth(place, SNITCH_SOLID.low) / view.focal
    return (
        (box[0] - a) * scale,
        (box[1] - b) * scale,
        (box[2] - c) * scale,
        (box[3] - d) * scale,
    )


def trimmed(view: GroundView, place: Place, trim: Trim, lift: float = 0.0) -> Box | None:
    """Give the box of the child at a place, px, cut off at the image's border.

    None where the place is not before the camera.
    """
    try:
        a, b, c, d = view.box(SNITCH_SOLID, place, lift)
    except ValueError:
        return None
    scale = view.focal / view.depth(place, SNITCH_SOLID.low + lift)
    return view.clipped(
        (a + trim[0] * scale, b + trim[1] * scale, c + trim[2] * scale, d + trim[3] * scale)
    )


def untrimmed(view: GroundView, place: Place, trim: Trim, box: Box, lift: float) -> Box:
    """Give the box that the ball alone would have, from the child's, px; edges cut off stay."""
    scale = view.focal / view.depth(place, SNITCH_SOLID.low + lift)
    free = view.free_edges(box)
    x1, y1, x2, y2 = (
        edge - off * scale if weight else edge
        for edge, off, weight in zip(box, trim, free, strict=True)
    )
    return x1, y1, x2, y2
