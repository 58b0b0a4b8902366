"""The how-to about training says what is so."""

from __future__ import annotations

import io
import json
import re
import sys
from contextlib import redirect_stdout
from importlib.resources import files
from pathlib import Path

import pytest
import yaml

from aapa.neural.models import NETWORKS, build_network, parameter_count
from aapa.neural.training.hyperparameters import Hyperparameters, hyperparameters_of
from runtime.cater.training import RECIPES, chosen_hyperparameters
from runtime.cli import main

PAGE = (Path(__file__).parents[3] / "docs" / "how-to" / "train.md").read_text(encoding="utf-8")
NEURAL = Path(str(files("aapa.neural")))


def test_the_table_has_every_network_and_its_size():
    rows = re.findall(r"^\| `([a-z-]+)` \| .* \| ([0-9,]+) \|$", PAGE, re.MULTILINE)
    assert {name: int(count.replace(",", "")) for name, count in rows} == {
        name: parameter_count(build_network(name)) for name in NETWORKS
    }


def test_the_yaml_can_be_used_and_names_everything_but_plateaus_numbers():
    text = re.search(r"```yaml\n(.*?)```", PAGE, re.DOTALL)
    assert text is not None
    values = yaml.safe_load(text[1])
    assert hyperparameters_of(values).epochs == 8
    left_out = set(Hyperparameters().to_json()) - set(values)
    assert left_out == {"factor", "patience"}


@pytest.mark.parametrize("recipe", RECIPES)
def test_every_recipe_is_there_and_told_of(recipe: str):
    assert f"`{recipe}`" in PAGE
    assert chosen_hyperparameters(recipe).epochs > 0


def help_of(name: str) -> str:
    out = io.StringIO()
    argv, sys.argv = sys.argv, ["icarus", "cater", name, "--help"]
    try:
        with redirect_stdout(out), pytest.raises(SystemExit):
            main()
    finally:
        sys.argv = argv
    return out.getvalue()


def test_its_commands_have_the_options_that_it_uses():
    lines = re.findall(r"^icarus cater ([a-z]+) (.*)$", PAGE, re.MULTILINE)
    assert len(lines) >= 8
    for name, rest in lines:
        known = set(re.findall(r"--[a-z-]+", help_of(name)))
        assert set(re.findall(r"--[a-z-]+", rest)) <= known, name


@pytest.mark.parametrize("name", ["opnet", "opnet-aa"])
def test_the_scores_are_those_of_the_weights(name: str):
    recipe = json.loads((NEURAL / "weights" / f"{name}.json").read_text())["recipe"]
    for kind in ("od", "pp"):
        assert " ".join(f"{score:.1f}" for score in recipe["scores"][kind]) in PAGE
