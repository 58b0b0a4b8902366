"""One generated video with everything that is written about it: labels, masks, detections."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from aapa.lacater.generator.detector import detect
from aapa.lacater.generator.noise import DetectorNoise
from aapa.lacater.generator.simulation import simulate
from aapa.lacater.generator.visibility import visible_shares
from aapa.lacater.label_rules import contained_frames, frame_masks, perfect_perception
from aapa.lacater.layout import PerceptionKind
from aapa.lacater.video import Perception, Video


@dataclass(frozen=True, slots=True, eq=False)
class GeneratedVideo:
    """A video, and what the two detectors report of it."""

    video: Video
    perceptions: Mapping[PerceptionKind, Perception]


def generate_video(seed: int, number: int, noise: DetectorNoise) -> GeneratedVideo:
    """Make up one video of a data set.

    Args:
        seed: The data set's, at least 0.
        number: The video's, at least 0; it looks the same however many others there are.
        noise: What the trained detector is like. The scene does not depend on it.

    Example:
        >>> made = generate_video(1, 18, DetectorNoise())
        >>> made.video.name, made.video.labels.frames
        ('CLEVR_new_000018', 300)
    """
    simulation = simulate(seed, number)
    labels, scene = simulation.labels(), simulation.scene()
    shares = visible_shares(simulation, contained_frames(scene, labels.frames))
    chance = np.random.default_rng((seed, number))
    return GeneratedVideo(
        Video(
            simulation.name,
            labels,
            frame_masks(labels, scene),
            scene,
            np.round(simulation.boxes, 4),
        ),
        {
            PerceptionKind.OD: detect(simulation, shares, noise, chance),
            PerceptionKind.PP: perfect_perception(labels, scene),
        },
    )
