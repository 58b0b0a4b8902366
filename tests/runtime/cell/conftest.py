from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import pytest

from runtime.cell import PERFECT, Cell, CellParameters, HandParameters, Mishaps, PlacedPart
from runtime.cell.arrangement import FIXTURE
from runtime.cell.mishaps import Fate
from runtime.cell.world import World
from runtime.kinematics import Joints, Matrix, inverse, nearest
from runtime.parts import PartModel, Primitive, load_parts

Over = Callable[..., Joints]


def above(cell: Cell, place: Sequence[float], height: float = 0.0, turn: float = 0.0) -> Joints:
    """Joints that bring the tool centre point over a place, pointing down, fingers along y."""
    c, s = np.cos(turn), np.sin(turn)
    target = np.array([[c, s, 0, 0], [s, -c, 0, 0], [0, 0, -1, 0], [0, 0, 0, 1.0]])
    target[:3, 3] = place
    target[2, 3] += height
    joints = nearest(inverse(cell.arm, target @ np.linalg.inv(cell.tcp)), cell.look_joints)
    assert joints is not None, f"{place} + {height} is out of reach"
    return joints


def pick(cell: Cell, name: str, turn: float = 0.0) -> bool:
    """Grip a part where it stands and come back to the look pose."""
    part = cell.truth.parts[name]
    joints = above(cell, part.position, part.model.grasp_height_m, turn)
    cell.update(joints, gripper_closed=False)
    cell.update(joints, gripper_closed=True)
    return cell.update(cell.look_joints, gripper_closed=True)


def let_go(
    cell: Cell, place: Sequence[float], turn: float = 0.0, aside: Sequence[float] = (0, 0, 0)
) -> None:
    """Bring the held part's centre to a place and open the hand, then return to the look pose."""
    held = cell.truth.held
    assert held is not None
    height = cell.truth.parts[held].model.grasp_height_m
    joints = above(cell, np.add(place, aside), height, turn)
    cell.update(joints, gripper_closed=True)
    cell.update(joints, gripper_closed=False)
    cell.update(cell.look_joints, gripper_closed=False)


@pytest.fixture
def over() -> Over:
    return above


@pytest.fixture
def grip() -> Callable[..., bool]:
    return pick


@pytest.fixture
def release() -> Callable[..., None]:
    return let_go


@pytest.fixture
def cell() -> Cell:
    made = Cell("ur5", 2, CellParameters(detector=PERFECT))
    made.update(made.look_joints, gripper_closed=False)
    return made


PARTS = load_parts()
PLATE = PartModel(
    FIXTURE, (Primitive("box", (0.2, 0.2, 0.006), (0, 0, 0), (0, 0, 0)),), (0.2, 0.2, 0.006), 0, 0.2
)


def at(x: float, y: float, z: float) -> Matrix:
    pose = np.eye(4)
    pose[:3, 3] = x, y, z
    return pose


def standing(
    name: str, x: float, y: float, bottom: float = 0.0, parent: str | None = None
) -> PlacedPart:
    model = PARTS[name.rpartition("-")[0]]
    return PlacedPart(name, model, at(x, y, bottom + model.size[2] / 2), parent=parent)


