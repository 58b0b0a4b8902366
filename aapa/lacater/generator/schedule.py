"""Who moves when: CATER's schedule of actions, in the setting with two moves at a time.

A scene is a sequence of slots. In each, either up to two stacks move, or a cone is set over
something and up to one other stack moves. All begin within eleven frames and take 20 to 30.

Source: the published generator of CATER ("max2action", the setting of LA-CATER).
"""

from __future__ import annotations

import random
from typing import Final

import numpy as np
from numpy.typing import NDArray

from aapa.lacater.generator.motion import pick_place, slide
from aapa.lacater.generator.placement import HALF_SIDE
from aapa.lacater.generator.stage import LAST_FRAME, Stage

MOVES_AT_A_TIME: Final = 2
"""How many stacks move within one slot."""

_LAST_SLOT = LAST_FRAME - 30
_SHORTEST, _LONGEST = 20, 30
_LATEST_START = 10
_PAIRS_TRIED = 100
_MOVES_TRIED = 101
_COVERED = ("cone", "sphere", "spl")
_TURNED = ("cube", "cylinder", "spl")


def play(stage: Stage, chance: random.Random) -> bool:
    """Let the whole schedule happen; False where it went wrong, and the scene is to be dropped."""
    slot = 0
    while slot <= _LAST_SLOT:
        # Things are placed without regard to where in them their origins are, moved with it: a
        # few scenes are too close from the start.
        if not stage.is_sound():
            return False
        if chance.random() < 0.5:
            end = _cover(stage, slot, chance)
        else:
            end = _move_some(stage, slot, None, MOVES_AT_A_TIME, chance)
        slot = end + 1
    return stage.is_sound()


def _cover(stage: Stage, slot: int, chance: random.Random) -> int:
    """Set a cone over something, and move another stack; gives the slot's last frame.

    Where no pair fits, the slot has not begun: it ends before its first frame.
    """
    for _ in range(_PAIRS_TRIED):
        over, under = chance.sample([stack[0] for stack in stage.stacks], 2)
        start, end = _times(slot, chance)
        if not _can_cover(stage, over, under, end):
            continue
        x, y, _ = stage.origin(under)
        target = np.array((x, y, stage.origin(over)[2]))
        stage.move(over, pick_place(end - start + 1), start, target)
        stage.record(over, "_contain", start, end, under)
        stage.merge(over, under)
        return max(end, _move_some(stage, slot, over, MOVES_AT_A_TIME - 1, chance))
    return slot - 1


def _can_cover(stage: Stage, over: int, under: int, end: int) -> bool:
    cone, covered = stage.bodies[over], stage.bodies[under]
    if (
        len(stage.stack_of(over)) > 1
        or cone.shape != "cone"
        or cone.radius <= covered.radius
        or covered.shape not in _COVERED
    ):
        return False
    x, y, _ = stage.planned[under, end]
    place = np.array((x, y, stage.origin(over)[2]))
    return stage.is_clear(place, cone.radius, end, (over, under))


def _move_some(
    stage: Stage, slot: int, ignored: int | None, most: int, chance: random.Random
) -> int:
    """Move some stacks by themselves; gives the slot's last frame."""
    chosen = [stack[0] for stack in stage.stacks if stack[0] != ignored]
    chance.shuffle(chosen)
    ends = [_move(stage, outer, slot, chance) for outer in chosen[:most]]
    return max(ends, default=LAST_FRAME)


def _move(stage: Stage, outer: int, slot: int, chance: random.Random) -> int:
    """Move one stack somehow; gives the last frame of the move."""
    start, end = _times(slot, chance)
    stack = stage.stack_of(outer)
    for _ in range(_MOVES_TRIED):
        action = chance.choice(_choices(stage, stack))
        if action == "_rotate":
            stage.turn(outer, start, end)
            stage.record(outer, action, start, end)
            return end
        x, y = (chance.uniform(-HALF_SIDE, HALF_SIDE) for _ in range(2))
        target = np.array((x, y, stage.origin(outer)[2]))
        if _go(stage, stack, action, (start, end), target):
            return end
    for index in stack:
        stage.record(index, "_no_op", start, end)
    return end


def _go(
    stage: Stage,
    stack: list[int],
    action: str,
    times: tuple[int, int],
    target: NDArray[np.float64],
) -> bool:
    """Let a stack slide, or its outermost body be picked and placed, if nothing is in the way."""
    start, end = times
    outer = stack[0]
    shift = target - stage.origin(outer)
    moves = (slide if action == "_slide" else pick_place)(end - start + 1)
    movers = stack if action == "_slide" else stack[:1]
    left = stack[len(movers) :]
    if not stage.is_free(movers, moves, start, shift):
        return False
    if left and not stage.are_apart(outer, target, left[0]):
        return False
    for index in movers:
        stage.move(index, moves, start, stage.origin(index) + shift)
        stage.record(index, action, start, end)
    for index in left:
        stage.record(index, "_no_op", start, end)
    if left:
        stage.split(outer)
    return True


def _choices(stage: Stage, stack: list[int]) -> tuple[str, ...]:
    if len(stack) == 1 and stage.bodies[stack[0]].shape in _TURNED:
        return "_slide", "_pick_place", "_rotate"
    return "_slide", "_pick_place"


def _times(slot: int, chance: random.Random) -> tuple[int, int]:
    duration = chance.randint(_SHORTEST, _LONGEST)
    start = slot + chance.randint(0, _LATEST_START)
    return start, min(start + duration, LAST_FRAME)
