from __future__ import annotations

import subprocess
import sys

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from aapa.alignment import Alignment, Place, align, squared_distance
from aapa.errors import AnchoringError

coordinates = st.integers(0, 40)
places = st.builds(
    Place, st.sampled_from(["cone", "ball"]), st.tuples(coordinates, coordinates).map(tuple)
)
sides = st.lists(places, max_size=6)
taus = st.sampled_from([1.0, 25.0, 200.0, 900.0, 1e6])


def total(alignment: Alignment, anchors, detections, tau):
    matched = sum(
        squared_distance(anchors[row].centre, detections[column].centre)
        for row, column in alignment.pairs
    )
    possible = sum(
        min(
            sum(place.type == name for place in anchors),
            sum(place.type == name for place in detections),
        )
        for name in ("cone", "ball")
    )
    return matched + tau * (possible - len(alignment.pairs))


def cheapest_by_trying_all(anchors, detections, tau):
    """The least (cost, unformed pairs) over every partial matching, by brute force."""

    def best(row, free):
        if row == len(anchors):
            return 0.0, 0
        cost, unformed = best(row + 1, free)
        options = [(cost, unformed)]
        for column in free:
            if anchors[row].type != detections[column].type:
                continue
            pair = squared_distance(anchors[row].centre, detections[column].centre)
            if pair <= tau:
                cost, unformed = best(row + 1, free - {column})
                options.append((cost + pair - tau, unformed - 1))
        return min(options)

    cost, pairs = best(0, frozenset(range(len(detections))))
    possible = sum(
        min(sum(p.type == name for p in anchors), sum(p.type == name for p in detections))
        for name in ("cone", "ball")
    )
    return cost + tau * possible, -pairs


@settings(max_examples=80, deadline=None)
@given(sides.filter(lambda side: len(side) <= 5), sides, taus)
def test_total_cost_is_the_least_of_all_matchings(anchors, detections, tau):
    alignment = align(anchors, detections, tau)
    cost, pairs = cheapest_by_trying_all(anchors, detections, tau)
    assert total(alignment, anchors, detections, tau) == pytest.approx(cost)
    assert len(alignment.pairs) == pairs


@settings(max_examples=60, deadline=None)
@given(sides, sides, taus)
def test_every_index_occurs_exactly_once_and_pairs_are_allowed(anchors, detections, tau):
    alignment = align(anchors, detections, tau)
    rows = [row for row, _ in alignment.pairs] + list(alignment.lost)
    columns = [column for _, column in alignment.pairs] + list(alignment.appeared)
    assert sorted(rows) == list(range(len(anchors)))
    assert sorted(columns) == list(range(len(detections)))
    for row, column in alignment.pairs:
        assert anchors[row].type == detections[column].type
        assert squared_distance(anchors[row].centre, detections[column].centre) <= tau


@settings(max_examples=60, deadline=None)
@given(sides, sides, taus, st.randoms(use_true_random=False))
def test_total_cost_does_not_depend_on_the_order(anchors, detections, tau, random):
    shuffled_anchors = random.sample(anchors, len(anchors))
    shuffled = random.sample(detections, len(detections))
    before = total(align(anchors, detections, tau), anchors, detections, tau)
    after = total(align(shuffled_anchors, shuffled, tau), shuffled_anchors, shuffled, tau)
    assert before == pytest.approx(after)


general_places = st.lists(
    st.tuples(st.floats(0, 100), st.floats(0, 100)), min_size=1, max_size=6, unique=True
)


@settings(max_examples=60, deadline=None)
@given(general_places, st.randoms(use_true_random=False))
def test_permuting_the_detections_permutes_the_pairs(centres, random):
    # 200 px apart and moved by less than 60: there is one optimum only.
    anchors = [Place("cone", (200.0 * index, 0.0)) for index in range(len(centres))]
    detections = [
        Place("cone", (200.0 * index + x / 2, y / 2)) for index, (x, y) in enumerate(centres)
    ]
    order = random.sample(range(len(detections)), len(detections))
    permuted = align(anchors, [detections[index] for index in order], 1e5)
    undone = tuple(sorted((row, order[column]) for row, column in permuted.pairs))
    assert undone == align(anchors, detections, 1e5).pairs


