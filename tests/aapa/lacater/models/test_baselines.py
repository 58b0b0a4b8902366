"""The models that know no actions, on frames worked by hand."""

from __future__ import annotations

import numpy as np

from aapa.lacater.models.heuristic import ClosestObject
from aapa.lacater.models.last_seen import LastSeen
from aapa.lacater.models.model import Frame

SNITCH, SPHERE, SMALL_CONE, LARGE_CONE = 140, 156, 141, 48


def follow(tracker, *frames):
    """Give what a tracker says to frames of {class: box}."""
    answers = []
    for number, seen in enumerate(frames):
        boxes = np.array(list(seen.values()), dtype=np.int64).reshape(-1, 4)
        classes = np.array(list(seen), dtype=np.int64)
        answers.append(tracker.observe(Frame(number, boxes, classes)))
    return answers


def test_the_last_box_is_held():
    at, away = (10, 10, 20, 20), (50, 50, 60, 60)
    answers = follow(LastSeen(), {}, {SNITCH: at}, {SPHERE: away}, {}, {SNITCH: away})
    assert answers == [None, at, at, at, away]


def test_of_two_snitches_the_surest_counts():
    boxes = np.array([[1, 1, 5, 5], [9, 9, 12, 12]])
    assert LastSeen().observe(Frame(0, boxes, np.array([SNITCH, SNITCH]))) == (1, 1, 5, 5)


def test_a_hidden_snitch_goes_with_what_is_nearest():
    answers = follow(
        ClosestObject(),
        {SNITCH: (10, 10, 20, 20), SPHERE: (30, 10, 40, 20), SMALL_CONE: (10, 60, 20, 70)},
        {SPHERE: (30, 10, 40, 20), SMALL_CONE: (10, 60, 20, 70)},
        {SPHERE: (40, 14, 50, 24), SMALL_CONE: (10, 60, 20, 70)},
    )
    # The sphere's middle is 20 px off, the cone's 50.
    assert answers == [(10, 10, 20, 20), (30, 10, 40, 20), (40, 14, 50, 24)]


def test_the_snitch_keeps_its_size_and_middles_are_whole_px():
    answers = follow(ClosestObject(), {SNITCH: (10, 10, 21, 17)}, {SPHERE: (30, 30, 41, 41)})
    # Middle (35, 35); 11 x 7 px around it.
    assert answers[1] == (30, 32, 41, 39)


def test_below_a_large_cone_the_snitch_is_15_px_lower():
    answers = follow(
        ClosestObject(),
        {SNITCH: (10, 10, 20, 20)},
        {LARGE_CONE: (0, 0, 40, 40)},
        {SNITCH: (10, 10, 20, 20)},
    )
    assert answers[1] == (15, 30, 25, 40)
    assert answers[2] == (10, 10, 20, 20)


def test_when_what_is_tracked_is_lost_too_the_next_nearest_is_and_back_again():
    snitch, cone, ball = (10, 10, 20, 20), (12, 10, 22, 20), (30, 10, 40, 20)
    answers = follow(
        ClosestObject(),
        {SNITCH: snitch, SMALL_CONE: cone, SPHERE: ball},
        {SMALL_CONE: cone, SPHERE: ball},  # the cone hides the snitch
        {SPHERE: ball},  # the ball hides the cone
        {SPHERE: (50, 10, 60, 20)},
        {SPHERE: (50, 10, 60, 20), SMALL_CONE: (70, 10, 80, 20)},  # the cone is seen again
        {SPHERE: (50, 10, 60, 20), SMALL_CONE: (75, 10, 85, 20)},
    )
    assert answers[1:] == [
        cone,
        ball,
        (50, 10, 60, 20),
        (70, 10, 80, 20),
        (75, 10, 85, 20),
    ]


def test_without_any_detection_the_state_is_kept():
    answers = follow(
        ClosestObject(), {}, {SNITCH: (10, 10, 20, 20)}, {}, {SPHERE: (15, 10, 25, 20)}, {}
    )
    assert answers == [None, *[(10, 10, 20, 20)] * 2, *[(15, 10, 25, 20)] * 2]


def test_nothing_is_told_before_the_snitch_was_seen():
    assert follow(ClosestObject(), {SPHERE: (1, 1, 9, 9)}, {}) == [None, None]
