"""Taking parts up and putting them down: `grasp`, `take-out`, `place`."""

from __future__ import annotations

import itertools
from typing import Final

from runtime.drivers.limits import MotionError
from runtime.drivers.motions.places import Held, Place, add, is_round
from runtime.drivers.motions.planner import Planner
from runtime.drivers.spots import free_spots

_SPOTS: Final = 10  # free spots tried before giving up
_LEAST_PLAY: Final = 0.004  # m that the open fingers leave around a part
_DROP_M: Final = 0.0015  # by which a part falls when it is put down: the table is not pressed


def grasp(planner: Planner, hand: str, obj: str) -> None:
    """Take hold of a part where it lies."""
    part, (x, y, z) = planner.places.part(obj), planner.places.position(obj)
    if planner.gripped:
        raise MotionError(f"{hand} cannot grasp {obj}: the gripper already feels a part")
    widest = planner.config.gripper.opening_m - _LEAST_PLAY
    if part.grip_width_m > widest:
        raise MotionError(
            f"{obj} is {part.grip_width_m:.3f} m wide where it is gripped; "
            f"the gripper takes at most {widest:.3f} m"
        )
    if planner.closed:
        planner.grip(close=False)
    planner.lift()
    target = (x, y, z + part.grasp_height_m)
    planner.reach(target, f"reach {obj}", turnable=is_round(part))
    planner.grip(close=True, part=part)
    planner.places.move(hand, target)


def take_out(planner: Planner, hand: str, obj: str, _into: str) -> None:
    """Take hold of a part and lift it out of what it sits in."""
    grasp(planner, hand, obj)
    planner.lift()


def place(planner: Planner, hand: str, obj: str) -> None:
    """Put the held part down at the nearest free spot of the put-down area."""
    held = planner.places.held(hand, obj, gripped=planner.gripped)
    planner.hangs_m = held.hangs_m
    planner.lift()
    here = (float(planner.tcp[0, 3]), float(planner.tcp[1, 3]))
    places = planner.places
    spots = free_spots(held.part, here, places.others(hand, obj), planner.config, places.parts)
    height = planner.config.workspace.table_z_m + held.part.size[2] / 2 + _DROP_M
    now = planner.turned_rad
    refusal = MotionError(f"there is no free spot to put {obj} down")
    for x, y in itertools.islice(spots, _SPOTS):
        centre = (x, y, height)
        try:
            planner.reach(
                lambda turn, centre=centre: add(centre, held.turned(turn - now)),  # type: ignore[misc]
                f"put {obj} down",
                turnable=is_round(held.part),
            )
        except MotionError as error:
            refusal = error
        else:
            release(planner, hand, obj, centre, held)
            return
    raise refusal


def rest(planner: Planner, _hand: str) -> None:
    """Go to the look pose."""
    planner.rest()


def release(planner: Planner, hand: str, obj: str, centre: Place, held: Held) -> None:
    """Open the hand; the part stays where it is."""
    planner.grip(close=False)
    planner.places.move(obj, centre)
    planner.places.move(hand, add(centre, held.offset))
    planner.hangs_m = 0.0
