"""The rules by which frames are labelled visible, occluded, contained or carried.

All of them are box rules: no pixel is looked at. A cone contains an object from the end of the
`_contain` that covered it to the beginning of the cone's next `_pick_place`. An object is behind
another if that one is nearer to a fixed point, has the larger box, and covers enough of its box.

Source: Shamsian et al., Learning Object Permanence from Video, ECCV 2020 (the published code).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from aapa.errors import DatasetError
from aapa.lacater.classes import SNITCH_KEY, class_of_key
from aapa.lacater.scene import Movement, Scene
from aapa.lacater.video import FrameMasks, Labels, Perception

CAMERA_POINT: Final = (7.1146, -6.1746, 5.5963)
"""Where the rules take the camera to be, in every video alike, in units of the scene."""

PERFECT_RATIO: Final = 0.3
"""The share of its box from which on a perfect detector sees an object. The published files do
not tell theirs; this value reproduces the published score of perfect perception."""

CONTAIN, PICK_PLACE, SLIDE = "_contain", "_pick_place", "_slide"


def containments(scene: Scene, frames: int) -> NDArray[np.bool_]:
    """Give (objects, objects, frames): [o, c, t] says that object o is directly under cone c at t.

    Args:
        scene: Its movements; the objects are numbered in its order.
        frames: How many frames the labels have.
    """
    index = {thing.instance: number for number, thing in enumerate(scene.objects)}
    inside = np.zeros((len(index), len(index), frames), dtype=np.bool_)
    for thing in scene.objects:
        if not thing.is_cone:
            continue
        record = scene.movements.get(thing.instance, ())
        for position, move in enumerate(record):
            if move.action == CONTAIN and move.other in index:
                end = _release(record, position, frames)
                inside[index[move.other], index[thing.instance], move.end : end + 1] = True
    return inside


def contained_frames(scene: Scene, frames: int) -> NDArray[np.bool_]:
    """Give (objects, frames): an object is under some cone."""
    contained: NDArray[np.bool_] = np.any(containments(scene, frames), axis=1)
    return contained


def carried_frames(scene: Scene, instance: str, frames: int) -> NDArray[np.bool_]:
    """Give (frames,): an object is under a cone that slides.

    Only the slides of the cone that covers it directly count. That does for nested cones too:
    what is inside another cone has the common slides in its own record.
    """
    carried = np.zeros(frames, dtype=np.bool_)
    for thing in scene.objects:
        if not thing.is_cone:
            continue
        record = scene.movements.get(thing.instance, ())
        for position, move in enumerate(record):
            if move.action != CONTAIN or move.other != instance:
                continue
            end = _release(record, position, frames)
            for later in record[position + 1 :]:
                if later.action == SLIDE and later.end <= end:
                    carried[later.start : later.end + 1] = True
    return carried


def hidden_by_others(
    labels: Labels, scene: Scene, ratio: float, target: str | None = None
) -> NDArray[np.bool_]:
    """Give (objects, frames): a nearer, larger, uncontained object covers too much of this one.

    Args:
        labels: The true boxes.
        scene: Objects and movements of the same video.
        ratio: The share of a box that has to be free for its object to be visible, in [0, 1]:
            0 hides only what is covered wholly.
        target: The key of the one object to look at; the rows of all others are left false.

    Raises:
        DatasetError: Scene and labels are not of the same video.
    """
    order = object_order(labels, scene)
    frames = labels.frames
    boxes = labels.boxes.astype(np.int64)
    places = np.stack([scene.objects[number].locations[:frames] for number in order])
    distances = np.linalg.norm(places - np.array(CAMERA_POINT), axis=2)
    areas = (boxes[..., 2] - boxes[..., 0] + 1) * (boxes[..., 3] - boxes[..., 1] + 1)
    free = ~contained_frames(scene, frames)[order]
    rows = range(len(order)) if target is None else [labels.keys.index(target)]
    hidden = np.zeros((len(order), frames), dtype=np.bool_)
    for row in rows:
        low = np.maximum(boxes[row, :, :2], boxes[:, :, :2])
        high = np.minimum(boxes[row, :, 2:], boxes[:, :, 2:])
        sides = np.maximum(high - low + 1, 0)
        shared = sides[..., 0] * sides[..., 1]
        covers = shared >= (1 - ratio) * np.minimum(areas[row], areas)
        behind = covers & (areas[row] < areas) & (distances[row] > distances) & free
        behind[row] = False
        hidden[row] = behind.any(axis=0)
    return hidden


def frame_masks(labels: Labels, scene: Scene) -> FrameMasks:
    """Derive which frames of a video have which label.

    Raises:
        DatasetError: Scene and labels are not of the same video, or it has no snitch.
    """
    frames = labels.frames
    snitch = next((thing for thing in scene.objects if thing.key == SNITCH_KEY), None)
    if snitch is None or SNITCH_KEY not in labels.keys:
        raise DatasetError("the video has no snitch", path=scene.image_filename)
    number = scene.objects.index(snitch)
    contained = contained_frames(scene, frames)[number]
    carried = carried_frames(scene, snitch.instance, frames) & contained
    row = labels.keys.index(SNITCH_KEY)
    visible = [
        ~hidden_by_others(labels, scene, ratio, SNITCH_KEY)[row] & ~contained
        for ratio in (0.0, 0.3, 0.99)
    ]
    return FrameMasks(contained, contained & ~carried, carried, *visible)


def perfect_perception(labels: Labels, scene: Scene, ratio: float = PERFECT_RATIO) -> Perception:
    """Derive what a perfect detector would report: the true boxes of all that can be seen.

    As in the published code, what is contained is left out by class: a second object of the
    class of a contained one is left out with it.

    Args:
        labels: The true boxes.
        scene: Objects and movements of the same video.
        ratio: The share of its box that an object has to show to be seen.

    Raises:
        DatasetError: Scene and labels are not of the same video, or a key has no class.
    """
    order = object_order(labels, scene)
    numbers = [class_of_key(key) for key in labels.keys]
    if None in numbers:
        key = labels.keys[numbers.index(None)]
        raise DatasetError("the detector has no class for it", path=scene.image_filename, key=key)
    classes = np.array(numbers, dtype=np.int64)
    contained = contained_frames(scene, labels.frames)[order]
    same_class = classes[:, None] == classes[None, :]
    left_out = (same_class[:, :, None] & contained[None, :, :]).any(axis=1)
    seen = ~left_out & ~hidden_by_others(labels, scene, ratio)
    boxes = labels.boxes.astype(np.int64)
    return Perception(
        tuple(boxes[seen[:, frame], frame] for frame in range(labels.frames)),
        tuple(classes[seen[:, frame]] for frame in range(labels.frames)),
    )


def object_order(labels: Labels, scene: Scene) -> list[int]:
    """Give, for each key of the labels, the number of its object in the scene.

    Raises:
        DatasetError: Scene and labels do not name the same objects, or the scene is shorter.
    """
    numbers = {thing.key: number for number, thing in enumerate(scene.objects)}
    if set(numbers) != set(labels.keys):
        odd = sorted(set(numbers) ^ set(labels.keys))
        raise DatasetError(
            f"scene and labels do not name the same objects; only one of them has {odd[0]}",
            path=scene.image_filename,
        )
    for thing in scene.objects:
        if len(thing.locations) < labels.frames:
            raise DatasetError(
                f"{thing.instance} has {len(thing.locations)} locations for {labels.frames} frames",
                path=scene.image_filename,
            )
    return [numbers[key] for key in labels.keys]


def _release(record: Sequence[Movement], position: int, frames: int) -> int:
    """Give the last frame at which a cone holds what the entry at a position covered."""
    later = (move.start for move in record[position + 1 :] if move.action == PICK_PLACE)
    return min(next(later, frames - 1), frames - 1)
