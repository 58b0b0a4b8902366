# ruff: noqa: FBT003 - the client takes its flags by position
"""The real ur-rtde client against the stand-in controller, over TCP."""

from __future__ import annotations

import os
import signal
import time

import numpy as np
import pytest

from runtime.kinematics import MODELS, forward, pose_to_matrix

pytestmark = pytest.mark.robot

HOME = (0.0, -1.5, 1.5, -1.5, -1.5, 0.0)
TARGET = (0.4, -1.2, 1.3, -1.7, -1.4, 0.3)


def same_pose(one, other, tolerance=1e-6):
    return np.allclose(pose_to_matrix(one), pose_to_matrix(other), atol=tolerance)


def moved(pose, dx=0.0, dy=0.0, dz=0.0):
    return [pose[0] + dx, pose[1] + dy, pose[2] + dz, *pose[3:]]


def test_movej_reaches_its_target_and_the_tool_is_where_the_geometry_says(rig):
    assert rig.control.moveJ(TARGET, 3.0, 10.0) is True
    assert rig.reached(TARGET)
    flange = forward(MODELS[rig.process.model], TARGET)
    assert np.allclose(pose_to_matrix(rig.receive.getActualTCPPose()), flange, atol=1e-9)


def test_movel_reaches_its_target(rig, wait):
    target = moved(rig.receive.getActualTCPPose(), dx=0.04, dz=-0.06)
    assert rig.control.moveL(target, 0.5, 2.0) is True
    assert wait(lambda: same_pose(rig.receive.getActualTCPPose(), target))


def test_a_pose_is_reached_by_joints_and_joints_by_a_line(rig, wait):
    target = moved(rig.receive.getActualTCPPose(), dy=0.05)
    assert rig.control.moveJ_IK(target, 3.0, 10.0) is True
    assert wait(lambda: same_pose(rig.receive.getActualTCPPose(), target))
    assert rig.control.moveL_FK(HOME, 0.5, 2.0) is True
    assert rig.reached(HOME)


def test_an_asynchronous_move_counts_its_operation_and_stopj_stops_it(rig, wait):
    before = rig.control.getAsyncOperationProgressEx().operationId()
    assert rig.control.moveJ(TARGET, 0.1, 1.0, True)
    wait(lambda: rig.control.getAsyncOperationProgressEx().operationId() != before)
    assert rig.control.getAsyncOperationProgressEx().isAsyncOperationRunning()
    assert rig.control.getAsyncOperationProgress() >= 0
    wait(lambda: rig.receive.getActualQ()[0] > 0.001)
    rig.control.stopJ(5.0)
    wait(lambda: not any(rig.receive.getActualQd()))
    assert rig.control.getAsyncOperationProgress() < 0
    assert 0.001 < rig.receive.getActualQ()[0] < TARGET[0] - 0.01


def test_an_asynchronous_move_ends_by_itself_at_its_target(rig, wait):
    before = rig.control.getAsyncOperationProgressEx().operationId()
    assert rig.control.moveL_FK(TARGET, 1.0, 5.0, True)
    wait(lambda: rig.control.getAsyncOperationProgressEx().operationId() != before)
    wait(lambda: not rig.control.getAsyncOperationProgressEx().isAsyncOperationRunning())
    assert rig.reached(TARGET)


def test_speeds_are_reached_and_stopped(rig, wait):
    assert rig.control.speedL([0, 0, -0.02, 0, 0, 0], 0.5)
    wait(lambda: abs(rig.receive.getActualTCPSpeed()[2] + 0.02) < 1e-4)
    assert rig.control.speedStop()
    wait(lambda: not any(rig.receive.getActualQd()))
    assert rig.control.speedJ([0, 0, 0, 0, 0, 0.2], 2.0)
    wait(lambda: abs(rig.receive.getActualQd()[5] - 0.2) < 1e-6)
    assert rig.control.speedStop()
    wait(lambda: not any(rig.receive.getActualQd()))


def test_servoj_follows(rig, wait):
    target = [*HOME[:5], 0.05]
    for _ in range(20):
        assert rig.control.servoJ(target, 0, 0, 0.008, 0.05, 300)
        time.sleep(0.002)  # a stream of set points, as a servo loop sends it
    wait(lambda: abs(rig.receive.getActualQ()[5] - 0.05) < 1e-4)
    assert rig.control.servoStop()


