from __future__ import annotations

import itertools
import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from runtime.drivers.limits import (
    MotionError,
    arm_solutions,
    check_joint_move,
    check_joints,
    linear_path,
    tcp_matrix,
    travel_time,
    travelled,
)


@given(
    distance=st.floats(0.0, 3.0),
    speed=st.floats(0.01, 1.0),
    acceleration=st.floats(0.05, 2.0),
)
def test_a_trapezoidal_move_keeps_speed_and_acceleration_and_arrives(distance, speed, acceleration):
    total = travel_time(distance, speed, acceleration)
    assert travelled(distance, speed, acceleration, total) == distance
    dt = max(total, 1e-3) / 200
    places = [travelled(distance, speed, acceleration, dt * index) for index in range(202)]
    speeds = [(after - before) / dt for before, after in itertools.pairwise(places)]
    assert min(speeds) >= -1e-9
    assert max(speeds) <= speed * (1 + 1e-6) + 1e-9
    gains = [abs(after - before) / dt for before, after in itertools.pairwise(speeds)]
    assert max(gains) <= acceleration * (1 + 1e-6) + 1e-6


@pytest.mark.parametrize(
    ("joint", "angle", "message"),
    [
        (0, 6.2, r"joint 1 would turn to 6\.200 rad \(at most 6\.1\)"),
        (5, math.nan, "joint 6 would turn to nan rad"),
        (1, -0.3, "over the table"),
        (0, 0.0, "outside its box"),
    ],
)
def test_joints_outside_the_limits_are_refused(config, joint, angle, message):
    joints = list(config.look_joints)
    joints[joint] = angle
    with pytest.raises(MotionError, match=message):
        check_joints(config, tuple(joints))


def test_a_joint_move_through_the_outside_is_refused_though_its_ends_are_inside(config):
    end = (config.look_joints[0] - 2 * math.pi, *config.look_joints[1:])
    check_joints(config, end)
    with pytest.raises(MotionError, match="outside its box"):
        check_joint_move(config, config.look_joints, end, hangs_m=0.0)


def test_what_hangs_from_the_hand_must_clear_the_table(config):
    check_joint_move(config, config.look_joints, config.look_joints, hangs_m=0.41)
    with pytest.raises(MotionError, match="sag"):
        check_joint_move(config, config.look_joints, config.look_joints, hangs_m=0.43)


def test_a_straight_move_through_the_base_is_refused_though_its_ends_are_inside(config):
    origin = tcp_matrix(config, config.look_joints)
    origin[:3, 3] = 0.18, 0.25, 0.3
    start = arm_solutions(config, origin, config.look_joints)[0]
    check_joints(config, start)
    target = origin.copy()
    target[1, 3] = -0.25
    with pytest.raises(MotionError, match="of the arm's base"):
        linear_path(config, start, origin, target)


def test_a_straight_move_across_the_singularity_behind_the_wrist_is_refused(config):
    origin = tcp_matrix(config, config.look_joints)
    wrong_branch = tuple(-angle for angle in config.look_joints)
    with pytest.raises(MotionError, match="too near a singularity"):
        linear_path(config, wrong_branch, origin, origin)


@settings(deadline=None, derandomize=True, max_examples=30)
@given(dz=st.floats(-0.3, 0.1), dx=st.floats(-0.05, 0.25))
def test_a_straight_path_is_straight_and_does_not_jump(config, dx, dz):
    origin = tcp_matrix(config, config.look_joints)
    target = origin.copy()
    target[0, 3] += dx
    target[2, 3] += dz
    path = linear_path(config, config.look_joints, origin, target)
    for index, joints in enumerate(path):
        share = index / (len(path) - 1)
        expected = origin[:3, 3] + share * (target[:3, 3] - origin[:3, 3])
        tool = tcp_matrix(config, joints)
        assert tool[:3, 3] == pytest.approx(expected, abs=1e-6)
        assert tool[:3, :3] == pytest.approx(origin[:3, :3], abs=1e-6)
    steps = itertools.pairwise(path)
    assert max(math.dist(before, after) for before, after in steps) < 0.15
