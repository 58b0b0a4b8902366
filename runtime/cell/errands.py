"""What the person can do, each as a sequence of motions and waits."""

from __future__ import annotations

import math
from collections.abc import Callable, Generator, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final, TypeAlias

from runtime.cell.body import REST
from runtime.cell.helping_hand import HelpingHand, Leg, StoppedError, Until
from runtime.cell.world import World
from runtime.parts import Vector

TRAVEL_M: Final = 0.24
"""How high over the table the hand goes across, m."""

_PATIENCE_S: Final = 40.0  # for the robot's arm to get out of the way
_GRASP_S: Final = 0.4
_PRESS_S: Final = 0.8
_TURN_S: Final = 0.7  # for each turn of a thread
_HOLDS_S: Final = 120.0
_REACHES_S: Final = 4.0
_MIDDLE: Final = (0.42, 0.0)
_OVER_PART_M: Final = 0.15


@dataclass(frozen=True, slots=True)
class Done:
    """What was asked is done, and can be told; what follows is the way back."""


Move: TypeAlias = Leg | Until | Done
Errand: TypeAlias = Generator[Move, None, None]
Target: TypeAlias = tuple[str, Vector | None]


class Errands:
    """The person's skills.

    Args:
        hand: Their hand.
        world: The parts.
        is_released: Tells whether the person was asked to let go of what they hold.
    """

    def __init__(self, hand: HelpingHand, world: World, is_released: Callable[[], bool]) -> None:
        self._hand = hand
        self._world = world
        self._is_released = is_released

    def hold(self, targets: Sequence[Target]) -> Errand:
        """Hold a part where it stands, until released or something was pressed into it."""
        hand = self._hand
        base = hand.find(*targets[0])
        hand.check_free(base)
        yield from self._across(hand.beside(base))
        if math.dist(hand.beside(base), hand.place) > 0.03:
            raise StoppedError(f"the {targets[0][0]} is no longer there")
        hand.pin(base)
        yield Leg(hand.place, _GRASP_S)
        before = self._seated_in(base)
        yield Done()
        yield Until(lambda: self._is_released() or bool(self._seated_in(base) - before), _HOLDS_S)
        yield Until(lambda: self._is_released() or self._is_robot_away(), _PATIENCE_S)
        hand.unpin()
        yield from self._home()

    def release(self, _targets: Sequence[Target]) -> Errand:
        """Let go of what is held: the holding has ended by the time this begins."""
        if self._hand.holds is not None:
            self._hand.unpin()
        yield Done()
        yield from self._home()

    def put_in(self, targets: Sequence[Target]) -> Errand:
        """Fetch a part and seat it in another."""
        hand = self._hand
        obj, into = hand.find(*targets[0]), hand.find(*targets[1])
        seat = hand.seat_of(obj, into)
        yield from self._fetch(obj)
        lift = hand.place[2] - self._world.parts[obj].position[2]
        yield from self._across((seat[0], seat[1], seat[2] + lift))
        thread = next(
            s.thread
            for s in self._world.parts[obj].model.seats
            if s.into == self._world.parts[into].model.type
        )
        yield Leg(hand.place, _PRESS_S + (0.0 if thread is None else _TURN_S * thread.turns))
        try:
            hand.insert(into)
        except StoppedError:
            yield from self._up()
            yield from self._put_aside()
            raise
        yield from self._home()
        yield Done()

    def take_away(self, targets: Sequence[Target]) -> Errand:
        """Take a part to the person's own side."""
        yield from self._fetch(self._hand.find(*targets[0]))
        yield from self._put_aside()
        yield Done()
        yield from self._home()

    def put_back(self, targets: Sequence[Target]) -> Errand:
        """Put a part down somewhere on the table, or back where it was taken."""
        hand = self._hand
        obj = hand.find(*targets[0])
        wanted = hand.home_of(obj)
        if len(targets) == 3:
            wanted = _number(targets[1][0]), _number(targets[2][0])
        if wanted is None:
            raise StoppedError(f"nobody said where to put the {targets[0][0]}")
        yield from self._fetch(obj)
        lift = hand.place[2] - self._world.parts[obj].position[2]
        height = self._world.parts[obj].model.size[2] / 2 + lift
        yield from self._across((*hand.free_near(obj, wanted), height + 0.004))
        hand.put_down()
        yield from self._home()
        yield Done()

    def reach_in(self, targets: Sequence[Target]) -> Errand:
        """Hold the hand over the table for a while."""
        x, y = _MIDDLE
        if targets:
            x, y, _ = self._world.parts[self._hand.find(*targets[0])].position
        yield from self._across((x, y, _OVER_PART_M))
        yield Leg(self._hand.place, _REACHES_S)
        yield from self._home()
        yield Done()

    def go_home(self) -> Errand:
        """Take the hand back, and leave what it carries on the person's own side."""
        yield from self._put_aside()
        yield from self._home()

    def _fetch(self, name: str) -> Errand:
        hand = self._hand
        if hand.carries == name:
            return
        hand.check_free(name)
        yield from self._across(hand.over(name))
        yield Leg(hand.place, _GRASP_S)
        hand.take(name)
        yield from self._up()

    def _put_aside(self) -> Errand:
        hand = self._hand
        if hand.carries is None:
            return
        x, y = hand.slot()
        lift = hand.place[2] - self._world.parts[hand.carries].position[2]
        yield from self._across((x, y, self._world.parts[hand.carries].model.size[2] / 2 + lift))
        hand.put_aside()

    def _across(self, target: Vector) -> Errand:
        """Go up, across and down to a place, keeping clear of the robot's tool."""
        yield from self._up()
        over = (target[0], target[1], max(TRAVEL_M, target[2]))
        for place in (over, target):
            if place != self._hand.place:
                yield self._clear(place)
                yield Leg(place)

    def _up(self) -> Errand:
        x, y, z = self._hand.place
        if z < TRAVEL_M and self._hand.place != REST:
            yield Leg((x, y, TRAVEL_M))

    def _home(self) -> Errand:
        yield from self._up()
        yield self._clear(REST)
        yield Leg(REST)

    def _clear(self, place: Vector) -> Until:
        reason = "the robot's arm was in the way"
        return Until(lambda: self._hand.is_clear(place), _PATIENCE_S, reason)

    def _is_robot_away(self) -> bool:
        tool = self._world.tool
        return tool is None or math.dist(tool[:3, 3].tolist(), self._hand.place) > 0.2

    def _seated_in(self, base: str) -> set[str]:
        return {
            part.name for part in self._world.parts.values() if part.seated and part.parent == base
        }


def _number(word: str) -> float:
    try:
        return float(word)
    except ValueError:
        raise StoppedError(f"{word!r} is no place") from None


SKILLS: Final[
    Mapping[str, tuple[tuple[int, ...], Callable[[Errands, Sequence[Target]], Errand]]]
] = MappingProxyType(
    {
        "hold": ((1,), Errands.hold),
        "release": ((0, 1), Errands.release),
        "put-in": ((2,), Errands.put_in),
        "take-away": ((1,), Errands.take_away),
        "put-back": ((1, 3), Errands.put_back),
        "reach-in": ((0, 1), Errands.reach_in),
    }
)
"""The skills by name: how many arguments each takes, and what it is."""
