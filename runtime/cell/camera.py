"""The eye in the hand: a pinhole camera on the flange, and what each of its pixels sees.

Its pose is known the way a real one is: from the measured joints and the hand-eye calibration.
Neither OpenGL nor a display is needed, and whatever is in front, the gripper, the part it holds and
a person's arm included, really hides what is behind.

Parts are drawn one by one (`runtime.cell.raster`). What else could hide them is asked of MuJoCo, by
rays through those pixels only where it could: the gripper moves with the camera, so its image is
kept for each width of its opening; arm and person are asked about inside the boxes around them.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Final

import numpy as np
from numpy.typing import NDArray

from aapa import Camera
from runtime.cell.arrangement import PlacedPart
from runtime.cell.raster import Drawing, draw
from runtime.cell.scene import Scene
from runtime.kinematics import ArmModel, Matrix, forward

HAND_EYE: Final[tuple[tuple[float, ...], ...]] = (
    (0.0, -1.0, 0.0, 0.07),
    (1.0, 0.0, 0.0, 0.0),
    (0.0, 0.0, 1.0, 0.03),
    (0.0, 0.0, 0.0, 1.0),
)
"""Flange to camera: looking along the tool, 70 mm beside its axis, the tool at the lower edge.

Columns: the camera's right, down and forward axes and its optical centre, in the flange frame.
"""

_FARTHEST_M: Final = 10.0  # what is farther away is nowhere
_SAME_M: Final = 1e-6  # a person's hand does not hide itself
_LENS_M: Final = 0.002  # the glass; nothing is between it and the optical centre
_EDGES: Final = np.array([(a, a ^ bit) for a in range(8) for bit in (1, 2, 4) if a < a ^ bit])


@dataclass(frozen=True, slots=True)
class CameraParameters:
    """A camera's optics; the defaults are a RealSense D435's colour stream, scaled down.

    Args:
        width: Image width, px.
        height: Image height, px.
        field_of_view_rad: Horizontal.
        near_m: Least distance along the optical axis at which depth is measured.
        mount: Flange to camera, (4, 4) as nested tuples.
    """

    width: int = 320
    height: int = 240
    field_of_view_rad: float = math.radians(69)
    near_m: float = 0.17
    mount: tuple[tuple[float, ...], ...] = field(default=HAND_EYE)

    @property
    def mount_matrix(self) -> Matrix:
        """Flange to camera, (4, 4)."""
        return np.array(self.mount, dtype=np.float64)

    @property
    def vertical_view_rad(self) -> float:
        """The vertical field of view."""
        return 2 * math.atan(self.height / self.width * math.tan(self.field_of_view_rad / 2))


@dataclass(frozen=True, slots=True, eq=False)
class Segmentation:
    """What each pixel sees.

    Args:
        camera: With the pose the image was taken from.
        ids: (height, width), index of the part seen, -1 for anything else.
        depth: (height, width), m along the optical axis, 0 where there is no part.
        parts: The parts, by index.
        silhouettes: Each drawn alone, by index; None where a part is not before the camera.
    """

    camera: Camera
    ids: NDArray[np.int32]
    depth: NDArray[np.float64]
    parts: tuple[PlacedPart, ...]
    silhouettes: tuple[Drawing | None, ...]

    def pixels(self, index: int) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """Give the rows and columns of the pixels that see a part."""
        whole = self.silhouettes[index]
        if whole is None:
            empty = np.empty(0, dtype=np.intp)
            return empty, empty
        rows, columns = whole.depth.shape
        block = self.ids[whole.row : whole.row + rows, whole.column : whole.column + columns]
        down, right = np.nonzero(block == index)
        return down + whole.row, right + whole.column

    def visible_share(self, index: int) -> float:
        """Give the visible share of a part's whole outline, in [0, 1]."""
        whole = self.silhouettes[index]
        if whole is None or whole.pixels == 0:
            return 0.0
        return min(1.0, len(self.pixels(index)[0]) / whole.pixels)


def camera_at(model: ArmModel, joints: Sequence[float], parameters: CameraParameters) -> Camera:
    """Give the camera with the pose it has at measured joint angles, rad."""
    pose = forward(model, joints) @ parameters.mount_matrix
    x, y, z = pose[:3, 3].tolist()
    return Camera(
        width=parameters.width,
        height=parameters.height,
        focal_px=parameters.width / 2 / math.tan(parameters.field_of_view_rad / 2),
        position=(x, y, z),
        rotation=pose[:3, :3],
        near_m=parameters.near_m,
    )


