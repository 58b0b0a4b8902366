"""The networks that come along, on videos they have never seen."""

from __future__ import annotations

import csv
import json
from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest

from aapa.lacater import PerceptionKind
from aapa.lacater.classes import class_of_key
from aapa.lacater.generator import DetectorNoise
from aapa.lacater.generator.video import GeneratedVideo, generate_video
from aapa.lacater.label_rules import containments
from aapa.lacater.metric import iou
from aapa.neural import (
    attention_weights,
    load_checkpoint,
    predict,
    slot_classes,
    tensor_of,
    tracked_slots,
)
from aapa.neural.checkpoints import Meta
from aapa.neural.models import parameter_count

WEIGHTS = Path(str(files("aapa.neural"))) / "weights"
NAMES = sorted(path.stem for path in WEIGHTS.glob("*.safetensors"))
SEED = 77_000
EVALUATED = {0, 1, 2}


@pytest.fixture(scope="module")
def videos() -> list[GeneratedVideo]:
    """Six in which the snitch is contained, and for a while carried."""
    made = (generate_video(SEED, number, DetectorNoise()) for number in range(200))
    hard = (one for one in made if one.video.masks.carried.sum() > 20)
    return [next(hard) for _ in range(6)]


def told_slots(made: GeneratedVideo, classes: tuple[int, ...]) -> np.ndarray:
    """The slot of the outermost cone over the snitch, from the labels' rules."""
    scene = made.video.scene
    assert scene is not None
    inside = containments(scene, 300)
    numbers = []
    for frame in range(300):
        thing = 0
        while inside[thing, :, frame].any():
            thing = int(inside[thing, :, frame].argmax())
        numbers.append(class_of_key(scene.objects[thing].key))
    return tracked_slots(np.array(numbers), classes)


def overlaps(name: str, videos: list[GeneratedVideo], *, told: bool) -> dict[str, float]:
    model, _ = load_checkpoint(WEIGHTS / f"{name}.safetensors")
    by_task: dict[str, list[float]] = {"visible": [], "contained": [], "carried": []}
    for made in videos:
        perception = made.perceptions[PerceptionKind.PP]
        weights = None
        if told:
            weights = attention_weights(told_slots(made, slot_classes(perception)))
        boxes = predict(model, tensor_of(perception), weights)
        boxes[:, 2:] = np.maximum(boxes[:, 2:], boxes[:, :2])
        snitch = made.video.labels.snitch
        assert snitch is not None
        values = iou(boxes, snitch.astype(float))
        for task, found in by_task.items():
            found.append(float(values[getattr(made.video.masks, task)].mean()))
    return {task: float(np.mean(found)) for task, found in by_task.items()}


def test_both_come_along():
    assert NAMES == ["opnet", "opnet-aa"]


@pytest.mark.parametrize("name", NAMES)
def test_a_file_is_small_and_says_how_it_was_made(name: str):
    path = WEIGHTS / f"{name}.safetensors"
    assert path.stat().st_size < 3_000_000
    model, meta = load_checkpoint(path)
    assert meta.network == name
    assert parameter_count(model) == 1_421_056
    recipe = meta.recipe
    assert recipe["videos"] == 9300
    for data in (recipe["train_data"], recipe["dev_data"]):
        seed = int(data.split("--seed ")[1])
        assert seed not in EVALUATED | {SEED}
    beside = json.loads(path.with_suffix(".json").read_text())
    assert Meta(beside["network"], beside["sizes"], meta.guidance, beside["recipe"]) == meta
    curve = list(csv.DictReader(path.with_suffix(".csv").read_text().splitlines()))
    scores = {float(line["od_overall"]) for line in curve if line["od_overall"]}
    assert min(abs(found - recipe["scores"]["od"][0]) for found in scores) < 0.01


def test_opnet_finds_what_is_seen(videos: list[GeneratedVideo]):
    assert overlaps("opnet", videos, told=False)["visible"] > 0.7


def test_opnet_aa_finds_what_is_carried_if_it_is_told_whom_to_look_at(
    videos: list[GeneratedVideo],
):
    told = overlaps("opnet-aa", videos, told=True)
    untold = overlaps("opnet-aa", videos, told=False)
    assert min(told.values()) > 0.7
    assert untold["carried"] < told["carried"] - 0.3
