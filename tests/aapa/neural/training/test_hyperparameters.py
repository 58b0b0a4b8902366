"""What there is to choose, and how wrong choices are told."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

import pytest

from aapa import AnchoringError
from aapa.neural.training.hyperparameters import (
    Hyperparameters,
    Stage,
    hyperparameters_of,
    read_hyperparameters,
)

RECIPES = Path(str(files("aapa.neural.training"))) / "recipes"


def test_the_published_recipe_is_the_default():
    assert read_hyperparameters(RECIPES / "published.yaml") == Hyperparameters()
    published = Hyperparameters()
    assert (published.batch, published.epochs, published.learning_rate) == (16, 160, 1e-3)
    assert (published.schedule, published.factor, published.patience) == ("plateau", 0.8, 2)
    assert (published.guidance_weight, published.guidance_mode) == (100, "product")
    assert not published.shuffle
    assert not published.clip


@pytest.mark.parametrize("recipe", sorted(RECIPES.glob("*.yaml")), ids=lambda path: path.stem)
def test_every_recipe_can_be_read(recipe: Path):
    assert read_hyperparameters(recipe).epochs > 0


def test_they_come_back_from_json():
    choice = Hyperparameters(
        stages=(Stage(2, 60, 5, 0.5, boxes=False), Stage(1)), perceptions=("od", "pp")
    )
    assert hyperparameters_of(choice.to_json()) == choice


def test_an_epoch_belongs_to_a_stage():
    choice = Hyperparameters(stages=(Stage(2, 50), Stage(1, 0)))
    assert [choice.stage(epoch).frames for epoch in range(4)] == [50, 50, 0, 0]
    assert choice.epochs == 3


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("bach: 3", "there is no hyper-parameter 'bach'; did you mean batch?"),
        ("zzz: 3", "known are batch, stages"),
        ("batch: 0", "batch is 0; it has to be from 1 to 4096"),
        ("batch: 1.5", "batch is 1.5; expected a whole number"),
        ("batch: yes", "batch is True; expected a whole number"),
        ("learning_rate: fast", "learning_rate is 'fast'; expected a number"),
        ("learning_rate: .nan", "learning_rate is nan; it has to be above 0"),
        ("learning_rate: 0", "it has to be above 0, and at most 1"),
        ("clip: .inf", "clip is inf"),
        ("shuffle: 1", "shuffle is 1; expected true or false"),
        ("schedule: cosine", "schedule is 'cosine'; it has to be plateau or linear"),
        ("guidance_mode: loud", "guidance_mode is 'loud'; it has to be product, softmax"),
        ("perceptions: od", "perceptions is 'od'; expected a list"),
        ("perceptions: []", "it has to be some of od, pp"),
        ("perceptions: [xy]", "it has to be some of od, pp"),
        ("stages: []", "expected a list such as [{epochs: 160}]"),
        ("stages: [3]", "3 has to have epochs"),
        ("stages: [{frames: 3}]", "does not say how many epochs"),
        ("stages: [{epochs: 0}]", "it has to be at least one"),
        ("stages: [{epochs: 1, step: 0}]", "it has to be at least one"),
        ("stages: [{epochs: 1, frames: 1.5}]", "frames is 1.5; expected a whole number"),
        ("stages: [{epochs: 1, teach: -1}]", "it has to be at least one"),
        ("stages: [{epochs: 1, boxes: false}]", "boxes or teach"),
        ("- 1", "expected the names of hyper-parameters"),
        ("{", "is no YAML"),
    ],
)
def test_what_is_wrong_is_told(tmp_path: Path, text: str, said: str):
    path = tmp_path / "own.yaml"
    path.write_text(text)
    with pytest.raises(AnchoringError) as refused:
        read_hyperparameters(path)
    assert said in str(refused.value)
    assert str(path) in str(refused.value)


def test_an_empty_file_is_the_published_recipe_and_a_missing_one_is_told(tmp_path: Path):
    (tmp_path / "own.yaml").touch()
    assert read_hyperparameters(tmp_path / "own.yaml") == Hyperparameters()
    with pytest.raises(AnchoringError, match="cannot be read: No such file"):
        read_hyperparameters(tmp_path / "other.yaml")