class Eye:
    """The camera in its scene.

    Args:
        scene: The solids.
        model: The arm that carries it.
        parameters: Optics and mount.
    """

    def __init__(self, scene: Scene, model: ArmModel, parameters: CameraParameters) -> None:
        self._scene = scene
        self._model = model
        self._parameters = parameters
        self._hands: dict[float, NDArray[np.float64]] = {}

    def look(
        self, joints: Sequence[float], opening_m: float, parts: Iterable[PlacedPart]
    ) -> Segmentation:
        """Tell for each pixel which part it sees, and how far away.

        Args:
            joints: Where the scene's arm is, rad.
            opening_m: How far apart the fingers are.
            parts: Everything to be told apart, where it is in the scene.
        """
        camera = camera_at(self._model, joints, self._parameters)
        placed = tuple(parts)
        drawings = tuple(draw(part, camera) for part in placed)
        ids, depth = _nearest(drawings, camera)
        seen = ids >= 0
        hidden = seen & (self._hand(camera, opening_m) < depth)
        asked = seen & ~hidden & self._in_reach(camera)
        if asked.any():
            rays = _rays(camera.width, camera.height, camera.focal_px)[asked]
            _, distance = self._scene.cast(
                camera.position, rays @ camera.rotation.T, ("arm", "person")
            )
            ends = np.where(distance < 0, np.inf, distance * rays[:, 2])
            hidden[asked] = ends < depth[asked] - _SAME_M
        ids[hidden] = -1
        depth[ids < 0] = 0.0
        return Segmentation(camera, ids, depth, placed, drawings)

    def _hand(self, camera: Camera, opening_m: float) -> NDArray[np.float64]:
        """Give how far away the gripper is in each pixel, (height, width) m, else inf."""
        key = round(opening_m, 5)
        if key not in self._hands:
            rays = _rays(camera.width, camera.height, camera.focal_px)
            flat = rays.reshape(-1, 3)
            _, distance = self._scene.cast(camera.position, flat @ camera.rotation.T, ("hand",))
            ends = np.where(distance < 0, np.inf, distance * flat[:, 2])
            self._hands[key] = ends.reshape(rays.shape[:2])
        return self._hands[key]

    def _in_reach(self, camera: Camera) -> NDArray[np.bool_]:
        """Tell which pixels arm or person could be in, (height, width)."""
        mask = np.zeros((camera.height, camera.width), dtype=np.bool_)
        corners = self._scene.corners(("arm", "person"))
        for box in (corners - np.asarray(camera.position)) @ camera.rotation:
            deep = box[:, 2]
            if deep.max() < _LENS_M or deep.min() > _FARTHEST_M:
                continue
            ends = box if deep.min() >= _LENS_M else _before_the_lens(box)
            seen = ends[:, :2] * (camera.focal_px / ends[:, 2:])
            (left, top), (right, bottom) = seen.min(axis=0).tolist(), seen.max(axis=0).tolist()
            rows = _pixels(top + camera.height / 2, bottom + camera.height / 2, camera.height)
            columns = _pixels(left + camera.width / 2, right + camera.width / 2, camera.width)
            mask[rows, columns] = True
        return mask


def _before_the_lens(box: NDArray[np.float64]) -> NDArray[np.float64]:
    """Cut a box, (8, 3) in camera axes, off at the lens; give the corners of what is before it."""
    starts, ends = box[_EDGES[:, 0]], box[_EDGES[:, 1]]
    crosses = (starts[:, 2] < _LENS_M) != (ends[:, 2] < _LENS_M)
    starts, ends = starts[crosses], ends[crosses]
    share = (_LENS_M - starts[:, 2:]) / (ends[:, 2:] - starts[:, 2:])
    return np.concatenate([box[box[:, 2] >= _LENS_M], starts + share * (ends - starts)])


def _pixels(low: float, high: float, end: int) -> slice:
    first = min(max(0, math.floor(low)), end)
    return slice(first, max(first, min(end, math.ceil(high))))


def _nearest(
    drawings: Iterable[Drawing | None], camera: Camera
) -> tuple[NDArray[np.int32], NDArray[np.float64]]:
    """Give the part that is in front in each pixel, -1 for none, and its depth, inf for none."""
    ids = np.full((camera.height, camera.width), -1, dtype=np.int32)
    depth = np.full((camera.height, camera.width), np.inf)
    for index, drawing in enumerate(drawings):
        if drawing is None:
            continue
        rows, columns = drawing.depth.shape
        block = (
            slice(drawing.row, drawing.row + rows),
            slice(drawing.column, drawing.column + columns),
        )
        nearer = drawing.depth < depth[block]
        ids[block][nearer] = index
        np.minimum(depth[block], drawing.depth, out=depth[block])
    return ids, depth


@lru_cache(maxsize=4)
def _rays(width: int, height: int, focal_px: float) -> NDArray[np.float64]:
    """Give unit vectors through the pixel centres in the camera frame, (height, width, 3)."""
    u, v = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
    rays = np.stack([u - width / 2, v - height / 2, np.full_like(u, focal_px)], axis=-1)
    unit: NDArray[np.float64] = rays / np.linalg.norm(rays, axis=-1, keepdims=True)
    unit.flags.writeable = False
    return unit
