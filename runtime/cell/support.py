"""What a part comes to rest on when it is lowered: height fields instead of contact dynamics.

The cell is quasi-static. Parts stand upright, and a part that comes down straight stops where the
lower face of one of its solids meets the upper face of another's. Whether two faces lie over one
another is decided exactly, so a field may be asked for at any spacing. Tipping over and bouncing
are left out.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Final

import numpy as np
from numpy.typing import NDArray

from runtime.kinematics import Matrix
from runtime.parts import PartModel, Primitive

Floats = NDArray[np.float64]

_TOUCH_M: Final = 1e-6  # faces that overlap by less than this pass one another
_PRESS_M: Final = 0.006  # a surface this far above an underside still counts as below it


def fall(
    model: PartModel, pose: Matrix, others: Iterable[tuple[str, PartModel, Matrix]]
) -> tuple[float, str | None]:
    """Give how far a part falls, and the name of what stops it (None: the table at z = 0).

    Args:
        model: The falling part.
        pose: (4, 4), its centre in the base frame, upright.
        others: Name, model and upright pose of everything it may land on.
    """
    here, height = pose[:2, 3].reshape(1, 2), float(pose[2, 3])
    rest, stopped_by = model.size[2] / 2, None
    for name, other, other_pose in others:
        most = height + _PRESS_M
        [meets] = resting_heights(model, heading(pose), here, other, other_pose, most)
        if meets > rest:
            rest, stopped_by = float(meets), name
    return height - rest, stopped_by


def resting_heights(
    model: PartModel,
    yaw: float,
    places: Floats,
    other: PartModel,
    other_pose: Matrix,
    most: float = math.inf,
) -> Floats:
    """Give how high a part's centre stands on another part, wherever it is lowered onto it.

    Args:
        model: The part that is lowered.
        yaw: How it is turned about the vertical, rad.
        places: (n, 2) x and y of its centre, m.
        other: What is below.
        other_pose: (4, 4), upright.
        most: Surfaces that would hold it up higher than this do not count, m.

    Returns:
        (n,) heights in m, -inf where it passes the other part by.
    """
    heights = np.full(len(places), -np.inf)
    other_yaw = heading(other_pose)
    own, theirs = _rotation(yaw), _rotation(other_yaw)
    middle, reach = places.mean(axis=0), float(np.abs(np.ptp(places, axis=0)).max())
    for above in model.primitives:
        beside = own @ np.asarray(above.offset[:2])
        for below in other.primitives:
            meets = (
                float(other_pose[2, 3])
                + (below.offset[2] + below.size[2] / 2)
                - (above.offset[2] - above.size[2] / 2)
            )
            if meets > most:
                continue
            centre = other_pose[:2, 3] + theirs @ np.asarray(below.offset[:2])
            if math.dist(middle + beside, centre) > reach + _radius(above) + _radius(below):
                continue
            over = _overlap(above, yaw, below, other_yaw, places + beside - centre)
            np.maximum(heights, np.where(over, meets, -np.inf), out=heights)
    return heights


def heading(pose: Matrix) -> float:
    """Give how far an upright pose is turned about the vertical, rad."""
    return math.atan2(float(pose[1, 0]), float(pose[0, 0]))


def _overlap(
    one: Primitive, one_yaw: float, other: Primitive, other_yaw: float, away: Floats
) -> NDArray[np.bool_]:
    """Tell where two footprints overlap, the first's centre (n, 2) m away from the second's."""
    within: NDArray[np.bool_]
    if one.shape == other.shape == "cylinder":
        least = (one.size[0] + other.size[0]) / 2 - _TOUCH_M
        within = np.einsum("ij,ij->i", away, away) < least**2
    elif one.shape == "cylinder":
        within = _disc_over_box(one.size[0] / 2, other, away @ _rotation(other_yaw))
    elif other.shape == "cylinder":
        within = _disc_over_box(other.size[0] / 2, one, away @ _rotation(one_yaw))
    else:
        within = _boxes(one, one_yaw, other, other_yaw, away)
    return within


def _disc_over_box(radius: float, box: Primitive, away: Floats) -> NDArray[np.bool_]:
    """Tell where a disc lies over a box; `away` is in the box's own axes."""
    outside = np.maximum(np.abs(away) - np.asarray(box.size[:2]) / 2, 0.0)
    within: NDArray[np.bool_] = np.einsum("ij,ij->i", outside, outside) < (radius - _TOUCH_M) ** 2
    return within


def _boxes(
    one: Primitive, one_yaw: float, other: Primitive, other_yaw: float, away: Floats
) -> NDArray[np.bool_]:
    """Tell where two turned rectangles overlap: no axis of either separates them."""
    axes = np.concatenate([_rotation(one_yaw).T, _rotation(other_yaw).T])
    reach = np.zeros(4)
    for solid, yaw in ((one, one_yaw), (other, other_yaw)):
        reach += np.abs(axes @ _rotation(yaw)) @ np.asarray(solid.size[:2]) / 2
    within: NDArray[np.bool_] = (np.abs(away @ axes.T) < reach - _TOUCH_M).all(axis=1)
    return within


def _radius(solid: Primitive) -> float:
    """Give the radius of the circle around a footprint, m."""
    return math.hypot(solid.size[0], solid.size[1]) / 2


def _rotation(yaw: float) -> Floats:
    c, s = math.cos(yaw), math.sin(yaw)
    return np.array([[c, -s], [s, c]])
