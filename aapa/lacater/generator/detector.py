"""A stand-in for the trained detector: what it would report of a generated video.

Every object has luck of its own, which changes slowly; it is missed when its luck is below what
its visible part needs. Boxes are shaken, classes mistaken for some frames, false boxes stand for
some frames somewhere on the floor, and all boxes are cut down to whole px, as the published are.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.special import expit, ndtr

from aapa.lacater.classes import CLASS_NAMES, SNITCH, SNITCH_NAME, class_number
from aapa.lacater.generator.bodies import RADII, SNITCH_RADIUS, Body
from aapa.lacater.generator.noise import DetectorNoise
from aapa.lacater.generator.outlines import boxes_of
from aapa.lacater.generator.placement import HALF_SIDE
from aapa.lacater.generator.simulation import Simulation, changes
from aapa.lacater.generator.viewpoint import Viewpoint
from aapa.lacater.video import HEIGHT, WIDTH, Perception

_LEAST_SCORE: Final = 0.8
"""The detector's users keep what it is at least so sure of."""

# What of an object's picture may change before its box is found anew.
_SAME_SHARE = 0.02
_NEIGHBOURS = {"large": ("medium",), "medium": ("large", "small"), "small": ("medium",)}
_OTHER_MATERIAL = {"metal": "rubber", "rubber": "metal"}
_LIKE_THE_SNITCH = ("small_yellow_sphere_metal", "small_brown_sphere_metal")


def detect(
    simulation: Simulation,
    shares: NDArray[np.float64],
    noise: DetectorNoise,
    chance: np.random.Generator,
) -> Perception:
    """Give what the detector reports of a video.

    Args:
        simulation: The video.
        shares: (n, f) how much of each body can be seen.
        noise: What the detector is like.
        chance: Where its luck comes from.
    """
    found, scores = _found(shares, noise, chance)
    boxes = _shaken(simulation, shares, noise, chance)
    classes = _called(simulation.bodies, shares.shape[1], noise, chance)
    false = _false_boxes(simulation.viewpoint, shares.shape[1], noise, chance)
    found &= ~np.isin(classes, noise.blind_classes)
    objects, frames = np.nonzero(found)
    all_frames = np.concatenate([frames, false.frames])
    all_boxes = np.concatenate([boxes[objects, frames], false.boxes])
    all_classes = np.concatenate([classes[objects, frames], false.classes])
    all_scores = np.concatenate([scores[objects, frames], false.scores])
    order = np.lexsort((all_classes, -all_scores, all_frames))
    cut = np.clip(all_boxes, 0.0, (WIDTH, HEIGHT, WIDTH, HEIGHT)).astype(np.int64)[order]
    bounds = np.searchsorted(all_frames[order], np.arange(1, shares.shape[1]))
    return Perception(tuple(np.split(cut, bounds)), tuple(np.split(all_classes[order], bounds)))


def look_alikes(class_name: str) -> tuple[int, ...]:
    """Give the classes that one may be mistaken for: of the next size, or the other material.

    The snitch is small, golden and round; a small yellow or brown metal sphere comes nearest.

    Example:
        >>> [CLASS_NAMES[number] for number in look_alikes("large_red_cone_metal")]
        ['medium_red_cone_metal', 'large_red_cone_rubber']
    """
    if class_name == SNITCH_NAME:
        names = list(_LIKE_THE_SNITCH)
    else:
        size, color, shape, material = class_name.split("_")
        names = [f"{other}_{color}_{shape}_{material}" for other in _NEIGHBOURS[size]]
        names.append(f"{size}_{color}_{shape}_{_OTHER_MATERIAL[material]}")
        if class_name in _LIKE_THE_SNITCH:
            names.append(SNITCH_NAME)
    numbers = [class_number(name) for name in names]
    return tuple(number for number in numbers if number is not None)


def _found(
    shares: NDArray[np.float64], noise: DetectorNoise, chance: np.random.Generator
) -> tuple[NDArray[np.bool_], NDArray[np.float64]]:
    """Give where each object is found (n, f), and how sure the detector is of it."""
    likely = (1.0 - noise.miss_rate) * expit((shares - noise.half_seen) / noise.seen_slope)
    likely = np.where(shares > 0.0, likely, 0.0)
    keep = np.full(shares.shape, noise.miss_correlation)
    luck = ndtr(_drifting(chance.standard_normal(shares.shape), keep))
    scores = 1.0 - (1.0 - _LEAST_SCORE) * np.minimum(luck / np.maximum(likely, 1e-9), 1.0)
    return luck < likely, scores


