"""The driver with the real, unmodified client against the stand-in controller."""

from __future__ import annotations

import dataclasses
import os
import re
import signal
import threading
import time

import pytest
from rtde_io import RTDEIOInterface

from icarus_lite import Action, Status
from runtime.config import load_robot
from runtime.controller.process import ControllerProcess
from runtime.drivers import UrDriver
from runtime.drivers.limits import joint_distance
from runtime.errors import ControllerError, DriverError

pytestmark = pytest.mark.robot

PICK = Action("pick-up", ("hand1", "hubcover"))
GRASP = (Action("grasp", ("hand1", "hubcover")),)
INSERT = Action("insert", ("hubcover", "case"))
INSERTING = (Action("insert", ("hand1", "hubcover", "case")),)
CYCLE_S = 0.02


@pytest.fixture
def controller(config):
    with ControllerProcess.start("ur5", clock=8.0, joints=config.look_joints) as process:
        yield process


@pytest.fixture
def slow_controller(config):
    with ControllerProcess.start("ur5", clock=1.0, joints=config.look_joints) as process:
        yield process


def connect(controller, config, parts, **options):
    return UrDriver(controller.address, config, parts, **options)


def run(driver, anchors, each=lambda: None, *, within_s=20.0):
    """Poll as the loop does, once a cycle, until the action has ended."""
    deadline = time.monotonic() + within_s
    while time.monotonic() < deadline:
        outcome = driver.poll(anchors())
        if outcome is None or outcome.status is not Status.RUNNING:
            return outcome
        each()
        wait(CYCLE_S)
    pytest.fail(f"the action did not end within {within_s} s")


def wait(seconds):
    """Let a cycle pass."""
    signal.sigtimedwait([], seconds)


def await_that(condition, within_s=5.0):
    deadline = time.monotonic() + within_s
    while not condition():
        assert time.monotonic() < deadline, "the condition never came true"
        wait(0.005)


def await_motion(driver, anchors):
    """Poll until the arm moves at speed."""
    first = driver.state().joints

    def has_left():
        outcome = driver.poll(anchors)
        assert outcome.status is Status.RUNNING, outcome.reason
        return joint_distance(first, driver.state().joints) > 0.02

    await_that(has_left)


def stands_still(controller):
    before = controller.bench({"query": "state"})["joints"]
    wait(0.1)
    return controller.bench({"query": "state"})["joints"] == before


def plate(x, y, height):
    """Give a contact that is flat, a few centimetres around a place."""
    return {
        "origin": [x - 0.03, y - 0.03],
        "step_m": 0.06,
        "heights": [[height, height], [height, height]],
        "stiffness_n_m": 20_000.0,
    }


def test_registers_that_a_dying_program_still_holds_are_waited_for(controller, config, parts):
    before = RTDEIOInterface(controller.address)
    lets_go = threading.Timer(1.0, before.disconnect)
    lets_go.start()
    driver = connect(controller, config, parts)
    lets_go.join()
    try:
        assert driver.state().joints == pytest.approx(config.look_joints, abs=1e-3)
    finally:
        driver.close()


