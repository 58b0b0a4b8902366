from __future__ import annotations

import pytest

from runtime.controller.arm import HOME
from runtime.controller.control_box import ControlBox
from runtime.controller.dashboard import DashboardServer
from runtime.controller.safety import RuntimeState, SafetyMode
from runtime.controller.tokens import ScriptError
from runtime.kinematics import UR5

MOVE = "def go():\nmovej([1, -1.5, 1.5, -1.5, -1.5, 0], a=2, v=1)\nend\n"


class Bench:
    """A control box whose wall clock the test turns."""

    def __init__(self) -> None:
        self.wall_s = 0.0
        self.box = ControlBox(UR5, lambda: self.wall_s, HOME)
        self.dashboard = DashboardServer(self.box)

    def run(self, seconds: float) -> None:
        for _ in range(round(seconds / self.box.cycle_s)):
            self.wall_s += self.box.cycle_s
            self.box.cycle()


@pytest.fixture
def bench():
    return Bench()


def test_a_program_runs_to_its_end(bench):
    bench.box.load(MOVE)
    assert bench.box.runtime_state is RuntimeState.PLAYING
    bench.run(3.0)
    assert bench.box.runtime_state is RuntimeState.STOPPED
    assert bench.box.arm.joints == (1, -1.5, 1.5, -1.5, -1.5, 0)


def test_a_stopped_program_lets_the_arm_brake(bench):
    bench.box.load(MOVE)
    bench.run(0.5)
    assert bench.dashboard.answer("stop") == "Stopped"
    bench.run(0.5)
    assert not bench.box.arm.state.qd.any()
    assert bench.box.arm.joints[0] < 0.5


def test_a_protective_stop_pauses_is_locked_for_five_seconds_and_play_goes_on(bench):
    bench.box.load(MOVE)
    bench.run(0.5)
    assert bench.box.protective_stop("a test")
    bench.run(1.0)
    assert bench.box.runtime_state is RuntimeState.PAUSED
    assert bench.box.safety.status_bits == 1 << 2 | 1 << 10
    assert bench.dashboard.answer("safetystatus") == "Safetystatus: PROTECTIVE_STOP"
    assert not bench.box.arm.state.qd.any()
    stopped_at = bench.box.arm.joints
    assert bench.dashboard.answer("play") == "Failed to execute: play"
    assert bench.dashboard.answer("unlock protective stop").startswith("Cannot unlock")
    bench.run(4.1)
    assert bench.dashboard.answer("unlock protective stop") == "Protective stop releasing"
    bench.run(0.5)
    assert bench.box.arm.joints == stopped_at
    assert bench.dashboard.answer("play") == "Starting program"
    bench.run(3.0)
    assert bench.box.arm.joints[0] == 1


def test_an_emergency_stop_ends_the_program_and_needs_power_and_brakes(bench):
    bench.box.load(MOVE)
    bench.run(0.5)
    bench.box.emergency_stop()
    bench.run(0.5)
    assert bench.box.runtime_state is RuntimeState.STOPPED
    assert bench.box.safety.status_bits == 1 << 6 | 1 << 7 | 1 << 10
    assert bench.dashboard.answer("robotmode") == "Robotmode: POWER_OFF"
    assert bench.dashboard.answer("power on") == "Failed: the emergency stop is pressed"
    with pytest.raises(ScriptError, match="a program was refused: robot mode POWER_OFF"):
        bench.box.load(MOVE)
    bench.box.release_emergency_stop()
    assert bench.dashboard.answer("power on") == "Powering on"
    assert bench.dashboard.answer("robotmode") == "Robotmode: POWER_ON"
    bench.run(1.1)
    assert bench.dashboard.answer("robotmode") == "Robotmode: IDLE"
    with pytest.raises(ScriptError, match="robot mode IDLE"):
        bench.box.load(MOVE)
    assert bench.dashboard.answer("brake release") == "Brake releasing"
    bench.run(0.9)
    with pytest.raises(ScriptError, match="robot mode IDLE"):
        bench.box.load(MOVE)
    bench.run(0.2)
    assert bench.dashboard.answer("robotmode") == "Robotmode: RUNNING"
    bench.box.load(MOVE)
    bench.run(3.0)
    assert bench.box.arm.joints[0] == 1


def test_a_motion_that_cannot_go_on_is_a_protective_stop(bench):
    bench.box.load("movel(p[2, 0, 0, 0, 0, 0])\n")
    bench.run(0.1)
    assert bench.box.safety.mode is SafetyMode.PROTECTIVE_STOP
    assert bench.box.safety.reason == "the target of the line is out of reach"


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("get_inverse_kin(p[2, 0, 0, 0, 0, 0])", "is out of reach"),
        ("teach_mode()", "teach_mode() is not supported by this stand-in controller"),
        ("movej([1, 2])", "the joint list must have six numbers, not a list of 2"),
        ("movej([0, 0, 0, 0, 0, 0], a=-1)", "the acceleration is -1, but must be greater than 0"),
        ("set_payload(9)", "a payload of 9 kg is outside 0 to 5 kg"),
        ("set_tool_digital_out(5, True)", "there is no tool digital terminal 5"),
        ("write_output_integer_register(99, 1)", "there is no register 99"),
        ("movej([0, 0, 0, 0, 0, 0], speed=1)", "movej() cannot be called as movej(…, speed=…)"),
        ("movej([1e200, 0, 0, 0, 0, 0])", "the joint list is 1e+200, which is beyond any arm"),
        ("speedl([1, 2, 3])", "the tool speed must have six numbers"),
        (
            "force_mode(p[0,0,0,0,0,0],[0,0,0,0,0,0],[0,0,0,0,0,0],4,[0,0,0,0,0,0])",
            "types 1, 2 and 3",
        ),
    ],
)
def test_what_cannot_be_done_stops_the_program_with_a_sentence(bench, text, reason):
    bench.box.load(f"{text}\n")
    bench.run(0.1)
    assert bench.box.runtime_state is RuntimeState.STOPPED
    assert bench.box.last_failure is not None
    assert reason in bench.box.last_failure


