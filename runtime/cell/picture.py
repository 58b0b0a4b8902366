"""Pictures of the cell for people: from a corner of the table, or through the wrist camera.

Detections need no OpenGL, pictures do. Where neither EGL nor OSMesa is installed, `Picture` says so
in one sentence.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterable
from pathlib import Path
from types import TracebackType
from typing import Any, Final, Literal, Self, TypeAlias

import numpy as np
from numpy.typing import NDArray

from aapa import Box, Detection
from runtime.cell.cell import Cell
from runtime.cell.mjcf import GROUPS
from runtime.cell.scene import load_mujoco
from runtime.errors import RuntimeFault, UsageError

Image: TypeAlias = NDArray[np.uint8]  # (height, width, 3)
View: TypeAlias = Literal["overview", "wrist"]

_LOOK_AT: Final = (0.28, -0.03, 0.26)
_DISTANCE_M: Final = 1.5
_AZIMUTH: Final = 133.0
_AZIMUTH_WITH_PERSON: Final = 52.0  # past the person's other shoulder, not through their head
_ELEVATION: Final = -25.0
_BOX_COLOUR: Final = (90, 255, 120)


class Picture:
    """A renderer for one cell. Only one may be open at a time in a process; close it.

    Args:
        cell: The cell to draw, as it is when a picture is taken.
        width: px, at most 1280.
        height: px, at most 960.

    Raises:
        RuntimeFault: There is no way to draw here.
    """

    def __init__(self, cell: Cell, width: int = 1200, height: int = 800) -> None:
        if not (1 <= width <= 1280 and 1 <= height <= 960):
            raise UsageError(
                f"A picture of {width} x {height} px; at most 1280 x 960 can be drawn."
            )
        self._cell = cell
        self._mujoco = load_mujoco()
        try:
            self._renderer: Any = self._mujoco.Renderer(cell.scene.model, height, width)
        except Exception as error:  # the failure's type depends on which library is missing
            raise RuntimeFault(
                "No picture can be drawn: neither EGL nor OSMesa works here"
                f" ({' '.join(str(error).split()) or type(error).__name__}); on Debian,"
                " 'apt-get install libegl1 libegl-mesa0 libgl1-mesa-dri' provides EGL."
            ) from error

    def take(self, view: View = "overview") -> Image:
        """Draw the cell from the corner of the table, or as the wrist camera sees it."""
        scene = self._cell.scene
        option = self._mujoco.MjvOption()
        option.geomgroup[:] = 1
        if view == "overview":
            camera = self._mujoco.MjvCamera()
            camera.lookat[:] = _LOOK_AT
            camera.distance, camera.elevation = _DISTANCE_M, _ELEVATION
            alone = self._cell.person.body is None
            camera.azimuth = _AZIMUTH if alone else _AZIMUTH_WITH_PERSON
            self._renderer.update_scene(scene.data, camera, option)
        else:
            option.geomgroup[GROUPS["camera"]] = 0  # the lens is inside its own housing
            self._renderer.update_scene(scene.data, "wrist", option)
        image: Image = np.array(self._renderer.render(), dtype=np.uint8)
        return image

    def portrait(self, detections: Iterable[Detection] = ()) -> Image:
        """Draw the overview with the wrist camera's view, and boxes on it, in the lower corner."""
        image, eye = self.take(), self.take("wrist")
        factor = 3  # every third pixel: the inset is a third as wide as the picture
        inset = eye[: eye.shape[0] // factor * factor, : eye.shape[1] // factor * factor]
        inset = inset.reshape(inset.shape[0] // factor, factor, -1, factor, 3).mean(axis=(1, 3))
        inset = inset.astype(np.uint8)
        camera = self._cell.view().camera
        # Both images show the same vertical field of view about the same centre.
        scale = inset.shape[0] / camera.height
        shift = (inset.shape[1] - camera.width * scale) / 2
        for detection in detections:
            x1, y1, x2, y2 = detection.box
            _frame(inset, (x1 * scale + shift, y1 * scale, x2 * scale + shift, y2 * scale))
        framed = np.full((inset.shape[0] + 8, inset.shape[1] + 8, 3), 255, np.uint8)
        framed[4:-4, 4:-4] = inset
        bottom, left = image.shape[0] - framed.shape[0] - 16, 16
        image[bottom : bottom + framed.shape[0], left : left + framed.shape[1]] = framed
        return image

    def close(self) -> None:
        """Give the drawing context back."""
        self._renderer.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()


def save_png(image: Image, path: str | Path) -> None:
    """Write a picture as a PNG file. Raises OSError if it cannot be written."""
    height, width, _ = image.shape
    # Every row starts with its filter's number; 0 means unfiltered.
    rows = np.hstack([np.zeros((height, 1), np.uint8), image.reshape(height, width * 3)])
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    chunks = ((b"IHDR", header), (b"IDAT", zlib.compress(rows.tobytes(), 9)), (b"IEND", b""))
    with Path(path).open("wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n")
        for name, body in chunks:
            file.write(struct.pack(">I", len(body)) + name + body)
            file.write(struct.pack(">I", zlib.crc32(name + body)))


def _frame(image: Image, box: Box) -> None:
    """Draw a box's edges into an image."""
    height, width, _ = image.shape
    columns = np.clip(np.round([box[0], box[2]]).astype(int), 1, width - 2)
    rows = np.clip(np.round([box[1], box[3]]).astype(int), 1, height - 2)
    (left, right), (top, bottom) = columns.tolist(), rows.tolist()
    for column in (left, right):
        image[top : bottom + 1, column] = _BOX_COLOUR
    for row in (top, bottom):
        image[row, left : right + 1] = _BOX_COLOUR
