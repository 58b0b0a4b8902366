"""Where the parts are, and what the hand does to them: gripping, carrying, seating, dropping.

Quasi-static: nothing has mass or speed. A part is either held by the hand, or it stands on the
table, on another part, or in a seat of another part, and then moves rigidly with that part.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Final

import numpy as np

from runtime.cell.support import fall
from runtime.errors import UsageError
from runtime.kinematics import Matrix
from runtime.parts import GRIPPER_OPENING_M, PartModel, Seat, Vector

FIXTURE: Final = "fixture"
"""The name of the plate the case stands on. It cannot be moved and is not a part."""

_UPRIGHT: Final = math.cos(math.radians(20))


@dataclass(frozen=True, slots=True)
class HandParameters:
    """How forgiving the hand and the parts are.

    Args:
        reach_across_m: A part's axis may be this far off the plane of the fingers.
        reach_height_m: The tool centre point may be this far off the part's grasp height.
        chamfer_m: A part let go within this distance of a seat's axis slides into the seat.
        press_m: How far below its seated height a part may be let go and still be seated.
        turn_rad: How far a part that is not round may be turned and still fit.
    """

    reach_across_m: float = 0.012
    reach_height_m: float = 0.015
    chamfer_m: float = 0.008
    press_m: float = 0.010
    turn_rad: float = math.radians(15)


@dataclass(frozen=True, slots=True, eq=False)
class PlacedPart:
    """One part and where it truly is.

    Args:
        name: Unique, such as "bearing-2".
        model: Its type's drawing.
        pose: (4, 4), its centre in the base frame.
        parent: What it stands on or sits in: a part, the fixture, or None for table and hand.
        seated: Whether it sits in one of its parent's seats.
    """

    name: str
    model: PartModel
    pose: Matrix
    parent: str | None = None
    seated: bool = False

    @property
    def position(self) -> Vector:
        """Its centre in the base frame, m."""
        x, y, z = self.pose[:3, 3].tolist()
        return x, y, z


class World:
    """The parts of the cell and the hand that moves them.

    Args:
        parts: The parts in their first places.
        fixture: The plate under the case; it can be landed on but not moved.
        hand: Tolerances.
    """

    def __init__(
        self, parts: Iterable[PlacedPart], fixture: PlacedPart, hand: HandParameters | None = None
    ) -> None:
        self._parts = {part.name: part for part in parts}
        self._fixture = fixture
        self._hand = hand or HandParameters()
        self._held: str | None = None
        self._grasp: Matrix = np.eye(4)
        self._closed = False
        self.version = 0
        """Grows whenever a part has moved."""

    @property
    def parts(self) -> Mapping[str, PlacedPart]:
        """The parts by name, always in the same order."""
        return MappingProxyType(self._parts)

    @property
    def held(self) -> str | None:
        """The part in the hand, if any."""
        return self._held

    @property
    def opening_m(self) -> float:
        """How far apart the fingers are now."""
        if self._held is not None:
            return self._parts[self._held].model.grip_width_m
        return 0.0 if self._closed else GRIPPER_OPENING_M

    def step(self, tcp: Matrix, *, closed: bool) -> bool:
        """Bring the hand to a pose, (4, 4), with its close output on or off.

        Returns:
            Whether the hand's sensor feels a part between the fingers.
        """
        if self._held is not None:
            self._move(self._held, tcp @ self._grasp)
        if closed and not self._closed:
            self._grip(tcp)
        elif self._closed and not closed:
            self._release()
        self._closed = closed
        return self._held is not None

    def place(self, name: str, x: float, y: float) -> None:
        """Put a part down at x, y, with all it carries, letting it fall from above."""
        part = self._part(name)
        pose = np.eye(4)
        pose[:3, 3] = x, y, 1.0
        self._let_go(part.name)
        self._move(name, pose)
        self._drop(name)

    def insert(self, name: str, into: str) -> None:
        """Put a part into its seat in another part, as a person would.

        Raises:
            UsageError: No such part, or it has no seat there.
        """
        part, receiver = self._part(name), self._part(into)
        for seat in part.model.seats:
            if seat.into == receiver.model.type:
                self._let_go(name)
                self._sit(part, receiver, seat)
                return
        raise UsageError(f"A {part.model.type} has no seat in a {receiver.model.type}.")

    def _grip(self, tcp: Matrix) -> None:
        reachable = [
            (abs(across), name)
            for name, part in self._parts.items()
            if (across := self._between_fingers(part, tcp)) is not None
        ]
        if not reachable:
            return
        name = min(reachable)[1]
        self._grasp = np.linalg.inv(tcp) @ self._parts[name].pose
        self._grasp[1, 3] = 0.0  # the fingers push it to the middle as they close
        self._parts[name] = replace(self._parts[name], parent=None, seated=False)
        self._held = name
        self._move(name, tcp @ self._grasp)

    def _between_fingers(self, part: PlacedPart, tcp: Matrix) -> float | None:
        """Give how far the part is off the fingers' plane, None if they would miss it."""
        across, along, below = np.linalg.solve(tcp, part.pose)[:3, 3].tolist()
        fits = (
            part.model.grippable
            and float(tcp[:3, 2] @ part.pose[:3, 2]) <= -_UPRIGHT
            and abs(across) <= self._hand.reach_across_m
            and abs(along) <= (GRIPPER_OPENING_M - part.model.grip_width_m) / 2
            and abs(below - part.model.grasp_height_m) <= self._hand.reach_height_m
        )
        return across if fits else None

    def _release(self) -> None:
        name, self._held = self._held, None
        if name is None:
            return
        part = self._parts[name]
        upright = np.eye(4)
        upright[:3, :3] = _turn(_yaw(part.pose))
        upright[:3, 3] = part.pose[:3, 3]
        self._move(name, upright)
        part = self._parts[name]
        for receiver in self._others(name):
            for seat in part.model.seats:
                if seat.into == receiver.model.type and self._fits(part, receiver, seat):
                    self._sit(part, receiver, seat)
                    return
        self._drop(name)

    def _fits(self, part: PlacedPart, receiver: PlacedPart, seat: Seat) -> bool:
        target = receiver.pose @ np.array([*seat.offset, 1.0])
        dx, dy, fall_m = map(float, part.pose[:3, 3] - target[:3])
        aside = math.hypot(dx, dy)
        if aside > self._hand.chamfer_m or fall_m < -self._hand.press_m:
            return False
        turn = _yaw(part.pose) - _yaw(receiver.pose)
        if not _round(part.model) and abs(math.remainder(turn, math.pi)) > self._hand.turn_rad:
            return False
        above = part.pose.copy()
        above[:2, 3] = target[:2]
        in_the_way = [
            (other.name, other.model, other.pose)
            for other in self._others(part.name)
            if other.name != receiver.name and other.name not in self._ancestors(receiver.name)
        ]
        free, _ = fall(part.model, above, in_the_way)
        return free >= fall_m - self._hand.press_m

    def _sit(self, part: PlacedPart, receiver: PlacedPart, seat: Seat) -> None:
        pose = receiver.pose.copy()
        pose[:3, 3] = (receiver.pose @ np.array([*seat.offset, 1.0]))[:3]
        self._parts[part.name] = replace(part, parent=receiver.name, seated=True)
        self._move(part.name, pose)

    def _drop(self, name: str) -> None:
        part = self._parts[name]
        below = [(other.name, other.model, other.pose) for other in self._others(name)]
        below.append((FIXTURE, self._fixture.model, self._fixture.pose))
        depth, support = fall(part.model, part.pose, below)
        pose = part.pose.copy()
        pose[2, 3] -= depth
        self._parts[name] = replace(part, parent=support, seated=False)
        self._move(name, pose)

    def _move(self, name: str, pose: Matrix) -> None:
        """Bring a part to a pose, and all that stands on it with it."""
        part = self._parts[name]
        if np.array_equal(part.pose, pose):
            return
        motion = pose @ np.linalg.inv(part.pose)
        for other in self._parts.values():
            if name in self._ancestors(other.name):
                self._parts[other.name] = replace(other, pose=motion @ other.pose)
        self._parts[name] = replace(part, pose=pose)
        self.version += 1

    def _let_go(self, name: str) -> None:
        if self._held == name:
            self._held = None

    def _others(self, name: str) -> list[PlacedPart]:
        """Give the parts that are neither this one, nor carried by it, nor in the hand."""
        away = {name, self._held}
        return [
            other
            for other in self._parts.values()
            if other.name not in away and not away & self._ancestors(other.name)
        ]

    def _ancestors(self, name: str) -> set[str | None]:
        found: set[str | None] = set()
        above = self._parts[name].parent
        while above is not None and above in self._parts:
            found.add(above)
            above = self._parts[above].parent
        return found

    def _part(self, name: str) -> PlacedPart:
        if name not in self._parts:
            raise UsageError(f"No part is called {name!r}; there are {', '.join(self._parts)}.")
        return self._parts[name]


def _round(model: PartModel) -> bool:
    return all(
        solid.shape == "cylinder" and solid.offset[:2] == (0.0, 0.0) for solid in model.primitives
    )


def _yaw(pose: Matrix) -> float:
    return math.atan2(float(pose[1, 0]), float(pose[0, 0]))


def _turn(yaw: float) -> Matrix:
    c, s = math.cos(yaw), math.sin(yaw)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
