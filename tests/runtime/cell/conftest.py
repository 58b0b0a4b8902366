from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import pytest

from runtime.cell import PERFECT, Cell, CellParameters
from runtime.kinematics import Joints, inverse, nearest

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
