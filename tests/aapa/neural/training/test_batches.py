"""What is seen together."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from aapa.neural.training.arrays import Seen, TrainingArrays
from aapa.neural.training.batches import Batch, Epoch, batches_of
from aapa.neural.training.closest_cone import closest_cone
from aapa.neural.training.hyperparameters import Hyperparameters, Stage

Make = Callable[[int, int], TrainingArrays]


def epoch_of(
    arrays: TrainingArrays, choice: Hyperparameters, number: int = 0, *, guided: bool = False
) -> list[Batch]:
    epoch = Epoch(arrays, choice, seed=4, number=number, guided=guided)
    batches = list(epoch.batches())
    assert len(batches) == len(epoch)
    return batches


def test_unshuffled_every_video_comes_once_in_its_order_whole(arrays: Make):
    made = arrays(5, 1)
    batches = epoch_of(made, Hyperparameters(batch=2))
    assert [len(batch.features) for batch in batches] == [2, 2, 1]
    seen = np.concatenate([batch.features for batch in batches])
    scale = np.float32([320, 240, 320, 240, 1, 1])
    assert seen == pytest.approx(made.seen["od"].tables / scale)
    assert np.concatenate([batch.boxes for batch in batches]) == pytest.approx(
        made.boxes / scale[:4]
    )
    assert batches[0].weights is None
    assert batches[0].attend is None


def test_shuffled_the_order_follows_from_seed_and_epoch(arrays: Make):
    made = arrays(9, 1)
    choice = Hyperparameters(batch=9, shuffle=True)
    first, again, next_one = (epoch_of(made, choice, n)[0].boxes for n in (0, 0, 1))
    assert (first == again).all()
    assert not (first == next_one).all()
    assert np.sort(first[:, 0, 0]) == pytest.approx(np.sort(next_one[:, 0, 0]))


def test_an_epoch_may_be_entered_in_the_middle(arrays: Make):
    epoch = Epoch(
        arrays(7, 1), Hyperparameters(batch=2, shuffle=True), seed=1, number=3, guided=False
    )
    rest = [batch.boxes for batch in epoch.batches(2)]
    whole = [batch.boxes for batch in epoch.batches()]
    assert len(rest) == 2
    assert all((a == b).all() for a, b in zip(rest, whole[2:], strict=True))


def test_guided_there_is_a_w(arrays: Make):
    made = arrays(2, 1)
    weights = epoch_of(made, Hyperparameters(guidance_weight=7), guided=True)[0].weights
    assert weights is not None
    assert weights[0, 0].tolist() == [7, *[1] * 14]
    assert weights[0, 15].tolist() == [1, 7, *[1] * 13]


def test_a_short_look_begins_where_the_snitch_is_seen(arrays: Make):
    made = arrays(40, 1)
    choice = Hyperparameters(batch=40, stages=(Stage(1, frames=6),))
    batch = epoch_of(made, choice)[0]
    assert batch.features.shape == (40, 6, 15, 6)
    assert (batch.features[:, 0, 0, 4] == 1).all()
    starts = {tuple(box) for box in batch.boxes[:, 0].tolist()}
    assert len(starts) > 20


def test_with_a_step_frames_are_left_out_alike_in_all_there_is(arrays: Make):
    made = arrays(3, 1)
    choice = Hyperparameters(stages=(Stage(1, step=5, teach=1),))
    batch = epoch_of(made, choice, guided=True)[0]
    assert batch.features.shape == (3, 4, 15, 6)
    assert batch.weights is not None
    assert batch.weights.shape == (3, 4, 15)
    seen = batch.features[..., 0, 4] == 1
    assert batch.features[seen][:, 0, :4] == pytest.approx(batch.boxes[seen])
    assert (batch.weights[seen][:, 0] == 100).all()


def test_what_is_taught_follows_from_what_is_seen(arrays: Make):
    made = arrays(2, 1)
    batch = epoch_of(made, Hyperparameters(stages=(Stage(1, teach=0.5),)))[0]
    assert batch.attend is not None
    assert batch.attend.tolist() == [closest_cone(t).tolist() for t in made.seen["od"].tables]
    assert (batch.attend[:, 15] == 1).all()


def test_the_detectors_take_turns(arrays: Make):
    made = arrays(4, 1)
    other = made.seen["pp"]
    empty = Seen(np.zeros_like(other.tables), other.tracked, other.first)
    made = TrainingArrays(made.boxes, made.labels, {"od": made.seen["od"], "pp": empty})
    choice = Hyperparameters(batch=4, perceptions=("od", "pp"))
    filled = [epoch_of(made, choice, n)[0].features.any(axis=(1, 2, 3)).tolist() for n in (0, 1)]
    assert filled == [[True, False, True, False], [False, True, False, True]]


def test_on_the_dev_split_everything_is_seen_whole(arrays: Make):
    made = arrays(5, 1)
    found = list(batches_of(made, "od", Hyperparameters(), guided=True, together=2))
    assert [list(videos) for videos, _ in found] == [[0, 1], [2, 3], [4]]
    assert sum(len(batch.features) for _, batch in found) == 5
    assert all(batch.weights is not None for _, batch in found)
