from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from runtime.controller.arm import HOME, Arm
from runtime.controller.motions import (
    MAX_JOINT_SPEED,
    JointMove,
    JointServo,
    JointSpeed,
    Motion,
    MotionError,
)
from runtime.controller.tokens import ScriptError
from runtime.controller.tool_motions import LinearMove, ToolSpeed
from runtime.kinematics import UR5, pose_to_matrix

DT = 1 / 125
STILL = (0.0,) * 6


def run(arm: Arm, cycles: int) -> None:
    for _ in range(cycles):
        arm.step(DT)


def drive(arm: Arm, motion: Motion, most: int = 5000) -> list[np.ndarray]:
    """Follow a motion to its end; the joint velocities of each cycle."""
    arm.command(motion, "test")
    speeds = [arm.state.qd]
    for _ in range(most):
        if motion.done:
            arm.release(motion)
            return speeds
        before = arm.state
        arm.step(DT)
        speeds.append(arm.state.qd)
        assert np.all(np.abs(arm.state.q - before.q) <= MAX_JOINT_SPEED * 1.05 * DT + 1e-12)
    raise AssertionError("the motion did not end")


def greatest_change(speeds: list[np.ndarray]) -> float:
    return max(float(np.abs(after - before).max()) for before, after in pairwise(speeds))


_ANGLES = st.tuples(*[st.floats(-3.0, 3.0)] * 6)


@settings(max_examples=25, deadline=None)
@given(_ANGLES, st.floats(0.3, 3.0), st.floats(0.5, 10.0))
def test_movej_arrives_exactly_within_its_limits_and_without_jumps(target, speed, acceleration):
    arm = Arm(UR5, HOME)
    speeds = drive(arm, JointMove(target, acceleration, speed))
    assert arm.joints == target
    assert float(np.abs(speeds[-1]).max()) == 0.0
    assert max(float(np.abs(qd).max()) for qd in speeds) <= speed * (1 + 1e-9)
    # The last cycle may end anywhere in its own time.
    assert greatest_change(speeds) <= 2 * acceleration * DT + 1e-9


def test_movej_from_a_moving_arm_brakes_first_and_still_arrives():
    arm = Arm(UR5, HOME)
    drive(arm, JointSpeed((0.5, 0, 0, 0, 0, 0), 2.0))
    speeds = drive(arm, JointMove(HOME, 2.0, 1.0))
    assert arm.joints == HOME
    assert greatest_change(speeds) <= 2 * 2.0 * DT + 1e-9


def test_movel_stays_on_its_line_and_turns_evenly():
    arm = Arm(UR5, HOME)
    start = np.array(arm.tcp_pose)
    target = tuple((start + np.array([0.1, 0.05, -0.1, 0, 0, 0])).tolist())
    motion = LinearMove(arm.tool, target, 0.5, 0.25)
    arm.command(motion, "test")
    along = np.array([0.1, 0.05, -0.1]) / math.dist((0, 0, 0), (0.1, 0.05, -0.1))
    cycles = 0
    while not motion.done:
        arm.step(DT)
        cycles += 1
        away = np.array(arm.tcp_pose[:3]) - start[:3]
        assert float(np.linalg.norm(away - along * (away @ along))) < 1e-9
        assert float(np.linalg.norm(arm.tcp_speed[:3])) <= 0.25 * 1.001
        turned = pose_to_matrix(arm.tcp_pose)[:3, :3].T @ pose_to_matrix(target)[:3, :3]
        assert np.allclose(turned, np.eye(3), atol=1e-8)
    assert np.allclose(pose_to_matrix(arm.tcp_pose), pose_to_matrix(target), atol=1e-9)
    assert cycles * DT == pytest.approx(0.15 / 0.25 + 0.25 / 0.5, abs=0.02)


def test_movel_out_of_reach_is_refused_before_anything_moves():
    arm = Arm(UR5, HOME)
    arm.command(LinearMove(arm.tool, (2.0, 0, 0, 0, 0, 0), 0.5, 0.25), "test")
    with pytest.raises(MotionError, match="out of reach"):
        arm.step(DT)
    assert arm.joints == HOME


def test_a_line_through_a_singularity_is_a_motion_error_not_a_leap():
    arm = Arm(UR5, (0.0, -1.5708, 1.5708, 0.0, 0.0, 0.0))
    x, y, z, rx, ry, rz = arm.tcp_pose
    arm.command(LinearMove(arm.tool, (x + 0.05, y + 0.05, z, rx, ry, rz), 5.0, 2.0), "test")
    with pytest.raises(MotionError):
        run(arm, 2000)


