"""The matching over listed pairs is the optimum, and what is called a proof is one."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import linear_sum_assignment

from aapa import matching
from aapa.exchanges import Bidding, disjoint_exchanges, leads_round
from aapa.matching import Offers, best_matching


def offers_of(gains):
    """All pairs with a gain above 0."""
    rows, columns = np.nonzero(gains > 0)
    return Offers(rows, columns, gains[rows, columns], gains.shape, float(gains.max(initial=1)))


def total(gains, column_of):
    formed = np.flatnonzero(column_of >= 0)
    assert len(set(column_of[formed].tolist())) == len(formed)
    assert (gains[formed, column_of[formed]] > 0).all()
    return float(gains[formed, column_of[formed]].sum())


def most(gains):
    rows, columns = linear_sum_assignment(-np.maximum(gains, 0))
    return float(np.maximum(gains, 0)[rows, columns].sum())


tables = st.integers(1, 8).flatmap(
    lambda width: st.lists(
        st.lists(st.integers(-3, 6), min_size=width, max_size=width), min_size=1, max_size=8
    )
)


@settings(max_examples=400)
@given(tables)
def test_small_and_tied_tables_come_out_as_the_dense_solver_has_them(table):
    gains = np.array(table, dtype=float)
    found = best_matching(offers_of(gains))
    assert found is not None
    assert total(gains, found) == most(gains)


@pytest.mark.parametrize("seed", range(30))
@pytest.mark.parametrize("share", [0.02, 0.05])
def test_contested_tables_come_out_right_or_are_passed_on(seed, share):
    chance = np.random.default_rng(seed)
    gains = chance.uniform(0, 1, (150, 140)) * (chance.random((150, 140)) < share)
    found = best_matching(offers_of(gains))
    if found is not None:
        assert total(gains, found) == pytest.approx(most(gains), rel=1e-12)


def test_a_circle_of_rows_that_want_each_other_s_columns_is_turned_round():
    # Row 0 takes column 0 first; that both change gains 1, but each alone would lose.
    gains = np.array([[10.0, 9.0], [9.0, 7.0]])
    assert best_matching(offers_of(gains)).tolist() == [1, 0]


def test_a_long_chain_of_exchanges_is_found():
    # Each row likes its own column best; only the last column is free, only the first row alone.
    count = 40
    gains = np.zeros((count + 1, count + 1))
    for row in range(count):
        gains[row + 1, row] = 10.0
        gains[row, row] = 9.9
    gains[count, count] = 9.9
    found = best_matching(offers_of(gains))
    assert found.tolist() == list(range(count + 1))


def test_what_takes_too_many_rounds_is_left_to_another_solver(monkeypatch):
    gains = np.array([[10.0, 9.0], [9.0, 7.0]])
    monkeypatch.setattr(matching, "_PROOFS", 0)
    assert best_matching(offers_of(gains)) is None
    monkeypatch.setattr(matching, "_PROOFS", 8)
    monkeypatch.setattr(matching, "_MOST_WAVES", 1)
    assert best_matching(offers_of(gains)) is None


def test_no_pairs_leave_all_alone():
    none = np.zeros(0, dtype=np.int64)
    assert best_matching(Offers(none, none, np.zeros(0), (3, 2), 1.0)).tolist() == [-1, -1, -1]


@settings(max_examples=200)
@given(tables)
def test_a_matching_that_passes_the_proof_cannot_be_improved(table):
    gains = np.array(table, dtype=float)[:4, :4]
    offers = offers_of(gains)
    state = matching._Matching(offers)
    state.take_mutual_bests()
    holds = matching._Proof(state).holds()
    rows, columns = range(gains.shape[0]), range(gains.shape[1])
    best = max(
        sum(max(0.0, gains[pair]) for pair in zip(chosen, order, strict=False))
        for chosen in itertools.permutations(rows)
        for order in itertools.permutations(columns)
    )
    if holds:
        assert total(gains, state.column_of) == best
    else:
        assert total(gains, state.column_of) < best


def test_exchanges_that_share_a_row_are_not_both_carried_out():
    # Row 0 is alone and bids for both columns: columns 0 and 1 are each wanted because of it.
    bidding = Bidding(bidder_of=[0, 0], column_of=[-1, 0, 1], row_of=[1, 2])
    found = disjoint_exchanges([0, 1], [], bidding)
    assert (found.rows, found.columns, found.ousted, found.left) == ([0], [0], [1], [])


def test_a_row_leaves_its_column_where_nobody_takes_it():
    bidding = Bidding(bidder_of=[-1, 0], column_of=[0], row_of=[0, -1])
    found = disjoint_exchanges([1], [], bidding)
    assert (found.rows, found.columns, found.ousted, found.left) == ([0], [1], [], [0])


def test_columns_whose_price_still_rises_count_only_in_a_circle():
    chain = Bidding(bidder_of=[0, 1], column_of=[-1, 0], row_of=[1, -1])
    assert not leads_round([1], chain)
    assert disjoint_exchanges([], [1], chain).rows == []
    circle = Bidding(bidder_of=[1, 0], column_of=[0, 1], row_of=[0, 1])
    assert leads_round([0], circle)
    assert sorted(disjoint_exchanges([], [0, 1], circle).rows) == [0, 1]
