from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from aapa.errors import AnchoringError, DatasetError
from aapa.lacater import Dataset, PerceptionKind, frame_masks, perfect_perception
from aapa.lacater.generator import DetectorNoise, Recipe, generate_dataset, generate_video
from aapa.lacater.generator.dataset import RECIPE_FILE

RECIPE = Recipe(4)


def generate(root: Path, count: int, jobs: int = 1, recipe: Recipe = RECIPE) -> list[tuple]:
    told: list[tuple] = []
    generate_dataset(root, recipe, count, jobs, lambda done, total: told.append((done, total)))
    return told


def contents(root: Path) -> dict[str, bytes]:
    return {
        str(path.relative_to(root)): path.read_bytes()
        for path in sorted(root.rglob("*"))
        if path.is_file()
    }


@pytest.fixture(scope="module")
def whole(tmp_path_factory) -> Path:
    root = tmp_path_factory.mktemp("data") / "whole"
    generate(root, 10)
    return root


def test_the_layout_is_the_published_one(whole):
    names = [f"CLEVR_new_{number:06d}" for number in range(10)]
    for folder, ending in (
        ("labels", "_bb.json"),
        ("scenes", ".json"),
        ("od_perception", ".pkl"),
        ("perfect_perception", ".pkl"),
        ("exact_boxes", ".npy"),
    ):
        assert sorted(path.name for path in (whole / folder).iterdir()) == [
            name + ending for name in names
        ]
    assert len(list((whole / "containment_and_occlusions").iterdir())) == 6


def test_what_is_read_back_is_what_was_made(whole):
    dataset = Dataset(whole)
    for number, name in enumerate(dataset.videos[:3]):
        made, read = generate_video(4, number, RECIPE.noise), dataset.video(name)
        assert np.array_equal(made.video.labels.boxes, read.labels.boxes)
        assert made.video.exact_boxes == pytest.approx(read.exact_boxes, abs=1e-4)
        for field, mask in made.video.masks.named().items():
            assert np.array_equal(mask, read.masks.named()[field])
        assert made.video.scene.movements == read.scene.movements
        for kind in PerceptionKind:
            seen = dataset.perception(read, kind)
            for field in ("boxes", "classes"):
                for one, two in zip(
                    getattr(made.perceptions[kind], field), getattr(seen, field), strict=True
                ):
                    assert np.array_equal(one, two)


def test_labels_follow_from_what_is_in_the_files(whole):
    dataset = Dataset(whole)
    for name in dataset.videos:
        video = dataset.video(name)
        derived = frame_masks(video.labels, video.scene)
        for field, mask in video.masks.named().items():
            assert np.array_equal(mask, derived.named()[field])
        perfect = perfect_perception(video.labels, video.scene)
        kept = dataset.perception(video, PerceptionKind.PP)
        assert all(np.array_equal(a, b) for a, b in zip(perfect.boxes, kept.boxes, strict=True))


def test_the_bytes_depend_neither_on_the_number_of_processes_nor_on_that_of_videos(whole, tmp_path):
    told = generate(tmp_path / "two", 10, jobs=2)
    assert told[0] == (0, 10)
    assert told[-1] == (10, 10)
    assert contents(tmp_path / "two") == contents(whole)
    generate(tmp_path / "few", 2)
    generate(tmp_path / "few", 10)
    assert contents(tmp_path / "few") == contents(whole)


def test_an_interrupted_run_goes_on_where_it_stopped(whole, tmp_path):
    root = tmp_path / "again"
    generate(root, 10)
    # As if it had been killed: one video begun, half a file left, no frame lists yet.
    kept = root / "labels" / "CLEVR_new_000001_bb.json"
    before = kept.stat().st_mtime_ns
    (root / "labels" / "CLEVR_new_000004_bb.json").unlink()
    (root / "scenes" / "CLEVR_new_000004.json").write_text("{")
    (root / "labels" / ".CLEVR_new_000005_bb.json.123.part").write_text("[[1,")
    for path in (root / "containment_and_occlusions").iterdir():
        path.unlink()
    told = generate(root, 10)
    assert told == [(9, 10), (10, 10)]
    assert contents(root) == contents(whole)
    assert kept.stat().st_mtime_ns == before


def test_fewer_videos_than_there_are_leaves_all(whole, tmp_path):
    root = tmp_path / "more"
    generate(root, 10)
    assert generate(root, 3) == [(3, 3)]
    assert contents(root) == contents(whole)


def test_another_seed_or_noise_is_refused(tmp_path):
    generate(tmp_path / "one", 1)
    with pytest.raises(DatasetError, match=r"its videos have seed 4, not 5; choose another folder"):
        generate(tmp_path / "one", 1, recipe=Recipe(5))
    with pytest.raises(DatasetError, match="were made with other detector noise"):
        generate(tmp_path / "one", 1, recipe=Recipe(4, DetectorNoise(jitter_px=2)))


def test_a_folder_with_other_data_is_refused(tmp_path):
    (tmp_path / "labels").mkdir()
    with pytest.raises(DatasetError, match=r"which was not generated here; choose another folder"):
        generate(tmp_path, 1)


@pytest.mark.parametrize(
    ("content", "text"),
    [("{", "is damaged"), ('{"version": 0}', "written by another version"), ("[]", "version")],
)
def test_a_damaged_recipe_is_refused(tmp_path, content, text):
    (tmp_path / RECIPE_FILE).write_text(content)
    with pytest.raises(DatasetError, match=text):
        generate(tmp_path, 1)


def test_a_file_in_the_place_of_the_folder_is_refused(tmp_path):
    (tmp_path / "data").write_text("")
    with pytest.raises(DatasetError, match="cannot be used: "):
        generate(tmp_path / "data", 1)


def test_the_recipe_says_all(whole):
    recipe = json.loads((whole / RECIPE_FILE).read_text())
    assert recipe["seed"] == 4
    assert recipe["noise"]["jitter_px"] == DetectorNoise().jitter_px


def test_the_noise_changes_the_detections_alone():
    one = generate_video(4, 2, DetectorNoise())
    two = generate_video(4, 2, DetectorNoise(jitter_px=3))
    assert np.array_equal(one.video.labels.boxes, two.video.labels.boxes)
    for kind, same in ((PerceptionKind.PP, True), (PerceptionKind.OD, False)):
        boxes = [np.concatenate(made.perceptions[kind].boxes) for made in (one, two)]
        assert np.array_equal(*boxes) is same


def test_a_cone_of_class_0_is_never_seen_by_the_detector(whole):
    dataset = Dataset(whole)
    for name in dataset.videos:
        seen = dataset.perception(dataset.video(name), PerceptionKind.OD)
        assert 0 not in np.concatenate(seen.classes)


def test_a_negative_seed_and_too_many_videos_are_refused(tmp_path):
    with pytest.raises(AnchoringError, match="the seed is -1; it has to be at least 0"):
        Recipe(-1)
    for count in (0, 1_000_001):
        with pytest.raises(AnchoringError, match="there have to be 1 to 1000000"):
            generate(tmp_path / "none", count)
    assert not (tmp_path / "none").exists()
