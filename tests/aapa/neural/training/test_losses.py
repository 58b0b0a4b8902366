"""What is made small."""

from __future__ import annotations

import numpy as np
import pytest
import torch

from aapa.neural.models import build_network
from aapa.neural.training.batches import Batch
from aapa.neural.training.hyperparameters import Stage
from aapa.neural.training.losses import losses

SIZES = {"who_hidden": 3, "where_hidden": 4}


@pytest.fixture
def batch() -> Batch:
    chance = np.random.default_rng(1)
    return Batch(
        chance.random((2, 5, 15, 6), dtype=np.float32),
        None,
        chance.random((2, 5, 4), dtype=np.float32),
        chance.integers(0, 15, (2, 5)),
    )


def test_boxes_count_by_the_mean_distance_of_their_edges(batch: Batch):
    model = build_network("opnet", SIZES)
    loss, taught = losses(model, Batch(batch.features, None, batch.boxes), Stage(1))
    boxes = model(torch.from_numpy(batch.features)).detach().numpy()
    assert loss is not None
    assert loss.item() == pytest.approx(np.abs(boxes - batch.boxes).mean(), rel=1e-5)
    assert taught is None


def test_the_attention_counts_by_the_logarithm_of_its_share(batch: Batch):
    model = build_network("opnet", SIZES)
    loss, taught = losses(model, batch, Stage(1, teach=0.5))
    assert batch.attend is not None
    shares = model.who(torch.from_numpy(batch.features)).detach().numpy()
    wanted = np.take_along_axis(shares, batch.attend[..., None], axis=-1)
    assert taught is not None
    assert taught.item() == pytest.approx(-0.5 * np.log(wanted).mean(), rel=1e-5)
    alone, _ = losses(model, Batch(batch.features, None, batch.boxes), Stage(1))
    assert loss is not None
    assert alone is not None
    assert loss.item() == pytest.approx(alone.item(), rel=1e-5)


def test_the_attention_may_be_all_there_is_to_learn(batch: Batch):
    model = build_network("opnet", SIZES)
    loss, taught = losses(model, batch, Stage(1, teach=1, boxes=False))
    assert loss is None
    assert taught is not None
    taught.backward()
    learned = {name for name, p in model.named_parameters() if p.grad is not None}
    assert learned == {"who.lstm.weight_ih_l0", "who.lstm.weight_hh_l0", "who.slots.weight"}


def test_what_has_no_such_attention_learns_boxes(batch: Batch):
    model = build_network("baseline-lstm", {"hidden": 4})
    loss, taught = losses(model, batch, Stage(1, teach=1, boxes=False))
    assert loss is not None
    assert taught is None
