"""The person's hand: where it is, what it carries, what it holds where it stands."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from runtime.cell.body import REST
from runtime.cell.support import heading
from runtime.cell.world import World
from runtime.parts import Vector

TRAY: Final = (0.98, -0.36)
"""x and y of the person's own side, where parts go that they take away, m."""

_SLOTS: Final = 4  # parts in a row on the person's side
_SLOT_M: Final = 0.12
_NEAR_M: Final = 0.15  # a part farther than this from where it is said to be is not meant
_BESIDE_M: Final = 0.055  # the palm from the side of a part it holds where it stands
_LOW_M: Final = 0.012
_ABOVE_M: Final = 0.012  # the palm over the top of a part it holds
_SPOT_M: Final = 0.01  # between the places looked at to put a part down
_LOOKS: Final = 15  # of them to each side
_ROOM_M: Final = 0.015  # left free around a part that is put down
_LEVEL_M: Final = 1e-6


class StoppedError(Exception):
    """What the person does cannot be done; the text says why."""


@dataclass(frozen=True, slots=True)
class Leg:
    """A motion of the hand, starting and ending at rest.

    Args:
        target: Where the palm goes, m.
        seconds: How long it takes; None follows from the distance.
    """

    target: Vector
    seconds: float | None = None


@dataclass(frozen=True, slots=True)
class Until:
    """Wait for something.

    Args:
        ready: Tells whether it has come about.
        limit_s: How long to wait for it.
        otherwise: Why the person gives up then; "" goes on without it.
    """

    ready: Callable[[], bool]
    limit_s: float
    otherwise: str = ""


