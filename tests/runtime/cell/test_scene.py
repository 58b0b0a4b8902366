from __future__ import annotations

import builtins
import sys

import numpy as np
import pytest

from runtime.cell import Cell
from runtime.cell.scene import load_mujoco
from runtime.errors import UsageError
from runtime.kinematics import MODELS, forward, link_frames


@pytest.mark.parametrize("name", sorted(MODELS))
def test_the_drawn_arm_is_where_kinematics_says(name):
    rng = np.random.default_rng(4)
    cell = Cell(name)
    for joints in rng.uniform(-3, 3, (20, 6)):
        cell.update(joints, gripper_closed=False)
        data = cell.scene.data
        flange = data.body("flange")
        expected = forward(MODELS[name], joints)
        np.testing.assert_allclose(flange.xpos, expected[:3, 3], atol=2e-6)
        np.testing.assert_allclose(flange.xmat.reshape(3, 3), expected[:3, :3], atol=1e-9)
        # Each link's body sits at the origin of the frame before its joint.
        origins = link_frames(MODELS[name], joints)[:6, :3, 3]
        drawn = data.xpos[flange.id - 6 : flange.id]
        np.testing.assert_allclose(drawn, origins, atol=2e-6)


def test_parts_are_where_the_world_says(cell, grip):
    assert grip(cell, "input-1", turn=0.7)
    data = cell.scene.data
    for name, part in cell.truth.parts.items():
        body = data.body(name)
        np.testing.assert_allclose(body.xpos, part.position, atol=1e-9)
        np.testing.assert_allclose(body.xmat.reshape(3, 3), part.pose[:3, :3], atol=1e-9)


def test_the_fingers_close_onto_the_part(cell, grip):
    grip(cell, "hubcover-1")
    model, data = cell.scene.model, cell.scene.data
    gap = data.joint("finger+1").qpos[0] + data.joint("finger-1").qpos[0]
    assert gap == pytest.approx(cell.truth.parts["hubcover-1"].model.grip_width_m)
    assert model.nq == 8


def test_rays_tell_parts_from_everything_else(cell):
    case = cell.truth.parts["case-1"]
    x, y, _ = case.position
    down = np.array([[0.0, 0.0, -1.0]])
    ids, distances = cell.scene.cast((x, y, 0.5), down)
    floor = case.position[2] - case.model.size[2] / 2 + 0.014
    assert ids.tolist() == [0]
    assert distances.tolist() == pytest.approx([0.5 - floor])
    ids, distances = cell.scene.cast((0.9, 0.9, 0.5), down)
    assert (ids.tolist(), distances.tolist()) == ([-1], [-1.0])


def test_without_mujoco_the_extra_is_named(monkeypatch):
    real = builtins.__import__

    def refuse(name, *args, **kwargs):
        if name == "mujoco":
            raise ImportError(name)
        return real(name, *args, **kwargs)

    monkeypatch.delitem(sys.modules, "mujoco", raising=False)
    monkeypatch.setattr(builtins, "__import__", refuse)
    with pytest.raises(UsageError, match=r"pip install 'icarus-lite\[cell\]'"):
        load_mujoco()
