"""Every way through an assignment problem gives the optimum that the full matrix gives."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import linear_sum_assignment

from aapa import alignment, assignment, matching
from aapa.alignment import Place, align
from aapa.assignment import Side, cheapest
from aapa.costs import CENTRE, CENTRE_AND_SIZE, OVERLAP


def side(centres, kinds=None):
    numbers = np.zeros(len(centres), dtype=np.int64) if kinds is None else kinds
    return Side(numbers, centres, centres)


def solved(old, new, tau):
    rows, columns = cheapest(side(old), side(new), tau, CENTRE)
    return list(zip(rows.tolist(), columns.tolist(), strict=True))


def total(pairs, old, new, tau):
    costs = CENTRE.pairs(old[[i for i, _ in pairs]], new[[j for _, j in pairs]])
    return float(costs.sum()) + tau * (min(len(old), len(new)) - len(pairs))


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
        # Every way through: the near pairs' proof, and the sparse solver.
        patch.setattr(assignment, "LARGEST_FULL", 0)
        patch.setattr("aapa.gating._CROWD", 2.0)
        if sparse:
            patch.setattr(matching, "_PROOFS", 0)
        pairs = solved(old, new, tau)
    best = dense(old, new, tau)
    assert is_matching(pairs)
    # Whole numbers: the least total, and with it the most pairs, come out exactly.
    assert total(pairs, old, new, tau) == total(best, old, new, tau)
    assert len(pairs) == len(best)
    assert all(((old[i] - new[j]) ** 2).sum() <= tau for i, j in pairs)


@pytest.mark.parametrize("sparse", [False, True])
def test_two_pairs_at_exactly_tau_are_not_given_up_for_one(monkeypatch, sparse):
    # (0, 0), (0, 1) and (1, 0) are 5 px apart, (1, 1) is not: one pair costs as little as two.
    monkeypatch.setattr(assignment, "LARGEST_FULL", 0)
    monkeypatch.setattr("aapa.gating._CROWD", 2.0)
    if sparse:
        monkeypatch.setattr(matching, "_PROOFS", 0)
    old, new = np.array([[0.0, 0.0], [8.0, 0.0]]), np.array([[4.0, 3.0], [-5.0, 0.0]])
    assert solved(old, new, 25.0) == [(0, 1), (1, 0)]


def scene(seed, count, spread):
    """Objects of which some are lost and some new, to 60 x 60 px each."""
    chance = np.random.default_rng(seed)
    size = 60 * count**0.5
    old = chance.uniform(0, size, (count, 2))
    new = old + chance.normal(0, spread, old.shape)
    lost = chance.random(count) < 0.1
    new = np.concatenate([new[~lost], chance.uniform(0, size, (count // 10, 2))])
    return old, new[chance.permutation(len(new))]


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("tau", [400.0, 3000.0, 20000.0])
@pytest.mark.parametrize("spread", [6.0, 40.0])
def test_crowds_cost_what_the_dense_optimum_costs(seed, tau, spread):
    old, new = scene(seed, 400, spread)
    pairs, best = solved(old, new, tau), dense(old, new, tau)
    assert is_matching(pairs)
    assert total(pairs, old, new, tau) == pytest.approx(total(best, old, new, tau), rel=1e-12)
    assert len(pairs) == len(best)
    assert all(((old[i] - new[j]) ** 2).sum() <= tau for i, j in pairs)


def test_a_scene_in_which_everything_hangs_together_is_solved_as_the_dense_solver_does():
    # Within 81 px of each other, one object to 60 x 60 px: one component of 1,200 objects.
    old, new = scene(9, 1200, 6.0)
    pairs, best = solved(old, new, 6500.0), dense(old, new, 6500.0)
    assert is_matching(pairs)
    assert total(pairs, old, new, 6500.0) == pytest.approx(total(best, old, new, 6500.0), rel=1e-12)
    assert len(pairs) == len(best)


@pytest.mark.parametrize("shift", [30.0, 31.0, 45.0])
def test_a_lattice_between_two_places_is_solved_as_the_dense_solver_does(shift):
    # Each object could as well be its neighbour: ties, and exchanges as long as a line.
    line = np.arange(20) * 60.0
    old = np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2)
    moved = old + np.array([shift, 0.0])
    pairs, best = (solve(old, moved, 6500.0) for solve in (solved, dense))
    assert is_matching(pairs)
    assert total(pairs, old, moved, 6500.0) == total(best, old, moved, 6500.0)
    assert len(pairs) == len(best)


def test_a_crowd_in_one_spot_goes_the_dense_way(monkeypatch):
    chance = np.random.default_rng(4)
    old, new = chance.uniform(0, 40, (2, 200, 2))
    monkeypatch.setattr(assignment, "best_matching", None)  # would fail if it were asked
    assert solved(old, new, 6500.0) == sorted(dense(old, new, 6500.0))


@pytest.mark.parametrize("crowded", [False, True])
def test_types_share_a_problem_and_do_not_mix(crowded):
    chance = np.random.default_rng(8)
    old = chance.uniform(0, 60 if crowded else 900, (300, 2))
    new = old + chance.normal(0, 3, old.shape)
    kinds = np.arange(300) % 3
    other = np.where(chance.random(300) < 0.2, 7, kinds)
    rows, columns = cheapest(side(old, kinds), side(new, other), 900.0, CENTRE)
    together = list(zip(rows.tolist(), columns.tolist(), strict=True))
    assert (kinds[rows] == other[columns]).all()
    expected = 0.0
    for kind in range(3):
        mine, theirs = old[kinds == kind], new[other == kind]
        expected += total(dense(mine, theirs, 900.0), mine, theirs, 900.0)
    spare = sum(min((kinds == k).sum(), (other == k).sum()) for k in range(3)) - len(together)
    costs = CENTRE.pairs(old[rows], new[columns])
    assert costs.sum() + 900.0 * spare == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("cost", [CENTRE, CENTRE_AND_SIZE, OVERLAP])
def test_a_cost_without_a_reach_is_solved_with_all_pairs(cost):
    chance = np.random.default_rng(6)
    corners = chance.uniform(0, 900, (170, 2))
    boxes = np.concatenate([corners, corners + 20], axis=1)
    order = chance.permutation(170)
    features = boxes[:, :2] + 10 if cost is CENTRE else boxes
    old = Side(np.zeros(170, dtype=np.int64), corners + 10, features)
    new = Side(old.kinds, old.centres[order], features[order])
    rows, columns = cheapest(old, new, 0.9, cost)
    assert (order[columns] == rows).all()
    assert len(rows) == 170


def test_two_sides_of_one_type_each_but_not_the_same_form_no_pairs():
    old, new = scene(2, 200, 6.0)
    other = np.ones(len(new), dtype=np.int64)
    assert [len(one) for one in cheapest(side(old), side(new, other), 900.0, CENTRE)] == [0, 0]


def test_one_empty_side_gives_no_pairs():
    none, some = side(np.zeros((0, 2))), side(np.ones((3, 2)))
    assert [
        len(rows) for rows, _ in (cheapest(none, some, 1, CENTRE), cheapest(some, none, 1, CENTRE))
    ] == [0, 0]


def test_objects_at_one_spot_are_paired_one_to_one():
    spot = np.zeros((300, 2))
    pairs = solved(spot, spot[:290], 25.0)
    assert is_matching(pairs)
    assert len(pairs) == 290


def test_positions_in_space_may_have_three_coordinates():
    chance = np.random.default_rng(5)
    old = chance.uniform(0, 1, (200, 3))
    order = chance.permutation(200)
    pairs = solved(old, old[order] + 1e-4, 0.0036)
    assert all(order[j] == i for i, j in pairs)
    assert len(pairs) == 200


def test_large_scenes_are_solved_as_one_problem_and_small_ones_are_not(monkeypatch):
    called = []
    real = alignment.cheapest
    monkeypatch.setattr(alignment, "cheapest", lambda *given: (called.append(1), real(*given))[1])
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
    old = chance.integers(0, 600, (500, 2)).astype(float)
    new = chance.integers(0, 600, (500, 2)).astype(float)
    assert solved(old, new, 1000.0) == solved(old, new, 1000.0)
