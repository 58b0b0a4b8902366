"""Seating a part in another: `insert`, and the way to a seat that screwing shares with it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from runtime.drivers.limits import MotionError
from runtime.drivers.motions.handling import give_up, look_again, release
from runtime.drivers.motions.places import Held, Place, add, is_round
from runtime.drivers.motions.planner import Planner
from runtime.drivers.steps import Look
from runtime.kinematics import Joints, Matrix
from runtime.parts import Seat

_ABOVE_RIM_M: Final = 0.008
_WIDEST_SPIRAL_M: Final = 0.002
_CLOSEST_SPIRAL_M: Final = 0.0005
_FORGIVES: Final = 0.7  # of the radius of an opening's mouth: windings overlap in it


@dataclass(frozen=True, slots=True)
class Seating:
    """What goes where.

    Args:
        held: The part in the hand.
        seat: Where it fits, as drawn.
        centre: Where its centre will be, m, base frame.
        sunk_m: How far its lower face will be below the top of what it goes into.
    """

    held: Held
    seat: Seat
    centre: Place
    sunk_m: float = 0.0


def insert(planner: Planner, hand: str, obj: str, into: str) -> None:
    """Seat the held part in another one, by force."""
    if give_up(planner) or look_again(planner):
        return
    seating = find_seat(planner, hand, obj, into)
    if seating.seat.thread is not None:
        raise MotionError(
            f"{obj} is screwed into {into}, not pressed: (screw-in {hand} {obj} {into})"
        )
    look_first(planner)
    target, joints = over_seat(planner, seating, f"reach the seat of {obj} in {into}")
    tolerance = planner.config.force.seat_tolerance_m
    press(planner, seating.seat, target, joints, seating.seat.press_n, tolerance)
    release(planner, hand, obj, seating.centre, seating.held)


def find_seat(planner: Planner, hand: str, obj: str, into: str) -> Seating:
    """Find where the held part fits in another one.

    Raises:
        MotionError: It is not held, or fits nowhere there.
    """
    places = planner.places
    held = places.held(hand, obj, gripped=planner.gripped)
    receiver = places.part(into)
    seat = next((seat for seat in held.part.seats if seat.into == receiver.type), None)
    if seat is None:
        raise MotionError(f"{obj} ({held.part.type}) fits nowhere in {into} ({receiver.type})")
    planner.hangs_m = held.hangs_m
    sunk = (receiver.size[2] + held.part.size[2]) / 2 - seat.offset[2]
    return Seating(held, seat, add(places.position(into), seat.offset), max(0.0, sunk))


def look_first(planner: Planner) -> None:
    """Go to the look pose and look, unless that has been done."""
    if not planner.progress.looked:
        planner.rest()
        planner.steps.append(Look(planner.config.look_cycles, planner.remaining))


def over_seat(
    planner: Planner,
    seating: Seating,
    what: str,
    *,
    above_m: float = 0.0,
    prefer: Callable[[Joints], Joints] = lambda joints: joints,
) -> tuple[Matrix, Joints]:
    """Go over the seat and down to where the way by force begins: above all it could strike.

    Args:
        planner: Gets the steps.
        seating: What goes where.
        what: What this is for, as it stands in a refusal.
        above_m: How far above its seat the part will stand first: on a thread.
        prefer: Another way to hold the arm in the same pose, if there is one.

    Returns:
        The tool centre point and the joint angles when it stands there.
    """
    x, y, z = seating.centre
    centre = (x, y, z + above_m)
    now = planner.turned_rad
    above_rim_m = seating.sunk_m - above_m + _ABOVE_RIM_M
    return planner.reach(
        lambda turn: add(centre, seating.held.turned(turn - now)),
        what,
        above_m=max(planner.config.force.guard_m, above_rim_m),
        prefer=prefer,
        turnable=is_round(seating.held.part),
    )


def press(
    planner: Planner,
    seat: Seat,
    target: Matrix,
    joints: Joints,
    press_n: float,
    tolerance_m: float,
) -> None:
    """Go down by force to a target straight below, and be there."""
    force = planner.config.force
    if press_n > 0.8 * force.most_n:
        raise MotionError(
            f"it takes {press_n:g} N to seat it; the configuration allows {force.most_n:g} N "
            "(force.most_n), and that with some margin"
        )
    planner.press(
        target,
        joints,
        press_n=press_n,
        tolerance_m=tolerance_m,
        search_m=force.search_radius_m,
        spiral_m=min(_WIDEST_SPIRAL_M, max(_CLOSEST_SPIRAL_M, _FORGIVES * _mouth_m(seat))),
    )


def _mouth_m(seat: Seat) -> float:
    """Give how far beside its axis a part is still led into a seat, m."""
    return seat.clearance_m + seat.chamfer_m
