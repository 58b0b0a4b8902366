"""Looking at near pairs only gives the optimum that looking at all pairs gives."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import linear_sum_assignment

from aapa import alignment, gating
from aapa.alignment import Place, align
from aapa.costs import CENTRE, CENTRE_AND_SIZE


def total(pairs, old, new, tau):
    costs = CENTRE.pairs(old[[i for i, _ in pairs]], new[[j for _, j in pairs]])
    return float(costs.sum()) + tau * (min(len(old), len(new)) - len(pairs))


def near(old, new, tau):
    return gating.cheapest_near_pairs((old, new), (old, new), tau, CENTRE)


def is_matching(pairs):
    return len({i for i, _ in pairs}) == len({j for _, j in pairs}) == len(pairs)


def dense(old, new, tau):
    """The optimum by scipy's dense solver alone: what everything here is compared with."""
    costs = CENTRE.pairs(old[:, None], new[None])
    rows, columns = linear_sum_assignment(np.where(costs > tau, tau * (1 + 1e-9), costs))
    return [(i, j) for i, j in zip(rows, columns, strict=True) if costs[i, j] <= tau]


whole = st.tuples(st.integers(0, 30), st.integers(0, 30))
sides = st.lists(whole, min_size=1, max_size=12).map(lambda p: np.array(p, dtype=float))
taus = st.sampled_from([1.0, 4.0, 16.0, 25.0, 100.0, 2000.0])


@given(sides, sides, taus, st.booleans())
def test_small_and_tied_problems_are_solved_as_the_dense_solver_does(old, new, tau, sparse):
    with pytest.MonkeyPatch.context() as patch:
        # Every way through: the crowd's, the rest solved densely, the rest solved sparsely.
        patch.setattr(gating, "_CROWD", 1.0)
        patch.setattr(gating, "_DENSE_SIDE", 0 if sparse else 150)
        pairs = near(old, new, tau)
    best = dense(old, new, tau)
    assert is_matching(pairs)
    # Whole numbers: the least total, and with it the most pairs, come out exactly.
    assert total(pairs, old, new, tau) == total(best, old, new, tau)
    assert len(pairs) == len(best)
    assert all(((old[i] - new[j]) ** 2).sum() <= tau for i, j in pairs)


def test_two_pairs_at_exactly_tau_are_not_given_up_for_one(monkeypatch):
    # (0, 0), (0, 1) and (1, 0) are 5 px apart, (1, 1) is not: one pair costs as little as two.
    monkeypatch.setattr(gating, "_CROWD", 1.0)
    old, new = np.array([[0.0, 0.0], [8.0, 0.0]]), np.array([[4.0, 3.0], [-5.0, 0.0]])
    assert sorted(near(old, new, 25.0)) == [(0, 1), (1, 0)]


def test_a_scene_in_which_everything_hangs_together_is_solved_as_the_dense_solver_does():
    # One object to 60 x 60 px within 81 px of each other: one component of 1,200 objects.
    chance = np.random.default_rng(9)
    side = 60 * 1200**0.5
    old = chance.uniform(0, side, (1200, 2))
    new = old + chance.normal(0, 6, old.shape)
    new = np.concatenate([new[chance.random(1200) > 0.05], chance.uniform(0, side, (60, 2))])
    pairs, best = near(old, new, 6500.0), dense(old, new, 6500.0)
    assert is_matching(pairs)
    assert total(pairs, old, new, 6500.0) == pytest.approx(total(best, old, new, 6500.0), rel=1e-12)
    assert len(pairs) == len(best)


@pytest.mark.parametrize("cost", [CENTRE, CENTRE_AND_SIZE])
def test_types_do_not_mix_however_many_there_are(cost):
    chance = np.random.default_rng(3)
    corners = chance.integers(0, 900, (600, 2)).astype(float)
    old = [
        Place("ab"[n % 2], (x + 5, y + 5), (x, y, x + 10, y + 10))
        for n, (x, y) in enumerate(corners.tolist())
    ]
    new = [
        Place("ba"[n % 3 == 0], (x + 7, y + 5), (x + 2, y, x + 12, y + 10))
        for n, (x, y) in enumerate(corners.tolist())
    ]
    pairs = align(old, new, 400.0, cost).pairs
    assert len(pairs) > 300
    assert all(old[i].type == new[j].type for i, j in pairs)


