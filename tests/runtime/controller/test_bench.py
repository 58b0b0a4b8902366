from __future__ import annotations

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from runtime.controller.arm import HOME
from runtime.controller.bench import BenchServer
from runtime.controller.control_box import ControlBox
from runtime.controller.dashboard import DashboardServer
from runtime.controller.fault_actions import FaultActions
from runtime.controller.following import Following
from runtime.controller.rtde_server import RtdeServer
from runtime.kinematics import UR5


@pytest.fixture
def box():
    return ControlBox(UR5, lambda: 0.0, HOME)


@pytest.fixture
def actions(box):
    return FaultActions(box, RtdeServer(box), DashboardServer(box))


@pytest.fixture
def bench(box, actions):
    return BenchServer(box, actions, Following(box))


def ask(bench, **request):
    return bench.answer(json.dumps(request).encode())


def test_inputs_are_wired_all_or_none(bench, box):
    assert ask(bench, inputs={"tool_digital_in_0": True, "standard_digital_in_3": True}) == {
        "ok": True
    }
    assert box.signals.digital_inputs == 1 << 16 | 1 << 3
    refused = ask(bench, inputs={"tool_digital_in_0": False, "tool_digital_in_9": True})
    assert refused["ok"] is False
    assert "there is no input 'tool_digital_in_9'" in refused["error"]
    assert box.signals.digital_inputs == 1 << 16 | 1 << 3


def test_the_state_says_what_it_comes_from(bench, box):
    box.load("sleep(1)\n")
    state = ask(bench, query="state")
    assert state["ok"] is True
    assert state["controller"] == "stand-in controller (not a robot, not URSim)"
    assert state["joints"] == list(HOME)
    assert state["safety"] == "NORMAL"
    assert state["program_state"] == "PLAYING"
    assert state["outputs"]["tool_digital_out_0"] is False


def test_faults_happen(bench, box, actions):
    box.load("sleep(1)\n")
    assert ask(bench, fault={"kill_script": True})["ok"]
    assert box.program is None
    assert ask(bench, fault={"drop_rtde": True})["ok"]
    assert ask(bench, fault={"protective_stop": True})["ok"]
    assert ask(bench, query="state")["safety"] == "PROTECTIVE_STOP"
    assert "stopped already" in ask(bench, fault={"protective_stop": True})["error"]
    assert ask(bench, fault={"emergency_stop": True})["ok"]
    assert ask(bench, query="state")["safety"] == "ROBOT_EMERGENCY_STOP"
    assert ask(bench, fault={"emergency_stop": False})["ok"]
    assert ask(bench, query="state")["robot_mode"] == "POWER_OFF"
    assert ask(bench, fault={"silence": 2.5})["ok"]
    assert actions.silence_s == 2.5
    assert ask(bench, fault={"die": True})["ok"]
    assert actions.dying


def test_a_contact_is_felt_at_once_and_taken_away(bench, box):
    x, y, z = box.arm.tcp_pose[:3]
    heights = [[z + 0.001, z + 0.001], [z + 0.001, z + 0.001]]
    surface = {"origin": [x - 0.05, y - 0.05], "step_m": 0.1, "heights": heights}
    assert ask(bench, contact={**surface, "stiffness_n_m": 20000, "thread": None})["ok"]
    assert ask(bench, query="state")["wrench"][2] == pytest.approx(20)
    assert ask(bench, contact=None)["ok"]
    assert ask(bench, query="state")["wrench"] == [0] * 6


def test_a_schedule_takes_the_place_of_the_one_before(bench):
    later = [{"fault": "die", "when": {"time_s": 9}}, {"fault": "stall", "when": {"move": 2}}]
    assert ask(bench, faults=later)["ok"]
    assert bench.schedule.pending == 2
    assert ask(bench, faults={"schedule": later[:1], "seed": 4})["ok"]
    assert bench.schedule.pending == 1
    assert ask(bench, faults=[])["ok"]
    assert bench.schedule.pending == 0


def test_the_journal_is_told(bench, box):
    box.protective_stop("a test")
    journal = ask(bench, query="journal")["journal"]
    assert [event["event"] for event in journal["events"]] == ["protective_stop"]
    assert journal["travel_while_stopped_rad"] == 0


@pytest.mark.parametrize(
    ("request_", "words"),
    [
        ({"fault": {"earthquake": True}}, "there is no fault 'earthquake'"),
        ({"fault": {}}, '"fault" takes an object'),
        ({"fault": {"silence": -1}}, "wall_s: -1; expected a number from 0.001 to 600 s"),
        ({"fault": {"die": 1}}, '"die" takes true or false, not 1'),
        ({"dance": 1}, "there is no request 'dance'; known are"),
        ({}, "a request is an object with"),
        ({"query": "weather"}, "there is no query 'weather'"),
        ({"wrench": [1, 2]}, '"wrench" takes a list of 6 numbers'),
        ({"wrench": [10**400] * 6}, '"wrench" takes a list of 6 numbers'),
        ({"inputs": {"tool_digital_in_0": 1}}, "takes true or false, not 1"),
        ({"inputs": 5}, '"inputs" takes an object'),
        ({"outputs": {"tool_digital_in_0": True}}, "there is no output 'tool_digital_in_0'"),
        ({"contact": {"origin": [0, 0]}}, '"contact" lacks "step_m"'),
        ({"followed": "yes"}, '"followed" takes true or false'),
        ({"faults": [{"fault": "die"}]}, "entry 1: when: None"),
        ({"faults": {"schedule": [], "seed": "x"}}, '"seed" takes a number'),
    ],
)
def test_a_wrong_request_is_answered_with_what_is_right(bench, request_, words):
    answer = bench.answer(json.dumps(request_).encode())
    assert answer["ok"] is False
    assert words in answer["error"]


@given(st.binary(max_size=60))
def test_garbage_is_answered(garbage):
    box = ControlBox(UR5, lambda: 0.0, HOME)
    actions = FaultActions(box, RtdeServer(box), DashboardServer(box))
    bench = BenchServer(box, actions, Following(box))
    assert bench.answer(garbage)["ok"] is False