def _shaken(
    simulation: Simulation,
    shares: NDArray[np.float64],
    noise: DetectorNoise,
    chance: np.random.Generator,
) -> NDArray[np.float64]:
    """Give the boxes (n, f, 4) with each edge a little off."""
    boxes = simulation.boxes
    scale = noise.jitter_px * (1.0 + noise.hidden_jitter * (1.0 - shares))
    same = np.stack(
        [
            ~changes(box) & (np.abs(np.diff(share, prepend=share[0])) < _SAME_SHARE)
            for box, share in zip(boxes, shares, strict=True)
        ]
    )
    keep = np.where(same, 1.0, noise.settling)[..., None]
    lasting = _drifting(chance.standard_normal(boxes.shape), np.broadcast_to(keep, boxes.shape))
    fresh = chance.standard_normal(boxes.shape)
    error = math.sqrt(noise.lasting) * lasting + math.sqrt(1.0 - noise.lasting) * fresh
    shaken: NDArray[np.float64] = boxes + error * scale[..., None]
    return shaken


def _drifting(fresh: NDArray[np.float64], keep: NDArray[np.float64]) -> NDArray[np.float64]:
    """Turn noise (n, f, …) of variance 1 into one that keeps so much from frame to frame."""
    drifting = fresh.copy()
    anew = np.sqrt(1.0 - keep**2)
    for frame in range(1, fresh.shape[1]):
        drifting[:, frame] = (
            keep[:, frame] * drifting[:, frame - 1] + anew[:, frame] * fresh[:, frame]
        )
    return drifting


def _called(
    bodies: tuple[Body, ...], frames: int, noise: DetectorNoise, chance: np.random.Generator
) -> NDArray[np.int64]:
    """Give the class (n, f) that each body is taken for."""
    classes = np.repeat(np.array([body.class_id for body in bodies])[:, None], frames, axis=1)
    starts = np.argwhere(chance.random(classes.shape) < noise.swap_rate)
    for body, start in starts:
        others = look_alikes(bodies[body].class_name)
        lasts = int(chance.geometric(1.0 / noise.swap_frames))
        classes[body, start : start + lasts] = others[int(chance.integers(len(others)))]
    return classes


@dataclass(frozen=True, slots=True, eq=False)
class _FalseBoxes:
    """Boxes where nothing is.

    Args:
        frames: (m,) the frame of each.
        classes: (m,) class numbers.
        scores: (m,)
        boxes: (m, 4) px.
    """

    frames: NDArray[np.int64]
    classes: NDArray[np.int64]
    scores: NDArray[np.float64]
    boxes: NDArray[np.float64]


def _false_boxes(
    viewpoint: Viewpoint, frames: int, noise: DetectorNoise, chance: np.random.Generator
) -> _FalseBoxes:
    rows: list[tuple[int, int, float]] = []
    boxes: list[NDArray[np.float64]] = []
    for rate, of_snitch in ((noise.false_snitches, True), (noise.false_others, False)):
        starts = np.flatnonzero(chance.random(frames) < rate)
        for start in starts:
            number = SNITCH if of_snitch else _other_class(noise, chance)
            body = _imagined(number)
            x, y = chance.uniform(-HALF_SIDE, HALF_SIDE, 2)
            place = np.array([body.origin_at(float(x), float(y))])
            [box] = boxes_of(body, place, np.zeros(1), viewpoint)
            lasts = int(chance.geometric(1.0 / noise.false_frames))
            for frame in range(int(start), min(int(start) + lasts, frames)):
                rows.append((frame, number, float(chance.uniform(_LEAST_SCORE, 1.0))))
                boxes.append(box)
    return _FalseBoxes(
        np.array([frame for frame, _, _ in rows], dtype=np.int64),
        np.array([number for _, number, _ in rows], dtype=np.int64),
        np.array([score for _, _, score in rows], dtype=np.float64),
        np.array(boxes, dtype=np.float64).reshape(-1, 4),
    )


def _other_class(noise: DetectorNoise, chance: np.random.Generator) -> int:
    blind = {SNITCH, *noise.blind_classes}
    reported = [number for number in range(len(CLASS_NAMES)) if number not in blind]
    return reported[int(chance.integers(len(reported)))]


def _imagined(number: int) -> Body:
    size, color, shape, material = CLASS_NAMES[number].split("_")
    radius = SNITCH_RADIUS if number == SNITCH else RADII[size]
    return Body(shape, size, color, material, radius, "", 0.0)