@settings(max_examples=20, deadline=None)
@given(st.floats(0.5, 10.0), st.floats(0.1, 2.0))
def test_stopj_decelerates_at_its_rate(deceleration, speed):
    arm = Arm(UR5, HOME)
    drive(arm, JointSpeed((speed, -speed / 2, 0, 0, 0, 0), 20.0))
    speeds = drive(arm, JointSpeed(STILL, deceleration))
    assert not arm.state.qd.any()
    assert greatest_change(speeds) <= deceleration * DT + 1e-9
    assert len(speeds) - 1 == pytest.approx(speed / deceleration / DT, abs=1)


def test_speedl_moves_the_tool_at_its_velocity_and_stopl_stops_it_on_the_line():
    arm = Arm(UR5, HOME)
    start = arm.tcp_pose
    drive(arm, ToolSpeed(arm.tool, (0, 0, -0.1, 0, 0, 0), 0.5, 0.5))
    assert arm.tcp_speed == pytest.approx((0, 0, -0.1, 0, 0, 0), abs=2e-4)
    drive(arm, ToolSpeed(arm.tool, STILL, 0.5, 0.5))
    assert not arm.state.qd.any()
    assert arm.tcp_pose[:2] == pytest.approx(start[:2], abs=5e-5)
    assert arm.tcp_pose[2] < start[2] - 0.015


def test_servoj_converges_on_a_target_that_stays():
    arm = Arm(UR5, HOME)
    target = (0.2, *HOME[1:])
    speeds = [arm.state.qd]
    for _ in range(200):
        motion = JointServo(target, 0.05)
        arm.command(motion, "test")
        arm.step(DT)
        speeds.append(arm.state.qd)
    assert arm.joints == pytest.approx(target, abs=1e-6)
    assert greatest_change(speeds) <= 40 * DT + 1e-9


def test_an_uncommanded_moving_arm_brakes():
    arm = Arm(UR5, HOME)
    drive(arm, JointSpeed((1.0, 0, 0, 0, 0, 0), 10.0))
    assert not arm.is_steady
    for _ in range(20):
        arm.step(DT)
    assert not arm.state.qd.any()
    for _ in range(63):
        arm.step(DT)
    assert arm.is_steady


def test_a_held_arm_brakes_and_goes_on_to_its_target_when_let_go():
    arm = Arm(UR5, HOME)
    motion = JointMove((1.0, *HOME[1:]), 2.0, 1.0)
    arm.command(motion, "test")
    for _ in range(60):
        arm.step(DT)
    arm.hold()
    for _ in range(50):
        arm.step(DT)
    assert not arm.state.qd.any()
    assert not motion.done
    arm.unhold()
    while not motion.done:
        arm.step(DT)
    assert arm.joints[0] == 1.0


def test_no_joint_leaves_its_range():
    arm = Arm(UR5, (6.2, *HOME[1:]))
    arm.command(JointSpeed((1.0, 0, 0, 0, 0, 0), 10.0), "test")
    with pytest.raises(MotionError, match="leave its range"):
        run(arm, 100)
    assert abs(arm.joints[0]) <= 2 * math.pi
    arm.hold()
    arm.step(DT)
    assert not arm.state.qd.any()


def test_two_owners_cannot_command_the_arm():
    arm = Arm(UR5, HOME)
    arm.command(JointMove(HOME, 1.0, 1.0), 1)
    with pytest.raises(ScriptError, match="another thread is already controlling the robot"):
        arm.command(JointMove(HOME, 1.0, 1.0), 2)


def test_the_slider_slows_the_arm_without_a_jump():
    fast, slow = Arm(UR5, HOME), Arm(UR5, HOME)
    slow.speed_fraction = 0.5
    for _ in range(100):
        slow.step(DT)
    target = (1.0, *HOME[1:])
    quick = drive(fast, JointMove(target, 2.0, 1.0))
    leisurely = drive(slow, JointMove(target, 2.0, 1.0))
    assert slow.joints == target
    assert len(leisurely) == pytest.approx(2 * len(quick), abs=3)
    assert max(float(np.abs(qd).max()) for qd in leisurely) == pytest.approx(0.5, rel=0.01)


def test_a_tool_moves_the_centre_point_and_the_past_is_remembered():
    arm = Arm(UR5, HOME)
    flange = arm.tcp_pose
    arm.set_tcp((0, 0, 0.1, 0, 0, 0))
    assert math.dist(flange[:3], arm.tcp_pose[:3]) == pytest.approx(0.1)
    drive(arm, JointMove((0.1, *HOME[1:]), 2.0, 1.0))
    assert arm.joints_before(0) == arm.joints
    assert arm.joints_before(10**6) == HOME
