"""What there is to choose in training, read from YAML; the defaults are the published ones.

Source of the defaults: Shamsian et al. 2020 (the published code); Liang et al. 2021, section IV-B.
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any, Final, Literal, get_args

import yaml

from aapa.errors import AnchoringError
from aapa.neural.guidance import GUIDANCE_MODES, PAPER_WEIGHT, GuidanceMode

Schedule = Literal["plateau", "linear"]
"""How the rate of learning goes down: by a factor when the training loss no longer falls, as
published, or in a straight line to nothing at the end."""

SCHEDULES: Final[tuple[Schedule, ...]] = get_args(Schedule)
_STAGE: Final = {"epochs": 0, "frames": 0, "step": 0, "teach": 0.0, "boxes": True}
_KEYS: Final = ", ".join(_STAGE)
PERCEPTIONS: Final = ("od", "pp")


@dataclass(frozen=True, slots=True)
class Stage:
    """Some epochs in which videos are seen at the same length.

    Args:
        epochs: How often every video is seen.
        frames: How many frames of it, begun at random where the snitch is seen; 0 for all.
        step: Only every so many-th frame is seen. What happens in a video is slow, so that a
            network learns most of it from every fifth frame, in a fifth of the time.
        teach: How much it counts in the loss that OPNet's attention is where `closest_cone` has
            it; 0, as published, leaves that to the network.
        boxes: Whether boxes are learned as well. If not, OPNet learns whom to look at and nothing
            else, which takes a quarter of the time; there is nothing to score yet.
    """

    epochs: int
    frames: int = 0
    step: int = 1
    teach: float = 0.0
    boxes: bool = True


@dataclass(frozen=True, slots=True)
class Hyperparameters:
    """What there is to choose.

    Args:
        batch: Videos before each change of the weights.
        stages: One after another; the published training is one of 160 epochs, all frames.
        learning_rate: Of Adam.
        schedule: See `Schedule`.
        factor: "plateau": what the rate is multiplied with.
        patience: "plateau": after how many epochs that the loss does not fall.
        warmup: Over how many updates the rate rises from nothing.
        decay_from: "linear": from which share of all updates on.
        clip: The largest norm of a gradient; 0 for any.
        shuffle: Videos come in another order each epoch. The published code reads them in theirs.
        perceptions: Whose detections are seen; with both, by turns from epoch to epoch.
        guidance_weight: w of OPNet+AA.
        guidance_mode: How W acts on the attention.
        stop_after: Training ends after so many epochs that are no better on the dev split; 0
            for never.

    Raises:
        AnchoringError: A value is out of its range.
    """

    batch: int = 16
    stages: tuple[Stage, ...] = (Stage(160),)
    learning_rate: float = 1e-3
    schedule: Schedule = "plateau"
    factor: float = 0.8
    patience: int = 2
    warmup: int = 0
    decay_from: float = 0.0
    clip: float = 0.0
    shuffle: bool = False
    perceptions: tuple[str, ...] = ("od",)
    guidance_weight: float = PAPER_WEIGHT
    guidance_mode: GuidanceMode = "product"
    stop_after: int = 0

    def __post_init__(self) -> None:
        checks: Mapping[str, tuple[bool, str]] = {
            "batch": (1 <= self.batch <= 4096, "from 1 to 4096"),
            "learning_rate": (0 < self.learning_rate <= 1, "above 0, and at most 1"),
            "factor": (0 < self.factor <= 1, "above 0, and at most 1"),
            "patience": (self.patience >= 0, "at least 0"),
            "warmup": (self.warmup >= 0, "at least 0"),
            "decay_from": (0 <= self.decay_from <= 1, "from 0 to 1"),
            "clip": (0 <= self.clip < math.inf, "at least 0"),
            "guidance_weight": (0 < self.guidance_weight < math.inf, "above 0"),
            "stop_after": (self.stop_after >= 0, "at least 0"),
            "schedule": (self.schedule in SCHEDULES, " or ".join(SCHEDULES)),
            "guidance_mode": (self.guidance_mode in GUIDANCE_MODES, ", ".join(GUIDANCE_MODES)),
            "perceptions": (
                bool(self.perceptions) and set(self.perceptions) <= set(PERCEPTIONS),
                "some of od, pp",
            ),
            "stages": (
                bool(self.stages) and all(_makes_sense(stage) for stage in self.stages),
                "at least one, epochs and step from 1 on, the rest from 0 on, boxes or teach",
            ),
        }
        for name, (fits, expected) in checks.items():
            if not fits:
                raise AnchoringError(f"{name} is {getattr(self, name)!r}; it has to be {expected}")

    @property
    def epochs(self) -> int:
        """How many epochs there are in all."""
        return sum(stage.epochs for stage in self.stages)

    def stage(self, epoch: int) -> Stage:
        """Give the stage that an epoch, counted from 0, belongs to."""
        for stage in self.stages:
            if epoch < stage.epochs:
                return stage
            epoch -= stage.epochs
        return self.stages[-1]

    def to_json(self) -> dict[str, Any]:
        """Give them for a file's metadata."""
        return asdict(self)


