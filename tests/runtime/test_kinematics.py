from __future__ import annotations

import math
import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from runtime.kinematics import (
    JOINT_LIMIT,
    MODELS,
    UR5,
    UR16E,
    forward,
    inverse,
    jacobian,
    link_frames,
    matrix_to_pose,
    nearest,
    pose_to_matrix,
)

models = st.sampled_from(sorted(MODELS.values(), key=lambda model: model.name))
free = st.tuples(*[st.floats(-math.pi, math.pi, allow_nan=False) for _ in range(6)])
eighths = st.tuples(*[st.integers(-4, 4).map(lambda n: n * math.pi / 4) for _ in range(6)])
joints = st.one_of(free, eighths)


def apart(one, other):
    return max(abs(math.remainder(a - b, 2 * math.pi)) for a, b in zip(one, other, strict=True))


@given(models, joints)
@settings(max_examples=300, deadline=None, derandomize=True)
def test_every_inverse_solution_reaches_the_pose(model, angles):
    flange = forward(model, angles)
    solutions = inverse(model, flange)
    assert solutions
    for solution in solutions:
        assert all(-math.pi < q <= math.pi for q in solution)
        np.testing.assert_allclose(forward(model, solution), flange, atol=1e-6)


@given(models, joints)
@settings(max_examples=300, deadline=None, derandomize=True)
def test_a_poses_own_joints_are_among_the_solutions(model, angles):
    # A straight wrist leaves q4 and q6 open, so there the pose's own q6 is asked for.
    solutions = inverse(model, forward(model, angles), free_wrist3=angles[5])
    near_singular = abs(math.sin(angles[4])) < 1e-5
    assert near_singular or min(apart(s, angles) for s in solutions) < 1e-5


@given(models, free)
@settings(max_examples=100, deadline=None, derandomize=True)
def test_at_most_eight_distinct_solutions(model, angles):
    solutions = inverse(model, forward(model, angles))
    assert len(set(solutions)) == len(solutions) <= 8


def test_the_usual_tool_down_pose_with_wrist_3_at_zero_keeps_all_eight_branches():
    angles = (0.4, -1.6, 1.3, -1.27, -math.pi / 2, 0.0)
    solutions = inverse(UR5, forward(UR5, angles))
    assert len(solutions) == 8
    assert min(apart(s, angles) for s in solutions) < 1e-9


@pytest.mark.parametrize("straight", [0.0, math.pi])
def test_a_straight_wrist_takes_the_wrist_3_asked_for(straight):
    angles = (0.3, -1.2, 1.5, -0.4, straight, 0.9)
    flange = forward(UR16E, angles)
    chosen = [s for s in inverse(UR16E, flange, free_wrist3=0.9) if apart(s, angles) < 1e-9]
    assert len(chosen) == 1
    for solution in inverse(UR16E, flange):
        np.testing.assert_allclose(forward(UR16E, solution), flange, atol=1e-9)


@pytest.mark.parametrize("place", [(1.5, 0.0, 0.3), (0.0, 0.0, 0.5), (0.05, 0.0, 0.2)])
def test_out_of_reach_has_no_solution(place):
    target = np.diag([1.0, -1.0, -1.0, 1.0])
    target[:3, 3] = place
    assert inverse(UR5, target) == ()


@given(models, free)
@settings(max_examples=60, deadline=None, derandomize=True)
def test_jacobian_agrees_with_finite_differences(model, angles):
    step = 1e-6
    base = forward(model, angles)
    expected = np.empty((6, 6))
    for joint in range(6):
        ahead, behind = list(angles), list(angles)
        ahead[joint] += step
        behind[joint] -= step
        change = (forward(model, ahead) - forward(model, behind)) / (2 * step)
        spin = change[:3, :3] @ base[:3, :3].T
        expected[:3, joint] = change[:3, 3]
        expected[3:, joint] = spin[2, 1], spin[0, 2], spin[1, 0]
    np.testing.assert_allclose(jacobian(model, angles), expected, atol=1e-7)


@given(st.tuples(*[st.floats(-2, 2) for _ in range(3)]), st.tuples(*[st.floats(-4, 4)] * 3))
@settings(max_examples=200, deadline=None, derandomize=True)
def test_rotation_vectors_agree_with_scipy(place, turn):
    matrix = pose_to_matrix((*place, *turn))
    np.testing.assert_allclose(matrix[:3, :3], Rotation.from_rotvec(turn).as_matrix(), atol=1e-12)
    pose = matrix_to_pose(matrix)
    assert math.hypot(*pose[3:]) <= math.pi + 1e-9
    np.testing.assert_allclose(pose_to_matrix(pose), matrix, atol=1e-9)


@pytest.mark.parametrize("axis", [(1, 0, 0), (0, 1, 0), (0, 0, 1), (0.6, 0.8, 0), (0, -0.6, 0.8)])
def test_half_turns_survive(axis):
    pose = (0.1, 0.2, 0.3, *(math.pi * component for component in axis))
    back = matrix_to_pose(pose_to_matrix(pose))
    np.testing.assert_allclose(pose_to_matrix(back), pose_to_matrix(pose), atol=1e-9)


@given(free, st.tuples(*[st.floats(-JOINT_LIMIT, JOINT_LIMIT) for _ in range(6)]))
@settings(max_examples=100, deadline=None, derandomize=True)
def test_nearest_is_no_farther_than_any_turn_of_any_solution(angles, reference):
    solutions = inverse(UR5, forward(UR5, angles))
    best = nearest(solutions, reference)
    assert best is not None
    assert all(abs(q) <= JOINT_LIMIT for q in best)
    assert min(apart(best, s) for s in solutions) < 1e-9
    for solution in solutions:
        assert math.dist(best, reference) <= math.dist(solution, reference) + 1e-6


def test_nearest_turns_joints_and_settles_ties_by_order():
    low, high = (-0.1, 0.0, 0.0, 0.0, 0.0, 0.0), (0.1, 0.0, 0.0, 0.0, 0.0, 0.0)
    assert nearest([high, low], (0.0,) * 6) == low
    assert nearest([low, high], (0.0,) * 6) == low
    turned = nearest([high], (6.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    assert turned is not None
    assert turned[0] == pytest.approx(0.1 + 2 * math.pi) or turned[0] == pytest.approx(0.1)
    assert turned[0] <= JOINT_LIMIT
    assert nearest([], (0.0,) * 6) is None


def test_ur5_at_zero_stretches_along_minus_x():
    place = forward(UR5, (0.0,) * 6)[:3, 3]
    assert place == pytest.approx([-0.81725, -0.19145, -0.005491])
    assert link_frames(UR5, (0.0,) * 6).shape == (7, 4, 4)


def test_it_imports_without_the_heavy_libraries():
    code = (
        "import sys, importlib.util as u; spec = u.spec_from_file_location('k', sys.argv[1]);"
        "m = u.module_from_spec(spec); sys.modules['k'] = m; spec.loader.exec_module(m);"
        "print([n for n in ('scipy', 'mujoco', 'yaml') if n in sys.modules])"
    )
    path = sys.modules[UR5.__class__.__module__].__file__
    done = subprocess.run(
        [sys.executable, "-c", code, path], capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == "[]"
