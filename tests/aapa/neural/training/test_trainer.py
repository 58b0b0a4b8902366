"""Trainings of small networks on small videos."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import torch

from aapa import AnchoringError
from aapa.errors import DatasetError
from aapa.neural import Guidance, load_checkpoint
from aapa.neural.training.arrays import Seen, TrainingArrays
from aapa.neural.training.hyperparameters import Hyperparameters, Stage
from aapa.neural.training.state import Point, Progress
from aapa.neural.training.trainer import Trainer, Training

Make = Callable[[int, int], TrainingArrays]
SIZES = {"who_hidden": 8, "where_hidden": 12}
QUICK = Hyperparameters(batch=4, stages=(Stage(3),), learning_rate=0.01, shuffle=True, clip=1)


@pytest.fixture
def training(tmp_path: Path) -> Training:
    return Training("opnet", QUICK, tmp_path / "net.safetensors", seed=3, sizes=SIZES)


def test_a_training_lowers_the_loss_and_places_the_snitch_better(training: Training, arrays: Make):
    longer = replace(QUICK, stages=(Stage(60),), schedule="linear")
    trainer = Trainer(replace(training, hyperparameters=longer), arrays(32, 1), arrays(8, 2))
    curve = trainer.run().curve
    losses = [point.loss for point in curve]
    assert losses[-1] < 0.1 * losses[0]
    assert curve[-1].score > curve[0].score + 10


def test_guidance_is_learned_to_be_used(training: Training, arrays: Make):
    longer = replace(QUICK, stages=(Stage(12),), guidance_weight=10)
    guided = replace(training, network="opnet-aa", hyperparameters=longer)
    trainer = Trainer(guided, arrays(32, 1), arrays(8, 2))
    curve = trainer.run().curve
    assert curve[-1].loss < 0.35 * curve[0].loss
    model, meta = load_checkpoint(guided.out)
    assert meta.guidance == Guidance(10, "product")
    assert sum(p.numel() for p in model.parameters()) == meta.recipe["parameters"]


def test_taught_the_attention_goes_where_it_is_told(training: Training, arrays: Make):
    def attention(teach: float) -> float:
        choice = replace(QUICK, stages=(Stage(10, teach=teach),))
        trainer = Trainer(replace(training, hyperparameters=choice), arrays(32, 1), arrays(4, 2))
        trainer.run()
        features = torch.from_numpy(arrays(4, 2).seen["od"].tables / np.float32([1] * 6)) / 300
        with torch.inference_mode():
            return float(trainer.model.who(features)[:, 15, 1].mean())

    assert attention(5.0) > attention(0.0) + 0.2


class Interrupted(Exception):  # noqa: N818 - it is no error
    pass


def weights(trainer: Trainer) -> dict[str, torch.Tensor]:
    return {name: tensor.clone() for name, tensor in trainer.model.state_dict().items()}


def timeless(progress: Progress) -> Progress:
    curve = tuple(replace(point, seconds=0.0) for point in progress.curve)
    return replace(progress, curve=curve, seconds=0.0)


@pytest.mark.parametrize("stop_at", [2, 4, 9])
@pytest.mark.parametrize("network", ["opnet-aa", "transformer-lstm"])
def test_interrupted_and_gone_on_with_it_ends_bit_for_bit_the_same(
    training: Training, arrays: Make, stop_at: int, network: str
):
    sizes = SIZES
    if network == "transformer-lstm":  # it leaves values out at random while it learns
        sizes = {"slot_hidden": 4, "feedforward": 4, "layers": 1, "hidden": 6}
    training = replace(training, network=network, sizes=sizes)
    train, dev = arrays(14, 1), arrays(4, 2)
    straight = Trainer(training, train, dev)
    straight.run()

    interrupted = Trainer(training, train, dev)
    done = 0

    def stop(_progress: Progress) -> None:
        nonlocal done
        done += 1
        if done == stop_at:
            interrupted.save()
            raise Interrupted

    with pytest.raises(Interrupted):
        interrupted.run(stop)
    going_on = Trainer(training, train, dev)
    going_on.resume()
    torch.rand(5)  # whatever else draws random numbers meanwhile
    going_on.run()
    assert timeless(going_on.progress) == timeless(straight.progress)
    for name, tensor in weights(straight).items():
        assert torch.equal(tensor, weights(going_on)[name]), name


def test_the_same_seed_gives_the_same_network_and_another_another(training: Training, arrays: Make):
    def trained(seed: int) -> dict[str, torch.Tensor]:
        trainer = Trainer(replace(training, seed=seed), arrays(8, 1), arrays(4, 2))
        trainer.run()
        return weights(trainer)

    first, again, other = trained(3), trained(3), trained(4)
    assert all(torch.equal(first[name], again[name]) for name in first)
    assert not torch.equal(first["box.weight"], other["box.weight"])


def test_the_best_on_the_dev_split_is_kept(training: Training, arrays: Make):
    wild = replace(QUICK, stages=(Stage(6),), learning_rate=0.3)
    points: list[Point] = []
    trainer = Trainer(replace(training, hyperparameters=wild), arrays(16, 1), arrays(4, 2))
    progress = trainer.run(on_epoch=points.append)
    best = max(points, key=lambda point: point.score)
    assert progress.best == best
    _, meta = load_checkpoint(training.out)
    assert meta.recipe["epoch"] == best.epoch
    assert meta.recipe["scores"] == {"od": list(best.scores["od"])}
    recipe = json.loads(training.recipe_file.read_text())
    assert (recipe["network"], recipe["recipe"]) == ("opnet", meta.recipe)


def test_it_ends_when_the_dev_split_is_no_longer_better(training: Training, arrays: Make):
    still = replace(QUICK, stages=(Stage(50),), learning_rate=1e-12, stop_after=2)
    trainer = Trainer(replace(training, hyperparameters=still), arrays(8, 1), arrays(4, 2))
    progress = trainer.run()
    assert trainer.stopped_early
    assert progress.best is not None
    assert progress.epoch == progress.best.epoch + 3 < 50


def test_the_curve_has_a_line_an_epoch(training: Training, arrays: Make):
    Trainer(training, arrays(8, 1), arrays(4, 2)).run()
    lines = training.curve_file.read_text().splitlines()
    assert lines[0] == (
        "epoch,updates,loss,rate,od_overall,od_visible,od_occluded,od_contained,od_carried,cpu_s"
    )
    assert [line.split(",")[:2] for line in lines[1:]] == [["0", "2"], ["1", "4"], ["2", "6"]]


def test_it_may_begin_with_another(training: Training, arrays: Make):
    Trainer(training, arrays(8, 1), arrays(4, 2)).run()
    begun = Trainer(
        replace(training, network="opnet-aa", begin_with=training.out), arrays(8, 1), arrays(4, 2)
    )
    model, before = load_checkpoint(training.out)
    assert all(torch.equal(weights(begun)[n], t) for n, t in model.state_dict().items())
    begun.run()
    recipe = load_checkpoint(training.out)[1].recipe
    assert recipe["begun_with"] == training.out.name
    assert recipe["before"] == before.recipe
    with pytest.raises(AnchoringError, match="is a network of other sizes"):
        Trainer(
            replace(training, sizes={"who_hidden": 9, "where_hidden": 12}, begin_with=training.out),
            arrays(8, 1),
            arrays(4, 2),
        )


def test_another_training_is_not_gone_on_with(training: Training, arrays: Make):
    first = Trainer(training, arrays(8, 1), arrays(4, 2))
    first.save()
    other = Trainer(replace(training, seed=4), arrays(8, 1), arrays(4, 2))
    with pytest.raises(DatasetError, match=r"seed: .* had 3, this one has 4; train without"):
        other.resume()
    fewer = Trainer(training, arrays(7, 1), arrays(4, 2))
    with pytest.raises(DatasetError, match="videos: "):
        fewer.resume()


def test_what_is_no_interrupted_training_is_told(training: Training, arrays: Make):
    trainer = Trainer(training, arrays(8, 1), arrays(4, 2))
    with pytest.raises(DatasetError, match="cannot be read"):
        trainer.resume()
    trainer.run()
    training.state_file.write_bytes(training.out.read_bytes())
    with pytest.raises(DatasetError, match="is no interrupted training"):
        trainer.resume()


def test_a_loss_that_is_no_number_ends_it_in_words(training: Training, arrays: Make):
    trainer = Trainer(training, arrays(8, 1), arrays(4, 2))
    with torch.no_grad():
        trainer.model.box.weight.fill_(float("nan"))
    with pytest.raises(AnchoringError, match="the loss of update 0 is nan; a smaller"):
        trainer.run()


def test_without_a_snitch_there_is_nothing_to_learn(training: Training, arrays: Make):
    made = arrays(4, 1)
    seen = made.seen["od"]
    none = Seen(seen.tables, seen.tracked, np.full(4, -1, dtype=np.int16))
    blind = TrainingArrays(made.boxes, made.labels, {"od": none})
    with pytest.raises(AnchoringError, match=r"never seen in any video \(od\)"):
        Trainer(training, blind, made)
    with pytest.raises(AnchoringError, match="there is no video to train on"):
        Trainer(training, made.part(0, 0), made)


def test_the_attention_may_be_learned_first_and_alone(training: Training, arrays: Make):
    stages = (Stage(2, step=2, teach=1, boxes=False), Stage(1, teach=1), Stage(1))
    choice = replace(QUICK, stages=stages)
    training = replace(training, hyperparameters=choice)
    straight = Trainer(training, arrays(14, 1), arrays(4, 2))
    before = weights(straight)
    points: list[Point] = []

    def look(point: Point) -> None:
        points.append(point)
        changed = not torch.equal(before["box.weight"], straight.model.state_dict()["box.weight"])
        assert changed == (point.epoch >= 2)
        assert training.out.exists() == (point.epoch >= 2)

    straight.run(on_epoch=look)
    assert [bool(point.scores) for point in points] == [False, False, True, True]
    lines = training.curve_file.read_text().splitlines()
    assert lines[1].split(",")[4:-1] == [""] * 5

    stopped = Trainer(training, arrays(14, 1), arrays(4, 2))

    def stop(progress: Progress) -> None:
        if progress.epoch == 1:
            stopped.save()
            raise Interrupted

    with pytest.raises(Interrupted):
        stopped.run(stop)
    going_on = Trainer(training, arrays(14, 1), arrays(4, 2))
    going_on.resume()
    going_on.run()
    for name, tensor in weights(straight).items():
        assert torch.equal(tensor, weights(going_on)[name]), name