def floor(rig, below_m, stiffness=30_000):
    """Put a level surface below the tool; give its height."""
    x, y, z = rig.receive.getActualTCPPose()[:3]
    heights = [[z - below_m] * 5] * 5
    surface = {"origin": [x - 0.2, y - 0.2], "step_m": 0.1, "heights": heights}
    rig.process.bench({"contact": {**surface, "stiffness_n_m": stiffness, "thread": None}})
    return z - below_m


def test_force_mode_presses_until_the_force_is_met(rig, wait):
    height = floor(rig, 0.02)
    assert rig.control.zeroFtSensor()
    down = ([0] * 6, [0, 0, 1, 0, 0, 0], [0, 0, -10, 0, 0, 0], 2, [0.1, 0.1, 0.05, 1, 1, 1])
    assert rig.control.forceModeSetDamping(0.02)
    assert rig.control.forceMode(*down)
    wait(lambda: rig.receive.getActualTCPForce()[2] == pytest.approx(10, abs=0.1))
    assert rig.receive.getActualTCPPose()[2] == pytest.approx(height - 10 / 30_000, abs=1e-4)
    # A line goes on in the axes that do not yield.
    line = moved(rig.receive.getActualTCPPose(), dx=0.02)
    assert rig.control.moveL(line, 0.2, 1.0)
    wait(lambda: rig.receive.getActualTCPPose()[0] == pytest.approx(line[0], abs=1e-4))
    assert rig.receive.getActualTCPForce()[2] == pytest.approx(10, abs=0.5)
    assert rig.control.forceModeStop()
    rig.process.bench({"contact": None})
    wait(lambda: rig.receive.getActualTCPForce() == [0] * 6)


def test_a_wired_force_is_felt_and_zeroed(rig, wait):
    rig.process.bench({"wrench": [1, 2, 3, 0, 0, 0.5]})
    wait(lambda: rig.receive.getActualTCPForce() == [1, 2, 3, 0, 0, 0.5])
    assert rig.control.zeroFtSensor()
    wait(lambda: rig.receive.getActualTCPForce() == [0] * 6)
    rig.process.bench({"wrench": [0] * 6})
    assert rig.control.zeroFtSensor()


def test_a_move_until_contact_ends_where_it_began(rig, wait):
    height = floor(rig, 0.02)
    assert rig.control.moveUntilContact([0, 0, -0.05, 0, 0, 0])
    if rig.process.model == "ur5":
        # Before PolyScope 5.4 the client leaves `tool_contact` out of its program.
        assert rig.reached(HOME)
        rig.process.bench({"contact": None})
        return
    wait(lambda: rig.receive.getActualTCPPose()[2] == pytest.approx(height, abs=2e-4))
    assert rig.receive.getActualTCPForce()[2] < 1
    assert rig.control.moveL(moved(rig.receive.getActualTCPPose(), dz=0.02), 0.3, 2.0)
    # With an asynchronous move the client's program stops by itself and goes back.
    assert rig.control.startContactDetection([0, 0, -1, 0, 0, 0])
    assert rig.control.moveL(moved(rig.receive.getActualTCPPose(), dz=-0.05), 0.05, 1.0, True)

    # Not asked meanwhile: a question that is just being answered can swallow the client's stop.
    # It stops first and then goes back, so that one reading without speed may be too early.
    since = None

    def rests_at_the_surface():
        nonlocal since
        near = rig.receive.getActualTCPPose()[2] == pytest.approx(height, abs=2e-4)
        now = rig.receive.getTimestamp()
        if not near or any(rig.receive.getActualQd()):
            since = None
        elif since is None:
            since = now
        return since is not None and now - since > 0.5

    wait(rests_at_the_surface, 15)
    assert rig.control.readContactDetection()
    assert rig.control.stopContactDetection()
    assert rig.control.isProgramRunning()
    rig.process.bench({"contact": None})


def test_tool_and_payload_are_set(rig, wait):
    assert rig.control.setTcp([0, 0, 0.12, 0, 0, 0])
    assert rig.control.getTCPOffset() == [0, 0, 0.12, 0, 0, 0]
    assert rig.control.setPayload(1.5, [0, 0, 0.06])
    wait(lambda: rig.receive.getPayload() == 1.5)
    assert rig.receive.getPayloadCog() == [0, 0, 0.06]
    assert rig.control.setTcp([0] * 6)


def test_the_inverse_is_the_branch_the_arm_is_in(rig):
    pose = rig.receive.getActualTCPPose()
    assert rig.control.getInverseKinematics(pose) == pytest.approx(HOME, abs=1e-9)
    assert rig.control.getInverseKinematicsHasSolution(pose)
    assert not rig.control.getInverseKinematicsHasSolution([2, 0, 0, 0, 0, 0])
    assert rig.control.isPoseWithinSafetyLimits(pose)
    assert not rig.control.isPoseWithinSafetyLimits([2, 0, 0, 0, 0, 0])
    assert rig.control.isJointsWithinSafetyLimits(HOME)