def test_a_hub_cover_is_picked_up_and_inserted(controller, config, parts, scene):
    lines = []
    with connect(controller, config, parts, log=lines.append) as driver:
        hand = "hand1"

        def anchored():
            x, y, z = driver.state().tcp_pose[:3]
            held = driver.state().gripped
            cover = {"hubcover": (x, y, z - parts["hubcover"].grasp_height_m)} if held else {}
            return scene(**{hand: (x, y, z)}, **cover)

        def feel():
            controller.set_tool_input(0, driver.state().gripper_closed)

        driver.start(PICK, GRASP, anchored())
        outcome = run(driver, anchored, feel)
        assert (outcome.action, outcome.status) == (PICK, Status.SUCCEEDED), outcome.reason
        state = driver.state()
        height = parts["hubcover"].size[2] / 2 + parts["hubcover"].grasp_height_m
        assert state.tcp_pose[:3] == pytest.approx((0.42, -0.10, height), abs=1e-4)
        assert (state.gripper_closed, state.gripped) == (True, True)
        assert driver.poll(anchored()) is None

        seat = parts["hubcover"].seats[0].offset
        stands = 0.035 + seat[2] + parts["hubcover"].grasp_height_m
        controller.bench({"contact": plate(0.40 + seat[0], 0.16 + seat[1], stands)})
        driver.start(INSERT, INSERTING, anchored())
        outcome = run(driver, anchored, feel)
        assert outcome.status is Status.SUCCEEDED, outcome.reason
        assert outcome.reason.startswith("pressed with 1")
        state = driver.state()
        assert state.tcp_pose[:2] == pytest.approx((0.40 + seat[0], 0.16 + seat[1]), abs=5e-4)
        assert (state.gripper_closed, state.gripped) == (False, False)

        driver.park()
        assert run(driver, anchored, feel).status is Status.SUCCEEDED
        assert driver.state().joints == pytest.approx(config.look_joints, abs=1e-5)
    assert "connected, PolyScope 3.15" in lines[0]
    assert sum(line.startswith("order") for line in lines) == 2 * 13
    assert controller.bench({"query": "state"})["program_state"] == "STOPPED"


def test_a_grasp_that_feels_nothing_fails_and_the_driver_lives(controller, config, parts, scene):
    short = dataclasses.replace(
        config, gripper=dataclasses.replace(config.gripper, sense_time_s=0.1)
    )
    with connect(controller, short, parts) as driver:
        driver.start(PICK, GRASP, scene())
        outcome = run(driver, scene)
        assert outcome.status is Status.FAILED
        assert "the gripper closed but feels no part" in outcome.reason
        driver.park()
        assert run(driver, scene).status is Status.SUCCEEDED


def test_what_cannot_be_planned_is_never_sent(controller, config, parts, scene):
    with connect(controller, config, parts) as driver:
        far = scene(hubcover=(0.9, 0.0, 0.012))
        driver.start(PICK, GRASP, far)
        outcome = driver.poll(far)
        assert outcome.status is Status.FAILED
        assert "outside its box" in outcome.reason
        assert stands_still(controller)
        assert driver.state().joints == pytest.approx(config.look_joints, abs=1e-6)


def test_a_protective_stop_ends_the_action_and_the_driver(slow_controller, config, parts, scene):
    with connect(slow_controller, config, parts) as driver:
        driver.start(PICK, GRASP, scene())
        await_motion(driver, scene())
        slow_controller.bench({"fault": {"protective_stop": True}})
        outcome = run(driver, scene, within_s=10.0)
        assert outcome.status is Status.FAILED
        assert "protective stop" in outcome.reason
        assert "unlock it on the teach pendant" in outcome.reason
        await_that(lambda: stands_still(slow_controller))
        # Only paused, the program could go on with the move once the stop is unlocked.
        await_that(lambda: slow_controller.bench({"query": "state"})["program_state"] == "STOPPED")
        for call in (driver.state, lambda: driver.poll(scene())):
            with pytest.raises(DriverError, match="protective stop"):
                call()
        with pytest.raises(DriverError, match="protective stop"):
            driver.start(PICK, GRASP, scene())
        driver.stop()


@pytest.mark.parametrize(
    ("fault", "reason"),
    [
        ("kill_script", r"the control program on the controller at .* was stopped"),
        ("drop_rtde", r"the connection to the controller at .* was lost"),
        ("emergency_stop", r"an emergency stop: clear the danger, release the button"),
    ],
)
def test_other_faults_are_told_apart(slow_controller, config, parts, scene, fault, reason):
    with connect(slow_controller, config, parts) as driver:
        driver.start(PICK, GRASP, scene())
        await_motion(driver, scene())
        slow_controller.bench({"fault": {fault: True}})
        outcome = run(driver, scene, within_s=10.0)
        assert outcome.status is Status.FAILED
        assert re.search(reason, outcome.reason), outcome.reason
        await_that(lambda: stands_still(slow_controller))


