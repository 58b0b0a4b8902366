"""The pairs within reach are found, all of them, whichever way they are looked for."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aapa import gating

whole = st.tuples(st.integers(-40, 40), st.integers(-40, 40))
sides = st.lists(whole, min_size=1, max_size=15).map(lambda p: np.array(p, dtype=float))


def near(old, new, reach):
    """The pairs within reach, by looking at all of them."""
    squares = ((old[:, None] - new[None]) ** 2).sum(axis=-1)
    return set(zip(*(side.tolist() for side in np.nonzero(squares <= reach**2)), strict=True))


def found(pairs):
    rows, columns = pairs
    assert (np.diff(rows) >= 0).all()
    listed = list(zip(rows.tolist(), columns.tolist(), strict=True))
    assert len(set(listed)) == len(listed)
    return set(listed)


@given(sides, sides, st.sampled_from([0.5, 1.0, 5.0, 17.0, 200.0]))
def test_no_pair_within_reach_is_left_out(old, new, reach):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(gating, "_CROWD", 2.0)
        by_grid = found(gating.pairs_within(old, new, reach))
        by_tree = found(gating._by_tree(old, new, reach))
    wanted, room = near(old, new, reach), near(old, new, reach * 1.00001)
    assert wanted <= by_grid <= room
    assert wanted <= by_tree <= room


@given(st.integers(0, 2**20), st.sampled_from([0.1, 1 / 3, 55.0]))
def test_neighbours_exactly_one_reach_apart_are_found_wherever_they_lie(steps, reach):
    # Multiples of the reach are where rounding could put two neighbours two cells apart.
    old = np.array([[0.0, 0.0], [steps * reach, 0.0]])
    new = old + np.array([reach, 0.0])
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(gating, "_CROWD", 2.0)
        patch.setattr(gating, "_CELLS_EACH", 10**6)
        pairs = found(gating.pairs_within(old, new, reach * (1 + 1e-9)))
    assert {(0, 0), (1, 1)} <= pairs


def test_the_grid_and_the_tree_find_the_same_in_a_large_scene():
    chance = np.random.default_rng(2)
    old, new = chance.uniform(-500, 1500, (2, 800, 2))
    assert found(gating.pairs_within(old, new, 55.0)) == found(gating._by_tree(old, new, 55.0))


def test_far_strays_do_not_make_a_table_of_all_the_space_between(monkeypatch):
    chance = np.random.default_rng(3)
    old = np.concatenate([chance.uniform(0, 900, (300, 2)), [[1e9, -1e9]]])
    monkeypatch.setattr(gating, "_by_grid", None)  # would fail if it were asked
    assert found(gating.pairs_within(old, old + 1.0, 20.0)) == near(old, old + 1.0, 20.0)


def test_a_reach_of_next_to_nothing_makes_no_endless_table(monkeypatch):
    monkeypatch.setattr(gating, "_CROWD", 2.0)
    old = np.array([[0.0, 0.0], [900.0, 500.0]])
    assert found(gating.pairs_within(old, old[::-1].copy(), 1e-160)) == {(0, 1), (1, 0)}


def test_positions_in_space_may_have_three_coordinates():
    chance = np.random.default_rng(5)
    old, new = chance.uniform(0, 1, (2, 200, 3))
    assert found(gating.pairs_within(old, new, 0.06)) == near(old, new, 0.06)


@pytest.mark.parametrize("dimensions", [2, 3])
def test_in_a_crowd_no_pairs_are_listed(dimensions):
    chance = np.random.default_rng(4)
    old, new = chance.uniform(0, 40, (2, 200, dimensions))
    assert gating.pairs_within(old, new, 80.0) is None
