"""The arm's joint axes in closed form: what each control cycle asks for, several times.

The same geometry as `runtime.kinematics`, whose general product of six matrices takes several
times as long. With q1 known the three joints that follow turn about one direction, so that the
angles just add up.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, sin
from typing import TypeAlias

import numpy as np

from runtime.kinematics import ArmModel, Matrix

Vector: TypeAlias = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class JointAxes:
    """Where the joints are and about what they turn, in the base frame.

    Args:
        origins: A point on each axis, m.
        directions: The unit vectors of the axes.
        flange: (4, 4), the flange.
    """

    origins: tuple[Vector, ...]
    directions: tuple[Vector, ...]
    flange: Matrix


def joint_axes(model: ArmModel, joints: Sequence[float]) -> JointAxes:
    """Give the axes at six joint angles, rad."""
    q1, q2, q3, q4, q5, q6 = joints
    c1, s1 = cos(q1), sin(q1)
    c2, s2 = cos(q2), sin(q2)
    c23, s23 = cos(q2 + q3), sin(q2 + q3)
    c234, s234 = cos(q2 + q3 + q4), sin(q2 + q3 + q4)
    c5, s5, c6, s6 = cos(q5), sin(q5), cos(q6), sin(q6)

    across = (s1, -c1, 0.0)  # the shoulder's, the elbow's and wrist 1's direction
    wrist2 = (c1 * s234, s1 * s234, -c234)
    along = (c1 * c234, s1 * c234, s234)  # x of the frame that wrist 1 carries
    wrist3 = _sum(along, -s5, across, c5)

    out2, out3 = model.a2 * c2, model.a2 * c2 + model.a3 * c23
    up2, up3 = model.d1 + model.a2 * s2, model.d1 + model.a2 * s2 + model.a3 * s23
    elbow, wrist1 = (c1 * out2, s1 * out2, up2), (c1 * out3, s1 * out3, up3)
    at4 = _along(wrist1, across, model.d4)
    at5 = _along(at4, wrist2, model.d5)
    x, y, z = _along(at5, wrist3, model.d6)

    turned = _sum(along, c5, across, s5)
    x6, y6 = _sum(turned, c6, wrist2, -s6), _sum(turned, -s6, wrist2, -c6)
    flange = np.array(
        [
            [x6[0], y6[0], wrist3[0], x],
            [x6[1], y6[1], wrist3[1], y],
            [x6[2], y6[2], wrist3[2], z],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )
    return JointAxes(
        ((0.0, 0.0, 0.0), (0.0, 0.0, model.d1), elbow, wrist1, at4, at5),
        ((0.0, 0.0, 1.0), across, across, across, wrist2, wrist3),
        flange,
    )


def jacobian(axes: JointAxes, tip: Vector) -> Matrix:
    """Give the velocity of a point that the flange carries, (6, 6), per joint velocity.

    Args:
        axes: The joints' axes.
        tip: The point, base frame, m. Rows 0-2 are its velocity, rows 3-5 the angular one.
    """
    x, y, z = tip
    columns = []
    for (ax, ay, az), (ox, oy, oz) in zip(axes.directions, axes.origins, strict=True):
        rx, ry, rz = x - ox, y - oy, z - oz
        columns.append((ay * rz - az * ry, az * rx - ax * rz, ax * ry - ay * rx, ax, ay, az))
    per_joint: Matrix = np.array(columns).T
    return per_joint


def _sum(a: Vector, by: float, b: Vector, times: float) -> Vector:
    return a[0] * by + b[0] * times, a[1] * by + b[1] * times, a[2] * by + b[2] * times


def _along(start: Vector, direction: Vector, way: float) -> Vector:
    return (
        start[0] + direction[0] * way,
        start[1] + direction[1] * way,
        start[2] + direction[2] * way,
    )