def test_a_silence_that_the_watchdog_ends_is_told_from_somebody_elses_stop(
    slow_controller, config, parts, scene
):
    with connect(slow_controller, config, parts) as driver:
        driver.start(PICK, GRASP, scene())
        await_motion(driver, scene())
        stall = {"fault": "stall", "when": {"time_s": 0}, "wall_s": 1.4}
        slow_controller.bench({"faults": [stall]})
        outcome = run(driver, scene, within_s=10.0)
        assert outcome.status is Status.FAILED
        # On a machine that is very busy the silence itself is noticed first.
        assert re.search(
            r"watchdog ended the control program|has sent no new state", outcome.reason
        ), outcome.reason
        await_that(lambda: stands_still(slow_controller))


def test_a_controller_killed_mid_move_is_noticed_and_let_go(slow_controller, config, parts, scene):
    driver = connect(slow_controller, config, parts)
    driver.start(PICK, GRASP, scene())
    await_motion(driver, scene())
    os.kill(slow_controller.pid, signal.SIGKILL)
    killed_at = time.monotonic()
    outcome = run(driver, scene, within_s=10.0)
    assert time.monotonic() - killed_at < 10.0
    assert outcome.status is Status.FAILED
    # The client may crash with its controller; either way the reason names the one that is gone.
    assert slow_controller.address in outcome.reason
    with pytest.raises(DriverError, match=r"was lost|no longer answers"):
        driver.state()
    closing_at = time.monotonic()
    driver.close()
    driver.close()
    assert time.monotonic() - closing_at < 10.0


def test_a_silent_controller_is_noticed(slow_controller, config, parts, scene):
    driver = connect(slow_controller, config, parts)
    driver.start(PICK, GRASP, scene())
    await_motion(driver, scene())
    os.kill(slow_controller.pid, signal.SIGSTOP)
    try:
        outcome = run(driver, scene, within_s=6.0)
        assert outcome.status is Status.FAILED
        assert "has sent no new state" in outcome.reason
        driver.close()
    finally:
        os.kill(slow_controller.pid, signal.SIGCONT)


def test_a_hung_connection_is_noticed_and_the_watchdog_stops_the_arm(
    slow_controller, config, parts, scene
):
    driver = connect(slow_controller, config, parts)
    driver.start(PICK, GRASP, scene())
    await_motion(driver, scene())
    os.kill(driver._worker.pid, signal.SIGSTOP)
    outcome = run(driver, scene, within_s=6.0)
    assert outcome.status is Status.FAILED
    assert "the connection to the controller has hung for" in outcome.reason
    await_that(lambda: stands_still(slow_controller))
    driver.close()


def test_a_stop_leaves_the_arm_standing_short_of_its_target(slow_controller, config, parts, scene):
    with connect(slow_controller, config, parts) as driver:
        driver.start(PICK, GRASP, scene())
        await_motion(driver, scene())
        driver.stop()
        driver.stop()
        await_that(lambda: stands_still(slow_controller))
        where = driver.state().joints
        assert driver.poll(scene()) is None
        assert 0.02 < joint_distance(where, config.look_joints) < 0.2
        assert stands_still(slow_controller)
        assert driver.state().joints == where
        # The arm can still be driven: a stop is no fault.
        driver.park()
        assert run(driver, scene).status is Status.SUCCEEDED


def test_an_action_right_after_a_stop_waits_for_the_standstill(
    slow_controller, config, parts, scene
):
    with connect(slow_controller, config, parts) as driver:
        driver.start(PICK, GRASP, scene())
        await_motion(driver, scene())
        driver.stop()
        driver.park()
        outcome = run(driver, scene)
        assert outcome.status is Status.SUCCEEDED, outcome.reason
        assert driver.state().joints == pytest.approx(config.look_joints, abs=1e-4)


