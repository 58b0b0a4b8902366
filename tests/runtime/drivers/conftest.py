from __future__ import annotations

import signal
import time

import pytest

from aapa import Anchor, AnchorStatus
from icarus_lite import Status
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


@pytest.fixture(scope="session")
def run():
    """Poll as the loop does, once a cycle, until the action has ended."""

    def _run(driver, anchors, each=lambda: None, *, within_s=60.0, cycle_s=0.01):
        deadline = time.monotonic() + within_s
        while time.monotonic() < deadline:
            outcome = driver.poll(anchors())
            if outcome is None or outcome.status is not Status.RUNNING:
                return outcome
            each()
            signal.sigtimedwait([], cycle_s)
        return pytest.fail(f"the action did not end within {within_s} s")

    return _run


@pytest.fixture(scope="session")
def await_that():
    """Wait for a condition, with a deadline."""

    def _await(condition, within_s=15.0):
        deadline = time.monotonic() + within_s
        while not condition():
            assert time.monotonic() < deadline, "the condition never came true"
            signal.sigtimedwait([], 0.005)

    return _await


@pytest.fixture(scope="session")
def stands_still():
    """Whether a controller's arm stands still."""

    def _stands_still(controller):
        speeds = controller.bench({"query": "state"})["joint_speeds"]
        return max(map(abs, speeds)) < 1e-6

    return _stands_still
