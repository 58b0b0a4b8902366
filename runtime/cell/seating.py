"""Where a part goes into another: how high it stands beside, on the edge of, and in its seat.

A seat is an opening with play, its edge broken at 45 degrees. A part that is lowered beside it
stands on the rim; on the broken edge it is led inwards; in line with it, it goes down to its seat,
or as far as something lets it: the beginning of a thread, or a jam.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

import numpy as np

from runtime.cell.support import Floats, heading, resting_heights
from runtime.kinematics import Matrix
from runtime.parts import PartModel, Seat, Vector

_WALL_M: Final = 0.001  # what rises this far above the rim of an opening is not its edge
_ENGAGED_WITHIN_M: Final = 0.02  # a part stands on its own dowels this far around its seat


@dataclass(frozen=True, slots=True, eq=False)
class Opening:
    """A seat of one part, for another that could go in as it is turned now.

    Args:
        receiver: Name of the part that has the seat.
        model: That part.
        pose: (4, 4), where it stands.
        seat: Its clearance, edge and thread.
        centre: The centre of the part once it is seated, m in the base frame.
        rim_m: How high the part's centre stands on the rim, m.
        floor_m: How low its centre goes when it is in line, m: its seat, or what is in the way.
    """

    receiver: str
    model: PartModel
    pose: Matrix
    seat: Seat
    centre: Vector
    rim_m: float
    floor_m: float

    @property
    def mouth_m(self) -> float:
        """How far beside its axis a part is still led in, m."""
        return self.seat.clearance_m + self.seat.chamfer_m

    def beside_m(self, x: float, y: float) -> float:
        """Give how far a place is beside its axis, m."""
        return math.hypot(x - self.centre[0], y - self.centre[1])


def openings(
    part: PartModel,
    yaw: float,
    receivers: Iterable[tuple[str, PartModel, Matrix]],
    turn_rad: float,
) -> tuple[Opening, ...]:
    """Give every seat a part would go into as it is turned.

    Args:
        part: The part.
        yaw: How it is turned about the vertical, rad.
        receivers: Name, model and upright pose of the parts that might have a seat for it.
        turn_rad: How far a part that is not round may be turned and still fit.
    """
    return tuple(
        _opening(part, yaw, name, model, pose, seat)
        for name, model, pose in receivers
        for seat in part.seats
        if seat.into == model.type and _turned_right(part, yaw - heading(pose), turn_rad)
    )


def field_over(part: PartModel, yaw: float, places: Floats, opening: Opening) -> Floats:
    """Give how high a part's centre stands on a part with a seat for it, (n,) m.

    Args:
        part: The part that is lowered.
        yaw: How it is turned, rad.
        places: (n, 2), x and y of its centre, m.
        opening: The seat. -inf stands where the part passes the receiver by.
    """
    heights = resting_heights(part, yaw, places, opening.model, opening.pose)
    away = np.hypot(*(places - np.asarray(opening.centre[:2])).T)
    on_dowels = away < _ENGAGED_WITHIN_M
    raised = np.maximum(heights, opening.centre[2] + opening.seat.engages_m)
    heights = np.where(on_dowels, raised, heights)
    edge = np.maximum(opening.floor_m, opening.rim_m - (opening.mouth_m - away))
    inside = (away <= opening.mouth_m) & (heights <= opening.rim_m + _WALL_M)
    heights = np.where(inside, np.minimum(edge, opening.rim_m), heights)
    return np.where(inside & (away <= opening.seat.clearance_m), opening.floor_m, heights)


def _opening(
    part: PartModel, yaw: float, name: str, model: PartModel, pose: Matrix, seat: Seat
) -> Opening:
    x, y, z = (pose @ np.array([*seat.offset, 1.0]))[:3].tolist()
    [rim] = resting_heights(part, yaw, np.array([[x, y]]), model, pose)
    rim = max(float(rim), z + seat.engages_m)
    floor = z if seat.thread is None else min(rim, z + seat.thread.depth_m)
    return Opening(name, model, pose, seat, (x, y, z), rim, floor)


def _turned_right(part: PartModel, turn: float, turn_rad: float) -> bool:
    return is_round(part) or abs(math.remainder(turn, math.pi)) <= turn_rad


def is_round(model: PartModel) -> bool:
    """Tell whether a part looks the same however it is turned about the vertical."""
    return all(
        solid.shape == "cylinder" and solid.offset[:2] == (0.0, 0.0) for solid in model.primitives
    )
