"""What a hidden child's box is while it stands in its container, or moves by itself.

The child is a ball on the floor. How its real box differs from the ball's, seen once while it
could be compared, goes with it, as large as it looks where it is.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from aapa.detections import Box
from aapa.lacater.models.plus.ground import GroundView, Place
from aapa.lacater.models.plus.solids import SNITCH_SOLID

Trim = tuple[float, float, float, float]
"""How far the edges of a box are off those of the ball, in units of the scene at its depth."""

NO_TRIM: Trim = (0.0, 0.0, 0.0, 0.0)

_FARTHEST: Final = 0.06
"""The middle of the child's box is no farther off that of the ball, in units of the scene."""


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
        stood: The container's box in the last frame in which it was seen, px.
        lost: The container has not been seen since it was last compared with its place.
    """

    root: str
    place: Place | None
    trim: Trim
    since: Box
    child: Box
    rested: Box
    stood: Box
    lost: bool = False


def trim_of(
    view: GroundView, place: Place, box: Box, share: float, more: tuple[float, float]
) -> Trim:
    """Give how a box differs from the ball's at a place.

    Args:
        view: The camera.
        place: Where the ball is taken to be.
        box: As it was seen, px.
        share: Which share is believed of how far the box's middle is off the ball's.
        more: How much farther than the ball the child reaches to a side, and up and down, in
            units of the scene.

    Returns:
        Without the shift of the middle where the place is not before the camera.
    """
    wide, tall = more
    try:
        a, b, c, d = view.box(SNITCH_SOLID, place)
    except ValueError:
        return -wide, -tall, wide, tall
    scale = share * view.depth(place, SNITCH_SOLID.low) / view.focal / 2
    most = _FARTHEST * share
    across = min(max((box[0] - a + box[2] - c) * scale, -most), most)
    down = min(max((box[1] - b + box[3] - d) * scale, -most), most)
    return across - wide, down - tall, across + wide, down + tall


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