class HelpingHand:
    """One hand of a person, in the world of the parts.

    Args:
        world: The parts, and the robot's tool.
        distance_m: How close to the robot's tool it goes, at the closest.
    """

    def __init__(self, world: World, distance_m: float) -> None:
        self._world = world
        self._distance_m = distance_m
        self._tray: list[str] = []
        self._taken_from: dict[str, tuple[float, float]] = {}
        self.place: Vector = REST
        """The middle of the palm, m."""
        self.carries: str | None = None
        """The part it carries, if any."""
        self.holds: str | None = None
        """The part it holds where it stands, if any."""

    def is_clear(self, target: Vector) -> bool:
        """Tell whether the robot's tool is far enough from a place, and from the way there."""
        tool = self._world.tool
        if tool is None:
            return True
        start, end, at = np.array(self.place), np.array(target), tool[:3, 3]
        way = end - start
        share = float((at - start) @ way) / max(1e-9, float(way @ way))
        nearest = start + way * min(1.0, max(0.0, share))
        near_now = float(np.linalg.norm(at - start))
        return (
            float(np.linalg.norm(at - end)) > self._distance_m
            and float(np.linalg.norm(at - nearest)) > min(self._distance_m, near_now) - 1e-9
        )

    def move(self, place: Vector) -> None:
        """Bring the palm somewhere, and what it carries with it."""
        if self.carries not in self._world.arrangement.in_hands:
            self.carries = None  # somebody else has put it elsewhere
        if self.carries is not None:
            pose = self._world.parts[self.carries].pose.copy()
            pose[:3, 3] += np.subtract(place, self.place)
            self._world.arrangement.move(self.carries, pose)
        self.place = place

    def find(self, name: str, near: Vector | None) -> str:
        """Give the true part that is meant by a name, such as "plug", "bearing-2" or "o3".

        Args:
            name: Of a part, or of its type; a number after the type is the asker's own counting.
            near: Where the asker believes it to be, m; None takes the part of that very name, or
                the first of its type.

        Raises:
            StoppedError: No such part is there.
        """
        parts = self._world.parts
        if near is None and name in parts:
            return name
        kind = name.rpartition("-")[0] if name.rpartition("-")[2].isdigit() else name
        alike = [part for part in parts.values() if part.model.type == kind]
        if not alike:
            raise StoppedError(f"there is no {kind}")
        mine = [part for part in alike if part.name == self.carries or part.name in self._tray]
        if near is None:
            return (mine or alike)[0].name
        best = min(alike, key=lambda part: (math.dist(part.position[:2], near[:2]), part.name))
        if math.dist(best.position[:2], near[:2]) <= _NEAR_M:
            return best.name
        if mine:
            return mine[0].name
        raise StoppedError(f"there is no {kind} near ({near[0]:.2f}, {near[1]:.2f}) m")

    def over(self, name: str) -> Vector:
        """Give where the palm is when it takes hold of a part from above, m."""
        part = self._world.parts[name]
        x, y, z = part.position
        return x, y, z + part.model.size[2] / 2 + _ABOVE_M

    def beside(self, name: str) -> Vector:
        """Give where the palm is when it holds a part where it stands, m: low, at its far side."""
        part = self._world.parts[name]
        x, y, z = part.position
        c, s = abs(math.cos(heading(part.pose))), abs(math.sin(heading(part.pose)))
        half = (c * part.model.size[0] + s * part.model.size[1]) / 2
        return x + half + _BESIDE_M, y, z - part.model.size[2] / 2 + _LOW_M

    def check_free(self, name: str) -> None:
        """Raise StoppedError if the robot has a part in its hand."""
        if self._world.held == name or self._world.held in self._carried_by(name):
            raise StoppedError(f"the robot holds the {self._kind(name)}")

    def take(self, name: str) -> None:
        """Take hold of a part. Raises StoppedError if it is not to be had."""
        self.check_free(name)
        if math.dist(self.over(name), self.place) > 0.03:
            raise StoppedError(f"the {self._kind(name)} is no longer there")
        x, y, _ = self._world.parts[name].position
        if name not in self._tray:
            self._taken_from[name] = (x, y)
        else:
            self._tray.remove(name)
        self._world.arrangement.take(name)
        self.carries = name

    def seat_of(self, name: str, into: str) -> Vector:
        """Give where a part's centre is when it is seated. Raises StoppedError if it fits not."""
        part, receiver = self._world.parts[name], self._world.parts[into]
        for seat in part.model.seats:
            if seat.into == receiver.model.type:
                x, y, z = (receiver.pose @ np.array([*seat.offset, 1.0]))[:3].tolist()
                return x, y, z
        raise StoppedError(f"the {part.model.type} fits nowhere in the {receiver.model.type}")

    def insert(self, into: str) -> None:
        """Seat what it carries. Raises StoppedError if something is in the way."""
        name = self.carries
        assert name is not None, "only what is carried is inserted"
        self.check_free(into)
        if not self._world.is_seat_free(name, into):
            raise StoppedError(f"something is in the way of the {self._kind(name)}")
        self._world.insert(name, into)
        self.carries = None

    def free_near(self, name: str, wanted: tuple[float, float]) -> tuple[float, float]:
        """Give the nearest place, m, at which a part would stand on the table and beside nothing.

        Whoever puts a part down sees what stands there already. The wanted place itself if no
        free one is near.
        """
        part = self._world.parts[name]
        ticks = np.arange(-_LOOKS, _LOOKS + 1) * _SPOT_M
        aside = np.stack(np.meshgrid(ticks, ticks, indexing="ij"), axis=-1).reshape(-1, 2)
        aside = aside[np.argsort(np.hypot(*aside.T), kind="stable")]
        around = [(x, y) for x in (0.0, -_ROOM_M, _ROOM_M) for y in (0.0, -_ROOM_M, _ROOM_M)]
        places = (np.asarray(wanted) + aside)[:, None, :] + np.asarray(around)
        heights = self._world.arrangement.field(
            name, heading(part.pose), places.reshape(-1, 2), ()
        ).reshape(len(aside), -1)
        free = (heights <= part.model.size[2] / 2 + _LEVEL_M).all(axis=1)
        if not free.any():
            return wanted
        x, y = places[int(np.argmax(free)), 0].tolist()
        return x, y

    def put_down(self) -> None:
        """Let go of what it carries; it falls onto what is below."""
        if self.carries is not None:
            self._world.arrangement.drop(self.carries)
            self.carries = None

    def put_aside(self) -> None:
        """Leave what it carries on the person's own side."""
        if self.carries is not None:
            self._tray.append(self.carries)
            self.put_down()

    def slot(self) -> tuple[float, float]:
        """Give a free place on the person's own side, m."""
        return TRAY[0], TRAY[1] - _SLOT_M * (len(self._tray) % _SLOTS)

    def home_of(self, name: str) -> tuple[float, float] | None:
        """Give where a part was taken from, m."""
        return self._taken_from.get(name)

    def pin(self, name: str) -> None:
        """Hold a part where it stands."""
        self.holds = name
        self._world.arrangement.pinned = frozenset({name})

    def unpin(self) -> None:
        """Let go of what is held where it stands."""
        self.holds = None
        self._world.arrangement.pinned = frozenset()

    def snapshot(self) -> dict[str, object]:
        """Give what is on the person's own side, and where it came from."""
        return {"tray": list(self._tray), "taken_from": dict(self._taken_from)}

    def restore(self, kept: Mapping[str, Any], carried: Iterable[str]) -> None:
        """Take over what was written down; what was carried is on the person's own side."""
        self.place, self.carries, self.holds = REST, None, None
        self._tray = [str(name) for name in kept.get("tray", ())]
        self._taken_from = {
            str(name): (float(x), float(y)) for name, (x, y) in kept.get("taken_from", {}).items()
        }
        for name in carried:
            self._world.place(name, *self.slot())
            self._tray.append(name)

    def _carried_by(self, name: str) -> tuple[str, ...]:
        return self._world.arrangement.ancestors(name)

    def _kind(self, name: str) -> str:
        return self._world.parts[name].model.type
