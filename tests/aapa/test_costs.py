from __future__ import annotations

import numpy as np
import pytest

from aapa import Anchoring, AnchoringError, AnchoringParameters, Detection
from aapa.alignment import align
from aapa.costs import CENTRE, CENTRE_AND_SIZE, COSTS, OVERLAP, Cost, Place


def of_boxes(cost, first, second):
    rows = [
        np.array([cost.features(Place("x", centre(b), b))], dtype=float) for b in (first, second)
    ]
    return float(cost.pairs(*rows)[0])


def centre(box):
    return (box[0] + box[2]) / 2, (box[1] + box[3]) / 2


def test_the_centre_s_cost_is_the_squared_distance():
    assert of_boxes(CENTRE, (0, 0, 10, 10), (3, 4, 13, 14)) == 25
    assert of_boxes(CENTRE, (0, 0, 10, 10), (-5, -5, 15, 15)) == 0


def test_positions_in_space_have_three_coordinates():
    old, new = np.array([[0.0, 0.0, 0.0]]), np.array([[1.0, 2.0, 2.0]])
    assert CENTRE.pairs(old, new).tolist() == [9]


def test_with_sizes_the_difference_of_the_sides_counts_like_px_of_distance():
    # 5 px of distance; mean sides of 10 and of 8 px: (5 + 2) squared.
    assert of_boxes(CENTRE_AND_SIZE, (0, 0, 10, 10), (4, 5, 12, 13)) == pytest.approx(49)
    # 20 x 5 px have the mean side 10.
    assert of_boxes(CENTRE_AND_SIZE, (0, 0, 10, 10), (-5, 2.5, 15, 7.5)) == 0


def test_the_overlap_s_cost_is_what_is_missing_to_one():
    assert of_boxes(OVERLAP, (0, 0, 10, 10), (5, 0, 15, 10)) == pytest.approx(1 - 50 / 150)
    assert of_boxes(OVERLAP, (0, 0, 10, 10), (0, 0, 10, 10)) == 0
    assert of_boxes(OVERLAP, (0, 0, 10, 10), (10, 0, 20, 10)) == 1
    assert of_boxes(OVERLAP, (3, 3, 3, 3), (3, 3, 3, 3)) == 1  # boxes without area share nothing


def test_each_cost_goes_by_its_name():
    assert {name: cost.name for name, cost in COSTS.items()} == {
        "centre": "centre",
        "centre-and-size": "centre-and-size",
        "overlap": "overlap",
    }


def test_sizes_tell_apart_what_centres_do_not():
    # A small and a large cone change order as the detector lists them, at nearly the same place.
    small, large = (8.0, 8.0, 12.0, 12.0), (0.0, 0.0, 22.0, 22.0)
    anchors = [Place("cone", centre(small), small), Place("cone", centre(large), large)]
    small_now, large_now = (9.5, 9.5, 13.5, 13.5), (-1.0, -1.0, 21.0, 21.0)
    seen = [
        Place("cone", centre(large_now), large_now),
        Place("cone", centre(small_now), small_now),
    ]
    assert align(anchors, seen, 400).pairs == ((0, 0), (1, 1))
    assert align(anchors, seen, 400, CENTRE_AND_SIZE).pairs == ((0, 1), (1, 0))
    assert align(anchors, seen, 0.9, OVERLAP).pairs == ((0, 1), (1, 0))


def test_a_cost_of_one_s_own_can_be_given_to_the_alignment():
    below = Cost("height", lambda p: p.centre[1:2], lambda old, new: np.abs(old - new)[..., 0])
    anchors = [Place("x", (0, 0)), Place("x", (0, 50))]
    seen = [Place("x", (900, 51)), Place("x", (700, 2))]
    assert align(anchors, seen, 10, below).pairs == ((0, 1), (1, 0))
    assert align(anchors[:1], seen[:1], 10, below).pairs == ()


def test_a_cost_of_one_s_own_can_be_among_the_parameters():
    below = Cost("height", lambda p: p.centre[1:2], lambda old, new: np.abs(old - new)[..., 0])
    anchoring = Anchoring(AnchoringParameters(cost=below, tau=10))
    anchoring.update([Detection("cone", (0, 0, 10, 10)), Detection("cone", (0, 50, 10, 60))])
    seen = [Detection("cone", (80, 51, 90, 61)), Detection("cone", (90, 2, 100, 12))]
    boxes = {a.name: a.box for a in anchoring.update(seen)}
    assert boxes == {"cone-1": (90, 2, 100, 12), "cone-2": (80, 51, 90, 61)}
    assert anchoring.parameters.radius == float("inf")


def test_the_cost_is_chosen_by_the_parameters():
    overlapping = Anchoring(AnchoringParameters(cost="overlap", tau=0.9))
    [first] = overlapping.update([Detection("cone", (0, 0, 10, 10))])
    names = [a.name for a in overlapping.update([Detection("cone", (12, 0, 22, 10))])]
    assert (first.name, names) == ("cone-1", ["cone-2"])
    assert "cone-1" in [a.name for a in overlapping.anchors + overlapping.dropped]


@pytest.mark.parametrize(
    ("values", "text"),
    [
        ({"cost": "nearest"}, "cost is 'nearest'; it has to be one of centre, centre-and-size"),
        ({"cost": ["centre"]}, r"cost is \['centre'\]"),
        ({"cost": "overlap"}, "with the cost of overlap it is at most 1"),
        ({"cost": "overlap", "tau": 0.5, "space": "base"}, "in base space it has to be"),
        ({"cost": "centre-and-size", "tau": 0.5, "space": "base"}, "in base space"),
    ],
)
def test_a_cost_that_does_not_fit_is_refused(values, text):
    with pytest.raises(AnchoringError, match=text):
        AnchoringParameters.from_mapping(values)


def test_a_cost_that_is_no_distance_has_no_radius():
    assert AnchoringParameters(cost="overlap", tau=0.5).radius == float("inf")
    assert AnchoringParameters(cost="centre-and-size", tau=100).radius == 10
