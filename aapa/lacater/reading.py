"""Reads a data set in the published layout, a video at a time, and checks what it reads."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from aapa.errors import AnchoringError, DatasetError
from aapa.lacater.camera import CALIBRATION_FILE, FloorCamera, camera_at, read_camera
from aapa.lacater.frame_lists import mask_of, read_frame_list
from aapa.lacater.label_rules import frame_masks, perfect_perception
from aapa.lacater.labels_file import check_resolution, read_labels
from aapa.lacater.layout import (
    FRAME_LISTS,
    PerceptionKind,
    exact_boxes_path,
    frame_lists_folder,
    labels_path,
    perception_path,
    scene_path,
    video_of_labels,
)
from aapa.lacater.perception_file import read_perception
from aapa.lacater.scene import Scene
from aapa.lacater.scene_file import read_scene
from aapa.lacater.video import FrameMasks, Labels, Perception, Video


class Dataset:
    """A folder in the published layout, such as `test_data/`.

    Args:
        root: The folder that `labels/` lies in.

    Raises:
        DatasetError: It holds no labels.
    """

    def __init__(self, root: Path) -> None:
        self.root = root
        self.videos = _videos(root)

    def video(self, name: str) -> Video:
        """Read one video; its frame lists are derived from the scene where there are none.

        Raises:
            DatasetError: A file of it is missing, malformed, or contradicts another.
        """
        labels = read_labels(labels_path(self.root, name))
        scene = self.scene(name)
        if scene is not None:
            check_resolution(labels, scene, labels_path(self.root, name))
        return Video(
            name,
            labels,
            self._masks(name, labels, scene),
            scene,
            self._exact_boxes(name, labels),
        )

    def scene(self, name: str) -> Scene | None:
        """Read a video's scene, or give None where the data set has no scenes at all.

        Raises:
            DatasetError: The scene is missing while others are there, or is malformed.
        """
        path = scene_path(self.root, name)
        return read_scene(path) if path.parent.is_dir() else None

    def camera(self, scene: Scene | None) -> FloorCamera | None:
        """Give the camera of a video: the calibration beside the labels, or what its scene says.

        None where neither says it, or where the scene's camera does not look down on the floor.

        Raises:
            DatasetError: There is a calibration, but it is malformed.
        """
        if self._calibration is not None or scene is None or scene.camera is None:
            return self._calibration
        try:
            return camera_at(scene.camera)
        except AnchoringError:
            return None

    def perception(self, video: Video, kind: PerceptionKind) -> Perception:
        """Read what a detector reported; perfect perception is derived where it has no folder.

        Raises:
            DatasetError: The detections are missing, malformed, or not of this video.
        """
        path = perception_path(self.root, video.name, kind)
        if kind is PerceptionKind.PP and not path.parent.is_dir():
            if video.scene is None:
                raise DatasetError(
                    "perfect perception cannot be derived without the folder scenes/",
                    path=str(path.parent),
                )
            return perfect_perception(video.labels, video.scene)
        perception = read_perception(path)
        if perception.frames != video.labels.frames:
            raise DatasetError(
                f"has {perception.frames} frames, the labels have {video.labels.frames}",
                path=str(path),
            )
        return perception

    @cached_property
    def _calibration(self) -> FloorCamera | None:
        path = self.root / CALIBRATION_FILE
        return read_camera(path) if path.is_file() else None

    def _masks(self, name: str, labels: Labels, scene: Scene | None) -> FrameMasks:
        folder = frame_lists_folder(self.root)
        if labels.snitch is None:
            raise DatasetError("the video has no snitch", path=str(labels_path(self.root, name)))
        if not folder.is_dir():
            if scene is None:
                raise DatasetError(
                    "frame lists cannot be derived without the folder scenes/", path=str(folder)
                )
            return frame_masks(labels, scene)
        masks = {}
        for field, lists in self._frame_lists.items():
            file = str(folder / FRAME_LISTS[field])
            if name not in lists:
                raise DatasetError(f"does not list {name}", path=file)
            try:
                masks[field] = mask_of(lists[name], labels.frames)
            except IndexError as error:
                raise DatasetError(
                    f"lists frame {max(lists[name])}; the labels have {labels.frames} frames",
                    path=file,
                    key=name,
                ) from error
        return _checked_masks(FrameMasks(**masks), folder, name)

    @cached_property
    def _frame_lists(self) -> Mapping[str, Mapping[str, tuple[int, ...]]]:
        folder = frame_lists_folder(self.root)
        return {field: read_frame_list(folder / file) for field, file in FRAME_LISTS.items()}

    def _exact_boxes(self, name: str, labels: Labels) -> NDArray[np.float64] | None:
        path = exact_boxes_path(self.root, name)
        if not path.parent.is_dir():
            return None
        try:
            boxes = np.load(path, allow_pickle=False)
        except OSError as error:
            raise DatasetError(f"cannot be read: {error}", path=str(path)) from error
        except (ValueError, EOFError) as error:
            raise DatasetError("is no whole array of numbers", path=str(path)) from error
        if boxes.shape != labels.boxes.shape or not np.isfinite(boxes).all():
            raise DatasetError(
                f"expected {labels.boxes.shape} finite numbers, found {boxes.shape}",
                path=str(path),
            )
        exact: NDArray[np.float64] = boxes.astype(np.float64)
        return exact


def _videos(root: Path) -> tuple[str, ...]:
    folder = root / "labels"
    if not folder.is_dir():
        found = sorted(child.parent.name for child in root.glob("*/labels"))
        hint = f"; did you mean {root / found[0]}?" if found else ""
        raise DatasetError(f"there is no folder labels/ in it{hint}", path=str(root))
    names = (video_of_labels(path) for path in folder.iterdir())
    videos = tuple(sorted(name for name in names if name is not None))
    if not videos:
        raise DatasetError("holds no …_bb.json", path=str(folder))
    return videos


def _checked_masks(masks: FrameMasks, folder: Path, name: str) -> FrameMasks:
    if not (masks.containment == (masks.contained | masks.carried)).all():
        raise DatasetError(
            "contained and carried frames do not add up to the frames of containment",
            path=str(folder),
            key=name,
        )
    if (masks.contained & masks.carried).any() or (masks.visible & masks.containment).any():
        raise DatasetError("a frame has two labels", path=str(folder), key=name)
    return masks
