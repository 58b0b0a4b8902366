"""One video of a data set, without its pictures: labels, scene, frame lists and detections."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Final

import numpy as np
from numpy.typing import NDArray

from aapa.lacater.classes import SNITCH_KEY
from aapa.lacater.scene import Scene

WIDTH: Final = 320
"""The width of every picture, px."""

HEIGHT: Final = 240
"""The height of every picture, px."""

FRAMES: Final = 300
"""The number of frames of every published video; the reader takes other lengths as well."""


@dataclass(frozen=True, slots=True, eq=False)
class Labels:
    """Where every object really is, seen or hidden.

    Args:
        keys: The objects as the label file names them, in its order.
        boxes: (objects, frames, 4) whole px, x1 y1 x2 y2 from the top left. A hidden object
            keeps its true box. The file holds x, y, width, height.
    """

    keys: tuple[str, ...]
    boxes: NDArray[np.int32]

    @property
    def frames(self) -> int:
        """The number of frames."""
        return int(self.boxes.shape[1])

    @property
    def snitch(self) -> NDArray[np.int32] | None:
        """(frames, 4) the snitch's boxes, or None in a video without one."""
        return self.boxes[self.keys.index(SNITCH_KEY)] if SNITCH_KEY in self.keys else None


@dataclass(frozen=True, slots=True, eq=False)
class Perception:
    """What a detector reported, frame by frame.

    Args:
        boxes: For each frame (n, 4) whole px, x1 y1 x2 y2, the surest first.
        classes: For each frame (n,) class numbers.
    """

    boxes: tuple[NDArray[np.int64], ...]
    classes: tuple[NDArray[np.int64], ...]

    @property
    def frames(self) -> int:
        """The number of frames."""
        return len(self.boxes)


@dataclass(frozen=True, slots=True, eq=False)
class FrameMasks:
    """Which frames have which label; each is (frames,) bool. The names are those of the files.

    Args:
        containment: The snitch is in a container, which may move: contained or carried.
        containment_only_static: Contained: in a container that stands still.
        containment_with_move: Carried: in a container that slides.
        visible_0: Visible: not contained, nor wholly behind a nearer, larger box.
        visible_30: As above, with not more than 70 % behind it.
        visible_99: As above, with not more than 1 % behind it.
    """

    containment: NDArray[np.bool_]
    containment_only_static: NDArray[np.bool_]
    containment_with_move: NDArray[np.bool_]
    visible_0: NDArray[np.bool_]
    visible_30: NDArray[np.bool_]
    visible_99: NDArray[np.bool_]

    @property
    def visible(self) -> NDArray[np.bool_]:
        """The snitch can be seen."""
        return self.visible_0

    @property
    def occluded(self) -> NDArray[np.bool_]:
        """The snitch is behind something, and in nothing."""
        hidden: NDArray[np.bool_] = ~self.visible_0 & ~self.containment
        return hidden

    @property
    def contained(self) -> NDArray[np.bool_]:
        """The snitch is in a container that stands still."""
        return self.containment_only_static

    @property
    def carried(self) -> NDArray[np.bool_]:
        """The snitch is in a container that slides."""
        return self.containment_with_move

    def named(self) -> dict[str, NDArray[np.bool_]]:
        """Give every mask under its field's name, in the order of the fields."""
        return {field.name: getattr(self, field.name) for field in fields(self)}


@dataclass(frozen=True, slots=True, eq=False)
class Video:
    """Everything written about one video.

    Args:
        name: Such as "CLEVR_new_000018".
        labels: The true boxes, rounded to px.
        masks: Which frames have which label.
        scene: The objects' paths and the actions; None where the data set has no scene files.
        exact_boxes: (objects, frames, 4) the true boxes before rounding, px, x1 y1 x2 y2, in the
            order of the labels; only generated data has them.
    """

    name: str
    labels: Labels
    masks: FrameMasks
    scene: Scene | None = None
    exact_boxes: NDArray[np.float64] | None = None
