"""What the camera could see of a place, if nothing stood in the way."""

from __future__ import annotations

from dataclasses import dataclass

from aapa.boxes import centred, has_area, overlap, reaches_out
from aapa.camera import Camera
from aapa.detections import Box, Position
from aapa.parameters import AnchoringParameters
from aapa.reasons import OUTSIDE, REACHES_OUT

_SMALLEST_DEPTH = 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class View:
    """The image of one frame, for questions about objects that were not detected in it.

    Args:
        parameters: Space, margin and, where there is no camera, the size of the image.
        camera: The camera at this frame. Its pose counts in base space only; in image space
            it gives no more than the size of the image.
    """

    parameters: AnchoringParameters
    camera: Camera | None = None

    @property
    def is_flat(self) -> bool:
        """Whether nothing is known of depth, so that only boxes in the image count."""
        return self._posed is None

    @property
    def image_size(self) -> tuple[int, int] | None:
        """Width and height of the image, px; None where nothing says what they are."""
        if self.camera is not None:
            return self.camera.width, self.camera.height
        return self.parameters.image_size

    def box_of(self, box: Box, position: Position | None, size: tuple[float, float] | None) -> Box:
        """Give the box that an object has in this image, px.

        Args:
            box: Its last known box, which stays where nothing better can be said.
            position: Its centre in the base frame, m.
            size: Its width and height, m; without it the box keeps its extent in px.
        """
        camera = self._posed
        if camera is None or position is None:
            return box
        u, v, depth = camera.project(position)
        if depth < _SMALLEST_DEPTH:
            return box
        if size is None:
            return centred(u, v, box[2] - box[0], box[3] - box[1])
        scale = camera.focal_px / depth
        return centred(u, v, size[0] * scale, size[1] * scale)

    def size_of(self, box: Box, position: Position | None) -> tuple[float, float] | None:
        """Give the width and height (m) of what fills a box at a position, if that is known."""
        camera = self._posed
        if camera is None or position is None or not has_area(box):
            return None
        depth = camera.project(position)[2]
        if depth < _SMALLEST_DEPTH:
            return None
        scale = depth / camera.focal_px
        return (box[2] - box[0]) * scale, (box[3] - box[1]) * scale

    def why_out_of_view(self, box: Box, position: Position | None) -> str | None:
        """Give the reason why an object cannot be detected in this image, or None if it can.

        Args:
            box: Its box in this image, px, as `box_of` gives it.
            position: Its centre in the base frame, m.
        """
        camera = self._posed
        if camera is not None and position is not None:
            depth = camera.project(position)[2]
            if depth < _SMALLEST_DEPTH:
                return "It lies behind the camera."
            if depth < camera.near_m:
                return (
                    f"It is {depth:.3f} m from the camera, "
                    f"which detects nothing nearer than {camera.near_m:.3f} m."
                )
        size = self.image_size
        if size is None or not reaches_out(box, size, self.parameters.margin_px):
            return None
        if box[2] <= 0 or box[3] <= 0 or box[0] >= size[0] or box[1] >= size[1]:
            return OUTSIDE
        return REACHES_OUT

    def hides(self, front: tuple[Box, Position | None], back: tuple[Box, Position | None]) -> bool:
        """Tell whether one object stands in front of another.

        In the image alone it may as soon as the boxes overlap. Where both positions and the
        camera's pose are known, it has to be the nearer of the two as well.
        """
        if not overlap(front[0], back[0], self.parameters.margin_px):
            return False
        camera = self._posed
        if camera is None or front[1] is None or back[1] is None:
            return True
        return 0 < camera.project(front[1])[2] < camera.project(back[1])[2]

    @property
    def _posed(self) -> Camera | None:
        return self.camera if self.parameters.space == "base" else None
