"""The vector v and the matrix W."""

from __future__ import annotations

import numpy as np
import pytest

from aapa import AnchoringError
from aapa.neural import attention_weights, tracked_slots
from aapa.neural.features import SLOTS


def test_v_gives_the_slot_of_a_class_and_nothing_where_it_has_none():
    order = (140, *range(1, 20))
    slots = tracked_slots(np.array([140, 1, 14, 15, 77, -1]), order)
    assert slots.tolist() == [0, 1, 14, -1, -1, -1]


def test_w_is_one_but_for_the_slot_to_follow():
    weights = attention_weights(np.array([0, 3]), 100)
    expected = np.ones((2, SLOTS))
    expected[0, 0] = expected[1, 3] = 100
    assert (weights == expected).all()
    assert weights.dtype == np.float32


@pytest.mark.parametrize("slot", [-1, 15, 999])
def test_what_is_no_slot_tells_nothing(slot: int):
    assert (attention_weights(np.array([slot])) == 1).all()


def test_a_softmax_leaves_shares_and_at_a_hundred_nothing_to_the_others():
    weights = attention_weights(np.array([[2, -1]]), 5, "softmax")
    assert weights.shape == (1, 2, SLOTS)
    assert weights.sum(axis=-1) == pytest.approx(1)
    assert weights[0, 0, 2] == pytest.approx(np.exp(5) / (np.exp(5) + 14 * np.exp(1)))
    assert weights[0, 1] == pytest.approx(1 / SLOTS)
    assert attention_weights(np.array([2]), 100, "softmax")[0] == pytest.approx(np.eye(SLOTS)[2])


def test_a_weight_that_is_none_and_a_mode_that_is_none_are_refused():
    with pytest.raises(AnchoringError, match=r"weight of the guidance is 0.*above 0"):
        attention_weights(np.array([0]), 0)
    with pytest.raises(AnchoringError, match="no guidance 'loud'; known are product, softmax"):
        attention_weights(np.array([0]), 100, "loud")  # type: ignore[arg-type]
