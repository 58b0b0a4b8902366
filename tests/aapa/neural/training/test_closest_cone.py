"""The rule by which the attention may be taught."""

from __future__ import annotations

import numpy as np

from aapa.neural.training.closest_cone import closest_cone


def table(*frames: dict[int, tuple[int, int]], cones: tuple[int, ...] = (1, 2)) -> np.ndarray:
    """Slots that are seen in each frame, each at a place; slot 0 is the snitch."""
    made = np.zeros((len(frames), 15, 6), dtype=np.int16)
    made[:, list(cones), 5] = 1
    for number, frame in enumerate(frames):
        for slot, (x, y) in frame.items():
            made[number, slot, :5] = x - 5, y - 5, x + 5, y + 5, 1
    return made


def test_while_it_is_seen_it_is_the_snitch():
    assert closest_cone(table({0: (50, 50), 1: (50, 52)}, {0: (9, 9)})).tolist() == [0, 0]


def test_what_vanishes_is_under_the_nearest_cone_until_it_is_seen_again():
    slots = closest_cone(
        table(
            {0: (50, 50), 1: (60, 50), 2: (90, 50)},
            {1: (50, 50), 2: (90, 50)},
            {1: (200, 50), 2: (50, 50)},  # carried away; the other cone comes near
            {0: (200, 52), 1: (260, 50), 2: (50, 50)},
        )
    )
    assert slots.tolist() == [0, 1, 1, 0]


def test_what_is_nearest_but_no_cone_covers_nothing():
    slots = closest_cone(table({0: (50, 50), 3: (55, 50), 1: (90, 50)}, {3: (50, 50), 1: (90, 50)}))
    assert slots.tolist() == [0, 0]


def test_a_cone_may_vanish_under_another_and_come_back():
    slots = closest_cone(
        table(
            {0: (50, 50), 1: (60, 50), 2: (90, 50)},
            {1: (50, 50), 2: (90, 50)},
            {2: (50, 50)},
            {2: (150, 50)},
            {1: (150, 50), 2: (200, 50)},
            {0: (150, 50), 1: (220, 50), 2: (200, 50)},
        )
    )
    assert slots.tolist() == [0, 1, 2, 2, 1, 0]


def test_with_nothing_to_be_seen_it_stays():
    assert closest_cone(table({0: (50, 50)}, {}, {})).tolist() == [0, 0, 0]
