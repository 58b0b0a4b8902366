"""A data set as arrays."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from aapa.errors import DatasetError
from aapa.lacater import Dataset, PerceptionKind, Video, write_video
from aapa.lacater.classes import SNITCH
from aapa.lacater.generator import DetectorNoise, Recipe, generate_dataset
from aapa.lacater.generator.video import generate_video
from aapa.lacater.metric import first_sighting
from aapa.neural import slot_classes, tracked_slots
from aapa.neural.features import slot_table
from aapa.neural.training.arrays import LABELS, build_arrays, open_arrays


@pytest.fixture(scope="module")
def dataset(tmp_path_factory: pytest.TempPathFactory) -> Dataset:
    root = tmp_path_factory.mktemp("data")
    generate_dataset(root, Recipe(5), 3, 1, lambda _done, _total: None)
    return Dataset(root)


def always_the_snitch(video: Video) -> np.ndarray:
    return np.full(video.labels.frames, SNITCH)


@pytest.fixture
def folder(tmp_path: Path, dataset: Dataset) -> Path:
    told: list[tuple[int, int]] = []
    build_arrays(tmp_path / "a", dataset, always_the_snitch, "x", lambda *n: told.append(n))
    assert told == [(1, 3), (2, 3), (3, 3)]
    return tmp_path / "a"


def test_they_hold_what_the_data_set_says(folder: Path, dataset: Dataset):
    arrays = open_arrays(folder, ("od", "pp"))
    assert (arrays.videos, arrays.frames) == (3, 300)
    for number, name in enumerate(dataset.videos):
        video = dataset.video(name)
        assert (arrays.boxes[number] == video.labels.snitch).all()
        for label, task in enumerate(LABELS):
            assert ((arrays.labels[number] == label) == getattr(video.masks, task)).all()
        for kind in PerceptionKind:
            perception = dataset.perception(video, kind)
            seen = arrays.seen[kind]
            assert (seen.tables[number] == slot_table(perception)).all()
            order = slot_classes(perception)
            assert (seen.tracked[number] == tracked_slots(always_the_snitch(video), order)).all()
            assert seen.first[number] == first_sighting(perception)


def test_they_lie_on_disk_and_are_not_read_before_they_are_needed(folder: Path):
    arrays = open_arrays(folder, ("od",))
    assert isinstance(arrays.seen["od"].tables, np.memmap)
    assert "pp" not in arrays.seen
    part = arrays.part(1, 3)
    assert part.videos == 2
    assert np.shares_memory(part.boxes, arrays.boxes)


def test_they_are_made_once_and_anew_when_what_they_rest_on_has_changed(
    folder: Path, dataset: Dataset
):
    told: list[int] = []

    def build(source: str) -> int:
        told.clear()
        build_arrays(folder, dataset, always_the_snitch, source, lambda n, _: told.append(n))
        return len(told)

    assert build("x") == 0
    assert build("y") == 3
    assert build("y") == 0
    (folder / "arrays.json").write_text("{")
    assert build("y") == 3


def test_what_is_not_whole_is_not_opened(folder: Path):
    (folder / "arrays.json").rename(folder / "kept.json")
    with pytest.raises(DatasetError, match="there are no arrays"):
        open_arrays(folder, ("od",))
    (folder / "arrays.json").write_text(json.dumps({"format": 9}))
    with pytest.raises(DatasetError, match="is of another format"):
        open_arrays(folder, ("od",))
    (folder / "kept.json").rename(folder / "arrays.json")
    np.save(folder / "labels.npy", np.zeros((2, 300), dtype=np.uint8))
    with pytest.raises(DatasetError, match="not of the same videos"):
        open_arrays(folder, ("od",))
    (folder / "labels.npy").write_bytes(b"no array")
    with pytest.raises(DatasetError, match="cannot be read"):
        open_arrays(folder, ("od",))


def test_a_video_of_another_length_is_named(tmp_path: Path):
    made = generate_video(5, 0, DetectorNoise())
    write_video(tmp_path, made.video, made.perceptions)
    labels = json.loads((tmp_path / "labels" / f"{made.video.name}_bb.json").read_text())
    shorter = {key: boxes[:200] for key, boxes in labels.items()}
    (tmp_path / "labels" / "CLEVR_new_000001_bb.json").write_text(json.dumps(shorter))
    scene = (tmp_path / "scenes" / f"{made.video.name}.json").read_text()
    (tmp_path / "scenes" / "CLEVR_new_000001.json").write_text(scene)
    shutil.rmtree(tmp_path / "exact_boxes")
    with pytest.raises(DatasetError, match="CLEVR_new_000001 has 200 frames, the first video has"):
        build_arrays(
            tmp_path / "a", Dataset(tmp_path), always_the_snitch, "x", lambda _done, _total: None
        )
