"""Models that were trained: handed whole videos, several at a time, they give the snitch's boxes.

They need the extra [neural]. What a slot of theirs means depends on which classes are detected
somewhere in the video, as in the published code; so they are asked for whole videos, not frame by
frame, and are no `Tracker`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import lru_cache
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from aapa.errors import AnchoringError
from aapa.lacater.video import Perception
from aapa.neural.checkpoints import Guidance, load_checkpoint
from aapa.neural.extra import require_torch
from aapa.neural.features import FEATURES, SLOTS, slot_classes, tensor_of
from aapa.neural.guidance import NO_SLOT, GuidanceMode, attention_weights
from aapa.neural.prediction import predict

if TYPE_CHECKING:
    from torch.nn import Module

TOGETHER: Final = 8
"""So many videos go through a network at a time, whatever is asked for: with fewer, empty ones are
added, so that a video's boxes do not depend on which others come with it."""

SHIPPED: Final[Mapping[str, GuidanceMode | None]] = {
    "opnet": None,
    "opnet-aa": "product",
    "opnet-aa-softmax": "softmax",
    "opnet-aa-renormalised": "renormalised",
}
"""The networks that have a name of their own, and how each is told what to look at. What was
trained to be told in one way makes nothing of another, so that each needs weights of its own."""


@dataclass(frozen=True, slots=True, eq=False)
class Footage:
    """All that a network is handed of one video.

    Args:
        perception: What the detector reported.
        looked_at: (frames,) the class of what is to be looked at to know where the snitch is:
            its own, or that of its outermost container; below 0 where that is not known. Only a
            network with guidance reads it.
    """

    perception: Perception
    looked_at: NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Network:
    """A trained model, under a name.

    Args:
        name: As it is given on the command line, such as "opnet-aa".
        file: Its weights.
        parameters: What there was to choose, for the report.
    """

    name: str
    file: Path
    parameters: Mapping[str, object] = field(default_factory=dict)

    def predict(self, videos: Sequence[Footage]) -> list[NDArray[np.float64]]:
        """Give (frames, 4) boxes of the snitch for each video, px.

        A box that the network turns inside out has no width, or no height.

        Raises:
            AnchoringError: The weights cannot be used.
        """
        boxes: list[NDArray[np.float64]] = []
        with _one_thread():
            for start in range(0, len(videos), TOGETHER):
                boxes += self._predict(videos[start : start + TOGETHER])
        return boxes

    def _predict(self, videos: Sequence[Footage]) -> list[NDArray[np.float64]]:
        model, guidance = _loaded(self.file, self.file.stat().st_mtime_ns)
        lengths = [video.perception.frames for video in videos]
        features = np.zeros((TOGETHER, max(lengths), SLOTS, FEATURES), dtype=np.float32)
        slots = np.full(features.shape[:2], NO_SLOT)
        for row, video in enumerate(videos):
            features[row, : lengths[row]] = tensor_of(video.perception)
            slots[row, : lengths[row]] = slots_looked_at(video)
        weights = None
        if guidance is not None:
            weights = attention_weights(slots, guidance.weight, guidance.mode)
        boxes = predict(model, features, weights)
        boxes[..., 2:] = np.maximum(boxes[..., 2:], boxes[..., :2])
        return [boxes[row, :frames] for row, frames in enumerate(lengths)]


def network_named(name: str, file: Path | None = None) -> Network:
    """Give a network, its weights read and found to be sound.

    Args:
        name: One of `SHIPPED`, or any other if there is a file.
        file: Its weights; those that come with the program if left out.

    Raises:
        AnchoringError: PyTorch is not installed, or there are no such weights.
    """
    try:
        require_torch()
    except AnchoringError as error:
        raise AnchoringError(f"{name} cannot be run: {error}") from error
    path = file or Path(str(files("aapa.neural"))) / "weights" / f"{name}.safetensors"
    if not path.is_file():
        raise AnchoringError(
            f"{name} has no weights: there is no file {path}; `icarus cater train` makes some, "
            f"and --weights {name}=FILE names them"
        )
    _, guidance = _loaded(path, path.stat().st_mtime_ns)
    mode = None if guidance is None else guidance.mode
    if name in SHIPPED and mode != SHIPPED[name]:
        raise AnchoringError(
            f"{path}: this network was trained with {_told(mode)}, and {name} means one with "
            f"{_told(SHIPPED[name])}; evaluate it under another name"
        )
    told = {} if guidance is None else {"w": guidance.weight, "mode": guidance.mode}
    return Network(name, path, {"weights": path.name, **told})


def _told(mode: GuidanceMode | None) -> str:
    return "no guidance" if mode is None else f"the guidance {mode!r}"


def slots_looked_at(video: Footage) -> NDArray[np.int64]:
    """Give (frames,) the slot of what is to be looked at; `NO_SLOT` where that has none."""
    slot_of = {number: slot for slot, number in enumerate(slot_classes(video.perception))}
    return np.array([slot_of.get(number, NO_SLOT) for number in video.looked_at.tolist()])


@lru_cache(maxsize=8)
def _loaded(path: Path, _changed: int) -> tuple[Module, Guidance | None]:
    """Read a network, once for as long as its file stays what it is."""
    model, meta = load_checkpoint(path)
    return model, meta.guidance


@contextmanager
def _one_thread() -> Iterator[None]:
    """Keep to one thread: there is a process for each core already."""
    import torch  # noqa: PLC0415 - an extra

    before = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        yield
    finally:
        torch.set_num_threads(before)
