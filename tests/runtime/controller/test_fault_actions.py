"""Faults on the control box, without sockets; what clients notice is in test_fault_clients."""

from __future__ import annotations

import pytest

from runtime.controller.control_box import ControlBox
from runtime.controller.dashboard import DashboardServer
from runtime.controller.fault_actions import FaultActions, FaultSchedule
from runtime.controller.faults import parse_faults
from runtime.controller.rtde_server import RtdeServer
from runtime.controller.safety import RobotMode, SafetyMode
from runtime.controller.tokens import ScriptError
from runtime.kinematics import UR5, UR16E

MOVES = """def moves():
  movej([0.5, -1.5, 1.5, -1.5, -1.5, 0], a=4, v=1)
  movel(pose_add(get_actual_tcp_pose(), p[0, 0, 0.05, 0, 0, 0]), a=1, v=0.2)
  movej([0, -1.5, 1.5, -1.5, -1.5, 0], a=4, v=1)
end
"""


class Bench:
    def __init__(self, entries, model=UR5, seed=0):
        self.box = ControlBox(model, lambda: self.box.time_s, (0, -1.5, 1.5, -1.5, -1.5, 0))
        self.rtde = RtdeServer(self.box)
        self.dashboard = DashboardServer(self.box)
        self.actions = FaultActions(self.box, self.rtde, self.dashboard)
        self.schedule = FaultSchedule(parse_faults(entries, seed), self.box, self.actions.act)

    def run(self, seconds):
        for _ in range(round(seconds / self.box.cycle_s)):
            self.box.cycle()
            self.schedule.step()
            self.actions.pass_by()

    @property
    def happened(self):
        return [
            (event["words"].partition(",")[0], event["time_s"])
            for event in self.box.journal.to_json()["events"]
            if event["event"] == "fault"
        ]


def test_a_time_is_robot_time_from_when_the_schedule_was_given():
    bench = Bench([])
    bench.run(1.0)
    bench.schedule = FaultSchedule(
        parse_faults([{"fault": "kill_script", "when": {"time_s": 0.5}}]),
        bench.box,
        bench.actions.act,
    )
    bench.run(1.0)
    assert bench.happened == [("kill_script", pytest.approx(1.5, abs=0.009))]
    assert bench.schedule.pending == 0
    bench.run(1.0)
    assert len(bench.happened) == 1


def test_a_stop_comes_at_its_joint_travel():
    bench = Bench([{"fault": "protective_stop", "when": {"travel_rad": 0.3}}])
    bench.box.load(MOVES)
    bench.run(2.0)
    assert bench.box.safety.mode is SafetyMode.PROTECTIVE_STOP
    # At 1 rad/s: a cycle late at most, then braked at 15 rad/s^2.
    assert 0.3 <= bench.box.arm.joints[0] <= 0.3 + 1.0 * bench.box.cycle_s * 2 + 1 / 30


@pytest.mark.parametrize("move", [1, 2, 3])
def test_a_fault_with_a_move_comes_when_that_move_begins(move):
    bench = Bench([{"fault": "protective_stop", "when": {"move": move}}])
    bench.box.load(MOVES)
    bench.run(5.0)
    assert bench.box.arm.moves == move
    assert bench.box.arm.joints[0] == pytest.approx(0.0 if move == 1 else 0.5, abs=0.01)


def test_and_with_travel_that_far_into_the_move():
    bench = Bench([{"fault": "kill_script", "when": {"move": 3, "travel_rad": 0.2}}])
    bench.box.load(MOVES)
    bench.run(5.0)
    assert bench.box.arm.moves == 3
    assert bench.box.arm.joints[0] == pytest.approx(0.3, abs=0.05)
    assert bench.box.program is None


def test_the_same_seed_gives_the_same_run():
    def joints(seed):
        bench = Bench([{"fault": "protective_stop", "when": {"time_s": [0.1, 1.5]}}], seed=seed)
        bench.box.load(MOVES)
        bench.run(2.0)
        return bench.box.arm.joints

    assert joints(1) == joints(1)
    assert joints(1) != joints(2)


def test_an_emergency_stop_may_be_released_again():
    bench = Bench([{"fault": "emergency_stop", "when": {"time_s": 0.1}, "release_after_s": 0.5}])
    bench.run(0.4)
    assert bench.box.safety.mode is SafetyMode.ROBOT_EMERGENCY_STOP
    bench.run(0.4)
    assert bench.box.safety.mode is SafetyMode.NORMAL
    assert bench.box.safety.robot_mode is RobotMode.POWER_OFF


def test_in_local_control_an_e_series_controller_refuses_what_acts():
    bench = Bench(
        [{"fault": "refuse_remote", "when": {"time_s": 0.1}, "release_after_s": 0.5}], UR16E
    )
    assert bench.dashboard.answer("is in remote control") == "true"
    bench.run(0.3)
    assert bench.dashboard.answer("is in remote control") == "false"
    for command in ("play", "stop", "power on", "brake release", "unlock protective stop"):
        assert bench.dashboard.answer(command) == "Command is not allowed due to safety reasons"
    assert bench.dashboard.answer("robotmode") == "Robotmode: RUNNING"
    with pytest.raises(ScriptError, match="the controller is in local control"):
        bench.box.load(MOVES)
    bench.run(0.5)
    assert bench.dashboard.answer("is in remote control") == "true"
    bench.box.load(MOVES)


def test_a_cb3_controller_knows_no_remote_control():
    bench = Bench([])
    assert bench.dashboard.answer("is in remote control").startswith("could not understand")


def test_registers_are_occupied_as_by_a_fieldbus_and_given_back():
    bench = Bench(
        [
            {
                "fault": "occupy_registers",
                "when": {"time_s": 0.1},
                "range": "upper",
                "release_after_s": 0.5,
            }
        ]
    )
    bench.run(0.2)
    client = object()
    upper, lower = "input_int_register_30", "input_int_register_3"
    assert bench.rtde.claim([upper], client) == ("IN_USE",)
    assert bench.rtde.claim([lower], client) == ("INT32",)
    bench.run(0.5)
    assert bench.rtde.claim([upper], client) == ("INT32",)


def test_slowness_passes_and_a_stall_and_death_are_for_the_loop():
    bench = Bench([{"fault": "slow", "when": {"time_s": 0.0}, "factor": 4}])
    bench.run(0.1)
    assert bench.actions.pace() == 4.0
    passing = Bench([{"fault": "slow", "when": {"time_s": 0.0}, "factor": 4, "wall_s": 1e-9}])
    passing.run(0.1)
    assert passing.actions.pace() == 1.0
    loop = Bench(
        [
            {"fault": "stall", "when": {"time_s": 0}, "wall_s": 2.5},
            {"fault": "die", "when": {"time_s": 0}},
        ]
    )
    loop.run(0.1)
    assert loop.actions.silence_s == 2.5
    assert loop.actions.dying
