"""A network asked about videos."""

from __future__ import annotations

import numpy as np
import pytest
import torch

from aapa import AnchoringError
from aapa.neural import attention_weights, predict
from aapa.neural.models import build_network

SIZES = {"who_hidden": 4, "where_hidden": 6}


@pytest.fixture
def features() -> np.ndarray:
    return np.random.default_rng(1).random((3, 7, 15, 6), dtype=np.float32)


def test_boxes_are_in_px(features: np.ndarray):
    torch.manual_seed(1)
    model = build_network("opnet", SIZES)
    boxes = predict(model, features)
    assert boxes.shape == (3, 7, 4)
    assert boxes.dtype == np.float64
    shares = model(torch.from_numpy(features)).detach().numpy()
    assert boxes == pytest.approx(shares * [320, 240, 320, 240], abs=1e-4)


def test_one_video_alone_gives_what_it_gives_among_others(features: np.ndarray):
    torch.manual_seed(1)
    model = build_network("opnet-aa", SIZES)
    weights = attention_weights(np.arange(21).reshape(3, 7))
    together = predict(model, features, weights)
    assert predict(model, features[1], weights[1]) == pytest.approx(together[1], abs=1e-4)
    assert not np.allclose(predict(model, features), together)


def test_a_baseline_does_not_see_which_are_cones(features: np.ndarray):
    torch.manual_seed(1)
    model = build_network("baseline-lstm", {"hidden": 6})
    otherwise = features.copy()
    otherwise[..., 5] = 1 - otherwise[..., 5]
    assert (predict(model, features) == predict(model, otherwise)).all()


def test_nothing_is_left_out_at_random(features: np.ndarray):
    model = build_network(
        "transformer-lstm", {"slot_hidden": 4, "feedforward": 4, "layers": 1, "hidden": 4}
    )
    assert (predict(model, features) == predict(model, features)).all()


def test_other_shapes_are_refused(features: np.ndarray):
    model = build_network("opnet", SIZES)
    with pytest.raises(AnchoringError, match=r"features have the shape \(7, 15, 5\)"):
        predict(model, features[0, ..., :5])
    with pytest.raises(AnchoringError, match=r"weights have the shape \(6, 15\); expected \(7, 15"):
        predict(model, features[0], np.ones((6, 15), dtype=np.float32))
