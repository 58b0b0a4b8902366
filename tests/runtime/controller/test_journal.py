from __future__ import annotations

import json
import math

import numpy as np
import pytest

from runtime.controller.contact import Contact, Surface
from runtime.controller.control_box import ControlBox
from runtime.controller.journal import MOST_EVENTS
from runtime.controller.motions import JointState
from runtime.kinematics import UR5

START = (0.0, -1.5, 1.5, -1.5, -1.5, 0.0)
MOVE = "def go():\n movej([1, -1.5, 1.5, -1.5, -1.5, 0], a=4, v=1)\nend\n"


class Witnessed:
    def __init__(self):
        self.box = ControlBox(UR5, lambda: 0.0, START)
        self.lines: list[str] = []
        self.box.journal.write = self.lines.append

    def run(self, seconds):
        for _ in range(round(seconds / self.box.cycle_s)):
            self.box.cycle()

    @property
    def summary(self):
        return self.box.journal.summary()

    def of_kind(self, kind):
        return [event for event in self.box.journal.to_json()["events"] if event["event"] == kind]


@pytest.fixture
def witnessed():
    return Witnessed()


def test_a_stop_is_followed_until_the_arm_stands(witnessed):
    witnessed.box.load(MOVE)
    witnessed.run(0.6)
    at, when = witnessed.box.arm.joints[0], witnessed.box.time_s
    witnessed.box.protective_stop("a test")
    assert witnessed.of_kind("protective_stop")[0]["standstill_s"] is None
    witnessed.run(0.5)
    (stop,) = witnessed.of_kind("protective_stop")
    assert stop["words"] == "a test"
    assert stop["time_s"] == pytest.approx(when)
    assert stop["travel_rad"] == pytest.approx(witnessed.box.arm.joints[0] - at)
    # From 1 rad/s at 15 rad/s^2.
    assert stop["travel_rad"] == pytest.approx(1 / 30, rel=0.1)
    assert stop["standstill_s"] - stop["time_s"] == pytest.approx(1 / 15, abs=0.02)
    assert witnessed.summary["travel_while_stopped_rad"] == 0.0


def test_a_stop_of_a_resting_arm_is_no_travel(witnessed):
    witnessed.run(0.1)
    witnessed.box.emergency_stop()
    (stop,) = witnessed.of_kind("emergency_stop")
    assert (stop["travel_rad"], stop["standstill_s"]) == (0.0, stop["time_s"])


def test_the_journal_would_tell_of_an_arm_that_moves_while_it_is_stopped(witnessed):
    """The rest of the program never does this: the journal has to be told from outside."""
    witnessed.box.load(MOVE)
    witnessed.run(0.3)
    witnessed.box.protective_stop("a test")
    witnessed.run(0.5)
    assert witnessed.summary["travel_while_stopped_rad"] == 0.0
    arm = witnessed.box.arm
    arm.state = JointState(arm.state.q + np.array([0, 0, 0.25, 0, 0, 0]), np.zeros(6))
    witnessed.run(0.1)
    assert witnessed.summary["travel_while_stopped_rad"] == pytest.approx(0.25)


def test_extremes_are_the_furthest_the_arm_has_ever_been(witnessed):
    box = witnessed.box
    begin = box.arm.tcp_pose
    box.load(
        "def there_and_back():\n movej([1, -1.2, 1.5, -1.5, -1.5, 0], a=4, v=1)\n"
        f" movej({list(START)}, a=4, v=1)\nend\n"
    )
    places = []
    while box.program is not None:
        box.cycle()
        places.append(box.arm.tcp_pose[:3])
    summary = witnessed.summary
    assert summary["joints_high"] == pytest.approx([1, -1.2, 1.5, -1.5, -1.5, 0])
    assert summary["joints_low"] == list(START)
    assert summary["tcp_low"] == pytest.approx([min(axis) for axis in zip(*places, strict=True)])
    assert summary["tcp_high"] == pytest.approx([max(axis) for axis in zip(*places, strict=True)])
    assert summary["joint_speed_rad_s"] == pytest.approx(1.0, rel=1e-6)
    assert summary["travel_rad"] == pytest.approx(2.0)
    assert summary["moves"] == 2
    assert 0.3 < summary["tcp_speed_m_s"] < 2 * math.hypot(*begin[:2])


def test_the_greatest_force_is_kept(witnessed):
    x, y, z = witnessed.box.arm.tcp_pose[:3]
    heights = ((z + 0.001, z + 0.001), (z + 0.001, z + 0.001))
    surface = Surface((x - 0.05, y - 0.05), 0.1, heights, 50_000)
    witnessed.box.arm.be_near(Contact(surface))
    witnessed.run(0.05)
    witnessed.box.arm.be_near(None)
    witnessed.run(0.05)
    assert witnessed.box.arm.wrench == (0, 0, 0, 0, 0, 0)
    assert witnessed.summary["force_n"] == pytest.approx(50.0)


def test_what_happens_to_programs_and_power_is_noted_in_order(witnessed):
    box = witnessed.box
    box.load(MOVE)
    witnessed.run(0.1)
    box.pause()
    box.play()
    box.protective_stop("a test")
    witnessed.run(5.1)
    assert box.unlock_refusal() is None
    box.stop_program("a test")
    box.emergency_stop()
    box.release_emergency_stop()
    box.release_brakes()
    witnessed.run(2.2)
    assert [event["event"] for event in box.journal.to_json()["events"]] == [
        *("program_started", "program_paused", "program_resumed", "protective_stop"),
        *("protective_stop_unlocked", "program_ended", "emergency_stop"),
        *("emergency_stop_released", "brakes_released"),
    ]


def test_lines_are_written_once_the_arm_stands_and_the_rest_at_the_end(witnessed):
    witnessed.box.load(MOVE)
    witnessed.run(0.5)
    witnessed.box.stop_program("a test")
    assert [json.loads(line)["event"] for line in witnessed.lines] == ["program_started"]
    witnessed.run(0.5)
    assert json.loads(witnessed.lines[-1])["words"] == "a test"
    witnessed.box.load(MOVE)
    witnessed.run(0.3)
    witnessed.box.stop_program("too late to stand")
    witnessed.box.journal.close()
    last, summary = (json.loads(line) for line in witnessed.lines[-2:])
    assert (last["words"], last["standstill_s"]) == ("too late to stand", None)
    assert summary["event"] == "summary"
    assert summary["moves"] == 2


def test_the_memory_is_bounded_and_says_so(witnessed):
    for _ in range(MOST_EVENTS + 5):
        witnessed.box.journal.note("brakes_released", "")
    document = witnessed.box.journal.to_json()
    assert len(document["events"]) == MOST_EVENTS
    assert document["events_forgotten"] == 5
    assert len(witnessed.lines) == MOST_EVENTS + 5
