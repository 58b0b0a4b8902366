"""Each fault of a schedule, as the real ur-rtde client meets it.

What may crash or block the client happens in a process of the test's own, under a deadline.
"""

from __future__ import annotations

import contextlib
import json
import signal
import subprocess
import sys
import textwrap
import time
from collections.abc import Iterator
from contextlib import contextmanager

import pytest
from dashboard_client import DashboardClient
from rtde_control import RTDEControlInterface
from rtde_receive import RTDEReceiveInterface

from runtime.controller import ControllerProcess
from runtime.errors import ConfigError, ControllerError

pytestmark = pytest.mark.robot

START = (0.0, -1.5, 1.5, -1.5, -1.5, 0.0)
PRELUDE = """
import json, os, sys, time
from rtde_control import RTDEControlInterface
from rtde_receive import RTDEReceiveInterface
address = sys.argv[1]

def until(condition, within_s=10.0):
    deadline = time.monotonic() + within_s
    while not (result := condition()):
        assert time.monotonic() < deadline, "the condition did not come to hold in time"
        time.sleep(0.005)
    return result

def tell(**seen):
    print("SEEN " + json.dumps(seen), flush=True)
    os._exit(0)  # the client's destructors may block when its links are broken
"""


@pytest.fixture(scope="module")
def ur5() -> Iterator[ControllerProcess]:
    with ControllerProcess.start("ur5", clock=8, joints=START) as process:
        yield process


@pytest.fixture
def process(ur5) -> Iterator[ControllerProcess]:
    """A shared controller, as good as new again after each test."""
    yield ur5
    ur5.bench({"faults": [], "fault": {"emergency_stop": False, "kill_script": True}})
    with dialled(ur5) as dashboard:
        deadline = time.monotonic() + 5
        while (state := ur5.bench({"query": "state"}))["safety"] != "NORMAL":
            assert time.monotonic() < deadline
            with contextlib.suppress(RuntimeError):
                dashboard.unlockProtectiveStop()
            time.sleep(0.02)
        dashboard.brakeRelease()
        while (state := ur5.bench({"query": "state"}))["robot_mode"] != "RUNNING":
            assert time.monotonic() < deadline
            time.sleep(0.02)
    assert state["safety"] == "NORMAL"


@contextmanager
def dialled(process) -> Iterator[DashboardClient]:
    dashboard = DashboardClient(process.address)
    dashboard.connect()
    yield dashboard
    dashboard.disconnect()


@contextmanager
def watching(process) -> Iterator[RTDEReceiveInterface]:
    receive = RTDEReceiveInterface(process.address)
    yield receive
    receive.disconnect()


