"""Small videos for small networks."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
import pytest
import torch

from aapa.lacater import Perception
from aapa.neural.training.arrays import Seen, TrainingArrays

FRAMES = 24


@pytest.fixture(autouse=True)
def one_thread() -> Iterator[None]:
    """Several threads are slower on networks as small as these, and much slower on busy cores."""
    before = torch.get_num_threads()
    torch.set_num_threads(1)
    yield
    torch.set_num_threads(before)


@pytest.fixture
def perception() -> Callable[..., Perception]:
    """Detections from a list of (class, box) a frame, the surest first."""

    def make(*frames: list[tuple[int, tuple[int, int, int, int]]]) -> Perception:
        return Perception(
            tuple(np.array([b for _, b in f], dtype=np.int64).reshape(-1, 4) for f in frames),
            tuple(np.array([c for c, _ in f], dtype=np.int64) for f in frames),
        )

    return make


@pytest.fixture
def arrays() -> Callable[..., TrainingArrays]:
    """Snitches that go straight on, and for a while are under a cone that goes with them."""

    def make(videos: int, seed: int) -> TrainingArrays:
        chance = np.random.default_rng(seed)
        tables = np.zeros((videos, FRAMES, 15, 6), dtype=np.int16)
        tracked = np.zeros((videos, FRAMES), dtype=np.int8)
        labels = np.zeros((videos, FRAMES), dtype=np.uint8)
        start = chance.integers([20, 20], [200, 150], (videos, 2))
        step = chance.integers(-3, 4, (videos, 2))
        corners = start[:, None] + step[:, None] * np.arange(FRAMES)[:, None]
        corners = np.clip(corners, 0, [280, 200])
        boxes = np.concatenate([corners, corners + 20], axis=2).astype(np.int16)
        tables[:, :, 0, :4], tables[:, :, 0, 4] = boxes, 1
        tables[:, :, 1, :4] = np.concatenate([corners - 10, corners + 30], axis=2)
        tables[:, :, 1, 4:] = 1
        hidden = slice(FRAMES // 2, FRAMES - 4)
        tables[:, hidden, 0] = 0
        tracked[:, hidden] = 1
        labels[:, hidden] = 2
        first = np.zeros(videos, dtype=np.int16)
        seen = Seen(tables, tracked, first)
        return TrainingArrays(boxes, labels, {"od": seen, "pp": seen})

    return make
