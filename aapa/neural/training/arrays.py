"""A data set as arrays on disk, made once, so that training reads what it needs and no more.

A video takes 56 kB for each detector: 9,300 of them half a gigabyte, of which only the pages of
the present batch have to be in memory.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import DTypeLike, NDArray

from aapa.errors import AnchoringError, DatasetError
from aapa.lacater.layout import PerceptionKind
from aapa.lacater.metric import first_sighting
from aapa.lacater.reading import Dataset
from aapa.lacater.video import FrameMasks, Perception, Video
from aapa.neural.features import FEATURES, SLOTS, slot_classes, slot_table
from aapa.neural.guidance import tracked_slots

MANIFEST: Final = "arrays.json"
"""Says what the arrays are of; written last, so that without it they are not whole."""

LABELS: Final = ("visible", "occluded", "contained", "carried")
"""What the numbers in `labels` mean."""

_FORMAT = 1

LookedAt = Callable[[Video], NDArray[np.integer]]
"""Gives (frames,) the class of what is to be looked at to know where the snitch is."""


@dataclass(frozen=True, slots=True, eq=False)
class Seen:
    """What one detector reported of all videos.

    Args:
        tables: (videos, frames, 15, 6) whole numbers, see `features.slot_table`.
        tracked: (videos, frames) v, the slot to follow, or below 0.
        first: (videos,) the frame in which the snitch is first seen, or below 0.
    """

    tables: NDArray[np.int16]
    tracked: NDArray[np.int8]
    first: NDArray[np.int16]


@dataclass(frozen=True, slots=True, eq=False)
class TrainingArrays:
    """All videos of a data set, on disk.

    Args:
        boxes: (videos, frames, 4) the snitch's true boxes, whole px.
        labels: (videos, frames) indices into `LABELS`.
        seen: What each detector reported.
    """

    boxes: NDArray[np.int16]
    labels: NDArray[np.uint8]
    seen: Mapping[str, Seen]

    def part(self, first: int, last: int) -> TrainingArrays:
        """Give the videos from one number up to another, that one left out; nothing is copied."""
        rows = slice(first, last)
        return TrainingArrays(
            self.boxes[rows],
            self.labels[rows],
            {
                kind: Seen(seen.tables[rows], seen.tracked[rows], seen.first[rows])
                for kind, seen in self.seen.items()
            },
        )

    @property
    def videos(self) -> int:
        """How many there are."""
        return len(self.boxes)

    @property
    def frames(self) -> int:
        """How many frames each has."""
        return int(self.boxes.shape[1])


def open_arrays(folder: Path, kinds: Sequence[str]) -> TrainingArrays:
    """Open what `build_arrays` made; nothing is read yet.

    Raises:
        DatasetError: They are missing, not whole, or contradict each other.
    """
    read_manifest(folder)
    try:
        arrays = TrainingArrays(
            np.load(folder / "snitch.npy", mmap_mode="r"),
            np.load(folder / "labels.npy", mmap_mode="r"),
            {
                kind: Seen(
                    np.load(folder / f"{kind}_table.npy", mmap_mode="r"),
                    np.load(folder / f"{kind}_tracked.npy", mmap_mode="r"),
                    np.load(folder / f"{kind}_first.npy", mmap_mode="r"),
                )
                for kind in kinds
            },
        )
    except (OSError, ValueError) as error:
        raise DatasetError(f"the arrays cannot be read: {error}", path=str(folder)) from error
    frames = arrays.boxes.shape[:2]
    fitting = arrays.labels.shape == frames and all(
        seen.tables.shape == (*frames, SLOTS, FEATURES)
        and seen.tracked.shape == frames
        and seen.first.shape == frames[:1]
        for seen in arrays.seen.values()
    )
    if not fitting:
        raise DatasetError("the arrays are not of the same videos", path=str(folder))
    return arrays


def read_manifest(folder: Path) -> dict[str, object]:
    """Give what the arrays in a folder are of.

    Raises:
        DatasetError: There are none, or they are of another format.
    """
    path = folder / MANIFEST
    try:
        manifest = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise DatasetError("there are no arrays", path=str(folder)) from error
    except ValueError as error:
        raise DatasetError("is damaged; remove the folder", path=str(path)) from error
    if not isinstance(manifest, dict) or manifest.get("format") != _FORMAT:
        raise DatasetError("is of another format; remove the folder", path=str(path))
    return manifest


def build_arrays(
    folder: Path,
    dataset: Dataset,
    looked_at: LookedAt,
    source: str,
    progress: Callable[[int, int], None],
) -> None:
    """Write the arrays of a data set, unless they are there already.

    Args:
        folder: Where to; made if need be.
        dataset: Labels, scenes and detections; all videos have to be of the same length.
        looked_at: What is to be looked at in a video, by class.
        source: What the arrays rest on besides the data set's files, such as the text of a domain.
        progress: Told how many videos are done, and of how many.

    Raises:
        DatasetError: A video cannot be read, or has another length; the folder cannot be written.
    """
    wanted: dict[str, object] = {
        "format": _FORMAT,
        "source": source,
        "videos": list(dataset.videos),
    }
    try:
        if read_manifest(folder) == wanted:
            return
    except DatasetError:
        pass  # not there, or of another time: made anew
    try:
        folder.mkdir(parents=True, exist_ok=True)
        (folder / MANIFEST).unlink(missing_ok=True)
        _fill(folder, dataset, looked_at, progress)
        (folder / MANIFEST).write_text(json.dumps(wanted), encoding="utf-8")
    except OSError as error:
        raise DatasetError(f"cannot be written: {error.strerror}", path=str(folder)) from error


def _fill(
    folder: Path, dataset: Dataset, looked_at: LookedAt, progress: Callable[[int, int], None]
) -> None:
    count = len(dataset.videos)
    frames = dataset.video(dataset.videos[0]).labels.frames

    def array(name: str, dtype: DTypeLike, *shape: int) -> NDArray[np.generic]:
        return np.lib.format.open_memmap(
            folder / f"{name}.npy", mode="w+", dtype=dtype, shape=(count, *shape)
        )

    boxes, labels = array("snitch", np.int16, frames, 4), array("labels", np.uint8, frames)
    seen = {
        kind: (
            array(f"{kind}_table", np.int16, frames, SLOTS, FEATURES),
            array(f"{kind}_tracked", np.int8, frames),
            array(f"{kind}_first", np.int16),
        )
        for kind in PerceptionKind
    }
    for number, name in enumerate(dataset.videos):
        video = dataset.video(name)
        snitch = video.labels.snitch
        if snitch is None or len(snitch) != frames:
            raise DatasetError(
                f"{name} has {video.labels.frames} frames, the first video has {frames}; to "
                "train, all need the same length",
                path=str(dataset.root),
            )
        boxes[number], labels[number] = snitch, label_numbers(video.masks)
        classes = looked_at(video)
        for kind, (tables, tracked, first) in seen.items():
            perception = dataset.perception(video, kind)
            tables[number] = slot_table(perception)
            tracked[number] = tracked_slots(classes, slot_classes(perception))
            first[number] = _first(perception)
        progress(number + 1, count)


def label_numbers(masks: FrameMasks) -> NDArray[np.uint8]:
    """Give (frames,) indices into `LABELS`."""
    chosen = np.select([masks.visible, masks.occluded, masks.contained], [0, 1, 2], 3)
    numbers: NDArray[np.uint8] = chosen.astype(np.uint8)
    return numbers


def _first(perception: Perception) -> int:
    first = first_sighting(perception)
    return -1 if first is None else first


def checked_kinds(arrays: TrainingArrays, kinds: Sequence[str]) -> None:
    """Make sure that there is something to learn from. Raises AnchoringError."""
    if not arrays.videos:
        raise AnchoringError("there is no video to train on")
    for kind in kinds:
        if not (arrays.seen[kind].first >= 0).any():
            raise AnchoringError(f"the snitch is never seen in any video ({kind})")
