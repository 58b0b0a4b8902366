"""Whether the hand holds on to a part that stands in its thread, told by where the arm is.

What is known of the part itself may be old then: the motion that screwed it in was broken off, by a
stop or with the program. Pulling would tear it out of the fingers, or the fingers off the arm.
"""

from __future__ import annotations

import math
from typing import Final

from runtime.drivers.motions.places import Place, add
from runtime.drivers.motions.planner import Planner
from runtime.parts import PartModel, Seat

_BESIDE_M: Final = 0.006  # of its axis: as far as a seat is looked for
_BITES_M: Final = 0.0005  # below the beginning of its thread: a third of a turn
_BELOW_M: Final = 0.003


def holds_in_thread(planner: Planner) -> bool:
    """Tell whether the fingers are closed on something where a screw is in its thread."""
    return planner.gripped and any(
        _is_at(planner, add(receiver.position, seat.offset), part, seat)
        for part in planner.places.parts.values()
        for seat in part.seats
        if seat.thread is not None
        for receiver in planner.places.others()
        if receiver.type == seat.into and receiver.position is not None
    )


def _is_at(planner: Planner, centre: Place, part: PartModel, seat: Seat) -> bool:
    assert seat.thread is not None, "only threads are looked at"
    x, y, z = planner.tcp[:3, 3].tolist()
    above = z - part.grasp_height_m - centre[2]
    aside = math.hypot(x - centre[0], y - centre[1])
    return aside <= _BESIDE_M and -_BELOW_M <= above <= seat.thread.depth_m - _BITES_M
