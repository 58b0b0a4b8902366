"""Each part drawn alone: which pixels it would cover, and how far away it is there.

Parts are made of boxes and upright cylinders. A ray from the lens through a pixel enters such a
solid where it has entered the last of the slabs (or the round wall) that bound it, and leaves it
where it leaves the first (Kay and Kajiya 1986). The components of the rays in a solid's own axes
are sums of a term for the row and one for the column, so that whole blocks of pixels are done at
once.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from aapa import Box, Camera
from runtime.cell.arrangement import PlacedPart
from runtime.kinematics import Matrix
from runtime.parts import Primitive

Floats = NDArray[np.float64]

NEAREST_M: Final = 0.02
"""A part that reaches closer to the lens than this has no outline worth the name."""

_MOST_PIXELS: Final = 40_000  # larger outlines are counted on a coarser grid
_BOX: Final = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) / 2
_RIM: Final = 24  # corners of the polygon around a cylinder's rim
_TINY: Final = 1e-12


def _unit_cylinder() -> Floats:
    """Give the corners of a prism around a cylinder of width and height 1, (n, 3)."""
    angles = np.arange(_RIM) * (2 * math.pi / _RIM)
    radius = 0.5 / math.cos(math.pi / _RIM)
    ring = np.column_stack([radius * np.cos(angles), radius * np.sin(angles)])
    return np.concatenate(
        [np.column_stack([ring, np.full(_RIM, height)]) for height in (-0.5, 0.5)]
    )


_CORNERS: Final = {"box": _BOX, "cylinder": _unit_cylinder()}


@dataclass(frozen=True, slots=True, eq=False)
class Drawing:
    """A part as it would look alone.

    Args:
        box: Around it, px; may lie partly or wholly outside the image.
        pixels: How many it would cover on an unbounded image; 0 if it reaches too close to the lens
            to tell.
        row: First row of the block of pixels it may cover.
        column: First column.
        depth: (rows, columns) of that block, m along the optical axis, inf where it is not.
    """

    box: Box
    pixels: float
    row: int
    column: int
    depth: Floats


def draw(part: PlacedPart, camera: Camera) -> Drawing | None:
    """Draw a part; None if it lies behind the lens."""
    boxes = [_Solid.of(solid, part.pose, camera) for solid in part.model.primitives]
    if all(solid.farthest < NEAREST_M for solid in boxes):
        return None
    whole = all(solid.nearest >= NEAREST_M for solid in boxes)
    frame: Box = (0.0, 0.0, float(camera.width), float(camera.height))
    around = _around([solid.box for solid in boxes]) if whole else frame
    x1, x2 = _clipped(around[0], around[2], camera.width)
    y1, y2 = _clipped(around[1], around[3], camera.height)
    depth = np.full((y2 - y1, x2 - x1), np.inf)
    for solid in boxes:
        u1, u2 = _clipped(solid.box[0], solid.box[2], camera.width)
        v1, v2 = _clipped(solid.box[1], solid.box[3], camera.height)
        if u1 < u2 and v1 < v2:
            block = depth[v1 - y1 : v2 - y1, u1 - x1 : u2 - x1]
            found = solid.depths(_middles(u1, u2), _middles(v1, v2), camera)
            np.minimum(block, found, out=block)
    if not whole:
        return Drawing(frame, 0.0, y1, x1, depth)
    inside = (
        around[0] >= 0
        and around[1] >= 0
        and around[2] <= camera.width
        and around[3] <= camera.height
    )
    count = float(np.isfinite(depth).sum()) if inside else _count(boxes, around, camera)
    return Drawing(around, count, y1, x1, depth)


@dataclass(frozen=True, slots=True, eq=False)
class _Solid:
    """A solid before the camera: `lens` is the optical centre in the solid's own axes."""

    solid: Primitive
    lens: Floats
    turn: Floats  # camera axes to the solid's own
    box: Box
    nearest: float
    farthest: float

    @classmethod
    def of(cls, solid: Primitive, pose: Matrix, camera: Camera) -> _Solid:
        turn = pose[:3, :3].T @ camera.rotation
        lens = pose[:3, :3].T @ (np.asarray(camera.position) - pose[:3, 3]) - solid.offset
        corners = (_CORNERS[solid.shape] * solid.size - lens) @ turn
        nearest, farthest = float(corners[:, 2].min()), float(corners[:, 2].max())
        box: Box = (0.0, 0.0, float(camera.width), float(camera.height))
        if nearest >= NEAREST_M:
            seen = corners[:, :2] * (camera.focal_px / corners[:, 2:])
            (x1, y1), (x2, y2) = seen.min(axis=0).tolist(), seen.max(axis=0).tolist()
            right, down = camera.width / 2, camera.height / 2
            box = (x1 + right, y1 + down, x2 + right, y2 + down)
        return cls(solid, lens, turn, box, nearest, farthest)

    def depths(self, columns: Floats, rows: Floats, camera: Camera) -> Floats:
        """Give the depth at which rays enter, (rows, columns), inf where they pass by.

        Args:
            columns: Of the rays, px.
            rows: Of the rays, px.
            camera: Whose rays they are.
        """
        u = (columns - camera.width / 2) / camera.focal_px
        v = (rows - camera.height / 2) / camera.focal_px
        x, y, z = ((axis[0] * u + axis[2])[None, :] + (axis[1] * v)[:, None] for axis in self.turn)
        enter, leave = _slab(z, self.lens[2], self.solid.size[2] / 2)
        if self.solid.shape == "cylinder":
            walls = [_wall(x, y, self.lens, self.solid.size[0] / 2)]
        else:
            walls = [
                _slab(x, self.lens[0], self.solid.size[0] / 2),
                _slab(y, self.lens[1], self.solid.size[1] / 2),
            ]
        for first, last in walls:
            np.maximum(enter, first, out=enter)
            np.minimum(leave, last, out=leave)
        enter[(enter > leave) | (enter <= 0)] = np.inf
        return enter


