"""Which videos are seen together, which frames of them, and in whose detections.

All of it follows from the seed and the number of the epoch, so that a training that was
interrupted goes on with the very batches it would have had.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from aapa.neural.features import scaled, shares
from aapa.neural.guidance import attention_weights
from aapa.neural.training.arrays import Seen, TrainingArrays
from aapa.neural.training.closest_cone import closest_cone
from aapa.neural.training.hyperparameters import Hyperparameters


@dataclass(frozen=True, slots=True, eq=False)
class Batch:
    """What the network sees before its weights change once.

    Args:
        features: (videos, frames, 15, 6).
        weights: (videos, frames, 15) W, or None without guidance.
        boxes: (videos, frames, 4) where the snitch is, as shares of the picture.
        attend: (videos, frames) the slot at which the attention is taught to be, or None.
    """

    features: NDArray[np.float32]
    weights: NDArray[np.float32] | None
    boxes: NDArray[np.float32]
    attend: NDArray[np.int64] | None = None


class Epoch:
    """The batches of one epoch.

    Args:
        arrays: The videos.
        hyperparameters: How many of them at a time, how long, and whose detections.
        seed: With the number it says all about order and places.
        number: Of the epoch, from 0.
        guided: Whether W is wanted.
    """

    def __init__(
        self,
        arrays: TrainingArrays,
        hyperparameters: Hyperparameters,
        *,
        seed: int,
        number: int,
        guided: bool,
    ) -> None:
        self._arrays = arrays
        self._choice = hyperparameters
        self._number = number
        self._guided = guided
        chance = np.random.default_rng((seed, number))
        self._order = np.arange(arrays.videos)
        if hyperparameters.shuffle:
            chance.shuffle(self._order)
        self._stage = hyperparameters.stage(number)
        step = self._stage.step
        steps = max(min(self._stage.frames or arrays.frames, arrays.frames) // step, 1)
        self._span = (steps - 1) * step + 1
        self._places = chance.integers(0, arrays.frames - self._span + 1, arrays.videos)

    def __len__(self) -> int:
        """Give the number of batches; the last one may be smaller."""
        return updates_an_epoch(self._arrays.videos, self._choice.batch)

    def batches(self, first: int = 0) -> Iterator[Batch]:
        """Give the batches, from one on."""
        for start in range(first * self._choice.batch, self._arrays.videos, self._choice.batch):
            yield self._batch(self._order[start : start + self._choice.batch])

    def _batch(self, videos: NDArray[np.int64]) -> Batch:
        tables, tracked, boxes = [], [], []
        for video in videos.tolist():
            kinds = self._choice.perceptions
            seen = self._arrays.seen[kinds[(video + self._number) % len(kinds)]]
            start = self._start(seen, video)
            window = slice(start, start + self._span, self._stage.step)
            tables.append(seen.tables[video, window])
            tracked.append(seen.tracked[video, window])
            boxes.append(self._arrays.boxes[video, window])
        weights = None
        if self._guided:
            choice = self._choice
            weights = attention_weights(
                np.stack(tracked), choice.guidance_weight, choice.guidance_mode
            )
        attend = None
        if self._stage.teach:
            attend = np.stack([closest_cone(table) for table in tables]).astype(np.int64)
        return Batch(scaled(np.stack(tables)), weights, shares(np.stack(boxes)), attend)

    def _start(self, seen: Seen, video: int) -> int:
        """Give where to begin: the next place at which the snitch is seen, if there is one."""
        place = int(self._places[video])
        last = self._arrays.frames - self._span
        if last == 0 or seen.first[video] < 0:
            return place
        found = np.flatnonzero(seen.tables[video, place : last + 1, 0, 4])
        return place + int(found[0]) if len(found) else min(int(seen.first[video]), last)


def updates_an_epoch(videos: int, batch: int) -> int:
    """Give how many batches there are of so many videos."""
    return -(-videos // batch)


def batches_of(
    arrays: TrainingArrays,
    kind: str,
    hyperparameters: Hyperparameters,
    *,
    guided: bool,
    together: int = 32,
) -> Iterator[tuple[Sequence[int], Batch]]:
    """Give all videos in their order and at their full length, with their numbers."""
    seen = arrays.seen[kind]
    for start in range(0, arrays.videos, together):
        videos = range(start, min(start + together, arrays.videos))
        window = slice(videos.start, videos.stop)
        weights = None
        if guided:
            weights = attention_weights(
                seen.tracked[window],
                hyperparameters.guidance_weight,
                hyperparameters.guidance_mode,
            )
        yield videos, Batch(scaled(seen.tables[window]), weights, shares(arrays.boxes[window]))
