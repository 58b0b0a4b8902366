"""The box of a body in the image: exact, for a convex hull of balls at any pose.

The box of a hull is the box of its balls, and that of a ball follows from the tangents from the
camera to it, one plane at a time.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from aapa.lacater.generator.bodies import Body, hull_of
from aapa.lacater.generator.viewpoint import FOCAL_LENGTH_PX, PRINCIPAL_POINT_PX, Viewpoint
from aapa.lacater.video import HEIGHT, WIDTH


def rotations(yaw: float, tilts: NDArray[np.float64]) -> NDArray[np.float64]:
    """Give the rotations (p, 3, 3) of a body turned about the vertical, then tilted about y.

    Args:
        yaw: rad.
        tilts: (p,) rad.
    """
    cos_yaw, sin_yaw = np.cos(yaw), np.sin(yaw)
    about_z = np.array([[cos_yaw, -sin_yaw, 0.0], [sin_yaw, cos_yaw, 0.0], [0.0, 0.0, 1.0]])
    about_y = np.zeros((len(tilts), 3, 3))
    about_y[:, 0, 0] = about_y[:, 2, 2] = np.cos(tilts)
    about_y[:, 0, 2] = np.sin(tilts)
    about_y[:, 2, 0] = -np.sin(tilts)
    about_y[:, 1, 1] = 1.0
    return about_z @ about_y


def boxes_of(
    body: Body,
    places: NDArray[np.float64],
    tilts: NDArray[np.float64],
    viewpoint: Viewpoint,
) -> NDArray[np.float64]:
    """Give the boxes (p, 4) of a body at p poses: x1 y1 x2 y2, px, cut off at the image's border.

    Args:
        body: What it is.
        places: (p, 3) where its origin is, in units of the scene.
        tilts: (p,) how far it is tilted about its own y axis, rad.
        viewpoint: The camera.
    """
    hull = hull_of(body.shape)
    turned = hull.centres * body.radius @ rotations(body.yaw, tilts).transpose(0, 2, 1)
    seen = viewpoint.seen_from_here(turned + places[:, None, :])
    radius = hull.radius * body.radius
    depth = seen[..., 2]
    left, right = _tangents(seen[..., 0], depth, radius)
    low, high = _tangents(seen[..., 1], depth, radius)
    (u, v), f = PRINCIPAL_POINT_PX, FOCAL_LENGTH_PX
    box = np.stack(
        [
            u + f * left.min(axis=1),
            v - f * high.max(axis=1),
            u + f * right.max(axis=1),
            v - f * low.min(axis=1),
        ],
        axis=1,
    )
    cut: NDArray[np.float64] = np.clip(box, 0.0, (WIDTH, HEIGHT, WIDTH, HEIGHT))
    return cut


def _tangents(
    across: NDArray[np.float64], depth: NDArray[np.float64], radius: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Give the least and largest slope across/depth at which a ray touches a ball."""
    if radius == 0.0:
        slope = across / depth
        return slope, slope
    middle = across * depth
    spread = radius * np.sqrt(across**2 + depth**2 - radius**2)
    below = depth**2 - radius**2
    return (middle - spread) / below, (middle + spread) / below


def rounded_boxes(boxes: NDArray[np.float64]) -> NDArray[np.int32]:
    """Round boxes (…, 4) as LA-CATER's labels are: the corner, and by itself the width and height.

    That is why x2 may lie a pixel off the rounded x2. Halves go to the even number.
    """
    corner = np.rint(boxes[..., :2])
    size = np.rint(boxes[..., 2:] - boxes[..., :2])
    return np.concatenate([corner, corner + size], axis=-1).astype(np.int32)