def test_steady_is_half_a_second_of_rest(rig, wait):
    wait(rig.control.isSteady)


def test_a_custom_function_runs_and_the_control_program_comes_back(rig, wait):
    text = f"x = 1\nwhile x < 3:\n x = x + 1\nend\nmovej({list(TARGET)}, a=10, v=x)\n"
    assert rig.control.sendCustomScriptFunction("visit", text)
    assert rig.reached(TARGET)
    wait(rig.control.isProgramRunning)
    assert rig.control.moveJ(HOME, 3.0, 10.0)


def test_a_watchdog_that_is_kicked_lets_a_move_pass(rig, wait):
    assert rig.control.setWatchdog(5)
    before = rig.control.getAsyncOperationProgressEx().operationId()
    assert rig.control.moveJ(TARGET, 0.5, 2.0, True)
    wait(lambda: rig.control.getAsyncOperationProgressEx().operationId() != before)

    def arrived():
        assert rig.control.kickWatchdog()
        return not rig.control.getAsyncOperationProgressEx().isAsyncOperationRunning()

    wait(arrived)
    assert rig.reached(TARGET)
    assert rig.control.setWatchdog(0)


def test_outputs_and_inputs_are_seen_in_the_stream(rig, wait):
    io = rig.io()
    assert io.setToolDigitalOut(0, True)
    assert io.setStandardDigitalOut(3, True)
    assert io.setConfigurableDigitalOut(1, True)
    wait(lambda: rig.receive.getActualDigitalOutputBits() == 1 << 16 | 1 << 9 | 1 << 3)
    assert rig.state()["outputs"]["tool_digital_out_0"] is True
    assert io.setToolDigitalOut(0, False)
    wait(lambda: rig.receive.getActualDigitalOutputBits() == 1 << 9 | 1 << 3)
    rig.process.set_tool_input(0, True)
    rig.process.bench({"inputs": {"standard_digital_in_5": True}})
    wait(lambda: rig.receive.getActualDigitalInputBits() == 1 << 16 | 1 << 5)
    rig.process.set_tool_input(0, False)
    wait(lambda: rig.receive.getActualDigitalInputBits() == 1 << 5)
    assert io.setStandardDigitalOut(3, False)
    assert io.setConfigurableDigitalOut(1, False)
    rig.process.bench({"inputs": {"standard_digital_in_5": False}})
    wait(lambda: not rig.receive.getActualDigitalInputBits())
    io.disconnect()


def test_modes_are_those_of_a_ready_arm(rig):
    assert rig.receive.getRobotMode() == 7
    assert rig.receive.getSafetyMode() == 1
    assert rig.receive.getSafetyStatusBits() == 1
    assert rig.receive.getRuntimeState() == 2
    assert rig.receive.getRobotStatus() == 0b11


def test_a_second_control_client_is_turned_away(rig):
    with pytest.raises(RuntimeError, match="already in use"):
        type(rig.control)(rig.process.address)


def test_a_protective_stop_and_the_way_back(breakable_rig, wait):
    rig = breakable_rig
    dashboard = rig.dashboard()
    assert rig.control.moveJ(TARGET, 0.2, 1.0, True)
    wait(lambda: rig.receive.getActualQ()[0] > 0.01)
    rig.process.bench({"fault": {"protective_stop": True}})
    assert rig.control.moveJ(TARGET, 3.0, 10.0) is False
    wait(rig.receive.isProtectiveStopped)
    wait(lambda: not any(rig.receive.getActualQd()))
    assert rig.receive.getSafetyMode() == 3
    assert dashboard.safetystatus() == "Safetystatus: PROTECTIVE_STOP"
    with pytest.raises(RuntimeError, match="Cannot unlock protective stop until 5s"):
        dashboard.unlockProtectiveStop()

    def unlocked():
        try:
            dashboard.unlockProtectiveStop()
        except RuntimeError:
            return False
        return True

    wait(unlocked)
    assert rig.control.moveJ(TARGET, 3.0, 10.0) is False
    rig.recover()
    assert rig.control.moveJ(TARGET, 3.0, 10.0) is True
    assert rig.reached(TARGET)
    dashboard.disconnect()