def read_hyperparameters(path: Path) -> Hyperparameters:
    """Read them from a YAML file; what it leaves out keeps its default.

    Raises:
        AnchoringError: The file cannot be read, or a value in it is wrong; the text says which.
    """
    try:
        values = yaml.safe_load(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise AnchoringError(f"{path}: cannot be read: {error.strerror}") from error
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        raise AnchoringError(f"{path}: is no YAML: {error}") from error
    if not isinstance(values, dict | None):
        raise AnchoringError(f"{path}: expected the names of hyper-parameters and their values")
    try:
        return hyperparameters_of(values or {})
    except AnchoringError as error:
        raise AnchoringError(f"{path}: {error}") from error


def hyperparameters_of(values: Mapping[Any, Any]) -> Hyperparameters:
    """Give the hyper-parameters of plain values, as they stand in YAML or JSON.

    Raises:
        AnchoringError: There is no hyper-parameter of a name, or a value is of the wrong kind.
    """
    defaults = Hyperparameters()
    known = [field.name for field in fields(Hyperparameters)]
    chosen: dict[str, Any] = {}
    for name, value in values.items():
        if name not in known:
            near = difflib.get_close_matches(str(name), known, n=1)
            hint = f"did you mean {near[0]}?" if near else f"known are {', '.join(known)}"
            raise AnchoringError(f"there is no hyper-parameter {name!r}; {hint}")
        if name == "stages":
            chosen[name] = _stages(value)
        elif name == "perceptions":
            if not isinstance(value, list | tuple) or not all(isinstance(v, str) for v in value):
                raise AnchoringError(f"perceptions is {value!r}; expected a list such as [od, pp]")
            chosen[name] = tuple(value)
        else:
            chosen[name] = _same_kind(name, value, getattr(defaults, name))
    return Hyperparameters(**chosen)


def _makes_sense(stage: Stage) -> bool:
    return (
        min(stage.epochs, stage.step) >= 1
        and stage.frames >= 0
        and 0 <= stage.teach < math.inf
        and (stage.boxes or stage.teach > 0)
    )


def _same_kind(name: str, value: Any, default: Any) -> Any:
    """Give a value of the kind of its default; a whole number does for a float."""
    kind = type(default)
    if kind is float and isinstance(value, int) and not isinstance(value, bool):
        return float(value)
    if type(value) is not kind:
        called = {int: "a whole number", float: "a number", bool: "true or false", str: "a word"}
        raise AnchoringError(f"{name} is {value!r}; expected {called[kind]}")
    return value


def _stages(value: Any) -> tuple[Stage, ...]:
    if not isinstance(value, list | tuple) or not value:
        raise AnchoringError("stages: expected a list such as [{epochs: 160}]")
    stages: list[Stage] = []
    for entry in value:
        if not isinstance(entry, dict) or not set(entry) <= set(_STAGE):
            raise AnchoringError(f"stages: {entry!r} has to have epochs; known are {_KEYS}")
        numbers = {key: _same_kind(key, value, _STAGE[key]) for key, value in entry.items()}
        if "epochs" not in numbers:
            raise AnchoringError(f"stages: {entry!r} does not say how many epochs")
        stages.append(Stage(**numbers))
    return tuple(stages)