class Bench:
    """A world without a robot: the tool is put where the test wants it."""

    def __init__(
        self, hand: HandParameters | None = None, mishaps: Mishaps | None = None, seed: int = 0
    ):
        self.world = World(
            [
                standing("case-1", 0.5, 0.2, 0.006, FIXTURE),
                standing("hubcover-1", 0.4, 0.0),
                standing("input-1", 0.4, -0.1),
                standing("bearing-1", 0.3, -0.1),
                standing("bearing-2", 0.3, -0.2),
                standing("casingtop-1", 0.5, -0.2),
                standing("plug-1", 0.4, 0.08),
                standing("transfer-1", 0.3, 0.08),
            ],
            PlacedPart(FIXTURE, PLATE, at(0.5, 0.2, 0.003)),
            hand,
            Fate(seed, mishaps),
        )
        self.place = [0.3, 0.0, 0.3]
        self.yaw = 0.0
        self.closed = False
        self.move()

    def move(self, x=None, y=None, z=None, yaw=None, force_n=0.0, spun_rad=0.0):
        """Bring the tool somewhere, pointing down; what is not given stays."""
        self.place = [b if a is None else a for a, b in zip((x, y, z), self.place, strict=True)]
        self.yaw = self.yaw if yaw is None else yaw
        c, s = np.cos(self.yaw), np.sin(self.yaw)
        tool = at(*self.place)
        tool[:3, :3] = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ np.diag([1.0, -1.0, -1.0])
        return self.world.step(tool, closed=self.closed, force_n=force_n, spun_rad=spun_rad)

    def close(self):
        self.closed = True
        return self.move()

    def open(self):
        self.closed = False
        return self.move()

    def grip(self, name: str, yaw: float = 0.0) -> bool:
        part = self.world.parts[name]
        x, y, z = part.position
        self.move(x, y, z + part.model.grasp_height_m, yaw)
        return self.close()

    def pick(self, name: str) -> bool:
        held = self.grip(name)
        self.move(z=0.3)
        return held

    def seat(self, name: str, into: str) -> np.ndarray:
        part, receiver = self.world.parts[name], self.world.parts[into]
        offset = next(s.offset for s in part.model.seats if s.into == receiver.model.type)
        return np.add(receiver.position, offset)

    def press(self, x, y, force_n=12.0, until_z=-1.0, search_m=0.006):
        """Go down at x, y as a compliant arm does: pressing, sliding, searching in a spiral.

        Gives how far above until_z (m, the tool's) it came to a stand.
        """
        wide, tries = 0.0, 0
        self.move(x, y)
        for _ in range(600):
            contact = self.world.contact()
            px, py, z = self.place
            height = None if contact is None else contact.height_at(px, py)
            if height is None:
                self.move(z=z - 0.002)
                continue
            # Deep against a wall it slides off rather than down.
            rest = height - min(0.003, force_n / (1000 * contact.press_n(px, py, height - 0.001)))
            if z > rest + 1e-9:
                self.move(z=max(rest, z - 0.002))
            elif z < rest - 1e-9:
                self.move(z=rest)
            else:
                around = [
                    (contact.height_at(px + dx * 2e-4, py + dy * 2e-4) or np.inf, dx, dy)
                    for dx in (-1, 0, 1)
                    for dy in (-1, 0, 1)
                ]
                low, dx, dy = min(around)
                if low < height - 3e-5:
                    self.move(px + dx * 2e-4, py + dy * 2e-4)
                    continue
                self.move(force_n=force_n)
                if z <= until_z + 2e-4 or self.world.held is None:
                    break
                walls = ((1.2e-3, 0), (-1.2e-3, 0), (0, 1.2e-3), (0, -1.2e-3))
                beside = [contact.height_at(px + dx, py + dy) or np.inf for dx, dy in walls]
                if min(beside) > height + 3e-4:
                    break  # in a hole: there is nothing to be searched
                tries += 1
                wide = 6e-4 * tries**0.5
                if wide > search_m:
                    break
                self.move(x + wide * np.cos(2.4 * tries), y + wide * np.sin(2.4 * tries))
        return self.place[2] - until_z

    def push_in(self, name, into, aside=(0.0, 0.0), force_n=None, search_m=0.006):
        """Insert what is held as an arm does; gives how far above its place it was when let go."""
        x, y, z = self.seat(name, into)
        part = self.world.parts[name]
        force_n = part.model.seats[0].press_n if force_n is None else force_n
        z += part.model.grasp_height_m
        rest = self.press(x + aside[0], y + aside[1], force_n, z, search_m)
        self.open()
        return rest


@pytest.fixture
def bench() -> Bench:
    return Bench()


@pytest.fixture
def new_bench() -> type[Bench]:
    return Bench
