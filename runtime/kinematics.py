"""The arms' geometry: joint angles to flange pose and back, in closed form.

All UR arms share one layout: a turning base, a two-link arm in a vertical plane, and a wrist of
three joints of which the first (q4) turns in that same plane. Once q1 is known, everything but
q5 and q6 happens in the plane, so the inverse is a handful of arc tangents and yields every
branch: shoulder left or right, wrist up or down, elbow up or down.

Nominal Denavit-Hartenberg rows (alpha = 90, 0, 0, 90, -90, 0 degrees), lengths in metres. A real
arm has a factory calibration of its own: use its controller's answer where tenths of a millimetre
count. This module needs numpy only and is cheap to import.

Sources: Universal Robots, "DH parameters for calculations of kinematics and dynamics"; the inverse
follows Hawkins, "Analytic inverse kinematics for the Universal Robots UR-5/UR-10 arms" (2013),
with q5 from an arc tangent instead of an arc cosine, which keeps its digits near q5 = 0.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

Joints: TypeAlias = tuple[float, float, float, float, float, float]
"""Joint angles from base to wrist 3, rad. The same type as `runtime.drivers.driver.Joints`."""

Pose: TypeAlias = tuple[float, float, float, float, float, float]
"""x, y, z in m and a rotation vector in rad. The same type as `runtime.drivers.driver.Pose`."""

Matrix: TypeAlias = NDArray[np.float64]
"""A rigid motion, (4, 4), or a stack of them."""

JOINT_LIMIT: Final = 2 * math.pi
"""Every joint of these arms turns from -360 to +360 degrees."""

_SINGULAR: Final = 1e-9  # below this sine the wrist axes q4 and q6 count as parallel
_ROUNDING: Final = 1e-9  # a cosine may leave [-1, 1] by this much through rounding
_SAME: Final = 1e-9  # two branches closer than this, rad, are one


@dataclass(frozen=True, slots=True)
class ArmModel:
    """One arm: its lengths, and what its maker's data sheet promises.

    Args:
        name: As on the command line, such as "ur5".
        d1: Height of the shoulder, m.
        a2: Upper arm, m, negative by the convention.
        a3: Forearm, m, negative by the convention.
        d4: Offset of wrist 1 from the arm's plane, m.
        d5: Length of wrist 2, m.
        d6: From wrist 3 to the flange, m.
        payload_kg: Greatest load at the flange.
        reach_m: Greatest distance of wrist 3 from the base axis.
        frequency_hz: Rate of the controller's state stream.
    """

    name: str
    d1: float
    a2: float
    a3: float
    d4: float
    d5: float
    d6: float
    payload_kg: float
    reach_m: float
    frequency_hz: float


UR5: Final = ArmModel("ur5", 0.089159, -0.425, -0.39225, 0.10915, 0.09465, 0.0823, 5.0, 0.85, 125.0)
"""UR5 of the CB3 series."""

UR16E: Final = ArmModel(
    "ur16e", 0.1807, -0.4784, -0.36, 0.17415, 0.11985, 0.11655, 16.0, 0.90, 500.0
)
"""UR16e of the e-Series."""

MODELS: Final[Mapping[str, ArmModel]] = MappingProxyType({m.name: m for m in (UR5, UR16E)})
"""The arms known, by name."""


def link_frames(model: ArmModel, joints: Sequence[float]) -> Matrix:
    """Give the frames of the base and after each joint, (7, 4, 4), in the base frame.

    Args:
        model: The arm.
        joints: Six angles, rad.
    """
    rows = (
        (model.d1, 0.0, 0, 1),
        (0.0, model.a2, 1, 0),
        (0.0, model.a3, 1, 0),
        (model.d4, 0.0, 0, 1),
        (model.d5, 0.0, 0, -1),
        (model.d6, 0.0, 1, 0),
    )
    frames = np.empty((7, 4, 4))
    frames[0] = np.eye(4)
    for index, (q, (d, a, cos_alpha, sin_alpha)) in enumerate(zip(joints, rows, strict=True)):
        c, s = math.cos(q), math.sin(q)
        frames[index + 1] = frames[index] @ np.array(
            [
                [c, -s * cos_alpha, s * sin_alpha, a * c],
                [s, c * cos_alpha, -c * sin_alpha, a * s],
                [0.0, sin_alpha, cos_alpha, d],
                [0.0, 0.0, 0.0, 1.0],
            ]
        )
    return frames


def forward(model: ArmModel, joints: Sequence[float]) -> Matrix:
    """Give the flange in the base frame, (4, 4), at six joint angles, rad."""
    flange: Matrix = link_frames(model, joints)[6]
    return flange


def jacobian(model: ArmModel, joints: Sequence[float]) -> Matrix:
    """Give the flange's velocity per joint velocity, (6, 6), in the base frame.

    Rows 0-2 are linear (m/rad), rows 3-5 angular (rad/rad).
    """
    frames = link_frames(model, joints)
    axes = frames[:6, :3, 2]
    arms = frames[6, :3, 3] - frames[:6, :3, 3]
    return np.vstack([np.cross(axes, arms).T, axes.T])


def inverse(model: ArmModel, matrix: Matrix, *, free_wrist3: float = 0.0) -> tuple[Joints, ...]:
    """Give every way to bring the flange to a pose, angles in (-pi, pi].

    Args:
        model: The arm.
        matrix: (4, 4), the flange in the base frame.
        free_wrist3: Where wrist 2 is straight (q5 = 0 or pi) only q4 + q6 or q4 - q6 is
            determined; q6 then takes this value, rad, if the pose can be reached with it.

    Returns:
        At most eight branches, each exact, in a fixed order; empty if the pose is out of reach.
    """
    # Wrist 3 stands d6 behind the flange, and d4 beside the plane the arm moves in.
    wrist_x, wrist_y = (matrix[:2, 3] - model.d6 * matrix[:2, 2]).tolist()
    sine = _cosine(model.d4, math.hypot(wrist_x, wrist_y))
    if sine is None:
        return ()
    bearing, offset = math.atan2(wrist_y, wrist_x), math.asin(sine)
    return tuple(
        solution
        for q1 in _distinct((bearing + offset, bearing + math.pi - offset))
        for solution in _within_the_plane(model, matrix, q1, free_wrist3)
    )


def nearest(solutions: Iterable[Joints], reference: Sequence[float]) -> Joints | None:
    """Give the solution with the least joint travel from a reference, or None if there is none.

    Each angle may be turned by whole turns within +-2 pi to come closer. Distance is Euclidean
    in joint space; of equally distant ones the smallest in tuple order wins.
    """
    unwrapped = [
        tuple(_closest_turn(q, at) for q, at in zip(solution, reference, strict=True))
        for solution in solutions
    ]
    if not unwrapped:
        return None
    q1, q2, q3, q4, q5, q6 = min(
        unwrapped, key=lambda joints: (round(math.dist(joints, reference), 9), joints)
    )
    return q1, q2, q3, q4, q5, q6


def pose_to_matrix(pose: Sequence[float]) -> Matrix:
    """Turn x, y, z (m) and a rotation vector (rad) into a (4, 4) rigid motion."""
    rotation = np.asarray(pose[3:6], dtype=np.float64)
    angle = float(np.linalg.norm(rotation))
    # The limits of sin(t)/t and (1-cos(t))/t^2 keep tiny rotations exact.
    first = math.sin(angle) / angle if angle > 1e-8 else 1.0
    second = (1 - math.cos(angle)) / angle**2 if angle > 1e-8 else 0.5
    x, y, z = rotation.tolist()
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    matrix = np.eye(4)
    matrix[:3, :3] += first * cross + second * (cross @ cross)
    matrix[:3, 3] = pose[:3]
    return matrix


def matrix_to_pose(matrix: Matrix) -> Pose:
    """Turn a (4, 4) rigid motion into x, y, z (m) and a rotation vector (rad, length <= pi)."""
    r = matrix[:3, :3].tolist()
    w, x, y, z = _quaternion(r)
    sine = math.sqrt(x * x + y * y + z * z)
    scale = 2 * math.atan2(sine, w) / sine if sine > 1e-12 else 2.0
    px, py, pz = matrix[:3, 3].tolist()
    return px, py, pz, scale * x, scale * y, scale * z


def _within_the_plane(
    model: ArmModel, matrix: Matrix, q1: float, free_wrist3: float
) -> list[Joints]:
    """Give the solutions for one q1: the wrist first, then the two links up to it."""
    c1, s1 = math.cos(q1), math.sin(q1)
    # Rows: along the plane, up in it, across it; columns: the flange's axes and wrist 3.
    frame = np.array([[c1, s1, 0.0], [0.0, 0.0, 1.0], [s1, -c1, 0.0]])
    (x_along, y_along, z_along), (x_up, y_up, z_up), (x_across, y_across, z_across) = (
        frame @ matrix[:3, :3]
    ).tolist()
    along, up, _ = (frame @ matrix[:3, 3]).tolist()
    along, up = along - model.d6 * z_along, up - model.d6 * z_up - model.d1

    def arm(q5: float, q6: float) -> list[Joints]:
        c6, s6 = math.cos(q6), math.sin(q6)
        # The axis of wrist 2 lies in the plane.
        axis_along, axis_up = -(s6 * x_along + c6 * y_along), -(s6 * x_up + c6 * y_up)
        q234 = math.atan2(axis_along, -axis_up)
        links = _two_links(
            model.a2, model.a3, along - model.d5 * axis_along, up - model.d5 * axis_up
        )
        return [
            (_wrap(q1), _wrap(q2), _wrap(q3), _wrap(q234 - q2 - q3), _wrap(q5), _wrap(q6))
            for q2, q3 in links
        ]

    sine5 = math.hypot(x_across, y_across)
    if sine5 >= _SINGULAR:
        return [
            *arm(math.atan2(sine5, z_across), math.atan2(-y_across, x_across)),
            *arm(math.atan2(-sine5, z_across), math.atan2(y_across, -x_across)),
        ]
    q5 = math.atan2(0.0, z_across)
    # Where the q6 asked for leaves the arm too short, wrist 2 points from the shoulder to wrist 3
    # instead, or back.
    straight = math.atan2(-(along * x_along + up * x_up), -(along * y_along + up * y_up))
    return arm(q5, free_wrist3) or arm(q5, straight) or arm(q5, straight + math.pi)


def _two_links(a2: float, a3: float, along: float, up: float) -> list[tuple[float, float]]:
    """Give q2, q3 that bring the end of two links to a point of their plane."""
    cosine = _cosine(along**2 + up**2 - a2**2 - a3**2, 2 * a2 * a3)
    if cosine is None:
        return []
    bend = math.acos(cosine)
    return [
        (math.atan2(up, along) - math.atan2(a3 * math.sin(q3), a2 + a3 * math.cos(q3)), q3)
        for q3 in _distinct((bend, -bend))
    ]


def _cosine(adjacent: float, hypotenuse: float) -> float | None:
    if abs(adjacent) > abs(hypotenuse) * (1 + _ROUNDING):
        return None
    return max(-1.0, min(1.0, adjacent / hypotenuse))


def _distinct(pair: tuple[float, float]) -> tuple[float, ...]:
    return pair if abs(_wrap(pair[0] - pair[1])) > _SAME else pair[:1]


def _wrap(angle: float) -> float:
    """Give the angle in (-pi, pi]."""
    wrapped = math.remainder(angle, 2 * math.pi)
    return math.pi if wrapped == -math.pi else wrapped


def _closest_turn(angle: float, reference: float) -> float:
    turns = (angle - 2 * math.pi, angle, angle + 2 * math.pi)
    within = [turn for turn in turns if abs(turn) <= JOINT_LIMIT]
    return min(within, key=lambda turn: abs(turn - reference))


def _quaternion(r: list[list[float]]) -> tuple[float, float, float, float]:
    """Give w >= 0, x, y, z of a rotation, from its greatest component (Shepperd 1978)."""
    trace = r[0][0] + r[1][1] + r[2][2]
    squares = (trace, r[0][0], r[1][1], r[2][2])
    largest = squares.index(max(squares))
    if largest == 0:
        w = math.sqrt(max(0.0, 1 + trace)) / 2
        x, y, z = ((r[k][j] - r[j][k]) / (4 * w) for j, k in ((1, 2), (2, 0), (0, 1)))
        return w, x, y, z
    i = largest - 1
    j, k = (i + 1) % 3, (i + 2) % 3
    root = math.sqrt(max(0.0, 1 + 2 * r[i][i] - trace)) / 2
    axis = [0.0, 0.0, 0.0]
    axis[i] = root
    axis[j] = (r[j][i] + r[i][j]) / (4 * root)
    axis[k] = (r[k][i] + r[i][k]) / (4 * root)
    w = (r[k][j] - r[j][k]) / (4 * root)
    sign = 1.0 if w >= 0 else -1.0
    return sign * w, sign * axis[0], sign * axis[1], sign * axis[2]
