"""The networks trained on LA-CATER, with the engine's attachments as guidance."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from dataclasses import dataclass, field
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from aapa.lacater import Dataset
from aapa.lacater.video import Video
from icarus_lite import load_domain
from runtime.cater.attachments import AttachmentEngine, timed_actions
from runtime.cater.evaluate import cater_domain
from runtime.cater.evaluation import cast_of
from runtime.cater.guidance import UNKNOWN, classes_looked_at
from runtime.errors import UsageError

if TYPE_CHECKING:
    from aapa.neural.training.arrays import TrainingArrays
    from aapa.neural.training.hyperparameters import Hyperparameters
    from aapa.neural.training.state import Point, Progress
    from aapa.neural.training.trainer import Trainer

RECIPES: Final = ("published", "practical", "practical-aa", "further")
"""Hyper-parameters that come with the program."""

ARRAYS: Final = "arrays"
"""The folder, in a data set's, of what training reads."""

_TRAIN, _DEV = ("train_data", "train"), ("dev_data", "val_data", "dev", "val")
_HELD_OUT = 10
"""Without a dev split every so many-th part of the videos is one: the last."""


@dataclass(frozen=True, slots=True)
class Order:
    """What a person asks for.

    Args:
        model: The network's name.
        data: The folder of one split, or one that holds train and dev splits.
        out: Where the network goes.
        dev: The folder of the dev split, where it is elsewhere.
        config: One of `RECIPES`, or a YAML file.
        seed: Of the first weights, of order and places.
        begin_with: A trained network to begin with.
        domain: Says which actions attach; cater.icr if left out.
        resume: Go on with what was interrupted.
    """

    model: str
    data: Path
    out: Path
    dev: Path | None = None
    config: str = "published"
    seed: int = 0
    begin_with: Path | None = None
    domain: Path | None = None
    resume: bool = False


@dataclass(frozen=True, slots=True)
class Listener:
    """Who is told how far it is; by default nobody.

    Args:
        prepared: How many videos have been read, and of how many.
        began: The trainer, before its first update.
        updated: After each update.
        scored: After each epoch.
    """

    prepared: Callable[[int, int], None] = field(default=lambda _done, _total: None)
    began: Callable[[Trainer], None] = field(default=lambda _trainer: None)
    updated: Callable[[Progress], None] = field(default=lambda _progress: None)
    scored: Callable[[Point], None] = field(default=lambda _point: None)


def train(order: Order, listener: Listener | None = None) -> Progress:
    """Train a network to the end.

    Raises:
        AnchoringError: PyTorch is not installed; hyper-parameters or data cannot be used.
        DomainError: The domain cannot be loaded.
        UsageError: There is no training to go on with, or no split to train on.
    """
    from aapa.neural.extra import require_torch  # noqa: PLC0415 - told before anything is done

    require_torch()
    from aapa.neural.training.trainer import Trainer, Training  # noqa: PLC0415 - an extra

    told = listener or Listener()
    choice = chosen_hyperparameters(order.config)
    train_videos, dev_videos = _splits(order, choice, told)
    training = Training(
        order.model,
        choice,
        order.out,
        order.seed,
        begin_with=order.begin_with,
        about={"data": order.data.name, "config": order.config},
    )
    trainer = Trainer(training, train_videos, dev_videos)
    if order.resume:
        trainer.resume()
    elif training.state_file.exists():
        raise UsageError(
            f"{training.state_file} holds a training that was begun before: --resume goes on with "
            "it; remove the file to begin anew"
        )
    told.began(trainer)
    return trainer.run(told.updated, told.scored)


def chosen_hyperparameters(config: str) -> Hyperparameters:
    """Give the hyper-parameters of a recipe's name, or of a YAML file.

    Raises:
        AnchoringError: The file cannot be read, or a value in it is wrong.
    """
    from aapa.neural.training.hyperparameters import (  # noqa: PLC0415 - see `train`
        read_hyperparameters,
    )

    shipped = Path(str(files("aapa.neural.training"))) / "recipes" / f"{config}.yaml"
    return read_hyperparameters(shipped if config in RECIPES else Path(config))


def _splits(
    order: Order, choice: Hyperparameters, told: Listener
) -> tuple[TrainingArrays, TrainingArrays]:
    """Give what is learned from, and what decides which epoch was the best."""
    from aapa.neural.models.catalogue import network_named  # noqa: PLC0415 - an extra

    guided = network_named(order.model).guided
    domain = order.domain or cater_domain()

    def arrays(folder: Path) -> TrainingArrays:
        return prepared_arrays(folder, domain, choice, guided=guided, told=told)

    folder, dev = _folder(order.data, _TRAIN), order.dev or _folder(order.data, _DEV)
    if folder is not None and dev is not None:
        return arrays(folder), arrays(dev)
    everything = arrays(order.data if folder is None else folder)
    if dev is not None:
        return everything, arrays(dev)
    first = everything.videos - max(1, everything.videos // _HELD_OUT)
    if first == 0:
        raise UsageError(f"{order.data} has a single video; to train takes two at least")
    return everything.part(0, first), everything.part(first, everything.videos)


def _folder(root: Path, names: tuple[str, ...]) -> Path | None:
    return next((root / name for name in names if (root / name / "labels").is_dir()), None)


def prepared_arrays(
    folder: Path,
    domain: Path,
    choice: Hyperparameters,
    *,
    guided: bool,
    told: Listener,
) -> TrainingArrays:
    """Give a data set as arrays, which are made where they are not there yet.

    Raises:
        AnchoringError: The data cannot be used.
        DomainError: The domain cannot be loaded.
        UsageError: Guidance is wanted, but there are no scene files to take it from.
    """
    from aapa.neural.training.arrays import build_arrays, open_arrays  # noqa: PLC0415

    dataset = Dataset(folder)
    if guided and not (folder / "scenes").is_dir():
        raise UsageError(f"{folder} has no scenes/, and so no actions to take the guidance from")
    engine = AttachmentEngine(load_domain(domain))

    def looked_at(video: Video) -> NDArray[np.int64]:
        if video.scene is None:
            return np.full(video.labels.frames, UNKNOWN)
        reports = engine.reports(timed_actions(video.scene), video.labels.frames)
        return classes_looked_at(reports, cast_of(video.scene))

    source = hashlib.sha256(domain.read_bytes()).hexdigest()[:16]
    build_arrays(folder / ARRAYS, dataset, looked_at, source, told.prepared)
    return open_arrays(folder / ARRAYS, choice.perceptions)
