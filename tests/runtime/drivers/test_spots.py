from __future__ import annotations

import math

from hypothesis import given, settings
from hypothesis import strategies as st

from runtime.drivers.spots import free_spots


def test_the_spot_under_the_hand_comes_first(config, parts):
    first = next(free_spots(parts["plug"], (0.4321, 0.1234), (), config, parts))
    assert first == (0.4321, 0.1234)


def test_outside_the_area_the_nearest_spot_in_it_comes_first(config, parts):
    x0, _, y0, y1 = config.workspace.put_down
    x, y = next(free_spots(parts["plug"], (0.0, 0.0), (), config, parts))
    assert x == x0
    assert y0 <= y <= y1
    assert abs(y) <= 0.02


@settings(derandomize=True, max_examples=50)
@given(
    others=st.lists(
        st.tuples(
            st.sampled_from(["case", "plug", "bearing", "something"]),
            st.floats(0.2, 0.7),
            st.floats(-0.3, 0.3),
        ),
        max_size=6,
    ),
    here=st.tuples(st.floats(0.2, 0.7), st.floats(-0.3, 0.3)),
)
def test_spots_are_in_the_area_clear_of_everything_and_nearest_first(
    config, parts, anchor, others, here
):
    anchors = [
        anchor(f"o{index}", type_, (x, y, 0.02)) for index, (type_, x, y) in enumerate(others)
    ]
    spots = list(free_spots(parts["hubcover"], here, anchors, config, parts))
    x0, x1, y0, y1 = config.workspace.put_down
    for x, y in spots:
        assert x0 <= x <= x1 + 1e-9
        assert y0 <= y <= y1 + 1e-9
        for other in anchors:
            known = parts.get(other.type)
            other_radius = math.hypot(*known.size[:2]) / 2 if known else 0.06
            assert math.dist((x, y), other.position[:2]) > other_radius + 0.03
    distances = [math.dist(spot, here) for spot in spots]
    assert distances == sorted(distances)
    assert len(set(spots)) == len(spots)


def test_what_has_no_place_is_ignored(config, parts, anchor):
    ghost = anchor("o1", "plug", None)
    assert next(free_spots(parts["plug"], (0.4, 0.1), [ghost], config, parts)) == (0.4, 0.1)
