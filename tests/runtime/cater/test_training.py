"""`icarus cater train`, and what leads up to it."""

from __future__ import annotations

import io
import sys
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path

import numpy as np
import pytest
import torch

from aapa.errors import DatasetError
from aapa.lacater import Dataset
from aapa.lacater.generator import Recipe, generate_dataset
from aapa.neural import load_checkpoint
from aapa.neural.training.arrays import open_arrays
from aapa.neural.training.hyperparameters import Hyperparameters
from runtime.cater.evaluate import cater_domain
from runtime.cater.training import Listener, Order, prepared_arrays, train
from runtime.cli import main
from runtime.errors import UsageError

QUICK = """
batch: 2
stages: [{epochs: 2, frames: 8}]
schedule: linear
perceptions: [pp]
"""


@pytest.fixture(scope="module", autouse=True)
def one_thread():
    before = torch.get_num_threads()
    torch.set_num_threads(1)
    yield
    torch.set_num_threads(before)


@pytest.fixture(scope="module")
def data(tmp_path_factory: pytest.TempPathFactory) -> Path:
    root = tmp_path_factory.mktemp("training") / "data"
    for split, seed, videos in (("train", 11, 4), ("val", 12, 2)):
        generate_dataset(root / split, Recipe(seed), videos, 1, lambda _done, _total: None)
    return root


@pytest.fixture
def config(tmp_path: Path) -> Path:
    path = tmp_path / "quick.yaml"
    path.write_text(QUICK)
    return path


def icarus(*args: str | Path) -> tuple[int, str, str]:
    out, err = io.StringIO(), io.StringIO()
    argv, sys.argv = sys.argv, ["icarus", "cater", "train", *map(str, args)]
    try:
        with redirect_stdout(out), redirect_stderr(err), pytest.raises(SystemExit) as ended:
            main()
    finally:
        sys.argv = argv
    return int(ended.value.code or 0), out.getvalue(), err.getvalue()


def test_a_network_is_trained_and_can_be_loaded(data: Path, config: Path, tmp_path: Path):
    out = tmp_path / "own.safetensors"
    status, said, told = icarus(
        *("--model", "opnet-aa", "--data", data, "--out", out, "--config", config, "--seed", 5)
    )
    assert (status, said.startswith(f"{out}: opnet-aa after epoch ")) == (0, True)
    assert told.count("dev mIoU") == 2
    _, meta = load_checkpoint(out)
    assert meta.network == "opnet-aa"
    assert meta.recipe["seed"] == 5
    assert (meta.recipe["videos"], meta.recipe["dev_videos"]) == (4, 2)
    assert len(out.with_name("own.csv").read_text().splitlines()) == 3


def test_what_was_begun_is_neither_forgotten_nor_begun_anew(
    data: Path, config: Path, tmp_path: Path
):
    out = tmp_path / "own.safetensors"
    order = ("--model", "opnet", "--data", data, "--out", out, "--config", config)
    status, _, told = icarus(*order, "--resume")
    assert (status, "cannot be read" in told) == (2, True)
    assert icarus(*order)[0] == 0
    before = out.read_bytes()
    status, _, told = icarus(*order)
    assert (status, "--resume goes on with it" in told) == (2, True)
    assert icarus(*order, "--resume")[0] == 0
    assert out.read_bytes() == before


def test_without_a_dev_split_the_last_tenth_is_one(data: Path, config: Path, tmp_path: Path):
    heard: list[int] = []
    order = Order("opnet", data / "train", tmp_path / "n.safetensors", config=str(config))
    train(order, Listener(began=lambda trainer: heard.append(trainer.updates)))
    assert heard == [2 * 2]  # three videos in batches of two, two epochs
    _, meta = load_checkpoint(order.out)
    assert (meta.recipe["videos"], meta.recipe["dev_videos"]) == (3, 1)


