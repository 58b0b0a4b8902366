from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aapa import AnchoringParameters, AnchorStatus, Camera
from aapa.anchors import Anchor
from aapa.boxes import overlap, overlaps
from aapa.occluders import _MANY, Occluders
from aapa.view import View

sides = st.integers(0, 40)
boxes = st.tuples(sides, sides, sides, sides).map(
    lambda b: (float(b[0]), float(b[1]), float(b[0] + b[2] // 4), float(b[1] + b[3] // 4))
)


def anchor(name, box, position=None):
    return Anchor(name, "x", box, AnchorStatus.VISIBLE, position=position)


@given(st.lists(boxes, min_size=1, max_size=30), boxes, st.sampled_from([0.0, 2.0]))
def test_asking_all_boxes_at_once_gives_what_asking_each_gives(many, one, margin):
    at_once = overlaps(np.array(many), np.array([one] * len(many)), margin).tolist()
    assert at_once == [overlap(box, one, margin) for box in many]


@given(st.lists(boxes, min_size=_MANY, max_size=3 * _MANY), boxes)
def test_many_things_hide_what_one_of_them_hides(many, one):
    view = View(AnchoringParameters())
    things = [anchor(f"thing-{n}", box) for n, box in enumerate(many)]
    behind = anchor("hidden", one)
    each = (thing for thing in things if Occluders([thing], view).first_hiding(behind))
    first = next(each, None)
    expected = None if first is None else first.name
    assert Occluders(things, view).first_hiding(behind) == expected
    assert Occluders(things, view).first_hiding_each([behind] * 2) == [expected] * 2


@given(
    st.lists(boxes, min_size=_MANY, max_size=2 * _MANY),
    st.lists(boxes, max_size=9),
    st.sampled_from([0.0, 2.0]),
)
def test_asking_for_many_gives_what_asking_for_each_gives(many, hidden, margin):
    view = View(AnchoringParameters(margin_px=margin))
    occluders = Occluders([anchor(f"thing-{n}", box) for n, box in enumerate(many)], view)
    behind = [anchor(f"hidden-{n}", box) for n, box in enumerate(hidden)]
    found = occluders.first_hiding_each(behind)
    assert found == [occluders.first_hiding(each) for each in behind]


@pytest.mark.parametrize("count", [3, _MANY + 3])
def test_of_those_that_overlap_only_what_is_nearer_hides(count):
    camera = Camera(320, 240, 300.0, (0.0, 0.0, 0.0), np.eye(3))
    view = View(AnchoringParameters(space="base", tau=0.01), camera)
    box = (100.0, 100.0, 120.0, 120.0)
    things = [anchor(f"far-{n}", box, (0.0, 0.0, 3.0 + n)) for n in range(count - 1)]
    behind = anchor("hidden", box, (0.0, 0.0, 2.0))
    assert Occluders(things, view).first_hiding(behind) is None
    assert Occluders(things, view).first_hiding_each([behind]) == [None]
    things.append(anchor("near", box, (0.0, 0.0, 1.0)))
    assert Occluders(things, view).first_hiding(behind) == "near"
    assert Occluders(things, view).first_hiding_each([behind, behind]) == ["near", "near"]


def test_nothing_hides_nothing():
    occluders = Occluders([], View(AnchoringParameters()))
    assert not occluders
    assert occluders.first_hiding(anchor("hidden", (0.0, 0.0, 9.0, 9.0))) is None
