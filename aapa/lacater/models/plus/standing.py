"""Where a container stands with the snitch in it, from the boxes of both."""

from __future__ import annotations

import math
from typing import Final

from aapa.detections import Box
from aapa.lacater.models.plus.appearance import Appearance
from aapa.lacater.models.plus.carrying import NO_TRIM, Bond, Trim, trim_of
from aapa.lacater.models.plus.containment import FITS_PX, REACH, misfit, on_floor
from aapa.lacater.models.plus.ground import Place
from aapa.lacater.models.plus.scenery import Scenery
from aapa.lacater.models.plus.solids import SNITCH_SOLID

TRIM_SHARE: Final = 0.2
"""Of how far the child's box is off where its container stands, this share is real; the rest is
the rounding of both."""

_FITS_STEADY_PX: Final = 1.6
_LONG_UNSEEN: Final = 5


def stands(
    scenery: Scenery, appearance: Appearance, root: str, box: Box, child: Box
) -> tuple[Place | None, Trim, bool]:
    """Give where a container and its child stand, as both boxes together tell.

    Args:
        scenery: What is seen, and by which camera.
        appearance: How the child looks.
        root: The container that can be seen.
        box: Its box, px.
        child: The child's box, px.

    Returns:
        The place, None if it is not known; the trim of the child's box; and whether the container
        was seen elsewhere, so that the report comes late, and the child has gone with it.
    """
    view, solid = scenery.camera(), scenery.solids.get(root)
    if view is None or solid is None:
        return None, NO_TRIM, False
    own = view.place(SNITCH_SOLID, child)
    unseen = scenery.things[root].missed
    # Not seen when it was set down, it was seen last in the air, where it stands nowhere; and
    # what has long been hidden may be anywhere.
    astray = unseen and on_floor(view, solid, box) is None
    place = own if unseen >= _LONG_UNSEEN or astray else view.place(solid, box)
    if place is None:
        return None, NO_TRIM, False
    if own is not None and math.dist(place, own) > REACH:
        if not unseen:
            return place, NO_TRIM, True
        place = own
    elif own is not None:
        place = (own[0] + place[0]) / 2, (own[1] + place[1]) / 2
    more = appearance.more(view, place)
    return place, trim_of(view, place, child, TRIM_SHARE, more), False


def foot_of(scenery: Scenery, bond: Bond, box: Box) -> Place | None:
    """Give where a container stands by its box, px; None where that is not one upon the floor."""
    view, solid = scenery.view, scenery.solids.get(bond.root)
    if view is None or solid is None:
        return None
    fits = FITS_PX if scenery.is_noisy else _FITS_STEADY_PX
    # How badly it fitted at rest is the calibration's fault, and says nothing of lifting.
    excuse = misfit(view, solid, bond.since) or 0.0
    return on_floor(view, solid, box, fits + excuse)
