"""The limits of motion: the one place that decides whether the arm may go somewhere.

Both kinds of motion are sampled along the way the controller will take, and every sample is held
against the joint limits, the tool's box, the table, the base and the arm's reach. A motion that
this module does not pass is never sent to any arm.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from runtime.config import MAX_JOINT_SPEED, RobotConfig
from runtime.errors import RuntimeFault
from runtime.kinematics import (
    Joints,
    Matrix,
    inverse,
    link_frames,
    matrix_to_pose,
    nearest,
    pose_to_matrix,
)

_JOINT_STEP = 0.05  # rad between samples of a joint move
_LINEAR_STEP = 0.01  # m between samples of a straight move
_TURN_STEP = 0.05  # rad between samples of a straight move that turns the tool
_ROUNDING = 1e-6  # m and rad by which a pose computed to lie on a limit may miss it
_ELBOW = 3  # of the frames of `link_frames`, the first that can come near the table


class MotionError(RuntimeFault, ValueError):
    """A command cannot be carried out; the text says why. Nothing has moved."""


def tcp_matrix(config: RobotConfig, joints: Joints) -> Matrix:
    """Give the tool centre point in the base frame, (4, 4)."""
    tcp: Matrix = link_frames(config.arm, joints)[6] @ pose_to_matrix(config.tcp)
    return tcp


def arm_solutions(config: RobotConfig, tcp: Matrix, reference: Joints) -> tuple[Joints, ...]:
    """Give the ways to bring the tool to a pose within the joint limits, least travel first."""
    flange = tcp @ np.linalg.inv(pose_to_matrix(config.tcp))
    solutions = [
        solution
        for branch in inverse(config.arm, flange, free_wrist3=reference[5])
        if (solution := nearest((branch,), reference)) is not None
        and max(map(abs, solution)) <= config.workspace.joint_limit_rad
    ]
    return tuple(sorted(solutions, key=lambda joints: (math.dist(joints, reference), joints)))


def check_place(config: RobotConfig, place: Sequence[float], *, slack: float = _ROUNDING) -> None:
    """Refuse a place of the tool centre point that is outside the workspace.

    Args:
        config: The robot.
        place: x, y, z in the base frame, m.
        slack: By how much a limit may be missed, m.

    Raises:
        MotionError: Names the coordinate and its range.
    """
    x, y, z = place
    box = config.workspace
    for axis, value, (low, high) in (("x", x, box.x), ("y", y, box.y), ("z", z, box.z)):
        if not low - slack <= value <= high + slack:
            raise MotionError(
                f"the tool would be at {axis} = {value:.3f} m, outside its box "
                f"({low:g} to {high:g} m)"
            )
    if math.hypot(x, y) < box.base_clearance_m - slack:
        raise MotionError(
            f"the tool would come within {math.hypot(x, y):.3f} m of the arm's base "
            f"(at least {box.base_clearance_m:g} m)"
        )
    if z - box.table_z_m < box.table_clearance_m - slack:
        raise MotionError(
            f"the tool would come to {z - box.table_z_m:.3f} m over the table "
            f"(at least {box.table_clearance_m:g} m)"
        )


def check_joints(config: RobotConfig, joints: Joints, *, slack: float = _ROUNDING) -> Matrix:
    """Refuse joint angles at which any part of the arm is where it may not be.

    Args:
        config: The robot.
        joints: The angles, rad.
        slack: By how much a limit may be missed, m or rad.

    Returns:
        The tool centre point in the base frame, (4, 4).

    Raises:
        MotionError: Names the joint, link or coordinate and its limit.
    """
    box = config.workspace
    for number, angle in enumerate(joints, start=1):
        if not abs(angle) <= box.joint_limit_rad + slack:  # also refuses NaN
            raise MotionError(
                f"joint {number} would turn to {angle:.3f} rad (at most {box.joint_limit_rad:g})"
            )
    frames = link_frames(config.arm, joints)
    lowest = float(frames[_ELBOW - 1 :, 2, 3].min()) - box.table_z_m
    if lowest < box.link_clearance_m - slack:
        raise MotionError(
            f"a joint of the arm would come to {lowest:.3f} m over the table "
            f"(at least {box.link_clearance_m:g} m)"
        )
    tcp: Matrix = frames[6] @ pose_to_matrix(config.tcp)
    check_place(config, tcp[:3, 3].tolist(), slack=slack)
    return tcp


def check_joint_move(config: RobotConfig, start: Joints, end: Joints, *, hangs_m: float) -> None:
    """Refuse a joint move that leaves the limits or sags too low anywhere on its way.

    Args:
        config: The robot.
        start: Where it begins, rad.
        end: Where it ends, rad.
        hangs_m: How far a held part reaches below the tool centre point, m.

    Raises:
        MotionError: Says what would go wrong.
    """
    box = config.workspace
    count = max(1, math.ceil(joint_distance(start, end) / _JOINT_STEP))
    ends = [float(tcp_matrix(config, joints)[2, 3]) for joints in (start, end)]
    floor = max(
        min(ends) - config.heights.transit_sag_m,
        box.table_z_m + box.table_clearance_m + hangs_m,
    )
    for index in range(count + 1):
        height = float(check_joints(config, blend(start, end, index / count))[2, 3])
        if height < floor - _ROUNDING:
            raise MotionError(
                f"on its way the tool would sag to z = {height:.3f} m (at least {floor:.3f} m)"
            )


def linear_path(
    config: RobotConfig, start: Joints, origin: Matrix, target: Matrix
) -> tuple[Joints, ...]:
    """Give the joint angles along a straight move, evenly spaced, its limits checked.

    Args:
        config: The robot.
        start: Joint angles at the beginning, rad.
        origin: (4, 4), the tool centre point at the beginning.
        target: (4, 4), the tool centre point at the end.

    Returns:
        The joint angles at the samples, the start first, on one branch of the inverse.

    Raises:
        MotionError: A sample is out of reach or outside the limits, or so near a singularity
            that a joint would have to turn faster than allowed.
    """
    path = [start]
    samples = list(_straight(origin, target))
    length = float(np.linalg.norm(target[:3, 3] - origin[:3, 3])) / max(1, len(samples) - 1)
    fastest = MAX_JOINT_SPEED * max(length / config.speeds.tool, _TURN_STEP)
    for tcp in samples[1:]:
        x, y, z = tcp[:3, 3].tolist()
        check_place(config, (x, y, z))
        solutions = arm_solutions(config, tcp, path[-1])
        if not solutions:
            raise MotionError(f"({x:.3f}, {y:.3f}, {z:.3f}) m is out of the arm's reach")
        if joint_distance(path[-1], solutions[0]) > fastest + config.watch.start_tolerance_rad:
            raise MotionError(
                f"at ({x:.3f}, {y:.3f}, {z:.3f}) m a straight move passes too near a singularity"
            )
        check_joints(config, solutions[0])
        path.append(solutions[0])
    return tuple(path)


def blend(start: Joints, end: Joints, share: float) -> Joints:
    """Give the joint angles a share (0 to 1) of the way from start to end."""
    a, b, c, d, e, f = (p + (q - p) * share for p, q in zip(start, end, strict=True))
    return a, b, c, d, e, f


def travel_time(distance: float, speed: float, acceleration: float) -> float:
    """Give the seconds a move from rest to rest takes, trapezoidal in speed."""
    if distance < speed * speed / acceleration:
        return 2 * math.sqrt(distance / acceleration)
    return distance / speed + speed / acceleration


def travelled(distance: float, speed: float, acceleration: float, time_s: float) -> float:
    """Give the distance covered `time_s` after the start of such a move."""
    total = travel_time(distance, speed, acceleration)
    if time_s >= total:
        return distance
    if time_s > total / 2:
        return distance - travelled(distance, speed, acceleration, total - time_s)
    ramp = min(time_s, speed / acceleration)
    return acceleration * ramp * ramp / 2 + speed * (time_s - ramp)


def joint_distance(start: Joints, end: Joints) -> float:
    """Give the travel of the leading joint, rad."""
    return max(abs(p - q) for p, q in zip(start, end, strict=True))


def _straight(origin: Matrix, target: Matrix) -> Iterator[Matrix]:
    """Interpolate place and orientation at one rate, as the controller's straight moves do."""
    relative = matrix_to_pose(np.linalg.inv(origin) @ target)[3:]
    shift = target[:3, 3] - origin[:3, 3]
    count = max(
        1,
        math.ceil(float(np.linalg.norm(shift)) / _LINEAR_STEP),
        math.ceil(math.hypot(*relative) / _TURN_STEP),
    )
    for index in range(count + 1):
        share = index / count
        turn = pose_to_matrix((0.0, 0.0, 0.0, *(share * angle for angle in relative)))
        sample = origin @ turn
        sample[:3, 3] = origin[:3, 3] + share * shift
        yield sample
