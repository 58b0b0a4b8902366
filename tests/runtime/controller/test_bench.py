from __future__ import annotations

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from runtime.controller.arm import HOME
from runtime.controller.bench import BenchServer
from runtime.controller.control_box import ControlBox
from runtime.kinematics import UR5


@pytest.fixture
def dropped():
    return []


@pytest.fixture
def box():
    return ControlBox(UR5, lambda: 0.0, HOME)


@pytest.fixture
def bench(box, dropped):
    return BenchServer(box, lambda: dropped.append(True))


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


def test_faults_happen(bench, box, dropped):
    box.load("sleep(1)\n")
    assert ask(bench, fault={"kill_script": True})["ok"]
    assert box.program is None
    assert ask(bench, fault={"drop_rtde": True})["ok"]
    assert dropped == [True]
    assert ask(bench, fault={"protective_stop": True})["ok"]
    assert ask(bench, query="state")["safety"] == "PROTECTIVE_STOP"
    assert "stopped already" in ask(bench, fault={"protective_stop": True})["error"]
    assert ask(bench, fault={"emergency_stop": True})["ok"]
    assert ask(bench, query="state")["safety"] == "ROBOT_EMERGENCY_STOP"
    assert ask(bench, fault={"emergency_stop": False})["ok"]
    assert ask(bench, query="state")["robot_mode"] == "POWER_OFF"
    assert ask(bench, fault={"silence": 2.5})["ok"]
    assert bench.silence_s == 2.5
    assert ask(bench, fault={"die": True})["ok"]
    assert bench.dying


@pytest.mark.parametrize(
    ("request_", "words"),
    [
        ({"fault": {"earthquake": True}}, "there is no fault 'earthquake'"),
        ({"fault": {}}, '"fault" takes an object'),
        ({"fault": {"silence": -1}}, '"silence" takes seconds'),
        ({"fault": {"die": 1}}, '"die" takes true or false, not 1'),
        ({"dance": 1}, "there is no request 'dance'; known are"),
        ({}, "a request is an object with"),
        ({"query": "weather"}, "there is no query 'weather'"),
        ({"wrench": [1, 2]}, '"wrench" takes a list of 6 numbers'),
        ({"wrench": [10**400] * 6}, '"wrench" takes a list of 6 numbers'),
        ({"inputs": {"tool_digital_in_0": 1}}, "takes true or false, not 1"),
        ({"inputs": 5}, '"inputs" takes an object'),
    ],
)
def test_a_wrong_request_is_answered_with_what_is_right(bench, request_, words):
    answer = bench.answer(json.dumps(request_).encode())
    assert answer["ok"] is False
    assert words in answer["error"]


@given(st.binary(max_size=60))
def test_garbage_is_answered(garbage):
    bench = BenchServer(ControlBox(UR5, lambda: 0.0, HOME), lambda: None)
    assert bench.answer(garbage)["ok"] is False