def client(process, program: str) -> tuple[dict, int, str]:
    """Run a client program in a process of its own: what it tells, its status, its last words."""
    done = subprocess.run(
        [sys.executable, "-c", PRELUDE + textwrap.dedent(program), process.address],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    told = [line for line in done.stdout.splitlines() if line.startswith("SEEN ")]
    return json.loads(told[-1][5:]) if told else {}, done.returncode, done.stderr


def journal(process) -> dict:
    return process.bench({"query": "journal"})["journal"]


def of_kind(process, kind) -> list[dict]:
    return [event for event in journal(process)["events"] if event["event"] == kind]


def test_a_protective_stop_at_a_joint_travel_fails_the_move_there(process):
    process.bench(
        {"faults": [{"fault": "protective_stop", "when": {"move": 1, "travel_rad": 0.2}}]}
    )
    seen, _, _ = client(
        process,
        """
        control, receive = RTDEControlInterface(address), RTDEReceiveInterface(address)
        start = receive.getActualQ()
        moved = control.moveJ([start[0] + 1, *start[1:]], 1.0, 5.0)
        until(receive.isProtectiveStopped)
        until(lambda: not any(receive.getActualQd()))
        tell(moved=moved, way=receive.getActualQ()[0] - start[0], safety=receive.getSafetyMode())
        """,
    )
    assert seen["moved"] is False
    assert seen["safety"] == 3
    assert 0.2 <= seen["way"] <= 0.3
    stop = of_kind(process, "protective_stop")[-1]
    assert stop["travel_rad"] == pytest.approx(1 / 30, abs=0.01)
    assert journal(process)["travel_while_stopped_rad"] == 0.0


def test_an_emergency_stop_takes_the_power(process, wait):
    stop = {"fault": "emergency_stop", "when": {"time_s": 0.5}, "release_after_s": 4}
    with watching(process) as receive:
        process.bench({"faults": [stop]})
        wait(receive.isEmergencyStopped)
        assert receive.getRobotMode() == 3
        wait(lambda: not receive.isEmergencyStopped())
        assert receive.getRobotMode() == 3
        with dialled(process) as dashboard:
            dashboard.brakeRelease()
            wait(lambda: receive.getRobotMode() == 7)


def test_a_dropped_link_is_noticed_and_the_journal_tells_what_the_arm_did(process, wait):
    process.bench({"faults": [{"fault": "drop_rtde", "when": {"move": 1, "travel_rad": 0.1}}]})
    before = process.bench({"query": "state"})["joints"][0]
    seen, _, _ = client(
        process,
        """
        control, receive = RTDEControlInterface(address), RTDEReceiveInterface(address)
        control.setWatchdog(10)
        start = receive.getActualQ()
        control.moveJ([start[0] + 1, *start[1:]], 0.1, 5.0, True)
        def gone():
            try:
                control.kickWatchdog()
            except RuntimeError:
                pass  # of the two links this one may be noticed first
            return not receive.isConnected()

        until(gone)
        tell(connected=receive.isConnected())
        """,
    )
    assert seen == {"connected": False}
    lost = of_kind(process, "link_lost")
    assert {"control", "state only"} <= {event["words"] for event in lost}
    # Nobody was left to renew the register: the watchdog, or the client's own reconnecting,
    # ended the move.
    wait(lambda: of_kind(process, "link_lost")[-1]["standstill_s"] is not None)
    assert 0.1 <= process.bench({"query": "state"})["joints"][0] - before < 0.99


def test_a_stall_shows_as_a_state_that_does_not_advance(process):
    with watching(process) as receive:
        process.bench({"faults": [{"fault": "stall", "when": {"time_s": 1.0}, "wall_s": 0.5}]})
        longest = 0.0
        changed, last = time.monotonic(), receive.getTimestamp()
        end = last + 4.0
        while last < end:
            time.sleep(0.005)
            if (now := receive.getTimestamp()) != last:
                longest = max(longest, time.monotonic() - changed)
                changed, last = time.monotonic(), now
        assert longest > 0.4
        assert receive.isConnected()


def test_a_slow_controller_s_clock_goes_slowly(process, wait):
    slow = {"fault": "slow", "when": {"time_s": 0}, "factor": 40, "wall_s": 2}
    with watching(process) as receive:
        process.bench({"faults": [slow]})
        began = of_kind(process, "fault")[-1]["time_s"]
        wait(lambda: receive.getTimestamp() > began)
        robot, wall = receive.getTimestamp(), time.monotonic()
        # Eight cycles at a time, each of 8 ms, every 40 * 8 ms.
        wait(lambda: receive.getTimestamp() > robot + 0.1)
        assert time.monotonic() - wall > 0.3


def test_a_killed_script_ends_the_move_and_the_program(process):
    process.bench({"faults": [{"fault": "kill_script", "when": {"move": 1, "travel_rad": 0.1}}]})
    seen, _, _ = client(
        process,
        """
        control, receive = RTDEControlInterface(address), RTDEReceiveInterface(address)
        start = receive.getActualQ()
        moved = control.moveJ([start[0] + 1, *start[1:]], 0.5, 5.0)
        until(lambda: not control.isProgramRunning())
        again = control.reuploadScript()
        until(control.isProgramRunning)
        tell(moved=moved, again=again)
        """,
    )
    assert seen == {"moved": False, "again": True}
    assert "killed by a fault" in [event["words"] for event in of_kind(process, "program_ended")]


def test_without_remote_control_an_e_series_client_is_turned_away():
    local = {"fault": "refuse_remote", "when": {"time_s": 0}}
    with (
        ControllerProcess.start("ur16e", faults=[local]) as process,
        pytest.raises(RuntimeError, match="Please enable remote control on the robot"),
    ):
        RTDEControlInterface(process.address)


def test_occupied_registers_turn_a_client_away_and_the_upper_range_is_the_way_round():
    occupied = {"fault": "occupy_registers", "when": {"time_s": 0}}
    flags = (
        RTDEControlInterface.FLAG_UPLOAD_SCRIPT | RTDEControlInterface.FLAG_UPPER_RANGE_REGISTERS
    )
    with ControllerProcess.start("ur5", clock=8, faults=[occupied]) as process:
        with pytest.raises(RuntimeError, match="input registers are already in use"):
            RTDEControlInterface(process.address)
        control = RTDEControlInterface(process.address, 125.0, flags)
        assert control.moveJ(START, 1.0, 5.0)
        control.disconnect()


def test_garbage_kills_the_client_s_process_and_not_the_controller(process):
    """A stray byte shifts the client's framing: it ends its own process."""
    seen, status, words = client(
        process,
        """
        from runtime.controller.bench_client import BenchClient
        receive = RTDEReceiveInterface(address)
        garbage = {"fault": "garbage", "when": {"time_s": 0}, "bytes": 1}
        BenchClient(address).request({"faults": [garbage]})
        until(lambda: not receive.isConnected(), 20)
        tell(connected=False)
        """,
    )
    assert seen == {}
    assert status == -signal.SIGABRT, words
    assert "length_error" in words
    with watching(process) as receive:
        assert receive.isConnected()


def test_garbage_on_the_dashboard_is_an_answer_nobody_understands(process):
    garbage = {"fault": "garbage", "when": {"time_s": 2}, "port": "dashboard"}
    with dialled(process) as dashboard:
        process.bench({"faults": [garbage]})

        def understood() -> bool:
            try:
                return "RUNNING" in dashboard.robotmode()
            except (RuntimeError, UnicodeDecodeError):
                return False

        assert understood()
        deadline = time.monotonic() + 5
        while understood():
            assert time.monotonic() < deadline
            time.sleep(0.01)


def test_a_dropped_dashboard_is_an_error_at_the_next_question(process):
    dashboard = DashboardClient(process.address)
    dashboard.connect()
    process.bench({"fault": {"drop_dashboard": True}})
    with pytest.raises(RuntimeError, match="End of file"):
        dashboard.robotmode()
    with dialled(process) as again:
        assert "RUNNING" in again.robotmode()


def test_a_controller_that_dies_is_gone_and_has_written_its_journal(wait, tmp_path):
    path = tmp_path / "journal.jsonl"
    die = {"fault": "die", "when": {"time_s": 2}}
    with (
        ControllerProcess.start("ur5", clock=2, faults=[die], journal=path) as process,
        watching(process) as receive,
    ):
        wait(lambda: not process.alive)
        wait(lambda: not receive.isConnected())
        events = [json.loads(line)["event"] for line in path.read_text().splitlines()]
        assert events[-1] == "summary"
        assert "fault" in events


def test_a_wrong_schedule_is_refused_with_its_entry(process):
    with pytest.raises(ConfigError, match="entry 1: fault: 'dye'"):
        ControllerProcess.start("ur5", faults=[{"fault": "dye"}])
    with pytest.raises(ControllerError, match="entry 1: when: None"):
        process.bench({"faults": [{"fault": "die"}]})
