"""The parts and what they stand on: a tree that is moved, taken apart and put together.

Nothing has mass or speed. A part is in somebody's hand, or it stands on the table, on another part
or in a seat of another part, and then moves rigidly with that part.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Final, TypeAlias

import numpy as np

from runtime.cell.seating import Opening, field_over, openings
from runtime.cell.support import Floats, fall, heading, resting_heights
from runtime.errors import UsageError
from runtime.kinematics import Matrix
from runtime.parts import PartModel, Seat, Vector

FIXTURE: Final = "fixture"
"""The name of the plate the case stands on. It cannot be moved and is not a part."""

_TIGHT: Final = 0.85  # a screwed part is seated after this share of its turns

Solid: TypeAlias = tuple[str, PartModel, Matrix]


@dataclass(frozen=True, slots=True, eq=False)
class PlacedPart:
    """One part and where it truly is.

    Args:
        name: Unique, such as "bearing-2".
        model: Its type's drawing.
        pose: (4, 4), its centre in the base frame.
        parent: What it stands on or sits in: a part, the fixture, or None for table and hand.
        seated: Whether it sits in one of its parent's seats.
        turned_rad: How far it is screwed into its parent.
    """

    name: str
    model: PartModel
    pose: Matrix
    parent: str | None = None
    seated: bool = False
    turned_rad: float = 0.0

    @property
    def position(self) -> Vector:
        """Its centre in the base frame, m."""
        x, y, z = self.pose[:3, 3].tolist()
        return x, y, z


class Arrangement:
    """Which part is where.

    Args:
        parts: The parts in their first places.
        fixture: The plate under the case; it can be landed on but not moved.
        turn_rad: How far a part that is not round may be turned and still fit a seat.
    """

    def __init__(self, parts: Iterable[PlacedPart], fixture: PlacedPart, turn_rad: float) -> None:
        self._parts = {part.name: part for part in parts}
        self._fixture = fixture
        self._turn_rad = turn_rad
        self._in_hands: list[str] = []
        self.pinned: frozenset[str] = frozenset()
        """The parts that somebody holds where they stand."""
        self.version = 0
        """Grows whenever a part has moved."""
        self.settled = 0
        """Grows whenever something has changed that a part in a hand could touch."""

    @property
    def parts(self) -> Mapping[str, PlacedPart]:
        """The parts by name, always in the same order."""
        return MappingProxyType(self._parts)

    @property
    def in_hands(self) -> tuple[str, ...]:
        """The parts that are in the robot's or in a person's hand."""
        return tuple(self._in_hands)

    def restore(self, parts: Mapping[str, PlacedPart], pinned: Iterable[str]) -> None:
        """Put every part where it once was; those in hands are in none until they are taken."""
        self._parts = dict(parts)
        self._in_hands = []
        self.pinned = frozenset(pinned)
        self.version += 1
        self.settled += 1

    def part(self, name: str) -> PlacedPart:
        """Give a part. Raises UsageError for an unknown name."""
        if name not in self._parts:
            raise UsageError(f"No part is called {name!r}; there are {', '.join(self._parts)}.")
        return self._parts[name]

    def ancestors(self, name: str) -> tuple[str, ...]:
        """Give what a part stands on or in, nearest first; table and fixture are not told."""
        found: list[str] = []
        above = self._parts[name].parent
        while above is not None and above in self._parts:
            found.append(above)
            above = self._parts[above].parent
        return tuple(found)

    def take(self, name: str) -> None:
        """Note that a hand has taken hold of a part."""
        self._parts[name] = replace(self._parts[name], parent=None, seated=False)
        if name not in self._in_hands:
            self._in_hands.append(name)
        self.settled += 1

    def let_go(self, name: str) -> None:
        """Note that no hand holds a part any more. It stays where it is until it is settled."""
        if name in self._in_hands:
            self._in_hands.remove(name)
        self.settled += 1

    def move(self, name: str, pose: Matrix) -> None:
        """Bring a part to a pose, and all that stands on it with it."""
        part = self._parts[name]
        if np.array_equal(part.pose, pose):
            return
        motion = pose @ np.linalg.inv(part.pose)
        for other in self._parts.values():
            if name in self.ancestors(other.name):
                self._parts[other.name] = replace(other, pose=motion @ other.pose)
        self._parts[name] = replace(part, pose=pose)
        self.version += 1
        if name not in self._in_hands:
            self.settled += 1

    def sit(self, name: str, receiver: str, seat: Seat, turned_rad: float | None = None) -> None:
        """Put a part into a seat.

        Args:
            name: The part.
            receiver: The part that has the seat.
            seat: The seat.
            turned_rad: How far it is screwed in; None is all the way.
        """
        self.let_go(name)
        part, into = self._parts[name], self._parts[receiver]
        pose = into.pose.copy()
        pose[:3, 3] = (into.pose @ np.array([*seat.offset, 1.0]))[:3]
        seated, turned = True, 0.0
        if seat.thread is not None:
            full = seat.thread.turns * 2 * np.pi
            turned = full if turned_rad is None else turned_rad
            seated = turned >= _TIGHT * full
            pose[2, 3] += seat.thread.depth_m * (1 - turned / full)
            pose[:3, :3] = part.pose[:3, :3] if turned_rad is not None else pose[:3, :3]
        self.move(name, pose)
        self._parts[name] = replace(
            self._parts[name], parent=receiver, seated=seated, turned_rad=turned
        )
        self.version += 1

    def stand(self, name: str, receiver: str, height_m: float, xy: tuple[float, float]) -> None:
        """Leave a part in the mouth of a seat without being seated, its centre at a height, m."""
        self.let_go(name)
        pose = self._parts[name].pose.copy()
        pose[:3, 3] = *xy, height_m
        self._parts[name] = replace(
            self._parts[name], parent=receiver, seated=False, turned_rad=0.0
        )
        self.move(name, pose)

    def drop(self, name: str) -> None:
        """Let a part fall straight down onto what is below it."""
        self.let_go(name)
        part = self._parts[name]
        depth, support = fall(part.model, part.pose, self.solids(name))
        pose = part.pose.copy()
        pose[2, 3] -= depth
        for opening in self.openings(name, heading(pose)):
            if opening.receiver == support and opening.beside_m(*pose[:2, 3]) < opening.mouth_m:
                pose[2, 3] = max(pose[2, 3], opening.rim_m)
        self._parts[name] = replace(part, parent=support, seated=False, turned_rad=0.0)
        self.move(name, pose)

    def solids(self, name: str, leave_out: Iterable[str] = ()) -> list[Solid]:
        """Give what a part could land on: the fixture, and all that is in nobody's hand.

        Args:
            name: The part; neither it nor what it carries is among them.
            leave_out: More parts that do not count.
        """
        out = {*leave_out, name}
        below = [(other.name, other.model, other.pose) for other in self._free(name)]
        below.append((FIXTURE, self._fixture.model, self._fixture.pose))
        return [solid for solid in below if solid[0] not in out]

    def openings(self, name: str, yaw: float) -> tuple[Opening, ...]:
        """Give the seats a part would go into, turned as it is, rad."""
        receivers = [(other.name, other.model, other.pose) for other in self._free(name)]
        return openings(self._parts[name].model, yaw, receivers, self._turn_rad)

    def field(self, name: str, yaw: float, places: Floats, mouths: Iterable[Opening]) -> Floats:
        """Give how high a part's centre stands wherever it is lowered, (n,) m.

        Args:
            name: The part.
            yaw: How it is turned about the vertical, rad.
            places: (n, 2), x and y of its centre, m.
            mouths: The seats it would go into, with what keeps it from going down all the way.
        """
        model = self._parts[name].model
        heights = np.full(len(places), model.size[2] / 2)  # on the table
        receivers = {mouth.receiver: mouth for mouth in mouths}
        for other, other_model, pose in self.solids(name):
            if other in receivers:
                over = field_over(model, yaw, places, receivers[other])
            else:
                over = resting_heights(model, yaw, places, other_model, pose)
            np.maximum(heights, over, out=heights)
        return heights

    def _free(self, name: str) -> list[PlacedPart]:
        """Give the parts that are neither this one, nor carried by it, nor in a hand."""
        away = {name, *self._in_hands}
        return [
            other
            for other in self._parts.values()
            if other.name not in away and away.isdisjoint(self.ancestors(other.name))
        ]
