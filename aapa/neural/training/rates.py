"""The rate of learning over a training."""

from __future__ import annotations

from dataclasses import dataclass, replace

from aapa.neural.training.hyperparameters import Hyperparameters

_NOTICEABLE = 1e-4
"""By which share a loss has to fall to count as fallen."""


@dataclass(frozen=True, slots=True)
class Rate:
    """Where the rate of learning stands.

    Args:
        value: Before warming up and the straight line down are taken into account.
        best: The smallest training loss of an epoch so far.
        waited: How many epochs have not fallen below it.
    """

    value: float
    best: float = float("inf")
    waited: int = 0


def rate_at(rate: Rate, choice: Hyperparameters, update: int, updates: int) -> float:
    """Give the rate of one update.

    Args:
        rate: Where the rate stands.
        choice: The schedule.
        update: Which one, from 0.
        updates: How many there are in all.
    """
    value = rate.value
    if update < choice.warmup:
        value *= (update + 1) / choice.warmup
    if choice.schedule == "linear" and choice.decay_from < 1:
        share = update / updates
        value *= min(1.0, (1 - share) / (1 - choice.decay_from))
    return value


def after_epoch(rate: Rate, choice: Hyperparameters, loss: float) -> Rate:
    """Give the rate after an epoch, of its mean training loss."""
    if choice.schedule != "plateau":
        return rate
    if loss < rate.best * (1 - _NOTICEABLE):
        return replace(rate, best=loss, waited=0)
    if rate.waited < choice.patience:
        return replace(rate, waited=rate.waited + 1)
    return Rate(rate.value * choice.factor, rate.best)
