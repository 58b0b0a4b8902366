"""What showed in its place should show there again; what it takes to notice that it does not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from aapa import Anchor, AnchorStatus, Camera, Detection
from runtime.expecting import Expectation
from runtime.percepts import HAND, HAND_TYPE

CASE = Anchor(
    "case", "case", (80.0, 60.0, 160.0, 120.0), AnchorStatus.VISIBLE, None, 1.0, (0.4, 0.1, 0.04)
)
COVER = Anchor(
    "hubcover",
    "hubcover",
    (100.0, 80.0, 130.0, 100.0),
    AnchorStatus.VISIBLE,
    None,
    1.0,
    (0.4, 0.06, 0.03),
)
PLUG = Anchor(
    "plug", "plug", (200.0, 80.0, 215.0, 95.0), AnchorStatus.VISIBLE, None, 1.0, (0.5, -0.1, 0.01)
)
HAND_THERE = Anchor(
    HAND, HAND_TYPE, (120.0, 0.0, 180.0, 40.0), AnchorStatus.VISIBLE, None, 1.0, (0.3, 0.0, 0.42)
)
UNSEEN = replace(COVER, status=AnchorStatus.ATTACHED, parent="case")
IN = (("hubcover", "case"),)


def camera(x=0.3, y=0.0, z=0.5):
    return Camera(320, 240, 240.0, (x, y, z), np.diag([1.0, -1.0, -1.0]))


def look(expectation, *anchors, score=0.93, attached=IN, at=None, company=False):
    """Let it see a frame in which the anchors that are visible have been detected."""
    detections = [
        Detection(each.type, each.box, 0.95 if each.name == "plug" else score, each.position)
        for each in anchors
        if each.status is AnchorStatus.VISIBLE
    ]
    return expectation.update(anchors, detections, attached, at or camera(), company=company)


@pytest.fixture
def known():
    """One that has seen the cover in the case once."""
    expectation = Expectation()
    assert look(expectation, CASE, COVER, HAND_THERE) == frozenset()
    assert expectation.shown == {"hubcover"}
    return expectation


def test_what_showed_and_does_not_show_is_expected(known):
    assert look(known, CASE, UNSEEN, HAND_THERE) == {"hubcover"}
    assert look(known, CASE, COVER, HAND_THERE) == frozenset()


def test_what_never_showed_may_be_hidden():
    expectation = Expectation()
    assert look(expectation, CASE, UNSEEN, HAND_THERE) == frozenset()
    assert expectation.shown == frozenset()


def test_what_showed_only_by_half_may_well_not_be_recognised():
    expectation = Expectation()
    look(expectation, CASE, COVER, score=0.8)
    assert look(expectation, CASE, UNSEEN) == frozenset()


def test_from_another_side_it_may_be_hidden(known):
    assert look(known, CASE, UNSEEN, at=camera(x=0.5)) == frozenset()
    assert look(known, CASE, UNSEEN, at=camera(z=0.9)) == frozenset()
    assert look(known, CASE, UNSEEN, at=camera(x=0.32)) == {"hubcover"}


def test_nothing_is_expected_while_a_person_reaches_in(known):
    assert look(known, CASE, UNSEEN, company=True) == frozenset()


def test_nothing_is_expected_where_the_whole_is_hidden(known):
    hidden = replace(CASE, status=AnchorStatus.OCCLUDED)
    assert look(known, hidden, UNSEEN) == frozenset()
    assert look(known, CASE, UNSEEN, score=0.75) == frozenset()  # something covers a part of it


def test_nothing_is_expected_where_something_has_come_in_front(known):
    in_front = replace(PLUG, box=(95.0, 75.0, 110.0, 90.0))
    assert look(known, CASE, UNSEEN, PLUG) == {"hubcover"}
    assert look(known, CASE, UNSEEN, in_front) == frozenset()
    held = replace(in_front, status=AnchorStatus.ATTACHED, parent=HAND)
    assert look(known, CASE, UNSEEN, held, attached=(*IN, ("plug", HAND))) == frozenset()


def test_what_stood_beside_it_when_it_showed_does_not_hide_it():
    expectation, beside = Expectation(), replace(PLUG, box=(125.0, 80.0, 140.0, 95.0))
    look(expectation, CASE, COVER, beside)
    assert look(expectation, CASE, UNSEEN, beside) == {"hubcover"}


def test_outside_the_image_nothing_is_expected(known):
    outside = replace(UNSEEN, box=(-10.0, 80.0, 20.0, 100.0))
    assert look(known, CASE, outside) == frozenset()


def test_a_part_that_hides_what_it_is_attached_to_is_expected_too():
    expectation = Expectation()
    look(expectation, replace(CASE, status=AnchorStatus.OCCLUDED), COVER)
    assert look(expectation, CASE, UNSEEN, score=0.7) == frozenset()
    assert look(expectation, CASE, UNSEEN, score=0.93) == {"hubcover"}


def test_a_part_that_was_taken_out_is_expected_no_more(known):
    assert look(known, CASE, replace(UNSEEN, status=AnchorStatus.MISSING)) == frozenset()
    look(known, CASE, UNSEEN, attached=())
    assert known.shown == frozenset()
    assert look(known, CASE, UNSEEN) == frozenset()


def test_a_part_put_elsewhere_has_not_shown_there(known):
    aside = replace(COVER, position=(0.4, 0.16, 0.03))
    assert look(known, CASE, aside, score=0.8) == frozenset()
    assert known.shown == frozenset()


def test_what_the_hand_holds_is_hidden_as_it_may_be():
    expectation, held = Expectation(), (("hubcover", HAND),)
    look(expectation, HAND_THERE, COVER, attached=held)
    assert look(expectation, HAND_THERE, replace(UNSEEN, parent=HAND), attached=held) == frozenset()
