"""The eye in the hand: a pinhole camera on the flange, and what each of its pixels sees.

Its pose is known the way a real one is: from the measured joints and the hand-eye calibration. The
pixels come from rays through MuJoCo's solids, so neither OpenGL nor a display is needed, and
whatever is in front, the gripper and the part it holds included, really hides what is behind.
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
from runtime.cell.scene import Scene
from runtime.cell.silhouette import Silhouette, silhouette
from runtime.cell.world import PlacedPart
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
        silhouettes: Their whole outlines, by index; None where a part is not before the camera.
    """

    camera: Camera
    ids: NDArray[np.int32]
    depth: NDArray[np.float64]
    parts: tuple[PlacedPart, ...]
    silhouettes: tuple[Silhouette | None, ...]

    def visible_share(self, index: int) -> float:
        """Give the visible share of a part's whole outline, in [0, 1]."""
        whole = self.silhouettes[index]
        if whole is None or whole.pixels == 0:
            return 0.0
        return min(1.0, float(np.count_nonzero(self.ids == index)) / whole.pixels)


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


def segment(scene: Scene, camera: Camera, parts: Iterable[PlacedPart]) -> Segmentation:
    """Tell for each pixel which part it sees, and how far away.

    Rays are cast only where some part could be seen at all.
    """
    placed = tuple(parts)
    outlines = tuple(silhouette(part, camera) for part in placed)
    shape = (camera.height, camera.width)
    wanted = np.zeros(shape, dtype=np.bool_)
    for outline in outlines:
        if outline is not None:
            x1, y1, x2, y2 = outline.box
            rows = slice(max(0, math.floor(y1)), max(0, math.ceil(y2)))
            wanted[rows, max(0, math.floor(x1)) : max(0, math.ceil(x2))] = True
    rays = _rays(camera.width, camera.height, camera.focal_px)[wanted]
    ids = np.full(shape, -1, dtype=np.int32)
    depth = np.zeros(shape)
    if len(rays):
        hit, distance = scene.cast(camera.position, rays @ camera.rotation.T)
        ids[wanted] = hit
        depth[wanted] = np.where(hit >= 0, distance * rays[:, 2], 0.0)
    return Segmentation(camera, ids, depth, placed, outlines)


@lru_cache(maxsize=4)
def _rays(width: int, height: int, focal_px: float) -> NDArray[np.float64]:
    """Give unit vectors through the pixel centres in the camera frame, (height, width, 3)."""
    u, v = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
    rays = np.stack([u - width / 2, v - height / 2, np.full_like(u, focal_px)], axis=-1)
    unit: NDArray[np.float64] = rays / np.linalg.norm(rays, axis=-1, keepdims=True)
    unit.flags.writeable = False
    return unit