def test_an_emergency_stop_needs_power_and_brakes(breakable_rig, wait):
    rig = breakable_rig
    dashboard = rig.dashboard()
    rig.process.bench({"fault": {"emergency_stop": True}})
    wait(rig.receive.isEmergencyStopped)
    wait(lambda: rig.receive.getRobotMode() == 3)
    assert rig.control.moveJ(TARGET, 3.0, 10.0) is False
    rig.process.bench({"fault": {"emergency_stop": False}})
    dashboard.powerOn()
    wait(lambda: dashboard.robotmode() == "Robotmode: IDLE")
    dashboard.brakeRelease()
    wait(lambda: rig.receive.getRobotMode() == 7)
    assert rig.control.reuploadScript()
    wait(rig.control.isProgramRunning)
    assert rig.control.moveJ(TARGET, 3.0, 10.0) is True
    dashboard.disconnect()


def test_a_line_out_of_reach_is_refused_with_a_protective_stop(breakable_rig, wait):
    assert breakable_rig.control.moveL([2, 0, 0, 0, 0, 0], 0.5, 1.0) is False
    wait(breakable_rig.receive.isProtectiveStopped)
    assert breakable_rig.state()["safety_reason"] == "the target of the line is out of reach"
    assert breakable_rig.reached(HOME)


def test_a_line_that_presses_too_hard_is_a_protective_stop(breakable_rig, wait):
    rig = breakable_rig
    height = floor(rig, 0.03)
    assert rig.control.moveL(moved(rig.receive.getActualTCPPose(), dz=-0.1), 0.1, 1.0) is False
    wait(rig.receive.isProtectiveStopped)
    state = rig.state()
    assert "more than 150 N" in state["safety_reason"]
    assert state["wrench"][2] > 150
    assert rig.receive.getActualTCPPose()[2] > height - 0.02
    # Unlocked, the arm may back out, though it still presses.
    rig.recover()
    assert rig.control.moveL(moved(rig.receive.getActualTCPPose(), dz=0.05), 0.1, 1.0)
    rig.process.bench({"contact": None})
    assert rig.process.bench({"query": "journal"})["journal"]["force_n"] > 150


def test_an_inverse_out_of_reach_ends_the_program(breakable_rig, wait):
    assert breakable_rig.control.getInverseKinematics([2, 0, 0, 0, 0, 0]) == []
    wait(lambda: not breakable_rig.control.isProgramRunning())
    assert "out of reach" in breakable_rig.state()["last_failure"]


def test_what_is_not_supported_is_said_and_stops_the_program(breakable_rig, wait):
    assert breakable_rig.control.teachMode() is False
    wait(lambda: not breakable_rig.control.isProgramRunning())
    assert "teach_mode() is not supported by this stand-in" in breakable_rig.state()["last_failure"]


def test_a_killed_program_makes_moves_fail(breakable_rig, wait):
    breakable_rig.process.bench({"fault": {"kill_script": True}})
    wait(lambda: not breakable_rig.control.isProgramRunning())
    assert breakable_rig.control.moveJ(TARGET, 3.0, 10.0) is False
    assert breakable_rig.reached(HOME)


def test_a_watchdog_nobody_kicks_stops_the_arm(breakable_rig, wait):
    assert breakable_rig.control.setWatchdog(10)
    assert breakable_rig.control.speedL([0, 0, -0.005, 0, 0, 0], 0.5)
    wait(lambda: not breakable_rig.control.isProgramRunning())
    wait(lambda: not any(breakable_rig.receive.getActualQd()))


def test_a_dropped_stream_is_noticed_and_comes_back(watcher, wait):
    watcher.process.bench({"fault": {"drop_rtde": True}})
    wait(lambda: not watcher.receive.isConnected())
    stale = watcher.receive.getTimestamp()
    assert watcher.receive.reconnect()
    wait(lambda: watcher.receive.getTimestamp() > stale)


def test_silence_stops_the_clock_and_passes(watcher, wait):
    watcher.process.bench({"fault": {"silence": 0.4}})
    started = time.monotonic()
    before = watcher.receive.getTimestamp()
    watcher.process.bench({"query": "state"})
    assert time.monotonic() - started > 0.3
    wait(lambda: watcher.receive.getTimestamp() > before)
    assert watcher.receive.isConnected()


@pytest.mark.parametrize("end", ["die", "kill"])
def test_a_controller_that_is_gone_is_noticed_in_the_stream(watcher, wait, end):
    if end == "die":
        watcher.process.bench({"fault": {"die": True}})
    else:
        os.kill(watcher.process.pid, signal.SIGKILL)
    wait(lambda: not watcher.process.alive)
    wait(lambda: not watcher.receive.isConnected())
