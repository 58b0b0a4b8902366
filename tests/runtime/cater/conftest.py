"""A data set of a few short videos, in which a cone covers the snitch and slides away with it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from aapa.lacater import (
    Labels,
    Movement,
    PerceptionKind,
    Scene,
    SceneObject,
    Video,
    frame_masks,
    perfect_perception,
    write_frame_lists,
    write_video,
)

FRAMES = 40


def _thing(
    instance: str, kind: tuple[str, str, str, str], box: np.ndarray, height: float
) -> SceneObject:
    size, color, shape, material = kind
    x, y = (box[0, 0] + box[0, 2]) / 2, (box[0, 1] + box[0, 3]) / 2
    place = (0.0, 0.0, 0.3) if instance == "Spl_0" else (2.0, -2.0, height)
    return SceneObject(
        instance,
        shape,
        size,
        color,
        material,
        0.3,
        0.0,
        place,
        (x, y, 9.0),
        np.tile(np.array(place), (FRAMES + 1, 1)),
    )


def short_video(number: int) -> Video:
    """A film: the cone comes from the right, covers the snitch, and slides left with it.

    It moves by `number` + 1 px a frame, so that every video has a score of its own.
    """
    step = number + 1
    snitch = np.tile([150, 120, 170, 140], (FRAMES, 1))
    cone = np.tile([140, 90, 182, 145], (FRAMES, 1))
    cone[:10] += [60, 0, 60, 0]
    for frame in range(21, 31):
        snitch[frame:, [0, 2]] -= step
        cone[frame:, [0, 2]] -= step
    cone[37:, [1, 3]] -= 80
    movements = {
        "Spl_0": (Movement("_slide", None, 20, 30),),
        "Cone_0": (
            Movement("_contain", "Spl_0", 5, 10),
            Movement("_slide", None, 20, 30),
            Movement("_pick_place", None, 36, 39),
        ),
    }
    things = (
        _thing("Spl_0", ("small", "gold", "spl", "metal"), snitch, 0.3),
        _thing("Cone_0", ("large", "green", "cone", "rubber"), cone, 0.9),
    )
    name = f"CLEVR_new_{number:06d}"
    scene = Scene(number, f"{name}.avi", things, movements)
    labels = Labels(tuple(t.key for t in things), np.stack([snitch, cone]).astype(np.int32))
    return Video(name, labels, frame_masks(labels, scene), scene, labels.boxes + 0.25)


@pytest.fixture
def dataset() -> Callable[[Path, int], Path]:
    """Writes a data set of so many videos into a folder."""

    def make(root: Path, count: int) -> Path:
        masks = {}
        for number in range(count):
            video = short_video(number)
            perception = perfect_perception(video.labels, video.scene)
            write_video(root, video, {PerceptionKind.PP: perception, PerceptionKind.OD: perception})
            masks[video.name] = video.masks
        write_frame_lists(root, masks)
        return root

    return make
