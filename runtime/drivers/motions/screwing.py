"""Screwing a part into another and out again: `screw-in`, `unscrew`.

Wrist 3 turns less than two turns in one go. At the end of its range the hand opens, goes up, turns
back and takes hold again; the thread keeps the part meanwhile. What is to be done next is planned
after each stroke, from how far it came and whether the torque ended it.
"""

from __future__ import annotations

import math
from typing import Final

from runtime.drivers.limits import MotionError
from runtime.drivers.motions.handling import come_off, give_up, grasp, look_again, release
from runtime.drivers.motions.planner import Planner
from runtime.drivers.motions.seating import (
    find_seat,
    look_first,
    over_seat,
    press,
)
from runtime.drivers.motions.threads import holds_in_thread
from runtime.drivers.steps import GiveUp, Grip, Tare, Turn
from runtime.kinematics import Joints
from runtime.parts import PartModel, ScrewThread, Seat

_TURN: Final = 2 * math.pi
_WRIST_MARGIN: Final = 0.3  # rad kept from the joint limit: force mode has no brake of its own
_LEAST_STROKE: Final = 0.8  # rad; for less the hand takes hold anew first
_EARLY: Final = 0.5 * _TURN  # tight before that much is left, the thread is crossed
_LATE: Final = 1.5 * _TURN  # where a thread begins to bite is not known; later, it is stripped
_CATCHES: Final = 0.5  # of the way down that its pitch explains: with less it only turns
_FREE: Final = 0.6  # rad beyond its turns after which a part is out of its thread
_BACK: Final = 0.2  # rad left when backing out counts as done
_STAND_M: Final = 0.003  # how far a part may stand from where its thread should begin
_FOLLOW_N: Final = 5.0  # downward while a thread is followed
_LOOSEN: Final = 1.5  # what is tight takes more torque to be loosened


def screw_in(planner: Planner, hand: str, obj: str, into: str) -> None:
    """Screw the held part into another one until it is tight.

    A part that stands in its thread already is let go: how far it is in is not known, so it has to
    be unscrewed first.
    """
    if look_again(planner):
        return
    if planner.progress.turned_rad is None and holds_in_thread(planner):
        planner.grip(close=False)
        planner.lift()
        planner.steps.append(GiveUp(f"{obj} stands in its thread already; it was let go there"))
        return
    seating = find_seat(planner, hand, obj, into)
    part, thread = seating.held.part, _thread(seating.seat, obj, into)
    if planner.progress.turned_rad is not None:
        _go_on(planner, thread, part, planner.progress.turned_rad)
    elif not give_up(planner):
        look_first(planner)
        target, joints = over_seat(
            planner,
            seating,
            f"reach the thread of {obj} in {into}",
            above_m=thread.depth_m,
            prefer=lambda found: _wound_back(planner, found),
        )
        descent_n = planner.config.force.descent_n
        press(planner, seating.seat, target, joints, descent_n, _STAND_M)
        whole = thread.turns * _TURN
        _turn(planner, thread, clockwise=True, angle_rad=whole, most_rad=whole + _LATE)
    if not isinstance(planner.steps[-1], Grip | GiveUp):
        release(planner, hand, obj, seating.centre, seating.held)


def unscrew(planner: Planner, hand: str, obj: str, into: str) -> None:
    """Take hold of a part that is screwed into another one, and screw it out."""
    progress, places = planner.progress, planner.places
    part, receiver = places.part(obj), places.part(into)
    seat = next((seat for seat in part.seats if seat.into == receiver.type), None)
    thread = _thread(seat, obj, into)
    left = thread.turns * _TURN + _FREE
    failure = progress.failure
    if progress.turned_rad is None:
        grasp(planner, hand, obj)
    else:
        turned = -progress.turned_rad
        left -= turned
        if progress.stalled and left > _FREE + _EARLY and not failure:
            failure = (
                f"it does not come loose: stuck after {turned / _TURN:.1f} of "
                f"{thread.turns:g} turns"
            )
        if left > _BACK and not (failure or progress.stalled):
            _regrip(planner, part, clockwise=False, left_rad=left)
    if failure:
        planner.grip(close=False)
        planner.lift()
        planner.steps.append(GiveUp(failure))
    elif left > _BACK and not progress.stalled:
        _turn(planner, thread, clockwise=False, angle_rad=left, most_rad=left)
    else:
        assert seat is not None, "it has a thread"
        top_m = places.position(into)[2] + seat.offset[2] + thread.depth_m
        _hold_at(planner, part, top_m + part.grasp_height_m)
        come_off(planner)


