"""What a detector would report of a segmented image: honest about what is hidden, and noisy.

`SegmentationDetector` stands in for the trained network of a real cell. It reports a part only if
enough of it is really visible, places it from the measured depth as a real one does, and adds the
errors real ones make: jitter, misses in bursts, the wrong class now and then. Only type, box,
score, position and size leave it; which part it was does not.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from aapa import Box, Camera, Detection, Position
from runtime.cell.camera import Segmentation

View_contra = TypeVar("View_contra", contravariant=True)

_TOP_M: Final = 0.003  # depth points this close under the highest one belong to the top face
_DRAWS: Final = 10  # random numbers a part uses up in one frame


class Detector(Protocol[View_contra]):
    """Whatever finds parts in a view of the cell, be it a segmented or a camera image."""

    def detect(self, view: View_contra, frame: int) -> list[Detection]:
        """Report what is seen in a view; `frame` counts the views."""


@dataclass(frozen=True, slots=True)
class DetectorParameters:
    """When a part is detected, and how wrong the detection is.

    Args:
        min_pixels: A part with fewer visible pixels is not detected.
        min_share: Nor is one of whose whole outline less than this share is visible.
        box_noise_px: Standard deviation of each box edge.
        position_noise_m: Standard deviation of each coordinate.
        miss_rate: Probability of missing a part in a single frame.
        burst_rate: Probability that a part is missed for a whole burst.
        burst_frames: Length of a burst.
        flicker_rate: Probability of reporting another class.
    """

    min_pixels: int = 20
    min_share: float = 0.5
    box_noise_px: float = 0.4
    position_noise_m: float = 0.0008
    miss_rate: float = 0.01
    burst_rate: float = 0.02
    burst_frames: int = 4
    flicker_rate: float = 0.003


PERFECT: Final = DetectorParameters(
    box_noise_px=0.0, position_noise_m=0.0, miss_rate=0.0, burst_rate=0.0, flicker_rate=0.0
)
"""No errors but those of geometry."""


class SegmentationDetector:
    """The detector of the simulated cell.

    Every random draw depends on the seed and the frame number only: the same views give the same
    detections, whatever was seen in between.

    Args:
        seed: Of the errors.
        parameters: Thresholds and errors.
    """

    def __init__(self, seed: int = 0, parameters: DetectorParameters | None = None) -> None:
        self._seed = seed
        self._parameters = parameters or DetectorParameters()

    def detect(self, view: Segmentation, frame: int) -> list[Detection]:
        """Report what is seen in a segmented image."""
        count = len(view.parts)
        burst = frame // max(1, self._parameters.burst_frames)
        missing = np.random.default_rng([self._seed, 1, burst]).random(count)
        rng = np.random.default_rng([self._seed, 2, frame])
        chances = rng.random((count, 3))
        errors = rng.standard_normal((count, _DRAWS))
        types = sorted({part.model.type for part in view.parts})
        found: list[Detection] = []
        for index in range(count):
            if missing[index] < self._parameters.burst_rate:
                continue
            if chances[index, 0] < self._parameters.miss_rate:
                continue
            detection = self._look_at(view, index, errors[index])
            if detection is None:
                continue
            if chances[index, 1] < self._parameters.flicker_rate:
                detection = _renamed(detection, types, float(chances[index, 2]))
            found.append(detection)
        # In an order that tells nothing of which part is which.
        return sorted(found, key=lambda detection: detection.box)

    def _look_at(
        self, view: Segmentation, index: int, errors: NDArray[np.float64]
    ) -> Detection | None:
        """Give a part's detection, None if too little of it shows or it is too near."""
        rows, columns = np.nonzero(view.ids == index)
        share = view.visible_share(index)
        parameters = self._parameters
        if len(rows) < max(1, parameters.min_pixels) or share < parameters.min_share:
            return None
        depth = view.depth[rows, columns]
        middle = float(np.median(depth))
        if middle < view.camera.near_m:
            return None
        box = _jittered(rows, columns, errors[:4] * parameters.box_noise_px, view.camera)
        centre = _centre(view, index, (rows, columns, depth))
        moved = np.asarray(centre) + errors[4:7] * parameters.position_noise_m
        scale = middle / view.camera.focal_px
        return Detection(
            type=view.parts[index].model.type,
            box=box,
            score=round(min(1.0, max(0.05, 0.55 + 0.42 * share + 0.02 * float(errors[7]))), 4),
            position=(float(moved[0]), float(moved[1]), float(moved[2])),
            size=((box[2] - box[0]) * scale, (box[3] - box[1]) * scale),
        )


def _centre(
    view: Segmentation,
    index: int,
    pixels: tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]],
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
    return x, y, highest - view.parts[index].model.size[2] / 2


def _jittered(
    rows: NDArray[np.int64],
    columns: NDArray[np.int64],
    errors: NDArray[np.float64],
    camera: Camera,
) -> Box:
    """Give the box around pixels, its edges off by some pixels but inside the image."""
    x1 = min(max(0.0, float(columns.min() + errors[0])), camera.width - 1.0)
    y1 = min(max(0.0, float(rows.min() + errors[1])), camera.height - 1.0)
    x2 = min(max(x1 + 1.0, float(columns.max() + 1 + errors[2])), float(camera.width))
    y2 = min(max(y1 + 1.0, float(rows.max() + 1 + errors[3])), float(camera.height))
    return x1, y1, x2, y2


def _renamed(detection: Detection, types: list[str], chance: float) -> Detection:
    others = [kind for kind in types if kind != detection.type] or types
    return Detection(
        type=others[int(chance * len(others))],
        box=detection.box,
        score=round(detection.score * 0.6, 4),
        position=detection.position,
        size=detection.size,
    )
