"""What a detector would report of a segmented image: honest about what is hidden, and noisy.

`SegmentationDetector` stands in for the trained network of a real cell. It reports a part only if
enough of it is really visible, places it from the measured depth as a real one does, and makes the
errors real ones make: parts that are half hidden, or seen from the side, come and go; the light
drifts and flickers; boxes jitter; a part is taken for one like it. Only type, box, score, position
and size leave it; which part it was does not.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final, Protocol, TypeVar

import numpy as np

from aapa import Box, Camera, Detection
from runtime.cell.camera import Segmentation
from runtime.cell.lighting import brightness, persistent_chances
from runtime.cell.sighting import Sighting, sightings
from runtime.parts import PartModel

View_contra = TypeVar("View_contra", contravariant=True)

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
        sure_share: From this share on it makes no difference. Between the two, the part is
            detected for a while and lost for a while.
        sure_angle_rad: Seen from within this angle to the vertical likewise.
        lost_angle_rad: Seen from beyond this angle, a part is not recognised.
        drift: How much of the visible share bad light takes away, at its worst.
        drift_frames: How many frames the light takes to change.
        box_noise_px: Standard deviation of each box edge.
        position_noise_m: Standard deviation of each coordinate.
        miss_rate: Probability of missing a part in a single frame.
        burst_rate: Probability that a part is missed for a whole burst.
        burst_frames: Length of a burst.
        shimmer_rate: Probability that the light flickers for a while, and every part with it.
        shimmer_frames: How long that lasts.
        shimmer_miss: Probability of missing a part in a frame while it does.
        flicker_rate: Probability of reporting another class.
        switch_rate: Probability that a part is taken for the one most like it, for some frames.
        switch_frames: How many.
    """

    min_pixels: int = 20
    min_share: float = 0.5
    sure_share: float = 0.7
    sure_angle_rad: float = math.radians(50)
    lost_angle_rad: float = math.radians(80)
    drift: float = 0.1
    drift_frames: int = 120
    box_noise_px: float = 0.4
    position_noise_m: float = 0.0008
    miss_rate: float = 0.01
    burst_rate: float = 0.02
    burst_frames: int = 4
    shimmer_rate: float = 0.01
    shimmer_frames: int = 6
    shimmer_miss: float = 0.3
    flicker_rate: float = 0.003
    switch_rate: float = 0.002
    switch_frames: int = 2


PERFECT: Final = DetectorParameters(
    sure_share=0.5,
    sure_angle_rad=math.pi,
    lost_angle_rad=math.pi,
    drift=0.0,
    box_noise_px=0.0,
    position_noise_m=0.0,
    miss_rate=0.0,
    burst_rate=0.0,
    shimmer_rate=0.0,
    flicker_rate=0.0,
    switch_rate=0.0,
)
"""No errors but those of geometry."""

