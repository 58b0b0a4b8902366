"""What is assumed of the trained detector, number by number.

None of its outputs are at hand. What is known of it: boxes are cut down to whole px; class 0 is
its background; only detections with a score of at least 0.8 are kept; it makes few errors, among
them classes mistaken for some frames, and the snitch seen somewhere else. And what follows from
the published scores: see `docs/results/generator.md`, which derives each number.

Source: Shamsian et al., ECCV 2020, and its code; Liang et al. 2021, section V.
"""

from __future__ import annotations

import difflib
import math
from dataclasses import dataclass, fields
from pathlib import Path

import yaml

from aapa.errors import AnchoringError
from aapa.lacater.classes import CLASS_NAMES


@dataclass(frozen=True, slots=True)
class DetectorNoise:
    """How a trained detector differs from a perfect one.

    Args:
        jitter_px: Standard deviation of each edge of a box, px, before it is cut down to whole px.
            The same for small boxes and large: rendered edges are sharp, and it is the pixels
            that limit how well they are found.
        lasting: Share of the jitter's variance that stays as long as nothing changes in the
            object's image: the same picture gives the same box. The rest is new each frame.
        settling: Correlation of the lasting part from one frame to the next while it changes.
        hidden_jitter: By how much the jitter grows when all of an object is hidden, as a factor
            on top of 1; half hidden, half as much.
        miss_rate: Share of the frames in which an object that is free to see is missed.
        miss_correlation: Correlation of an object's luck from one frame to the next: what makes
            misses come in bursts.
        half_seen: The share of an object to be seen at which it is found half of the time.
        seen_slope: How fast the chance to be found grows around there.
        swap_rate: Chance per frame that an object is begun to be taken for one like it.
        swap_frames: How many frames that lasts on average.
        false_snitches: How many false boxes of the snitch begin per frame.
        false_others: How many false boxes of any other class begin per frame.
        false_frames: How many frames a false box lasts on average.
        blind_classes: Classes that are never reported.

    Raises:
        AnchoringError: A value is out of its range.
    """

    jitter_px: float = 0.67
    lasting: float = 0.5
    settling: float = 0.8
    hidden_jitter: float = 1.0
    miss_rate: float = 0.01
    miss_correlation: float = 0.8
    half_seen: float = 0.3
    seen_slope: float = 0.05
    swap_rate: float = 0.001
    swap_frames: float = 5.0
    false_snitches: float = 0.00045
    false_others: float = 0.002
    false_frames: float = 2.0
    blind_classes: tuple[int, ...] = (0,)

    def __post_init__(self) -> None:
        shares = {"lasting", "miss_rate", "half_seen", "swap_rate"}
        for field in fields(self):
            value = getattr(self, field.name)
            if field.name == "blind_classes":
                continue
            if not math.isfinite(value) or value < 0:
                raise AnchoringError(f"{field.name} is {value}; it has to be a number from 0 on")
            if field.name in shares and value > 1:
                raise AnchoringError(f"{field.name} is {value}; it has to be at most 1")
        for name in ("settling", "miss_correlation"):
            if getattr(self, name) >= 1:
                raise AnchoringError(f"{name} is {getattr(self, name)}; it has to be below 1")
        for name in ("swap_frames", "false_frames"):
            if getattr(self, name) < 1:
                raise AnchoringError(f"{name} is {getattr(self, name)}; it has to be at least 1")
        if self.seen_slope <= 0:
            raise AnchoringError(f"seen_slope is {self.seen_slope}; it has to be above 0")


def read_noise(path: Path) -> DetectorNoise:
    """Read the noise from a YAML file; what it leaves out keeps its default.

    Raises:
        AnchoringError: The file cannot be read, or a value in it is wrong; the text says which.
    """
    try:
        values = yaml.safe_load(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise AnchoringError(f"{path}: cannot be read: {error.strerror}") from error
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        raise AnchoringError(f"{path}: is no YAML: {error}") from error
    if values is None:
        return DetectorNoise()
    if not isinstance(values, dict):
        raise AnchoringError(f"{path}: expected the names of parameters and their values")
    known = [field.name for field in fields(DetectorNoise)]
    for name, value in values.items():
        if name not in known:
            near = difflib.get_close_matches(str(name), known, n=1)
            hint = f"did you mean {near[0]}?" if near else f"known are {', '.join(known)}"
            raise AnchoringError(f"{path}: there is no parameter {name!r}; {hint}")
        if name != "blind_classes" and (
            isinstance(value, bool) or not isinstance(value, int | float)
        ):
            raise AnchoringError(f"{path}: {name} is {value!r}; it has to be a number")
    blind = values.get("blind_classes")
    if blind is not None:
        values["blind_classes"] = _classes(blind, path)
    try:
        return DetectorNoise(**values)
    except AnchoringError as error:
        raise AnchoringError(f"{path}: {error}") from error


def _classes(value: object, path: Path) -> tuple[int, ...]:
    if not isinstance(value, list) or not all(
        isinstance(item, int) and 0 <= item < len(CLASS_NAMES) for item in value
    ):
        raise AnchoringError(
            f"{path}: blind_classes is {value!r}; expected a list of class numbers, "
            f"0 to {len(CLASS_NAMES) - 1}"
        )
    return tuple(value)