def test_guidance_follows_the_actions(data: Path):
    arrays = prepared_arrays(
        data / "train", cater_domain(), Hyperparameters(), guided=True, told=Listener()
    )
    contained = (arrays.labels == 2) | (arrays.labels == 3)
    tracked = arrays.seen["od"].tracked
    # An action that has ended counts from the next frame on.
    settled = contained[:, 1:] & contained[:, :-1]
    assert (tracked[:, 1:][settled] != 0).all()
    free = ~contained[:, 1:] & ~contained[:, :-1]
    assert (tracked[:, 1:][free] == 0).all()
    assert settled.any()


def test_without_scenes_there_is_no_guidance(data: Path, tmp_path: Path):
    bare = tmp_path / "bare"
    for folder in ("labels", "od_perception", "perfect_perception", "containment_and_occlusions"):
        (bare / folder).parent.mkdir(exist_ok=True)
        (bare / folder).symlink_to(data / "train" / folder)
    with pytest.raises(UsageError, match="has no scenes/, and so no actions"):
        prepared_arrays(bare, cater_domain(), Hyperparameters(), guided=True, told=Listener())
    arrays = prepared_arrays(bare, cater_domain(), Hyperparameters(), guided=False, told=Listener())
    assert (arrays.seen["od"].tracked == -1).all()


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"--model": "opnett"}, "there is no network 'opnett'; did you mean 'opnet'"),
        ({"--data": "nowhere"}, "there is no folder labels/ in it"),
        ({"--config": "nowhere.yaml"}, "nowhere.yaml: cannot be read"),
        ({"--begin-with": "nowhere.safetensors"}, "nowhere.safetensors: cannot be read"),
    ],
)
def test_what_cannot_be_done_is_told(
    data: Path, config: Path, tmp_path: Path, changes: dict[str, str], said: str
):
    options = {
        "--model": "opnet",
        "--data": str(data),
        "--out": str(tmp_path / "n.safetensors"),
        "--config": str(config),
    } | changes
    status, printed, told = icarus(*(part for pair in options.items() for part in pair))
    assert (status, printed) == (2, "")
    assert said in told
    assert "Traceback" not in told


def test_without_the_extra_one_sentence_names_it(
    data: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr("aapa.neural.extra.find_spec", lambda _name: None)
    status, _, told = icarus(
        *("--model", "opnet", "--data", data, "--out", tmp_path / "n.safetensors")
    )
    assert status == 2
    assert told.strip() == (
        "neural models need PyTorch and safetensors: pip install 'icarus-lite[neural]'"
    )


def test_a_single_video_is_too_few(tmp_path: Path, config: Path):
    generate_dataset(tmp_path / "one", Recipe(3), 1, 1, lambda _done, _total: None)
    order = Order("opnet", tmp_path / "one", tmp_path / "n.safetensors", config=str(config))
    with pytest.raises(UsageError, match="has a single video; to train takes two at least"):
        train(order)


def test_arrays_are_read_from_the_data_set_only_once(data: Path):
    heard: list[int] = []
    listener = Listener(prepared=lambda done, _total: heard.append(done))
    choice = Hyperparameters(perceptions=("od", "pp"))
    prepared_arrays(data / "val", cater_domain(), choice, guided=False, told=listener)
    heard.clear()
    prepared_arrays(data / "val", cater_domain(), choice, guided=True, told=listener)
    assert heard == []
    assert open_arrays(data / "val" / "arrays", ("od",)).videos == len(Dataset(data / "val").videos)


def test_a_data_set_that_is_damaged_is_told(tmp_path: Path):
    generate_dataset(tmp_path / "bad", Recipe(3), 2, 1, lambda _done, _total: None)
    damaged = next((tmp_path / "bad" / "od_perception").iterdir())
    damaged.write_bytes(b"x")
    with pytest.raises(DatasetError, match="od_perception"):
        prepared_arrays(
            tmp_path / "bad", cater_domain(), Hyperparameters(), guided=False, told=Listener()
        )
    assert not (tmp_path / "bad" / "arrays" / "arrays.json").exists()
    assert np.load(tmp_path / "bad" / "arrays" / "snitch.npy").shape == (2, 300, 4)