def _slab(along: Floats, lens: float, half: float) -> tuple[Floats, Floats]:
    """Give where rays enter and leave the space between two parallel faces."""
    along = np.where(np.abs(along) < _TINY, _TINY, along)
    one, other = (-half - lens) / along, (half - lens) / along
    return np.minimum(one, other), np.maximum(one, other)


def _wall(x: Floats, y: Floats, lens: Floats, radius: float) -> tuple[Floats, Floats]:
    """Give where rays enter and leave an endless upright cylinder."""
    square = x * x + y * y
    np.maximum(square, _TINY, out=square)
    middle = lens[0] * x + lens[1] * y
    root = middle * middle - square * (lens[0] ** 2 + lens[1] ** 2 - radius**2)
    passes = root < 0
    np.maximum(root, 0.0, out=root)
    np.sqrt(root, out=root)
    enter, leave = (-middle - root) / square, (root - middle) / square
    enter[passes] = np.inf
    return enter, leave


def _count(solids: list[_Solid], around: Box, camera: Camera) -> float:
    """Give how many pixels solids cover, those beyond the border of the image too."""
    x1, y1, x2, y2 = around
    stride = max(1, math.ceil(math.sqrt((x2 - x1) * (y2 - y1) / _MOST_PIXELS)))
    columns = _middles(math.floor(x1), math.ceil(x2) + 1, stride)
    rows = _middles(math.floor(y1), math.ceil(y2) + 1, stride)
    covered = np.zeros((len(rows), len(columns)), dtype=np.bool_)
    for solid in solids:
        covered |= np.isfinite(solid.depths(columns, rows, camera))
    return float(covered.sum()) * stride**2


def _middles(first: int, end: int, stride: int = 1) -> Floats:
    """Give the middles of pixels, px."""
    return np.arange(first, end, stride, dtype=np.float64) + 0.5


def _around(boxes: list[Box]) -> Box:
    x1, y1, x2, y2 = zip(*boxes, strict=True)
    return min(x1), min(y1), max(x2), max(y2)


def _clipped(low: float, high: float, end: int) -> tuple[int, int]:
    """Give the pixels between two edges that are in the image: from, and the first one after."""
    first = min(max(0, math.floor(low)), end)
    return first, max(first, min(end, math.ceil(high)))