def test_the_arm_stops_when_the_driver_process_is_killed(slow_controller, config, parts, scene):
    driver = connect(slow_controller, config, parts)
    driver.start(PICK, GRASP, scene())
    await_motion(driver, scene())
    os.kill(driver._worker.pid, signal.SIGKILL)
    outcome = run(driver, scene, within_s=10.0)
    assert "ended by itself (status -9)" in outcome.reason
    await_that(lambda: stands_still(slow_controller))
    state = slow_controller.bench({"query": "state"})
    assert state["program_state"] == "STOPPED", "the watchdog has ended the program"
    driver.close()


def test_closing_mid_move_stops_the_arm(slow_controller, config, parts, scene):
    driver = connect(slow_controller, config, parts)
    driver.start(PICK, GRASP, scene())
    await_motion(driver, scene())
    closing_at = time.monotonic()
    driver.close()
    assert time.monotonic() - closing_at < 10.0
    await_that(lambda: stands_still(slow_controller))
    with pytest.raises(DriverError, match="closed"):
        driver.state()


def test_a_part_lost_on_the_way_stops_the_arm(controller, config, parts, scene):
    with connect(controller, config, parts) as driver:
        controller.set_tool_input(0, on=True)
        await_that(lambda: driver.state().gripped)
        x, y, z = driver.state().tcp_pose[:3]
        held = scene(hand1=(x, y, z), hubcover=(x, y, z - parts["hubcover"].grasp_height_m))
        driver.start(INSERT, INSERTING, held)
        for _ in range(config.look_cycles):
            assert driver.poll(held).status is Status.RUNNING
        controller.set_tool_input(0, on=False)
        outcome = run(driver, lambda: held)
        assert "no longer feels the part" in outcome.reason
        await_that(lambda: stands_still(controller))


def test_two_arms_are_driven_at_once(config, parts, scene):
    with (
        ControllerProcess.start("ur5", clock=8.0, joints=config.look_joints) as one,
        ControllerProcess.start("ur5", clock=8.0, joints=config.look_joints) as two,
        connect(one, config, parts) as left,
        connect(two, config, parts) as right,
    ):
        one.set_tool_input(0, on=False)
        left.start(PICK, GRASP, scene())
        right.start(PICK, GRASP, scene(hubcover=(0.45, 0.05, 0.012)))
        places = {}
        deadline = time.monotonic() + 20
        while len(places) < 2 and time.monotonic() < deadline:
            for driver, process in ((left, one), (right, two)):
                process.set_tool_input(0, on=driver.state().gripper_closed)
                outcome = driver.poll(scene())
                if outcome is not None and outcome.status is not Status.RUNNING:
                    assert outcome.status is Status.SUCCEEDED, outcome.reason
                    places[process.address] = driver.state().tcp_pose[:2]
            wait(CYCLE_S)
        assert places[one.address] == pytest.approx((0.42, -0.10), abs=1e-4)
        assert places[two.address] == pytest.approx((0.45, 0.05), abs=1e-4)


def test_nobody_at_the_address_is_said_with_what_to_do(config, parts):
    with pytest.raises(ControllerError, match=r"127\.0\.0\.250: no answer .* controller is on"):
        UrDriver("127.0.0.250", config, parts)


def test_a_second_driver_of_one_arm_is_refused_and_the_first_goes_on(
    controller, config, parts, scene
):
    with connect(controller, config, parts) as driver:
        with pytest.raises(ControllerError, match=controller.address):
            connect(controller, config, parts)
        driver.park()
        assert run(driver, scene).status is Status.SUCCEEDED


def test_another_arm_than_configured_is_refused_and_the_right_one_driven(config, parts, scene):
    right = load_robot("ur16e")
    joints = (right.look_joints[0] + 0.1, *right.look_joints[1:])
    with ControllerProcess.start("ur16e", clock=4.0, joints=joints) as controller:
        with pytest.raises(ControllerError, match="configuration"):
            connect(controller, config, parts)
        with connect(controller, right, parts) as driver:
            driver.park()
            assert run(driver, scene).status is Status.SUCCEEDED
            assert driver.state().joints == pytest.approx(right.look_joints, abs=1e-5)
