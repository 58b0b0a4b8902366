"""What one detection makes of one anchor."""

from __future__ import annotations

from dataclasses import replace

import pytest

from aapa import Anchor, AnchoringParameters, AnchorStatus, Detection
from aapa.sightings import Sightings
from aapa.view import View

BOX, NEAR = (100.0, 100.0, 120.0, 120.0), (104.0, 100.0, 124.0, 120.0)
OLD = Anchor("cone-1", "cone", BOX, AnchorStatus.VISIBLE, None, 0.5, last_seen=6, streak=3)


def sightings(parents=None, **parameters):
    chosen = AnchoringParameters(**parameters)
    return Sightings(7, chosen, parents or {}, View(chosen))


def test_an_anchor_takes_the_detection_as_it_is():
    new = sightings().of_old(OLD, Detection("cone", NEAR), 16.0)
    assert (new.name, new.box, new.status) == ("cone-1", NEAR, AnchorStatus.VISIBLE)
    assert (new.confidence, new.last_seen, new.streak) == (0.6, 7, 4)
    assert new.reason == "It is seen 4 px from its last place."


def test_what_has_not_moved_is_seen_at_its_last_place():
    new = sightings().of_old(OLD, Detection("cone", BOX), 0.0)
    assert new.reason == "It is seen at its last place."


def test_confidence_stops_at_one():
    sure = replace(OLD, confidence=0.95)
    assert sightings().of_old(sure, Detection("cone", BOX), 0.0).confidence == 1
    assert (
        sightings().of_old(replace(OLD, confidence=1.0), Detection("cone", BOX), 0.0).confidence
        == 1
    )


def test_with_a_gain_an_anchor_goes_part_of_the_way():
    new = sightings(position_gain=0.25).of_old(OLD, Detection("cone", NEAR), 16.0)
    assert new.box == (101.0, 100.0, 121.0, 120.0)


@pytest.mark.parametrize(
    ("old", "squared", "parents"),
    [
        (replace(OLD, status=AnchorStatus.ATTACHED), 16.0, {}),  # it was carried until now
        (OLD, 16.0, {"cone-1": "hand"}),  # it is being carried
        (replace(OLD, status=AnchorStatus.OCCLUDED), 1700.0, {}),  # back beyond half the radius
    ],
)
def test_what_has_been_moved_is_not_averaged(old, squared, parents):
    new = sightings(parents, position_gain=0.25).of_old(old, Detection("cone", NEAR), squared)
    assert new.box == NEAR


def test_what_is_half_hidden_does_not_move_a_sure_anchor():
    half = Detection("cone", NEAR, score=0.8)
    sure, parameters = replace(OLD, confidence=1.0), {"position_gain": 0.25, "sure_score": 0.9}
    assert sightings(**parameters).of_old(sure, half, 16.0).box == OLD.box
    whole = Detection("cone", NEAR, score=0.95)
    assert sightings(**parameters).of_old(sure, whole, 16.0).box == (101.0, 100.0, 121.0, 120.0)
    unsure = replace(OLD, confidence=0.9)
    assert sightings(**parameters).of_old(unsure, half, 16.0).box == (101.0, 100.0, 121.0, 120.0)
    carried = sightings({"cone-1": "hand"}, **parameters).of_old(sure, half, 16.0)
    assert carried.box == NEAR


def test_what_comes_back_nearby_is_averaged():
    old = replace(OLD, status=AnchorStatus.OCCLUDED)
    new = sightings(position_gain=0.25).of_old(old, Detection("cone", NEAR), 1600.0)
    assert new.box == (101.0, 100.0, 121.0, 120.0)


def test_a_size_once_known_is_kept():
    old = replace(OLD, size=(0.1, 0.2))
    assert sightings().of_old(old, Detection("cone", BOX), 0.0).size == (0.1, 0.2)
    other = Detection("cone", BOX, size=(0.3, 0.4))
    assert sightings().of_old(old, other, 0.0).size == (0.3, 0.4)


def test_a_body_is_always_fully_believed_and_counts_its_frames():
    hand = Detection("hand", BOX, name="hand1")
    first = sightings().of_body("hand1", hand, None)
    second = sightings().of_body("hand1", hand, first)
    assert (first.confidence, first.streak, second.streak) == (1.0, 1, 2)


def test_a_new_anchor_begins_at_the_initial_confidence():
    new = sightings(initial_confidence=0.3).of_new("cone-2", Detection("cone", BOX))
    assert (new.name, new.confidence, new.streak) == ("cone-2", 0.3, 1)


def test_a_place_is_the_middle_of_a_box_or_a_position():
    place = sightings().place(Detection("cone", NEAR))
    assert (place.type, place.centre, place.box) == ("cone", (114.0, 110.0), NEAR)
    in_space = sightings(space="base", tau=0.01).place(Detection("cone", NEAR, position=(1, 2, 3)))
    assert in_space.centre == (1, 2, 3)


@pytest.mark.parametrize(
    "parameters", [{}, {"position_gain": 0.5}, {"sure_score": 0.6}, {"space": "base", "tau": 0.1}]
)
def test_many_pairs_become_what_each_of_them_becomes(parameters):
    detections = [
        Detection("cone", BOX),
        Detection("cone", NEAR, 0.5, (1.0, 2.0, 3.0), (0.1, 0.2)),
        Detection("cone", NEAR, 0.5, (1.0, 2.0, 3.5)),
    ]
    olds = [
        OLD,
        replace(OLD, confidence=0.95, streak=-3, status=AnchorStatus.OCCLUDED, size=(1.0, 1.0)),
        replace(OLD, confidence=1.0, position=(1.0, 2.0, 3.0), status=AnchorStatus.ATTACHED),
    ]
    frame = sightings({}, **parameters)
    pairs = [
        (old, detection, squared)
        for old in olds
        for detection in detections
        for squared in (0.0, 16.0, 0.0025)
    ]
    assert frame.of_pairs(iter(pairs)) == [frame.of_old(*pair) for pair in pairs]


def test_what_shows_of_a_large_thing_is_no_place_to_go_to():
    # The right half of a case 0.2 m wide: its middle is 0.04 m from that of the whole.
    whole = Anchor(
        "case", "case", BOX, AnchorStatus.OUT_OF_VIEW, None, 1.0, (0.4, 0.0, 0.04), (0.2, 0.13)
    )
    half = Detection("case", NEAR, 0.77, (0.44, 0.0, 0.04), (0.12, 0.13))
    base = sightings(space="base", tau=0.0036, position_gain=0.2, sure_score=0.95)
    new = base.of_old(whole, half, 0.04**2)
    assert new.status is AnchorStatus.VISIBLE
    assert (new.position, new.size) == (whole.position, whole.size)
    # All of it, seen there, has been moved there; so has a small thing that shows by half.
    assert base.of_old(whole, replace(half, score=0.97), 0.04**2).position == half.position
    plug = replace(whole, size=(0.03, 0.03))
    assert base.of_old(plug, half, 0.04**2).position == half.position
