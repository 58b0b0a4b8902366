"""Networks on disk, ours and hostile ones."""

from __future__ import annotations

import json
import pickle
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch
from safetensors.torch import save_file

from aapa import AnchoringError
from aapa.errors import DatasetError
from aapa.neural import Guidance, Meta, load_checkpoint, predict, save_checkpoint
from aapa.neural import checkpoints as module
from aapa.neural.models import build_network
from aapa.neural.models.opnet import OPNet

SIZES = {"who_hidden": 4, "where_hidden": 6}
META = Meta("opnet-aa", SIZES, Guidance(100.0, "product"), {"seed": 7, "scores": {"od": [1.5]}})


@pytest.fixture
def model() -> torch.nn.Module:
    torch.manual_seed(2)
    return build_network("opnet-aa", SIZES)


@pytest.fixture
def file(tmp_path: Path, model: torch.nn.Module) -> Path:
    path = tmp_path / "some" / "network.safetensors"
    save_checkpoint(path, model, META, half=False)
    return path


def test_what_is_read_is_what_was_written(file: Path, model: torch.nn.Module):
    read, meta = load_checkpoint(file)
    assert meta == META
    assert not read.training
    for name, tensor in model.state_dict().items():
        assert torch.equal(read.state_dict()[name], tensor)


def test_half_precision_takes_half_the_space_and_moves_no_box_by_a_tenth_of_a_pixel(
    file: Path, model: torch.nn.Module
):
    half = file.with_name("half.safetensors")
    save_checkpoint(half, model, META)
    numbers = sum(p.numel() for p in model.parameters())
    assert file.stat().st_size - half.stat().st_size == pytest.approx(2 * numbers, abs=16)
    features = np.random.default_rng(1).random((9, 15, 6), dtype=np.float32)
    read, _ = load_checkpoint(half)
    assert next(read.parameters()).dtype == torch.float32
    assert np.abs(predict(read, features) - predict(model, features)).max() < 0.1


def test_it_may_be_guided_in_another_way_than_it_was_trained(file: Path):
    as_trained, renormalised = load_checkpoint(file)[0], load_checkpoint(file, "renormalised")[0]
    assert isinstance(as_trained, OPNet)
    assert isinstance(renormalised, OPNet)
    assert not as_trained.renormalise
    assert renormalised.renormalise


def test_a_network_trained_to_be_renormalised_is(tmp_path: Path, model: torch.nn.Module):
    path = tmp_path / "n.safetensors"
    save_checkpoint(path, model, Meta("opnet-aa", SIZES, Guidance(5.0, "renormalised")))
    read, _ = load_checkpoint(path)
    assert isinstance(read, OPNet)
    assert read.renormalise


def written(path: Path, model: torch.nn.Module, entry: object, **changes: torch.Tensor) -> Path:
    tensors = dict(model.state_dict()) | {n.replace("/", "."): t for n, t in changes.items()}
    text = entry if isinstance(entry, str) else json.dumps(entry)
    save_file(tensors, path, metadata={"icarus": text})
    return path


ENTRY: dict[str, Any] = {"format": 1, "network": "opnet", "sizes": SIZES}


@pytest.mark.parametrize(
    ("entry", "said"),
    [
        ("{", "is no network in the safetensors format"),
        ("[" * 100_000, "is no network in the safetensors format"),
        ("[]", "no entry 'icarus' of ours"),
        (ENTRY | {"format": 2}, "has format 2; this version reads 1"),
        (ENTRY | {"network": None}, "does not say which network it is"),
        (ENTRY | {"network": "os.system"}, "there is no network 'os.system'"),
        (ENTRY | {"sizes": [1]}, "sizes and recipe have to be objects"),
        (ENTRY | {"recipe": 3}, "sizes and recipe have to be objects"),
        (ENTRY | {"sizes": {"who_hidden": 10**12}}, "who_hidden is 1000000000000"),
        (ENTRY | {"sizes": {"who_hidden": "4"}}, "who_hidden is '4'"),
        (ENTRY | {"sizes": {"where": 1}}, "opnet has no size 'where'"),
        (ENTRY | {"sizes": {"where_hidden": 5}}, "has the shape (4, 6); expected (4, 5)"),
        (ENTRY | {"network": "baseline-lstm", "sizes": {}}, "the tensor "),
        (ENTRY | {"guidance": {"weight": 0, "mode": "product"}}, "expected a weight above 0"),
        (ENTRY | {"guidance": {"weight": True, "mode": "product"}}, "expected a weight above 0"),
        (ENTRY | {"guidance": {"weight": 5, "mode": ["x"]}}, "a mode of product, softmax"),
        (ENTRY | {"guidance": [100]}, "expected a weight above 0"),
    ],
)
def test_what_a_file_says_of_itself_is_checked(
    tmp_path: Path, model: torch.nn.Module, entry: object, said: str
):
    path = written(tmp_path / "n.safetensors", model, entry)
    with pytest.raises(DatasetError) as refused:
        load_checkpoint(path)
    assert said in str(refused.value)
    assert str(path) in str(refused.value)