def _go_on(planner: Planner, thread: ScrewThread, part: PartModel, turned: float) -> None:
    """Go on with a screw that has been turned that far, or turn it back."""
    whole, progress = thread.turns * _TURN, planner.progress
    failure, tight = progress.failure, progress.stalled and turned >= whole - _EARLY
    if not failure and progress.stalled and not tight:
        failure = (
            f"tight after {turned / _TURN:.1f} of {thread.turns:g} turns: its thread is crossed"
        )
    elif not failure and turned >= whole + _LATE - _BACK:
        failure = f"it turns freely after {turned / _TURN:.1f} of {thread.turns:g} turns"
    elif not failure and not tight and _only_turns(planner, thread, turned):
        down = f"{(progress.sunk_m or 0.0) * 1000:.1f} mm down after {turned / _TURN:.1f} turns"
        failure = f"its thread does not catch: {down}"
        if (progress.sunk_m or 0.0) < thread.pitch_m / 2:
            planner.lift()
            planner.steps.append(GiveUp(f"{failure}; it is still held"))
            return
    if failure:
        _back_out(planner, thread, part, turned, failure)
    elif tight:
        planner.grip(close=False)
    else:
        left = whole - turned
        _regrip(planner, part, clockwise=True, left_rad=left + _LATE)
        _turn(planner, thread, clockwise=True, angle_rad=left, most_rad=left + _LATE)


def _only_turns(planner: Planner, thread: ScrewThread, turned: float) -> bool:
    """Tell whether a screw has gone down much less than its thread would take it."""
    sunk_m = planner.progress.sunk_m
    in_thread = turned - _LATE
    if sunk_m is None or in_thread <= 0:
        return False
    return sunk_m < _CATCHES * thread.pitch_m * in_thread / _TURN


def _back_out(
    planner: Planner, thread: ScrewThread, part: PartModel, turned: float, failure: str
) -> None:
    """Turn a part that will not go in out again, and come away with it."""
    if turned <= _BACK:
        planner.lift()
        planner.steps.append(GiveUp(f"{failure}; it was backed out and is still held"))
    elif planner.progress.failure and planner.progress.stalled:
        planner.grip(close=False)
        planner.lift()
        planner.steps.append(GiveUp(f"{failure}; nor could it be backed out: it was let go"))
    else:
        if _end(planner) + planner.joints[5] < min(_LEAST_STROKE, turned):
            _regrip(planner, part, clockwise=False, left_rad=turned)
        _turn(planner, thread, clockwise=False, angle_rad=turned, most_rad=turned, failure=failure)


def _turn(
    planner: Planner,
    thread: ScrewThread,
    *,
    clockwise: bool,
    angle_rad: float,
    most_rad: float,
    failure: str = "",
) -> None:
    """Turn as far as there is to turn, or as wrist 3 can."""
    force, end = planner.config.force, _end(planner)
    planner.steps.append(
        Turn(
            clockwise,
            max(angle_rad, _BACK),
            max(most_rad, _BACK),
            end if clockwise else -end,
            force.descent_n if clockwise else min(_FOLLOW_N, force.descent_n),
            force.torque_nm * (1.0 if clockwise else _LOOSEN),
            thread.pitch_m,
            planner.remaining,
            failure,
        )
    )


def _regrip(planner: Planner, part: PartModel, *, clockwise: bool, left_rad: float) -> None:
    """Open, go up, turn the wrist back by what is left or as far as it can, take hold again."""
    low, end = planner.height, _end(planner)
    stroke = min(2 * end, left_rad + _WRIST_MARGIN)
    planner.grip(close=False, again=True)
    planner.hangs_m = 0.0
    planner.shift(low + planner.config.force.regrip_m, "go up to take hold again")
    back = (*planner.joints[:5], end - stroke if clockwise else stroke - end)
    planner.turn_joints(back, "turn the wrist back")
    planner.steps.append(Tare())
    planner.shift(low, "come down to take hold again", guarded=True)
    planner.grip(close=True, part=part)


def _hold_at(planner: Planner, part: PartModel, height: float) -> None:
    """Take hold again where the part's place is known: before, its thread hid how deep it was."""
    planner.grip(close=False, again=True)
    planner.hangs_m = 0.0
    planner.steps.append(Tare())
    planner.shift(height, "take hold of it as it stands on its thread", guarded=True)
    planner.grip(close=True, part=part)


def _wound_back(planner: Planner, joints: Joints) -> Joints:
    """Give the same pose with wrist 3 a whole turn back, if its range allows that."""
    wrist = joints[5] - _TURN
    return (*joints[:5], wrist) if wrist >= -_end(planner) else joints


def _end(planner: Planner) -> float:
    """Give where wrist 3 must stop, either way, rad."""
    return planner.config.workspace.joint_limit_rad - _WRIST_MARGIN


def _thread(seat: Seat | None, obj: str, into: str) -> ScrewThread:
    if seat is None or seat.thread is None:
        raise MotionError(f"{obj} has no thread that goes into {into}")
    return seat.thread
