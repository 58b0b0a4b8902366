"""The rate of learning."""

from __future__ import annotations

import pytest
import torch

from aapa.neural.training.hyperparameters import Hyperparameters
from aapa.neural.training.rates import Rate, after_epoch, rate_at

LOSSES = [1.0, 0.9, 0.9, 0.9, 0.9, 0.5, 0.6, 0.6, 0.6, 0.6, 0.6, 0.6, 0.49999, 0.2]


def test_plateau_is_what_torch_does():
    choice = Hyperparameters()
    optimizer = torch.optim.SGD([torch.zeros(1, requires_grad=True)], lr=1e-3)
    torchs = torch.optim.lr_scheduler.ReduceLROnPlateau(optimizer, factor=0.8, patience=2)
    rate = Rate(1e-3)
    for loss in LOSSES:
        torchs.step(loss)
        rate = after_epoch(rate, choice, loss)
        assert rate.value == pytest.approx(optimizer.param_groups[0]["lr"])
    assert rate.value < 1e-3


def test_linear_rises_holds_and_falls_to_nothing():
    choice = Hyperparameters(schedule="linear", warmup=4, decay_from=0.5, learning_rate=0.1)
    rates = [rate_at(Rate(0.1), choice, update, 20) for update in range(20)]
    assert rates[:5] == pytest.approx([0.025, 0.05, 0.075, 0.1, 0.1])
    assert rates[10] == pytest.approx(0.1)
    assert rates[15] == pytest.approx(0.05)
    assert rates[19] == pytest.approx(0.01)
    assert after_epoch(Rate(0.1), choice, 5.0) == Rate(0.1)


def test_without_decay_linear_stays():
    choice = Hyperparameters(schedule="linear", decay_from=1.0)
    assert rate_at(Rate(0.1), choice, 19, 20) == 0.1
