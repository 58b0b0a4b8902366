"""Videos made up after CATER: scenes, labels and detections in the layout of LA-CATER.

In the order in which a video comes about: `bodies` and `placement` draw what stands where,
`schedule` decides who moves when and `stage` keeps account of it, `motion` says how a move goes;
`viewpoint` films it, `outlines` gives the boxes; `simulation` puts these together. `rays` and
`visibility` tell how much of a thing is seen, and from that `detector` with `noise` makes up what
the trained detector would report. `video` is one whole video, `dataset` a folder of them.
"""

from __future__ import annotations

from aapa.lacater.generator.dataset import Recipe, generate_dataset
from aapa.lacater.generator.noise import DetectorNoise, read_noise
from aapa.lacater.generator.simulation import Simulation, simulate, video_name
from aapa.lacater.generator.video import GeneratedVideo, generate_video

__all__ = [
    "DetectorNoise",
    "GeneratedVideo",
    "Recipe",
    "Simulation",
    "generate_dataset",
    "generate_video",
    "read_noise",
    "simulate",
    "video_name",
]
