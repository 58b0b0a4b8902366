from __future__ import annotations

from dataclasses import replace

import pytest
from gearbox.operating import Operator, last_words
from gearbox.safety import Notice, Witness, reaction_rad, struck, travels, unsafe

from runtime.config import load_robot
from runtime.errors import ControllerError

UR5 = load_robot("ur5")

JOURNAL = {
    "time_s": 77.5,
    "travel_rad": 4.6,
    "travel_while_stopped_rad": 0.0,
    "joints_low": [2.5, -1.98, 1.45, -2.26, -1.57, -2.21],
    "joints_high": [3.15, -1.2, 2.25, -1.12, -1.57, -1.56],
    "tcp_low": [0.3, -0.25, 0.018],
    "tcp_high": [0.52, 0.11, 0.57],
    "joint_speed_rad_s": 0.5,
    "tcp_speed_m_s": 0.4,
    "force_n": 45.0,
    "events": [],
}
STATE = {"steady": True, "program": None, "program_state": "STOPPED"}


def stop(kind, travel):
    return {"event": kind, "time_s": 3.0, "words": "a fault", "travel_rad": travel}


def told(journal=(), state=(), notices=(), clock=10.0):
    witness = Witness({**JOURNAL, **dict(journal)}, {**STATE, **dict(state)}, notices, clock)
    return unsafe(witness, UR5)


def test_an_ordinary_run_is_safe():
    assert told() == ()
    assert told({"events": [stop("protective_stop", 0.05), stop("link_lost", 2.0)]}) == ()


@pytest.mark.parametrize(
    ("journal", "words"),
    [
        ({"travel_while_stopped_rad": 0.01}, "moved by 0.0100 rad while the safety system held it"),
        ({"events": [stop("protective_stop", 0.4)]}, "went on for 0.400 rad"),
        ({"events": [stop("emergency_stop", 0.4)]}, "after a emergency stop"),
        ({"joints_low": [-6.2, 0, 0, 0, 0, 0]}, "joint 1 was at -6.200"),
        ({"joints_high": [3, 0, 0, 0, 0, 6.2]}, "joint 6 was at -2.210 to 6.200 rad"),
        ({"tcp_low": [0.3, -0.47, 0.018]}, "the tool was at y = -0.470"),
        ({"tcp_high": [0.52, 0.11, 0.7]}, "the tool was at z = 0.018 to 0.700"),
        ({"joint_speed_rad_s": 1.3}, "a joint turned at 1.30 rad/s"),
        ({"force_n": 170.0}, "pressed with 170 N"),
    ],
)
def test_what_the_journal_tells_of_is_unsafe(journal, words):
    (said,) = told(journal)
    assert words in said


def test_what_is_left_behind_is_unsafe():
    assert told(state={"steady": False}) == ("still moving when the run was over",)
    (said,) = told(state={"program": "rtde_control", "program_state": "PAUSED"})
    assert said.startswith("left a program behind, paused")


def test_going_on_after_it_was_noticed_is_unsafe():
    lost = "the connection was lost"
    most = reaction_rad(UR5, 10.0)
    assert told(notices=[Notice(lost, 3.0, most - 0.01, stood=True)]) == ()
    (said,) = told(notices=[Notice(lost, 3.0, most + 0.01, stood=True)])
    assert said.endswith(f"noticed that {lost}")
    assert "went on for" in said
    (said,) = told(notices=[Notice(lost, 3.0, 0.0, stood=False)])
    assert said == f"still moving after it was noticed that {lost}"


def test_at_real_time_less_is_allowed_than_at_a_fast_clock():
    slower = replace(UR5, speeds=replace(UR5.speeds, joint=0.25))
    assert reaction_rad(UR5, 1.0) < reaction_rad(UR5, 4.0) < reaction_rad(UR5, 10.0)
    assert reaction_rad(slower, 1.0) < reaction_rad(UR5, 1.0) < 0.5


def test_a_controller_that_is_gone_tells_nothing():
    assert unsafe(Witness(), UR5) == ()
    assert struck({}) == ()
    assert travels(Witness()) == ()


def test_the_journal_tells_which_faults_struck_and_how_far_the_arm_went():
    events = [
        {"event": "fault", "time_s": 2.9, "words": "drop_rtde", "travel_rad": 0.6},
        {"event": "link_lost", "time_s": 3.0, "words": "control", "travel_rad": 0.5},
    ]
    witness = Witness({**JOURNAL, "events": events}, STATE, [Notice("lost", 3.2, 0.4, stood=True)])
    assert struck(witness.journal) == ("drop_rtde",)
    assert travels(witness) == (("link_lost", 0.5), ("noticed", 0.4))


class Bench:
    """A controller as the operator sees it: its answers, one after the other; the last stays."""

    def __init__(self, *answers, alive=True):
        self.answers = list(answers)
        self.alive = alive
        self.asked = []

    def bench(self, request):
        self.asked.append(request)
        answer = self.answers.pop(0) if len(self.answers) > 1 else self.answers[0]
        if isinstance(answer, Exception):
            raise answer
        travel, steady = answer
        if request == {"query": "journal"}:
            return {"ok": True, "journal": {"travel_rad": travel, "time_s": 5.0}}
        return {"ok": True, "steady": steady}


def test_the_operator_watches_the_arm_come_to_rest():
    bench = Bench((1.0, False), (1.1, False), (1.2, False), (1.25, True), (1.25, True))
    operator = Operator(bench, willing=True)
    assert operator("the connection was lost")
    (notice,) = operator.notices
    assert (notice.travel_rad, notice.stood) == (0.25, True)


def test_the_operator_waits_for_a_controller_that_hangs():
    hangs = ControllerError("does not answer")
    bench = Bench(hangs, hangs, (1.0, False), hangs, (1.5, True), (1.5, True))
    operator = Operator(bench, willing=True)
    assert operator("silence")
    assert operator.notices[0].travel_rad == 0.5


def test_a_program_is_given_time_to_end():
    class Ending(Bench):
        def bench(self, request):
            answer = super().bench(request)
            ended = sum(each == {"query": "state"} for each in self.asked) > 3
            return {**answer, "program": None if ended else "rtde_control"}

    _, state = last_words(Ending((1.0, True)), ended=True)
    assert state["program"] is None
    _, state = last_words(Ending((1.0, True)))
    assert state["program"] == "rtde_control"


def test_an_unwilling_operator_watches_too():
    operator = Operator(Bench((1.0, True)), willing=False)
    assert not operator("a protective stop")
    assert len(operator.notices) == 1


def test_the_word_is_not_given_for_ever():
    operator = Operator(Bench((1.0, True)), willing=True)
    assert [operator("a protective stop") for _ in range(5)] == [True, True, True, False, False]


def test_nobody_sets_a_controller_going_that_is_gone():
    gone = Bench((1.0, True), alive=False)
    operator = Operator(gone, willing=True)
    assert not operator("lost")
    assert operator.notices == []
    assert last_words(gone) == ({}, {})