POOR_LIGHT: Final = DetectorParameters(
    sure_share=0.95,
    sure_angle_rad=math.radians(20),
    lost_angle_rad=math.radians(70),
    drift=0.3,
    box_noise_px=0.8,
    position_noise_m=0.0015,
    miss_rate=0.03,
    burst_rate=0.04,
    shimmer_rate=0.05,
    shimmer_miss=0.5,
    flicker_rate=0.005,
    switch_rate=0.005,
)
"""A workshop by a window: parts come and go, and like ones are taken for one another."""


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
        self._measured: tuple[Segmentation, tuple[Sighting, ...]] | None = None

    def detect(self, view: Segmentation, frame: int) -> list[Detection]:
        """Report what is seen in a segmented image."""
        count, parameters = len(view.parts), self._parameters
        burst = self._stream(1, frame // max(1, parameters.burst_frames)).random(count)
        switched = self._stream(4, frame // max(1, parameters.switch_frames)).random(count)
        chances = self._stream(2, frame).random((count, 3))
        errors = self._stream(6, frame).standard_normal((count, _DRAWS)).tolist()
        luck = persistent_chances(self._seed, frame, count)
        light = brightness(self._seed, frame, parameters.drift_frames)
        shimmer = float(self._stream(7, frame // max(1, parameters.shimmer_frames)).random())
        shimmers = shimmer < parameters.shimmer_rate
        missed = parameters.shimmer_miss if shimmers else parameters.miss_rate
        models = {part.model.type: part.model for part in view.parts}
        found: list[Detection] = []
        for index, part in enumerate(self._seen(view)):
            if burst[index] < parameters.burst_rate or chances[index, 0] < missed:
                continue
            if luck[index] >= self._chance(part, light):
                continue
            detection = self._report(part, view.camera, errors[index], light)
            if detection is None:
                continue
            if switched[index] < parameters.switch_rate:
                detection = _renamed(detection, _most_like(part.model, models))
            elif chances[index, 1] < parameters.flicker_rate:
                others = [kind for kind in sorted(models) if kind != detection.type]
                other = others[int(chances[index, 2] * len(others))] if others else detection.type
                detection = _renamed(detection, other)
            found.append(detection)
        # In an order that tells nothing of which part is which.
        return sorted(found, key=lambda detection: detection.box)

    def _stream(self, kind: int, number: int) -> np.random.Generator:
        return np.random.default_rng([self._seed, kind, number])

    def _seen(self, view: Segmentation) -> tuple[Sighting, ...]:
        """Measure a view, once: an arm at rest sees the same one again and again."""
        if self._measured is None or self._measured[0] is not view:
            self._measured = (view, sightings(view))
        return self._measured[1]

    def _chance(self, seen: Sighting, light: float) -> float:
        """Give how likely a part is recognised as it is seen: 1 if it is seen well."""
        parameters = self._parameters
        share = seen.share - parameters.drift * (1 - light)
        return _ramp(share, parameters.min_share, parameters.sure_share) * _ramp(
            -seen.angle_rad, -parameters.lost_angle_rad, -parameters.sure_angle_rad
        )

    def _report(
        self, seen: Sighting, camera: Camera, errors: Sequence[float], light: float
    ) -> Detection | None:
        """Give a part's detection, None if too little of it shows or it is too near."""
        parameters = self._parameters
        if seen.pixels < max(1, parameters.min_pixels) or seen.share < parameters.min_share:
            return None
        if seen.depth_m < camera.near_m:
            return None
        box = _jittered(seen.box, [error * parameters.box_noise_px for error in errors[:4]], camera)
        dx, dy, dz = (error * parameters.position_noise_m for error in errors[4:7])
        x, y, z = seen.centre
        scale = seen.depth_m / camera.focal_px
        score = 0.55 + 0.42 * seen.share - 0.3 * parameters.drift * (1 - light) + 0.02 * errors[7]
        return Detection(
            type=seen.model.type,
            box=box,
            score=round(min(1.0, max(0.05, score)), 4),
            position=(x + dx, y + dy, z + dz),
            size=((box[2] - box[0]) * scale, (box[3] - box[1]) * scale),
        )


def _jittered(box: Box, errors: Sequence[float], camera: Camera) -> Box:
    """Give a box with its edges off by some pixels but inside the image."""
    left, top, right, bottom = (edge + error for edge, error in zip(box, errors, strict=True))
    x1 = min(max(0.0, left), camera.width - 1.0)
    y1 = min(max(0.0, top), camera.height - 1.0)
    x2 = min(max(x1 + 1.0, right), float(camera.width))
    y2 = min(max(y1 + 1.0, bottom), float(camera.height))
    return x1, y1, x2, y2


def _ramp(value: float, low: float, high: float) -> float:
    """Give 0 up to low, 1 from high on, and a straight line between."""
    if value >= high:
        return 1.0
    return max(0.0, (value - low) / (high - low)) if high > low else 0.0


def _most_like(model: PartModel, models: Mapping[str, PartModel]) -> str:
    """Give the type that is most easily taken for another: the one nearest in size."""
    own = np.log(model.size)
    others = [
        (float(np.abs(np.log(other.size) - own).sum()), kind)
        for kind, other in models.items()
        if kind != model.type
    ]
    return min(others)[1] if others else model.type


def _renamed(detection: Detection, kind: str) -> Detection:
    return Detection(
        type=kind,
        box=detection.box,
        score=round(detection.score * 0.6, 4),
        position=detection.position,
        size=detection.size,
    )
