from __future__ import annotations

import math

import numpy as np
import pytest

from runtime.cell.layout import FIXTURE_HEIGHT_M, LayoutParameters, random_layout
from runtime.cell.support import fall
from runtime.errors import UsageError
from runtime.parts import load_parts

PARTS = load_parts()


@pytest.mark.parametrize("seed", range(25))
def test_parts_stand_apart_inside_the_area(seed):
    parameters = LayoutParameters()
    layout = random_layout(PARTS, seed)
    assert [part.model.type for part in layout.parts] == list(parameters.parts)
    assert len({part.name for part in layout.parts}) == len(layout.parts)
    for index, part in enumerate(layout.parts):
        x, y, _ = part.position
        assert parameters.x_m[0] <= x - part.model.size[0] / 2
        assert x + part.model.size[0] / 2 <= parameters.x_m[1]
        assert parameters.y_m[0] <= y - part.model.size[1] / 2
        assert y + part.model.size[1] / 2 <= parameters.y_m[1]
        assert parameters.reach_m[0] <= math.hypot(x, y) <= parameters.reach_m[1]
        others = [(o.name, o.model, o.pose) for o in layout.parts[:index]]
        distance, _ = fall(part.model, part.pose, others)
        assert distance == pytest.approx(FIXTURE_HEIGHT_M if part.model.type == "case" else 0.0)


def test_the_case_stands_unturned_in_its_shifted_fixture():
    places = set()
    for seed in range(8):
        layout = random_layout(PARTS, seed)
        case = layout.parts[0]
        assert case.parent == "fixture"
        assert case.position[:2] == layout.fixture.position[:2]
        assert np.array_equal(case.pose[:3, :3], np.eye(3))
        parameters = LayoutParameters()
        for axis in range(2):
            off = abs(case.position[axis] - parameters.fixture_xy_m[axis])
            assert off <= parameters.fixture_shift_m
        places.add(case.position)
    assert len(places) == 8


def test_the_same_seed_gives_the_same_layout():
    one, other, third = (random_layout(PARTS, seed) for seed in (5, 5, 6))
    places = [[part.position for part in layout.parts] for layout in (one, other, third)]
    assert places[0] == places[1] != places[2]


def test_an_unknown_type_is_refused():
    with pytest.raises(UsageError, match="No part of type 'gear' is known; there are case"):
        random_layout(PARTS, 0, LayoutParameters(parts=("case", "gear")))


def test_too_many_parts_are_refused():
    with pytest.raises(UsageError, match="12 parts do not fit"):
        random_layout(PARTS, 0, LayoutParameters(parts=("casingtop",) * 12))