@pytest.mark.parametrize(
    ("name", "tensor", "said"),
    [
        ("box.weight", torch.full((4, 6), float("nan")), "not finite"),
        ("box.weight", torch.zeros(4, 6, dtype=torch.int64), "no numbers with a fraction"),
        ("box.weight", torch.zeros(4, 7), "has the shape (4, 7); expected (4, 6)"),
        ("box.bias", torch.zeros(4), "has, beyond the network, the tensor box.bias"),
    ],
)
def test_its_tensors_are_checked(
    tmp_path: Path, model: torch.nn.Module, name: str, tensor: torch.Tensor, said: str
):
    path = written(tmp_path / "n.safetensors", model, ENTRY, **{name: tensor})
    with pytest.raises(DatasetError) as refused:
        load_checkpoint(path)
    assert said in str(refused.value)


def test_a_tensor_that_is_missing_is_named(tmp_path: Path, model: torch.nn.Module):
    tensors = dict(model.state_dict())
    del tensors["box.weight"]
    path = tmp_path / "n.safetensors"
    save_file(tensors, path, metadata={"icarus": json.dumps(ENTRY)})
    with pytest.raises(DatasetError, match=r"lacks the tensor box\.weight"):
        load_checkpoint(path)


class Trap:
    def __reduce__(self):
        return (Path.touch, (Path("sprung"),))


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"PK\x03\x04 a zip file",
        pickle.dumps(Trap()),
        struct.pack("<Q", 2**63) + b"{}",
        struct.pack("<Q", 20) + b'{"a":{"dtype":"F32",' + b"\0" * 8,
    ],
)
def test_a_file_of_another_kind_is_refused_and_never_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, content: bytes
):
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "n.safetensors"
    path.write_bytes(content)
    with pytest.raises(DatasetError, match="is no network in the safetensors format"):
        load_checkpoint(path)
    assert not (tmp_path / "sprung").exists()


def test_a_file_that_is_cut_off_is_refused(file: Path):
    file.write_bytes(file.read_bytes()[:-10])
    with pytest.raises(DatasetError, match="is no network in the safetensors format"):
        load_checkpoint(file)


def test_a_file_without_our_metadata_is_refused(tmp_path: Path, model: torch.nn.Module):
    path = tmp_path / "n.safetensors"
    save_file(dict(model.state_dict()), path)
    with pytest.raises(DatasetError, match="no entry 'icarus' of ours"):
        load_checkpoint(path)


def test_a_file_that_is_too_large_is_not_read(file: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(module, "LARGEST_FILE", 100)
    with pytest.raises(DatasetError, match="a network has at most 100"):
        load_checkpoint(file)


def test_a_file_that_is_not_there_or_cannot_be_written_is_told(
    tmp_path: Path, model: torch.nn.Module
):
    with pytest.raises(DatasetError, match="cannot be read: No such file"):
        load_checkpoint(tmp_path / "nowhere.safetensors")
    (tmp_path / "file").touch()
    with pytest.raises(DatasetError, match="cannot be written"):
        save_checkpoint(tmp_path / "file" / "n.safetensors", model, META)


def test_without_the_extra_one_sentence_names_it(file: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("aapa.neural.extra.find_spec", lambda _name: None)
    with pytest.raises(AnchoringError, match=r"pip install 'icarus-lite\[neural\]'"):
        load_checkpoint(file)
