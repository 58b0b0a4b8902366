"""How the part in the hand goes into its seat: what stops it on the way, how far it is screwed in.

The world tells each step where the part is and how hard it is pressed down; from that follow the
heights at which it is held up, whether it jams or binds, and what has become of it when the hand
opens.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final

from runtime.cell.arrangement import Arrangement
from runtime.cell.mishaps import Fate
from runtime.cell.seating import Opening
from runtime.cell.support import heading
from runtime.kinematics import Matrix

_APPROACH_M: Final = 0.08  # this far above a rim it is decided what will happen
_BESIDE_M: Final = 0.015
_OUT_M: Final = 0.003  # above the rim, a part is out
_TAKES_HOLD_M: Final = 0.0015  # above its thread, a part can be turned into it
_OFF_AXIS_M: Final = 0.004
_SLIPS_OFF_M: Final = 0.004  # lifted this far, a screwed part slips out of the fingers
_LOOSE_RAD: Final = 0.5  # turned in no farther than this, it just comes out
_LEAST_JAM_M: Final = 0.003  # less would pass for seated


@dataclass(frozen=True, slots=True)
class Turning:
    """A part in the hand that is in its thread.

    Args:
        receiver: The part with the thread.
        base_rad: How far it was screwed in when it was taken hold of.
        base_yaw: How the tool was turned then, rad.
        yaw: How the tool is turned now, counted through, rad.
        end_rad: Where it is tight, or where it binds.
        binds: Whether it binds there.
    """

    receiver: str
    base_rad: float
    base_yaw: float
    yaw: float
    end_rad: float
    binds: bool

    @property
    def turned_rad(self) -> float:
        """How far it is screwed in. Clockwise from above, which is negative about z, is in."""
        return min(max(self.base_rad + self.base_yaw - self.yaw, 0.0), self.end_rad)


class Insertion:
    """What keeps the part in the hand from going down, from the first approach to the release.

    Args:
        arrangement: The parts.
        fate: What goes wrong.
    """

    def __init__(self, arrangement: Arrangement, fate: Fate) -> None:
        self._arrangement = arrangement
        self._fate = fate
        self._jams: dict[tuple[str, str], float | None] = {}  # height above the floor of the seat
        self._binds: dict[tuple[str, str], float | None] = {}
        self._stuck: set[tuple[str, str]] = set()
        self._bound: set[tuple[str, str]] = set()
        self._openings: tuple[Opening, ...] = ()
        self._key: tuple[str, int, int] | None = None
        self.turning: Turning | None = None
        """The thread the part in the hand is in."""
        self.press_n = 0.0
        """The greatest force with which it was pressed down in its seat."""

    def take_hold(self, name: str, tool_yaw: float, parent: str | None, turned_rad: float) -> None:
        """Begin anew with a part that was just gripped, and that was screwed in so far."""
        self.press_n, self.turning, self._key = 0.0, None, None
        height = self._arrangement.part(name).position[2]
        for opening in self.openings(name):
            in_thread = turned_rad > 0 or height <= opening.floor_m + _TAKES_HOLD_M
            if opening.receiver == parent and opening.seat.thread is not None and in_thread:
                self.turning = self._into_thread(name, opening, tool_yaw, turned_rad)

    def follow(self, name: str, tool: Matrix, force_n: float, spun_rad: float = 0.0) -> bool:
        """Note where the part is now. Give whether it stays behind in its thread.

        Args:
            name: The part in the hand.
            tool: (4, 4), the tool centre point.
            force_n: How hard it is pressed down.
            spun_rad: How far the tool has turned about the vertical since the last look, about:
                its pose tells that up to whole turns only.
        """
        x, y, z = self._arrangement.part(name).position
        for opening in self.openings(name):
            beside = opening.beside_m(x, y)
            key = (name, opening.receiver)
            if beside > _BESIDE_M or z > opening.rim_m + _APPROACH_M:
                continue
            self._decide(key, opening)
            if beside <= opening.mouth_m and z < opening.rim_m:
                self.press_n = max(self.press_n, force_n)
            jam = self._jams[key]
            if jam is not None and z < opening.centre[2] + jam + _OUT_M:
                self._stuck.add(key)
            elif key in self._stuck and z > opening.rim_m + _OUT_M:
                self._free(key)
            if self.turning is None and opening.seat.thread is not None:
                down = z <= opening.floor_m + _TAKES_HOLD_M
                if down and beside <= _OFF_AXIS_M and jam is None:
                    self.turning = self._into_thread(name, opening, _yaw_of(tool), 0.0)
                    spun_rad = 0.0  # that was before it was in
        return self._turn(name, tool, spun_rad)

    def sunk_m(self, name: str) -> float:
        """Give how far the part is below its place in a seat that it is in line with, m.

        So far have part, seat and fingers given way: it tells how hard it is pressed home, also
        where the force that was measured last is the one of another moment.
        """
        x, y, z = self._arrangement.part(name).position
        sunk = (
            opening.floor_m - z
            for opening in self.openings(name)
            if opening.seat.thread is None and opening.beside_m(x, y) <= opening.seat.clearance_m
        )
        return max([0.0, *sunk])

    def snapshot(self) -> list[list[object]]:
        """Give what was decided of each pair of parts: jam, m, and binding thread, rad."""
        return [
            [*key, jam, self._binds.get(key), key in self._stuck, key in self._bound]
            for key, jam in self._jams.items()
        ]

    def restore(self, kept: Iterable[Sequence[Any]]) -> None:
        """Take over what was decided earlier."""
        for name, receiver, jam, binds, stuck, bound in kept:
            key = (str(name), str(receiver))
            self._jams[key], self._binds[key] = jam, binds
            self._stuck |= {key} if stuck else set()
            self._bound |= {key} if bound else set()
        self.release()

    def release(self) -> None:
        """Note that the hand has opened."""
        self.turning, self.press_n, self._key = None, 0.0, None

    def openings(self, name: str) -> tuple[Opening, ...]:
        """Give the seats the part would go into as it is turned, all the way down."""
        yaw = heading(self._arrangement.part(name).pose)
        key = (name, round(math.degrees(yaw)), self._arrangement.settled)
        if key != self._key:
            self._openings = self._arrangement.openings(name, yaw)
            self._key = key
        return self._openings

    def mouths(self, name: str) -> tuple[Opening, ...]:
        """Give the same seats with what really stops it on its way."""
        found = []
        for opening in self.openings(name):
            floor, turning = opening.floor_m, self.turning
            jam = self.jam_m(name, opening)
            if jam is not None:
                floor = max(floor, opening.centre[2] + jam)
            if turning is not None and turning.receiver == opening.receiver:
                floor = thread_height(opening, turning.turned_rad)
            found.append(replace(opening, floor_m=floor))
        return tuple(found)

    def jam_m(self, name: str, opening: Opening) -> float | None:
        """Give how far above its seat the part sticks, if it does."""
        return self._jams.get((name, opening.receiver))

    def _decide(self, key: tuple[str, str], opening: Opening) -> None:
        """Draw once for each pair of parts whether the first try goes well."""
        if key in self._jams:
            return
        way = opening.rim_m - opening.floor_m
        share = self._fate.jam_share()
        stuck = share is not None and way > _LEAST_JAM_M
        base = opening.floor_m - opening.centre[2]
        self._jams[key] = base + max(_LEAST_JAM_M, (1 - (share or 0.0)) * way) if stuck else None
        turns = self._fate.binds_after_turns() if opening.seat.thread is not None else None
        self._binds[key] = None if turns is None else turns * 2 * math.pi
        if stuck:
            self._arrangement.settled += 1

    def _free(self, key: tuple[str, str]) -> None:
        self._jams[key] = None
        self._stuck.discard(key)
        self._arrangement.settled += 1

    def _into_thread(
        self, name: str, opening: Opening, tool_yaw: float, turned_rad: float
    ) -> Turning:
        thread = opening.seat.thread
        assert thread is not None, "only a seat with a thread is screwed into"
        full, binds = thread.turns * 2 * math.pi, self._binds.get((name, opening.receiver))
        end = full if binds is None else min(full, binds)
        self._arrangement.settled += 1
        return Turning(opening.receiver, turned_rad, tool_yaw, tool_yaw, end, binds is not None)

    def _turn(self, name: str, tool: Matrix, spun_rad: float) -> bool:
        turning = self.turning
        if turning is None:
            return False
        into = [o for o in self.openings(name) if o.receiver == turning.receiver]
        if not into:
            return False
        opening, height = into[0], self._arrangement.part(name).position[2]
        off = math.remainder(_yaw_of(tool) - turning.yaw - spun_rad, 2 * math.pi)
        self.turning = turning = replace(turning, yaw=turning.yaw + spun_rad + off)
        key = (name, turning.receiver)
        if turning.binds and turning.turned_rad >= turning.end_rad:
            self._bound.add(key)
        if height <= thread_height(opening, turning.turned_rad) + _SLIPS_OFF_M:
            return False
        if turning.turned_rad <= _LOOSE_RAD:
            if key in self._bound:
                self._binds[key] = None
                self._bound.discard(key)
            self.turning = None
            self._arrangement.settled += 1
            return False
        return True


def thread_height(opening: Opening, turned_rad: float) -> float:
    """Give the height of the centre of a part that is screwed in so far, m."""
    thread = opening.seat.thread
    assert thread is not None, "only a seat with a thread is screwed into"
    return opening.floor_m - thread.pitch_m * turned_rad / (2 * math.pi)


def _yaw_of(tool: Matrix) -> float:
    """Give the angle of the tool's x axis about the base's z axis, rad."""
    return math.atan2(float(tool[1, 0]), float(tool[0, 0]))