def test_a_crowd_in_one_spot_goes_the_dense_way(monkeypatch):
    chance = np.random.default_rng(4)
    old, new = chance.uniform(0, 40, (2, 200, 2))
    monkeypatch.setattr(gating, "_within_reach", None)  # would fail if it were asked
    assert sorted(near(old, new, 6500.0)) == sorted(dense(old, new, 6500.0))


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("tau", [400.0, 3000.0, 20000.0])
def test_crowds_cost_what_the_dense_optimum_costs(seed, tau):
    # 400 objects, some lost, some new: what is left after the certain pairs is solved sparsely.
    chance = np.random.default_rng(seed)
    old = chance.uniform(0, 1200, (400, 2))
    new = old + chance.normal(0, 12, old.shape)
    new = np.concatenate([new[chance.random(400) > 0.1], chance.uniform(0, 1200, (40, 2))])
    new = new[chance.permutation(len(new))]
    pairs = near(old, new, tau)
    best = dense(old, new, tau)
    assert is_matching(pairs)
    assert total(pairs, old, new, tau) == pytest.approx(total(best, old, new, tau), rel=1e-12)
    assert pairs
    assert all(((old[i] - new[j]) ** 2).sum() <= tau for i, j in pairs)


@given(sides, sides, st.sampled_from([16.0, 100.0]))
def test_the_sparse_and_the_dense_rest_agree(old, new, tau):
    rows, columns = np.nonzero(CENTRE.pairs(old[:, None], new[None]) <= tau)
    if not len(rows):
        return
    costs = CENTRE.pairs(old[rows], new[columns])
    shape = (len(old), len(new))
    sparse = gating._sparse(rows, columns, costs, shape, tau).tolist()
    filled = gating._dense(rows, columns, costs, shape, tau).tolist()
    assert is_matching(sparse)
    assert total(sparse, old, new, tau) == total(filled, old, new, tau)


def test_a_pair_at_exactly_tau_is_formed():
    old, new = np.array([[0.0, 0.0]]), np.array([[3.0, 4.0]])
    assert near(old, new, 25.0) == [(0, 0)]
    assert near(old, new, 24.9) == []


def test_nothing_within_reach_gives_no_pairs():
    assert near(np.array([[0.0, 0.0]]), np.array([[90.0, 0.0]]), 25.0) == []


def test_objects_at_one_spot_are_paired_one_to_one():
    spot = np.zeros((300, 2))
    pairs = near(spot, spot[:290], 25.0)
    assert is_matching(pairs)
    assert len(pairs) == 290


def test_positions_in_space_may_have_three_coordinates():
    chance = np.random.default_rng(5)
    old = chance.uniform(0, 1, (200, 3))
    order = chance.permutation(200)
    pairs = near(old, old[order] + 1e-4, 0.0036)
    assert all(order[j] == i for i, j in pairs)
    assert len(pairs) == 200


def test_large_scenes_go_the_gated_way_and_small_ones_do_not(monkeypatch):
    called = []
    real = alignment.cheapest_near_pairs
    monkeypatch.setattr(
        alignment, "cheapest_near_pairs", lambda *given: (called.append(1), real(*given))[1]
    )
    places = [Place("x", (30.0 * n, 0.0), (30.0 * n - 5, 0, 30.0 * n + 5, 9)) for n in range(200)]
    assert align(places, places[::-1], 100.0).pairs == tuple((n, 199 - n) for n in range(200))
    assert called == [1]
    align(places[:20], places[:20], 100.0)
    assert called == [1]
    same = align(places, places[::-1], 100.0, CENTRE_AND_SIZE)
    assert same.pairs == tuple((n, 199 - n) for n in range(200))
    assert called == [1, 1]


def test_the_result_is_the_same_every_time():
    chance = np.random.default_rng(1)
    old = chance.integers(0, 60, (500, 2)).astype(float)
    new = chance.integers(0, 60, (500, 2)).astype(float)
    assert near(old, new, 100.0) == near(old, new, 100.0)
