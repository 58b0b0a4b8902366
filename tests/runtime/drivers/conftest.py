from __future__ import annotations

import pytest

from aapa import Anchor, AnchorStatus
from runtime.config import load_robot
from runtime.drivers import ArmState
from runtime.drivers.limits import tcp_matrix
from runtime.kinematics import matrix_to_pose
from runtime.parts import load_parts


@pytest.fixture(scope="session")
def config():
    return load_robot("ur5")


@pytest.fixture(scope="session")
def parts():
    return load_parts()


@pytest.fixture(scope="session")
def anchor():
    def _anchor(name, type_, position):
        return Anchor(name, type_, (0.0, 0.0, 1.0, 1.0), AnchorStatus.VISIBLE, None, 1.0, position)

    return _anchor


@pytest.fixture(scope="session")
def arm_at(config):
    def _arm_at(joints=None, *, closed=False, gripped=False):
        joints = joints or config.look_joints
        pose = matrix_to_pose(tcp_matrix(config, joints))
        return ArmState(joints, pose, closed, gripped, 0.0)

    return _arm_at


@pytest.fixture(scope="session")
def scene(anchor, parts):
    """A case, a hub cover and a plug on the table, by name."""

    def _scene(**moved):
        places = {
            "case": ("case", (0.40, 0.16)),
            "hubcover": ("hubcover", (0.42, -0.10)),
            "plug-1": ("plug", (0.55, -0.05)),
        }
        anchors = {
            name: anchor(name, type_, (*xy, parts[type_].size[2] / 2))
            for name, (type_, xy) in places.items()
        }
        anchors["hand1"] = anchor("hand1", "hand", (0.30, 0.0, 0.42))
        for name, position in moved.items():
            if position is None:
                del anchors[name]
            else:
                anchors[name] = anchor(name, anchors[name].type, position)
        return anchors

    return _scene
