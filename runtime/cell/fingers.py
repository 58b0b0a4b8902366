"""How the fingers close: whether a part is between them, and how far they push it.

The tool's x axis lies in the plane between the fingers, which close along its y axis.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final

import numpy as np

from runtime.cell.arrangement import PlacedPart
from runtime.cell.support import Floats
from runtime.kinematics import Matrix
from runtime.parts import GRIPPER_OPENING_M

UPRIGHT: Final = math.cos(math.radians(20))
"""How closely a tool and a part must be in line to be gripped."""

_STEP_M: Final = 0.0005  # from one place to the next that is looked at on the way of a pushed part
_RISE_M: Final = 0.0005  # what rises this far above the underside of a pushed part is a wall


def between_fingers(
    part: PlacedPart, tcp: Matrix, across_m: float, height_m: float
) -> float | None:
    """Give how far a part is off the fingers' plane, m, None if they would miss it.

    Args:
        part: The part.
        tcp: (4, 4), the tool centre point.
        across_m: Its axis may be this far off that plane.
        height_m: The tool centre point may be this far off its grasp height.
    """
    across, along, below = np.linalg.solve(tcp, part.pose)[:3, 3].tolist()
    fits = (
        part.model.grippable
        and float(tcp[:3, 2] @ part.pose[:3, 2]) <= -UPRIGHT
        and abs(across) <= across_m
        and abs(along) <= (GRIPPER_OPENING_M - part.model.grip_width_m) / 2
        and abs(below - part.model.grasp_height_m) <= height_m
    )
    return float(across) if fits else None


def pushed_aside(
    pose: Matrix, tcp: Matrix, aside_m: float, heights_at: Callable[[Floats], Floats]
) -> float:
    """Give how far beside the fingers' middle a part is once they are closed, m.

    They push it over what it lies on, but through no wall: a part in its seat stays there, and the
    fingers yield.

    Args:
        pose: (4, 4), where the part stood.
        tcp: (4, 4), the tool centre point.
        aside_m: How far beside the middle it was, along the tool's y axis.
        heights_at: Gives how high its centre would stand at places, (n, 2) to (n,), m.
    """
    steps = max(1, math.ceil(abs(aside_m) / _STEP_M))
    shares = np.arange(1, steps + 1) / steps
    places = pose[:2, 3] - np.outer(shares * aside_m, tcp[:2, 1])
    free = heights_at(places) <= pose[2, 3] + _RISE_M
    pushed = 1.0 if free.all() else float(np.argmin(free)) / steps
    return aside_m * (1.0 - pushed)
