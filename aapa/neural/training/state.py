"""A training that has been interrupted, on disk: enough to go on as if nothing had happened."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import torch
from torch import Tensor, nn

from aapa.errors import DatasetError
from aapa.neural.checkpoints import read_tensors, write_tensors
from aapa.neural.training.rates import Rate

Scores = tuple[float | None, ...]
"""Mean intersection over union, %: overall, then by label."""


@dataclass(frozen=True, slots=True)
class Point:
    """One epoch on the curve.

    Args:
        epoch: From 0.
        updates: How often the weights have changed by its end.
        loss: Mean training loss over its batches.
        rate: Of learning, at its end.
        scores: Mean intersection over union on the dev split, %: for each detector overall, then
            by label, None for a label that no frame has.
        seconds: Processor time since the training began.
    """

    epoch: int
    updates: int
    loss: float
    rate: float
    scores: Mapping[str, Scores]
    seconds: float

    @property
    def score(self) -> float:
        """Give the mean over the detectors of the score overall; 0 where nothing was scored."""
        return sum(numbers[0] or 0.0 for numbers in self.scores.values()) / (len(self.scores) or 1)


@dataclass(frozen=True, slots=True)
class Progress:
    """How far a training is.

    Args:
        epoch: The epoch that is under way, from 0.
        batch: How many of its batches are done.
        losses: The sum of their losses.
        rate: Of learning.
        curve: The epochs that are done.
        seconds: Processor time so far.
    """

    epoch: int = 0
    batch: int = 0
    losses: float = 0.0
    rate: Rate = field(default_factory=lambda: Rate(0.0))
    curve: tuple[Point, ...] = ()
    seconds: float = 0.0

    @property
    def best(self) -> Point | None:
        """Give the epoch that was best on the dev split, the first of equals, if any is scored."""
        scored = (point for point in self.curve if point.scores)
        return max(scored, key=lambda point: (point.score, -point.epoch), default=None)

    def advanced(self, loss: float, seconds: float) -> Progress:
        """Give the progress after one more batch."""
        return replace(
            self, batch=self.batch + 1, losses=self.losses + loss, seconds=self.seconds + seconds
        )


def save_state(
    path: Path,
    what: Mapping[str, Any],
    model: nn.Module,
    optimizer: torch.optim.Adam,
    progress: Progress,
) -> None:
    """Write all there is to a training.

    Args:
        path: Where to.
        what: What is trained on what, and how; it has to be the same when it goes on.
        model: The network.
        optimizer: Its moments are kept.
        progress: How far it is.

    Raises:
        DatasetError: The file cannot be written.
    """
    tensors = {f"model.{name}": tensor for name, tensor in model.state_dict().items()}
    for name, parameter in model.named_parameters():
        for moment, value in optimizer.state[parameter].items():
            tensors[f"adam.{moment}.{name}"] = value
    write_tensors(path, tensors, {"training": dict(what), "progress": _to_json(progress)})


def load_state(
    path: Path, what: Mapping[str, Any], model: nn.Module, optimizer: torch.optim.Adam
) -> Progress:
    """Go back to where a training was.

    Args:
        path: What `save_state` wrote.
        what: As it was given to `save_state`.
        model: Gets the weights.
        optimizer: Gets the moments.

    Raises:
        DatasetError: The file cannot be read, or is of another training.
    """
    tensors, entry = read_tensors(path)
    training = entry.get("training")
    if not isinstance(training, dict):
        raise DatasetError("is no interrupted training", path=str(path))
    for key, value in what.items():
        if training.get(key) != value:
            raise DatasetError(
                f"the training that was interrupted had {training.get(key)!r}, this one has "
                f"{value!r}; train without --resume to begin anew",
                path=str(path),
                key=key,
            )
    names = dict(model.named_parameters())
    try:
        model.load_state_dict(
            {n.removeprefix("model."): t for n, t in tensors.items() if n.startswith("model.")}
        )
        for name, parameter in names.items():
            optimizer.state[parameter] = dict(_moments(tensors, name, parameter.device))
        return _from_json(entry["progress"])
    except (KeyError, TypeError, ValueError, RuntimeError) as error:
        raise DatasetError("is damaged; train without --resume", path=str(path)) from error


def _moments(
    tensors: Mapping[str, Tensor], name: str, device: torch.device
) -> Iterable[tuple[str, Tensor]]:
    """Give what Adam remembers of a parameter; nothing of one that has not been learned yet."""
    for moment in ("step", "exp_avg", "exp_avg_sq"):
        tensor = tensors.get(f"adam.{moment}.{name}")
        if tensor is not None:
            # Adam counts steps on the processor, wherever the parameter is.
            yield moment, tensor if moment == "step" else tensor.to(device)


def _to_json(progress: Progress) -> dict[str, Any]:
    rate = progress.rate
    return {
        "epoch": progress.epoch,
        "batch": progress.batch,
        "losses": progress.losses,
        "rate": [rate.value, None if rate.best == float("inf") else rate.best, rate.waited],
        "seconds": progress.seconds,
        "curve": [
            [
                p.epoch,
                p.updates,
                p.loss,
                p.rate,
                {k: list(v) for k, v in p.scores.items()},
                p.seconds,
            ]
            for p in progress.curve
        ],
    }


def _from_json(entry: Mapping[str, Any]) -> Progress:
    value, best, waited = entry["rate"]
    curve = tuple(
        Point(epoch, updates, loss, rate, {k: tuple(v) for k, v in scores.items()}, seconds)
        for epoch, updates, loss, rate, scores, seconds in entry["curve"]
    )
    return Progress(
        int(entry["epoch"]),
        int(entry["batch"]),
        float(entry["losses"]),
        Rate(float(value), float("inf") if best is None else float(best), int(waited)),
        curve,
        float(entry["seconds"]),
    )
