from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from icarus_lite.inference.network.kernels.sweep import Stretch, candidates

_PLACES = st.lists(
    st.one_of(st.floats(-50, 50), st.integers(-50, 50).map(float)), min_size=1, max_size=25
)
_REACHES = st.sampled_from([0.0, 1e-3, 0.5, 1.0, 2.5, 7.0, 40.0])


@settings(max_examples=150, deadline=None)
@given(st.data(), st.integers(1, 3))
def test_every_pair_within_reach_is_found_and_none_twice(data: st.DataObject, axes: int) -> None:
    count = len(data.draw(_PLACES, label="left"))
    other = len(data.draw(_PLACES, label="right"))
    stretches = []
    for _ in range(axes):
        ends = [
            np.array(data.draw(st.lists(st.floats(-50, 50), min_size=n, max_size=n)))
            for n in (count, other)
        ]
        stretches.append(Stretch(ends[0], ends[1], data.draw(_REACHES)))
    found = candidates(stretches, 2)
    if found is None:
        return
    pairs = list(zip(*(each.tolist() for each in found), strict=True))
    assert len(pairs) == len(set(pairs))
    near = np.ones((count, other), dtype=bool)
    for axis in stretches:
        near &= np.abs(axis.left[:, None] - axis.right) <= axis.reach
    assert set(zip(*(each.tolist() for each in np.nonzero(near)), strict=True)) <= set(pairs)


@settings(max_examples=150, deadline=None)
@given(st.lists(st.tuples(st.floats(-50, 50), st.floats(-9, 9)), min_size=1, max_size=40), _REACHES)
def test_mirrored_pairs_are_found_once(places: list[tuple[float, float]], reach: float) -> None:
    columns = [np.array(each) for each in zip(*places, strict=True)]
    axes = [Stretch(each, each, reach) for each in columns]
    found = candidates(axes, 2, mirrored=True)
    if found is None:
        return
    pairs = [tuple(sorted(pair)) for pair in zip(*(e.tolist() for e in found), strict=True)]
    assert len(pairs) == len(set(pairs))
    near = np.ones((len(places), len(places)), dtype=bool)
    for each in columns:
        near &= np.abs(each[:, None] - each) <= reach
    wanted = {(i, j) for i, j in zip(*np.nonzero(near), strict=True) if i <= j}
    assert wanted <= set(pairs)


def test_a_grid_finds_far_fewer_pairs_than_there_are() -> None:
    rng = np.random.default_rng(3)
    axes = [Stretch(each, each, 300.0) for each in rng.uniform(0, 8000, (2, 1000))]
    found = candidates(axes, 4, mirrored=True)
    assert found is not None
    assert len(found[0]) < 15_000
    one = candidates(axes[:1], 4)
    assert one is not None
    assert len(one[0]) < 150_000


@pytest.mark.parametrize("reach", [1e9, float("inf")])
def test_objects_that_are_all_near_are_left_to_other_ways(reach: float) -> None:
    places = np.arange(10.0)
    assert candidates([Stretch(places, places, reach)], 4) is None
    assert candidates([], 4) is None


def test_places_on_the_edges_of_strips_count_on_both_sides() -> None:
    places = np.arange(0.0, 100.0)
    found = candidates([Stretch(places, places + 1.0, 1.0)], 4)
    assert found is not None
    pairs = set(zip(*(each.tolist() for each in found), strict=True))
    assert {(n, m) for n in range(100) for m in (n - 2, n - 1, n) if m >= 0} <= pairs
