"""Trains a network: batches, updates, a look at the dev split after each epoch.

The network that is kept is the best on the dev split.

Source: Shamsian et al. 2020 (the published code).
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import torch

from aapa.errors import AnchoringError
from aapa.neural.checkpoints import Guidance, Meta, load_checkpoint, save_checkpoint
from aapa.neural.models.catalogue import build_network, network_named, parameter_count
from aapa.neural.training.arrays import TrainingArrays, checked_kinds
from aapa.neural.training.batches import Batch, Epoch, updates_an_epoch
from aapa.neural.training.hyperparameters import Hyperparameters
from aapa.neural.training.losses import losses
from aapa.neural.training.rates import Rate, after_epoch, rate_at
from aapa.neural.training.report import write_curve, write_recipe
from aapa.neural.training.scoring import score
from aapa.neural.training.state import Point, Progress, Scores, load_state, save_state

_SAVE_EVERY_S = 120.0


@dataclass(frozen=True, slots=True)
class Training:
    """What is to be trained.

    Args:
        network: Its name in `NETWORKS`.
        hyperparameters: How.
        out: Where the network goes; curve and interrupted state lie beside it.
        seed: Of the first weights, of order and places.
        sizes: Where they differ from the published ones.
        begin_with: A trained network of the same sizes to begin with, in place of random weights.
        about: What the recipe says besides, such as where the data are from.
    """

    network: str
    hyperparameters: Hyperparameters
    out: Path
    seed: int = 0
    sizes: Mapping[str, int] = field(default_factory=dict)
    begin_with: Path | None = None
    about: Mapping[str, Any] = field(default_factory=dict)

    @property
    def state_file(self) -> Path:
        """Where to go on from."""
        return self.out.with_name(f"{self.out.stem}.training.safetensors")

    @property
    def curve_file(self) -> Path:
        """The curve, a line an epoch."""
        return self.out.with_name(f"{self.out.stem}.csv")

    @property
    def recipe_file(self) -> Path:
        """The recipe of the network that is kept, for a person to read."""
        return self.out.with_name(f"{self.out.stem}.json")


class Trainer:
    """Trains one network.

    Args:
        training: What is to be trained.
        train: The videos it learns from.
        dev: The videos that decide which epoch was the best.

    Raises:
        AnchoringError: There is no such network, or nothing to learn from.
        DatasetError: What it is to begin with cannot be read, or is another network.
    """

    def __init__(self, training: Training, train: TrainingArrays, dev: TrainingArrays) -> None:
        choice = training.hyperparameters
        checked_kinds(train, choice.perceptions)
        checked_kinds(dev, choice.perceptions)
        self.training = training
        self.progress = Progress(rate=Rate(choice.learning_rate))
        self._train, self._dev = train, dev
        self._guided = network_named(training.network).guided
        torch.manual_seed(training.seed)
        self.model = build_network(training.network, training.sizes, choice.guidance_mode)
        self._before: Mapping[str, Any] = {}
        if training.begin_with is not None:
            self._before = self._begin_with(training.begin_with)
        self._device = torch.device("cuda" if torch.cuda.is_available() else "cpu")
        self.model.to(self._device)
        self._optimizer = torch.optim.Adam(self.model.parameters(), lr=choice.learning_rate)

    def resume(self) -> None:
        """Go on where an earlier training of the same kind was interrupted.

        Raises:
            DatasetError: There is none, or it was of another kind.
        """
        self.progress = load_state(
            self.training.state_file, self._what(), self.model, self._optimizer
        )

    def run(
        self,
        on_update: Callable[[Progress], None] = lambda _progress: None,
        on_epoch: Callable[[Point], None] = lambda _point: None,
    ) -> Progress:
        """Train to the end, and keep the best network; state and curve are written meanwhile.

        Args:
            on_update: Told after each change of the weights.
            on_epoch: Told after each epoch.

        Raises:
            AnchoringError: The loss is no longer a number.
            DatasetError: A file cannot be written.
        """
        choice = self.training.hyperparameters
        saved = time.monotonic()
        while self.progress.epoch < choice.epochs and not self.stopped_early:
            epoch = Epoch(
                self._train,
                choice,
                seed=self.training.seed,
                number=self.progress.epoch,
                guided=self._guided,
            )
            for batch in epoch.batches(self.progress.batch):
                before = time.process_time()
                loss = self._update(batch)
                self.progress = self.progress.advanced(loss, time.process_time() - before)
                on_update(self.progress)
                if time.monotonic() - saved > _SAVE_EVERY_S:
                    self.save()
                    saved = time.monotonic()
            on_epoch(self._end_epoch())
            saved = time.monotonic()
        return self.progress

    @property
    def stopped_early(self) -> bool:
        """Whether the dev split has not become better for as long as was to be waited."""
        best, patience = self.progress.best, self.training.hyperparameters.stop_after
        return (
            bool(patience) and best is not None and self.progress.epoch - 1 - best.epoch >= patience
        )

    @property
    def updates(self) -> int:
        """How many updates there are in all."""
        choice = self.training.hyperparameters
        return choice.epochs * updates_an_epoch(self._train.videos, choice.batch)

    def save(self) -> None:
        """Write what it takes to go on from here. Raises DatasetError."""
        save_state(
            self.training.state_file, self._what(), self.model, self._optimizer, self.progress
        )

    def _update(self, batch: Batch) -> float:
        """Change the weights once, and give the loss before that: of boxes, if they are learned."""
        choice, progress = self.training.hyperparameters, self.progress
        done = progress.epoch * updates_an_epoch(self._train.videos, choice.batch) + progress.batch
        for group in self._optimizer.param_groups:
            group["lr"] = rate_at(progress.rate, choice, done, self.updates)
        # What is left out at random follows from the update, not from what was before.
        torch.manual_seed(self.training.seed * 1_000_003 + done)
        self.model.train()
        parts = losses(self.model, batch, choice.stage(progress.epoch))
        learned = [part for part in parts if part is not None]
        self._optimizer.zero_grad()
        torch.stack(learned).sum().backward()  # type: ignore[no-untyped-call]
        if choice.clip:
            torch.nn.utils.clip_grad_norm_(self.model.parameters(), choice.clip)
        self._optimizer.step()
        value = float(learned[0].item())
        if not math.isfinite(value):
            raise AnchoringError(
                f"the loss of update {done} is {value}; a smaller learning_rate helps, or clip: 1.0"
            )
        return value

    def _end_epoch(self) -> Point:
        choice, progress = self.training.hyperparameters, self.progress
        loss = progress.losses / max(progress.batch, 1)
        before = time.process_time()
        scores: dict[str, Scores] = {}
        for kind in choice.perceptions if choice.stage(progress.epoch).boxes else ():
            result = score(self.model, self._dev, kind, choice, guided=self._guided)
            scores[kind] = (result.overall, *result.by_label)
        best = progress.best
        point = Point(
            progress.epoch,
            (progress.epoch + 1) * updates_an_epoch(self._train.videos, choice.batch),
            loss,
            float(self._optimizer.param_groups[0]["lr"]),
            scores,
            round(progress.seconds + time.process_time() - before, 1),
        )
        self.progress = Progress(
            progress.epoch + 1,
            rate=after_epoch(progress.rate, choice, loss),
            curve=(*progress.curve, point),
            seconds=point.seconds,
        )
        if scores and (best is None or point.score > best.score):
            self._keep(point)
        write_curve(self.training.curve_file, self.progress.curve)
        self.save()
        return point

    def _keep(self, point: Point) -> None:
        choice = self.training.hyperparameters
        guidance = Guidance(choice.guidance_weight, choice.guidance_mode) if self._guided else None
        recipe = {
            **self.training.about,
            **self._what(),
            "epoch": point.epoch,
            "updates": point.updates,
            "scores": {kind: list(numbers) for kind, numbers in point.scores.items()},
            "seconds": point.seconds,
        }
        if self._before:
            recipe["before"] = dict(self._before)
        meta = Meta(self.training.network, self.training.sizes, guidance, recipe)
        save_checkpoint(self.training.out, self.model, meta)
        write_recipe(self.training.recipe_file, meta)

    def _what(self) -> dict[str, Any]:
        """Say what a training has to have in common with the one it goes on from."""
        choice = self.training.hyperparameters.to_json()
        choice["stages"] = [dict(stage) for stage in choice["stages"]]
        choice["perceptions"] = list(choice["perceptions"])
        begun = self.training.begin_with
        return {
            "network": self.training.network,
            "parameters": parameter_count(self.model),
            "seed": self.training.seed,
            "begun_with": begun and begun.name,
            "videos": self._train.videos,
            "dev_videos": self._dev.videos,
            "hyperparameters": choice,
        }

    def _begin_with(self, path: Path) -> Mapping[str, Any]:
        """Take over a network's weights, and give its recipe."""
        other, meta = load_checkpoint(path)
        try:
            self.model.load_state_dict(other.state_dict())
        except RuntimeError as error:
            raise AnchoringError(f"{path}: is a network of other sizes") from error
        return meta.recipe
