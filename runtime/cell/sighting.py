"""What there is to be measured of each part in a view, before any error: computed once a view."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from aapa import Box, Position
from runtime.cell.camera import Segmentation
from runtime.parts import PartModel

_TOP_M: Final = 0.003  # depth points this close under the highest one belong to the top face


@dataclass(frozen=True, slots=True)
class Sighting:
    """A part as it shows.

    Args:
        model: Its type.
        pixels: How many see it.
        share: The share of its whole outline that shows, in [0, 1].
        angle_rad: Between the line of sight and the vertical.
        box: Around the pixels that see it; of no meaning if none does.
        depth_m: In the middle of these, along the optical axis.
        centre: Where its centre is, by its top face and its height from the drawing, m.
    """

    model: PartModel
    pixels: int
    share: float
    angle_rad: float
    box: Box = (0.0, 0.0, 0.0, 0.0)
    depth_m: float = 0.0
    centre: Position = (0.0, 0.0, 0.0)


def sightings(view: Segmentation) -> tuple[Sighting, ...]:
    """Give each part of a view as it shows, in the view's order."""
    return tuple(sighting(view, index) for index in range(len(view.parts)))


def sighting(view: Segmentation, index: int) -> Sighting:
    """Give one part of a view as it shows."""
    part, whole = view.parts[index], view.silhouettes[index]
    rows, columns = view.pixels(index)
    sight = np.asarray(view.camera.position) - part.pose[:3, 3]
    angle = math.acos(min(1.0, max(-1.0, float(sight[2]) / float(np.linalg.norm(sight)))))
    if whole is None or whole.pixels == 0 or not len(rows):
        return Sighting(part.model, len(rows), 0.0, angle)
    depth = view.depth[rows, columns]
    low_x, high_x, low_y, high_y = columns.min(), columns.max(), rows.min(), rows.max()
    return Sighting(
        part.model,
        len(rows),
        min(1.0, len(rows) / whole.pixels),
        angle,
        (float(low_x), float(low_y), float(high_x + 1), float(high_y + 1)),
        float(np.median(depth)),
        _centre(view, part.model, (rows, columns, depth)),
    )


def _centre(
    view: Segmentation,
    model: PartModel,
    pixels: tuple[NDArray[np.intp], NDArray[np.intp], NDArray[np.float64]],
) -> Position:
    """Place a part by the middle of its visible top face and its height from the drawing."""
    rows, columns, depth = pixels
    camera = view.camera
    rays = np.column_stack(
        [
            (columns + 0.5 - camera.width / 2) / camera.focal_px,
            (rows + 0.5 - camera.height / 2) / camera.focal_px,
            np.ones(len(rows)),
        ]
    )
    points = (rays * depth[:, None]) @ camera.rotation.T + np.asarray(camera.position)
    highest = float(points[:, 2].max())
    top = points[points[:, 2] >= highest - _TOP_M, :2]
    x, y = ((top.min(axis=0) + top.max(axis=0)) / 2).tolist()
    return x, y, highest - model.size[2] / 2