@pytest.mark.parametrize(("rows", "columns"), [(0, 0), (0, 3), (3, 0), (1, 4), (4, 1), (2, 3)])
def test_sides_of_different_length(rows, columns):
    anchors = [Place("cone", (float(index), 0.0)) for index in range(rows)]
    detections = [Place("cone", (float(index), 0.0)) for index in range(columns)]
    alignment = align(anchors, detections, 100.0)
    common = min(rows, columns)
    assert alignment.pairs == tuple((index, index) for index in range(common))
    assert alignment.lost == tuple(range(common, rows))
    assert alignment.appeared == tuple(range(common, columns))


def test_the_cap_is_part_of_the_optimum():
    # Without the cap the two 9-px pairs (162) beat 0 + 324; the second of those would be dropped.
    anchors = [Place("cone", (0.0, 0.0)), Place("cone", (9.0, 0.0))]
    detections = [Place("cone", (9.0, 0.0)), Place("cone", (18.0, 0.0))]
    assert align(anchors, detections, 1000.0).pairs == ((0, 0), (1, 1))
    assert align(anchors, detections, 100.0).pairs == ((1, 0),)


def test_a_pair_at_exactly_tau_is_taken():
    one = [Place("cone", (0.0, 0.0))]
    assert align(one, [Place("cone", (10.0, 0.0))], 100.0).pairs == ((0, 0),)
    assert align(one * 2, [Place("cone", (10.0, 0.0))] * 2, 100.0).lost == ()
    assert align(one, [Place("cone", (10.001, 0.0))], 100.0).pairs == ()


@pytest.mark.parametrize("near", [0, 1])
@pytest.mark.parametrize("anchor", [0, 1])
def test_a_pair_at_exactly_tau_is_taken_rather_than_none(anchor, near):
    anchors = [Place("cone", (1000.0, 0.0)), Place("cone", (1000.0, 0.0))]
    anchors[anchor] = Place("cone", (0.0, 0.0))
    detections = [Place("cone", (-1000.0, 0.0)), Place("cone", (-1000.0, 0.0))]
    detections[near] = Place("cone", (10.0, 0.0))
    assert align(anchors, detections, 100.0).pairs == ((anchor, near),)


def test_ties_come_out_the_same_each_time():
    anchors = [Place("cone", (0.0, 0.0)), Place("cone", (2.0, 0.0))]
    detections = [Place("cone", (1.0, 0.0))] * 3
    results = {align(anchors, detections, 100.0) for _ in range(5)}
    assert len(results) == 1
    assert len(results.pop().pairs) == 2


def test_positions_in_space_have_three_numbers():
    anchors = [Place("plug", (0.3, 0.1, 0.0)), Place("plug", (0.3, 0.1, 0.2))]
    detections = [Place("plug", (0.3, 0.1, 0.19)), Place("plug", (0.3, 0.11, 0.0))]
    assert align(anchors, detections, 0.01).pairs == ((0, 1), (1, 0))


@pytest.mark.parametrize("tau", [0.0, -1.0, float("nan")])
def test_tau_has_to_be_above_zero(tau):
    with pytest.raises(AnchoringError, match="has to be above 0"):
        align([], [], tau)


def test_large_crowds_agree_with_the_solver_run_type_by_type():
    crowd = [Place("ab"[i % 2], (float(i * 37 % 101), float(i * 53 % 97))) for i in range(60)]
    later = [Place(place.type, (place.centre[0] + 0.25, place.centre[1])) for place in crowd]
    together = align(crowd, later, 400.0).pairs
    alone = []
    for name in "ab":
        index = [i for i, place in enumerate(crowd) if place.type == name]
        pairs = align([crowd[i] for i in index], [later[i] for i in index], 400.0).pairs
        alone += [(index[row], index[column]) for row, column in pairs]
    assert together == tuple(sorted(alone))


def test_importing_the_package_does_not_load_the_solver():
    code = "import sys, aapa; print('scipy' in sys.modules)"
    output = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    ).stdout
    assert output.strip() == "False"


def test_brute_force_oracle_on_a_known_case():
    anchors = [Place("cone", (0.0, 0.0)), Place("cone", (9.0, 0.0))]
    detections = [Place("cone", (9.0, 0.0)), Place("cone", (18.0, 0.0))]
    assert cheapest_by_trying_all(anchors, detections, 100.0) == (100.0, 1)
