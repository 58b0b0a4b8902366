from __future__ import annotations

import math
import statistics as reference

import pytest
from gearbox.statistics import Rate, median, shown
from hypothesis import given
from hypothesis import strategies as st

RATES = st.integers(1, 500).flatmap(
    lambda runs: st.integers(0, runs).map(lambda hits: Rate(hits, runs))
)


@pytest.mark.parametrize(
    ("hits", "runs", "low", "high"),
    [(0, 10, 0.0, 0.2775), (5, 10, 0.2366, 0.7634), (1, 10, 0.0179, 0.4042), (300, 300, 0.9874, 1)],
)
def test_wilsons_interval_is_that_of_the_tables(hits, runs, low, high):
    found = Rate(hits, runs).interval
    assert found == pytest.approx((low, high), abs=5e-5)


@given(RATES)
def test_the_interval_holds_the_share_and_stays_inside(rate):
    low, high = rate.interval
    assert 0 <= low <= rate.share <= high <= 1
    assert low < high


@given(RATES)
def test_hits_and_misses_mirror_each_other(rate):
    low, high = rate.interval
    mirrored = Rate(rate.runs - rate.hits, rate.runs).interval
    assert mirrored == pytest.approx((1 - high, 1 - low), abs=1e-12)


@given(RATES)
def test_its_ends_are_where_the_score_test_just_rejects(rate):
    # What defines the interval: at each end the observed share is z standard errors away.
    z = reference.NormalDist().inv_cdf(0.975)
    for end in rate.interval:
        if 0 < end < 1:
            error = math.sqrt(end * (1 - end) / rate.runs)
            assert abs(rate.share - end) == pytest.approx(z * error, rel=1e-6)


def test_no_runs_are_a_dash():
    assert str(Rate(0, 0)) == "-"
    assert Rate(0, 0).interval == (0.0, 1.0)
    assert math.isnan(median([]))
    assert shown(math.nan) == "-"


def test_a_rate_is_shown_with_its_interval():
    assert str(Rate(49, 50)) == "49 of 50 (90-100 %)"
    assert shown(1234.567) == "1,234.6"
