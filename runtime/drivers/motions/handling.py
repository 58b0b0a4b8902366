"""Taking parts up and putting them down: `grasp`, `take-out`, `place`."""

from __future__ import annotations

import itertools
from typing import Final

from runtime.drivers.limits import MotionError
from runtime.drivers.motions.places import Held, Place, add, is_round
from runtime.drivers.motions.planner import Planner
from runtime.drivers.motions.threads import holds_in_thread
from runtime.drivers.spots import free_spots
from runtime.drivers.steps import GiveUp, Look

_SPOTS: Final = 10  # free spots tried before giving up
_LEAST_PLAY: Final = 0.004  # m that the open fingers leave around a part
_OFF_M: Final = 0.0015  # lifted so far, a part is off its seat
_PUT_DOWN_N: Final = 4.0  # with which a part must stand on the table before it is let go
_STANDS_M: Final = 0.005  # as far above where it should stand: a part may hang lower in the hand
_SEEN_STANDING_M: Final = 0.004  # above what stands on the table, it may still be that
_SEEN_BELOW_M: Final = 0.010  # below that nothing can be: seen lower still, it is some mistake


def grasp(planner: Planner, hand: str, obj: str) -> None:
    """Take hold of a part where it lies."""
    part, (x, y, _) = planner.places.part(obj), planner.places.position(obj)
    z = _centre_height(planner, obj)
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


def _centre_height(planner: Planner, obj: str) -> float:
    """Give how high the centre of a part is, m: of one that stands on the table, by the table.

    Where it is gripped decides how deep it will be pressed home, to fractions of a millimetre; a
    camera is not as good as that. What is seen a little lower than on the table stands there.
    """
    part, z = planner.places.part(obj), planner.places.position(obj)[2]
    standing = planner.config.workspace.table_z_m + part.size[2] / 2
    return standing if -_SEEN_BELOW_M <= z - standing <= _SEEN_STANDING_M else z


def take_out(planner: Planner, hand: str, obj: str, _into: str) -> None:
    """Take hold of a part and lift it off its seat in another one."""
    grasp(planner, hand, obj)
    come_off(planner)


def come_off(planner: Planner) -> None:
    """Lift a part a little, so that it is seen to come along.

    No higher: what the hand holds is anchored to it when the action has ended, at the place where
    it was seen last.
    """
    planner.shift(planner.height + _OFF_M, "lift it off its seat")


def place(planner: Planner, hand: str, obj: str) -> None:
    """Put the held part down at the nearest free spot of the put-down area.

    The last of the way it goes down by force, until it stands: what it meets sooner, or whatever
    it hangs below the fingers, is never pressed harder than that.
    """
    if give_up(planner) or look_again(planner):
        return
    held = planner.places.held(hand, obj, gripped=planner.gripped)
    planner.hangs_m = held.hangs_m
    planner.lift()
    here = (float(planner.tcp[0, 3]), float(planner.tcp[1, 3]))
    places = planner.places
    spots = free_spots(held.part, here, places.others(hand, obj), planner.config, places.parts)
    height = planner.config.workspace.table_z_m + held.part.size[2] / 2
    now = planner.turned_rad
    refusal = MotionError(f"there is no free spot to put {obj} down")
    for x, y in itertools.islice(spots, _SPOTS):
        centre = (x, y, height)
        try:
            target, joints = planner.reach(
                lambda turn, centre=centre: add(centre, held.turned(turn - now)),  # type: ignore[misc]
                f"put {obj} down",
                above_m=planner.config.heights.approach_m,
                turnable=is_round(held.part),
            )
        except MotionError as error:
            refusal = error
        else:
            planner.press(target, joints, press_n=_PUT_DOWN_N, tolerance_m=_STANDS_M)
            release(planner, hand, obj, centre, held)
            return
    raise refusal


def rest(planner: Planner, _hand: str) -> None:
    """Go to the look pose; what stands in its thread is let go."""
    if holds_in_thread(planner):
        planner.grip(close=False)
    planner.rest()


def give_up(planner: Planner) -> bool:
    """Come away from where pressing has failed, the part still in the hand."""
    failure = planner.progress.failure
    if failure:
        planner.lift()
        planner.steps.append(GiveUp(failure))
    return bool(failure)


def look_again(planner: Planner) -> bool:
    """Look first where the hand feels nothing of what it is said to hold.

    It has been lost, and may be seen: the command then fails once, not until that is believed.
    """
    lost = not (planner.gripped or planner.progress.looked)
    if lost:
        planner.rest()
        planner.steps.append(Look(planner.config.look_cycles, planner.remaining))
    return lost


def release(planner: Planner, hand: str, obj: str, centre: Place, held: Held) -> None:
    """Open the hand; the part stays where it is."""
    planner.grip(close=False)
    planner.places.move(obj, centre)
    planner.places.move(hand, add(centre, held.offset))
    planner.hangs_m = 0.0
