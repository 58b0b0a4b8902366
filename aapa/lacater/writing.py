"""Writes a data set in the published layout, a video at a time."""

from __future__ import annotations

import io
import json
import os
import pickle
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from aapa.errors import DatasetError
from aapa.lacater.frame_lists import format_frame_list
from aapa.lacater.layout import (
    FRAME_LISTS,
    PerceptionKind,
    exact_boxes_path,
    frame_lists_folder,
    labels_path,
    perception_path,
    scene_path,
)
from aapa.lacater.scene import Scene, SceneObject
from aapa.lacater.video import FrameMasks, Labels, Perception, Video


def write_video(
    root: Path, video: Video, perceptions: Mapping[PerceptionKind, Perception] | None = None
) -> None:
    """Write all files of one video but the frame lists, which hold every video.

    Each file appears whole or not at all, the labels last: where they are, all is.

    Args:
        root: The folder of the split; made if need be.
        video: Labels and, where given, scene and exact boxes. Its masks are not written here.
        perceptions: What each detector reported.

    Raises:
        DatasetError: A file cannot be written.
    """
    name = video.name
    for kind, perception in (perceptions or {}).items():
        _replace(perception_path(root, name, kind), _pickled(perception))
    if video.exact_boxes is not None:
        buffer = io.BytesIO()
        np.save(buffer, video.exact_boxes.astype(np.float32), allow_pickle=False)
        _replace(exact_boxes_path(root, name), buffer.getvalue())
    if video.scene is not None:
        _replace(scene_path(root, name), _json(_scene_entry(video.scene)))
    _replace(labels_path(root, name), _json(_labels_entry(video.labels)))


def write_frame_lists(root: Path, masks: Mapping[str, FrameMasks]) -> None:
    """Write the six frame lists, the videos in the order given.

    Raises:
        DatasetError: A file cannot be written.
    """
    folder = frame_lists_folder(root)
    for field, file in FRAME_LISTS.items():
        lists = {video: getattr(entry, field) for video, entry in masks.items()}
        _replace(folder / file, format_frame_list(lists).encode())


def _replace(path: Path, content: bytes) -> None:
    """Put a file in place in one step, so that nobody ever reads half of it."""
    partial = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        partial.write_bytes(content)
        partial.replace(path)
    except OSError as error:
        raise DatasetError(f"cannot be written: {error.strerror}", path=str(path)) from error


def _pickled(perception: Perception) -> bytes:
    frames = {
        "bb": [np.ascontiguousarray(boxes, dtype=np.int64) for boxes in perception.boxes],
        "labels": [np.ascontiguousarray(c, dtype=np.int64) for c in perception.classes],
    }
    return pickle.dumps(frames, protocol=4)


def _json(entry: object) -> bytes:
    return json.dumps(entry).encode()


def _labels_entry(labels: Labels) -> dict[str, object]:
    sized = labels.boxes.copy()
    sized[..., 2:] -= sized[..., :2]
    return dict(zip(labels.keys, sized.tolist(), strict=True))


def _scene_entry(scene: Scene) -> dict[str, object]:
    entry: dict[str, object] = {
        "split": scene.split,
        "image_index": scene.image_index,
        "image_filename": scene.image_filename,
        "objects": [_object_entry(thing) for thing in scene.objects],
        "directions": {name: list(vector) for name, vector in scene.directions.items()},
        "relationships": {
            name: [list(others) for others in lists] for name, lists in scene.relationships.items()
        },
        "movements": {
            instance: [[move.action, move.other, move.start, move.end] for move in moves]
            for instance, moves in scene.movements.items()
        },
    }
    if scene.camera is not None:
        entry["camera"] = list(scene.camera)
    return entry


def _object_entry(thing: SceneObject) -> dict[str, object]:
    return {
        "shape": thing.shape,
        "size": thing.size,
        "sized": thing.sized,
        "material": thing.material,
        "3d_coords": list(thing.coords_3d),
        "rotation": thing.rotation,
        "pixel_coords": list(thing.pixel_coords),
        "color": thing.color,
        "instance": thing.instance,
        "locations": {str(frame): place for frame, place in enumerate(thing.locations.tolist())},
    }
