"""The gated unit in numpy gives what PyTorch's gives, and refuses weights of anything else."""

from __future__ import annotations

import numpy as np
import pytest

from aapa.errors import DatasetError
from aapa.lacater.models.refined.recurrent import (
    GatedUnit,
    Weights,
    read_weights,
    write_weights,
)


def random_weights(inputs, hidden, outputs, seed=3):
    chance = np.random.default_rng(seed)
    return Weights(
        chance.normal(size=(3 * hidden, inputs)) / 2,
        chance.normal(size=3 * hidden),
        chance.normal(size=(3 * hidden, hidden)) / 2,
        chance.normal(size=3 * hidden),
        chance.normal(size=(outputs, hidden + inputs)),
        chance.normal(size=outputs),
    )


def test_it_computes_what_pytorch_computes():
    torch = pytest.importorskip("torch")
    weights = random_weights(5, 7, 3)
    theirs = torch.nn.GRU(5, 7, batch_first=True).double()
    names = ("weight_ih_l0", "bias_ih_l0", "weight_hh_l0", "bias_hh_l0")
    arrays = (weights.into, weights.into_bias, weights.back, weights.back_bias)
    for name, array in zip(names, arrays, strict=True):
        getattr(theirs, name).data = torch.from_numpy(array)
    inputs = np.random.default_rng(4).normal(size=(20, 5))
    with torch.no_grad():
        hidden = theirs(torch.from_numpy(inputs)[None])[0][0].numpy()
    expected = np.hstack([hidden, inputs]) @ weights.out.T + weights.out_bias
    unit = GatedUnit(weights)
    np.testing.assert_allclose([unit.step(row) for row in inputs], expected, atol=1e-12)


def test_it_remembers():
    weights = random_weights(2, 4, 1)
    fresh, used = GatedUnit(weights), GatedUnit(weights)
    used.step(np.array([3.0, -2.0]))
    assert abs(fresh.step(np.zeros(2)) - used.step(np.zeros(2))).max() > 1e-3


def test_what_is_written_is_read_again(tmp_path):
    path = tmp_path / "weights.npz"
    weights = random_weights(4, 6, 2)
    write_weights(path, weights)
    again = read_weights(path, 4, 2)
    assert again.hidden == 6
    np.testing.assert_allclose(again.out, weights.out, atol=1e-6)


def test_a_file_that_holds_something_else_is_refused(tmp_path):
    path = tmp_path / "weights.npz"
    with pytest.raises(DatasetError, match="cannot be read as weights"):
        read_weights(path, 4, 2)
    path.write_bytes(b"PK\x03\x04 cut off")
    with pytest.raises(DatasetError, match="cannot be read as weights"):
        read_weights(path, 4, 2)
    np.savez(path, into=np.zeros(3))
    with pytest.raises(DatasetError, match="expected the arrays into, into_bias"):
        read_weights(path, 4, 2)
    np.savez(path, into=np.array([object()]), allow_pickle=True)
    with pytest.raises(DatasetError, match="cannot be read as weights"):
        read_weights(path, 4, 2)


def test_weights_of_another_shape_or_not_finite_are_refused(tmp_path):
    path = tmp_path / "weights.npz"
    write_weights(path, random_weights(4, 6, 2))
    with pytest.raises(DatasetError, match=r"into: expected \(18, 5\) finite numbers"):
        read_weights(path, 5, 2)
    weights = random_weights(4, 6, 2)
    weights.out[0, 0] = np.nan
    write_weights(path, weights)
    with pytest.raises(DatasetError, match=r"out: expected \(2, 10\) finite"):
        read_weights(path, 4, 2)
