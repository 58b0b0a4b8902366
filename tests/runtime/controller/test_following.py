"""Robot time waits for whoever moves a world after the arm."""

from __future__ import annotations

import dataclasses
import socket
import time

import numpy as np
import pytest

from runtime.controller import ControllerProcess
from runtime.controller.arm import HOME
from runtime.controller.bench_client import BenchTeller
from runtime.controller.control_box import ControlBox
from runtime.controller.following import LEAD_S, Following
from runtime.controller.ports import BENCH_PORT
from runtime.kinematics import UR5

FAST = 10.0


@pytest.fixture
def box():
    return ControlBox(UR5, lambda: 0.0, HOME)


@pytest.fixture
def following(box):
    return Following(box)


def moves(box, *, seconds):
    speeds = np.array([0.0, 0.0, 0.0, 0.0, 0.0, -0.1])
    box.arm.state = dataclasses.replace(box.arm.state, qd=speeds)
    box.time_s += seconds


def test_where_nobody_follows_nobody_is_waited_for(box, following):
    moves(box, seconds=100.0)
    assert following.pace(FAST, 0.0) == FAST


def test_an_arm_that_moves_waits_for_the_world(box, following):
    following.looked(0.0)
    moves(box, seconds=0.9 * LEAD_S)
    assert following.pace(FAST, 0.1) == FAST
    moves(box, seconds=0.2 * LEAD_S)
    assert following.pace(FAST, 0.1) == 0.25
    assert following.pace(0.1, 0.1) == 0.1, "never faster than it was"
    following.looked(0.2)
    assert following.pace(FAST, 0.2) == FAST


def test_an_arm_that_stands_still_has_nothing_to_wait_for(box, following):
    following.looked(0.0)
    box.time_s += 100.0
    assert following.pace(FAST, 0.1) == FAST


def test_who_is_gone_is_waited_for_no_longer(box, following):
    following.looked(0.0)
    moves(box, seconds=100.0)
    assert following.pace(FAST, 1.9) < 1
    assert following.pace(FAST, 2.1) == FAST
    following.looked(3.0)
    moves(box, seconds=100.0)
    assert following.pace(FAST, 3.1) < 1
    following.ended()
    assert following.pace(FAST, 3.1) == FAST


@pytest.mark.robot
def test_a_moving_arm_of_a_fast_clock_waits():
    with ControllerProcess.start("ur5", clock=50) as process:

        def robot_s():
            return process.bench({"query": "state"})["timestamp_s"]

        joints = [*HOME[:5], HOME[5] + 3.0]
        with socket.create_connection((process.address, 30002)) as line:
            line.sendall(f"def turn():\n  movej({joints}, a=1, v=0.02)\nend\n".encode())
            while not any(process.bench({"query": "state"})["joint_speeds"]):
                pass
            process.bench({"followed": True})
            begun_s = robot_s()
            while (waits_s := robot_s()) <= begun_s + LEAD_S:
                pass
            until = time.monotonic() + 0.3
            while time.monotonic() < until:
                later_s = robot_s()
        assert later_s - waits_s < LEAD_S, "it would have been many seconds"


class Bench:
    """A bench that hears and says nothing, on an address of its own."""

    def __init__(self, address):
        self.listener = socket.create_server((address, BENCH_PORT))
        self.client = None

    def hears(self, length):
        if self.client is None:
            self.client, _ = self.listener.accept()
        heard = b""
        while len(heard) < length:
            heard += self.client.recv(length - len(heard))
        return heard

    def close(self):
        for each in (self.client, self.listener):
            if each is not None:
                each.close()


def test_telling_waits_for_nobody():
    line = b'{"followed": true}\n'
    teller = BenchTeller("127.0.7.9", {"followed": True})
    teller.tell()  # nobody is there
    bench = Bench("127.0.7.9")
    for _ in range(3):
        teller.tell()
    assert bench.hears(3 * len(line)) == 3 * line
    bench.close()
    for _ in range(4):
        teller.tell()  # the other end is gone, and one telling goes to nobody
    bench = Bench("127.0.7.9")
    teller.tell()
    teller.tell()
    assert bench.hears(len(line)) == line
    teller.close()
    bench.close()