def test_a_program_reads_and_writes_terminals_registers_and_geometry(bench):
    bench.box.signals.set_input("tool", 0, on=True)
    bench.box.signals.input_doubles[3] = 2.5
    bench.box.load(
        """def work():
        set_tcp(p[0, 0, 0.1, 0, 0, 0])
        set_payload(1.5, [0, 0, 0.05])
        set_standard_digital_out(2, get_tool_digital_in(0))
        write_output_float_register(0, read_input_float_register(3) * 2)
        here = get_actual_tcp_pose()
        there = pose_trans(here, p[0, 0, 0.05, 0, 0, 0])
        write_output_float_register(1, norm(pose_sub(there, here)))
        q = get_inverse_kin(here)
        write_output_float_register(2, q[1])
        write_output_integer_register(1, is_within_safety_limits(p[3, 0, 0, 0, 0, 0]))
        end
        """
    )
    bench.run(0.1)
    assert bench.box.last_failure is None
    assert bench.box.signals.output_is_on("standard", 2)
    assert bench.box.signals.output_doubles[:3] == pytest.approx([5.0, 0.05, HOME[1]])
    assert bench.box.signals.output_ints[1] == 0
    assert bench.box.arm.payload_kg == 1.5


def test_the_watchdog_stops_a_program_nobody_talks_to(bench):
    bench.box.load(
        """def watched():
        rtde_set_watchdog("input_int_register_0", 10, "stop")
        while True:
            sync()
        end
        end
        """
    )
    for _ in range(20):
        bench.run(0.05)
        bench.box.input_renewed(("input_int_register_0",))
    assert bench.box.runtime_state is RuntimeState.PLAYING
    bench.run(0.05)
    bench.box.input_renewed(("input_int_register_1",))
    bench.run(0.08)
    assert bench.box.runtime_state is RuntimeState.STOPPED


def test_two_threads_cannot_both_drive(bench):
    bench.box.load(
        """def both():
        thread other():
            movej([1, 0, 0, 0, 0, 0])
        end
        t = run other()
        sync()
        movej([0, 1, 0, 0, 0, 0])
        end
        """
    )
    bench.run(0.1)
    assert bench.box.last_failure is not None
    assert "another thread is already controlling the robot" in bench.box.last_failure


def test_the_same_program_is_not_translated_twice_and_others_do_not_pile_up(bench):
    bench.box.load(MOVE)
    for number in range(10):
        bench.box.load(f"sleep({number + 1})\n")
    assert len(bench.box._translations) == 4
    bench.box.load(MOVE)
    second = bench.box._translations[MOVE]
    bench.box.load(MOVE)
    assert bench.box._translations[MOVE] is second


def test_the_dashboard_answers_in_the_words_clients_wait_for(bench):
    answer = bench.dashboard.answer
    assert answer("running") == "Program running: false"
    assert answer("programState") == "STOPPED null"
    assert answer("PolyscopeVersion") == "URSoftware 3.15.8.0 (stand-in controller)"
    assert answer("get robot model") == "UR5"
    assert answer("load x.urp") == "File not found: x.urp (a stand-in controller has no files)"
    assert answer("pause") == "Failed to execute: pause"
    assert answer("popup hello") == "showing popup"
    assert answer("dance") == "could not understand: 'dance'"
    bench.box.load(MOVE)
    assert answer("programState") == "PLAYING go"
    assert answer("pause") == "Pausing program"
    assert answer("programState") == "PAUSED go"
    assert "not a robot, not URSim" in answer("shutdown")


def test_force_mode_is_asked_for_every_cycle_and_may_change(bench):
    bench.box.load(
        "def press():\n"
        "  wrench = [0, 0, -5, 0, 0, 0]\n"
        "  while True:\n"
        "    force_mode(p[0,0,0,0,0,0], [0,0,1,0,0,0], wrench, 2, [1,1,0.1,1,1,1])\n"
        "    sync()\n"
        "    if get_actual_tcp_pose()[2] < 0.4:\n"
        "      wrench[2] = 5\n"
        "    end\n"
        "  end\n"
        "end\n"
    )
    bench.run(0.1)
    mode = bench.box.arm.force_mode
    assert mode is not None
    bench.run(0.1)
    assert bench.box.arm.force_mode is mode
    bench.run(2.0)
    assert bench.box.arm.force_mode.wrench[2] == 5
    bench.box.stop_program("a test")
    assert bench.box.arm.force_mode is None


def test_damping_holds_from_the_beginning_of_force_mode_to_its_end(bench):
    mode = "force_mode(p[0,0,0,0,0,0], [0,0,1,0,0,0], [0,0,{},0,0,0], 2, [1,1,0.1,1,1,1])\nsync()\n"
    bench.box.load(
        "force_mode_set_damping(0.5)\n"
        + mode.format(1)
        + "force_mode_set_damping(0.1)\n"
        + mode.format(2)
        + "sleep(1)\n"
        + "end_force_mode()\n"
        + mode.format(2)
        + "sleep(1)\n"
    )
    bench.run(0.5)
    assert (bench.box.arm.force_mode.wrench[2], bench.box.arm.force_mode.damping) == (2, 0.5)
    bench.run(1.0)
    assert bench.box.arm.force_mode.damping == 0.1
