"""From detections to percepts, without a mind and without an arm."""

from __future__ import annotations

from dataclasses import replace

import pytest
from scripted_assembly import CAMERA, CONFIG, PLACES, Body, Eyes

from aapa import Anchoring, AnchorStatus, Attachment, Detection
from runtime.percepts import PERSON_TYPE
from runtime.run import anchoring_parameters
from runtime.seeing import Sight

ARM = Body().state()
INSERTED = (Attachment("hubcover", "case"),)


class Watched(Eyes):
    """Notes where it was told that the arm is."""

    hand = None


@pytest.fixture
def eyes():
    return Watched(Body())


@pytest.fixture
def sight(eyes):
    return Sight(Anchoring(anchoring_parameters()), eyes, CONFIG)


def look(sight, *attachments, times=1):
    for _ in range(times):
        seen = sight.look(ARM, attachments, acting=False)
    return seen


def test_a_frame_becomes_anchors_and_percepts(sight, eyes):
    sight.update(ARM)
    assert eyes.hand == ARM.tcp_pose[:3]
    first = look(sight)
    last = look(sight, times=3)
    assert sorted(sight.by_name()) == ["case", "hand1", "hubcover"]
    assert {percept.name for percept in last.percepts} == {"case", "hand1", "hubcover"}
    assert [detection.type for detection in last.detections] == eyes.parts
    assert (first.before, {anchor.name for anchor in last.before}) == ((), {*sight.by_name()})
    assert first.looked_s <= first.anchored_s <= last.looked_s
    assert sight.frame == 4


def test_what_is_attached_is_kept_out_of_sight(sight, eyes):
    look(sight, times=3)
    eyes.body.inserted.add("hubcover")
    look(sight, *INSERTED, times=30)
    kept = sight.by_name()["hubcover"]
    assert (kept.status, kept.parent) == (AnchorStatus.ATTACHED, "case")


def test_a_run_that_is_gone_on_with_begins_with_its_anchors(sight, eyes):
    look(sight, times=3)
    again = Sight(Anchoring(anchoring_parameters()), eyes, CONFIG, sight.anchors)
    assert again.by_name() == sight.by_name()
    assert look(again).before == sight.anchors


def test_company_is_whoevers_hand_is_in_sight(sight, eyes):
    look(sight)
    assert not sight.company
    u, v, _ = CAMERA.project(PLACES["case"])
    hand = Detection(PERSON_TYPE, (u - 20, v - 20, u + 20, v + 20), 0.9, PLACES["case"])
    see = eyes.look
    eyes.look = lambda: ([*see()[0], hand], CAMERA)
    look(sight)
    assert sight.company


def test_a_second_one_of_what_there_is_but_one_speaks_against_the_first(sight, eyes):
    look(sight, times=3)
    assert not sight.shows_another_of(["hubcover", "case"])
    u, v, _ = CAMERA.project((0.30, 0.15, 0.01))
    elsewhere = Detection("hubcover", (u - 8, v - 8, u + 8, v + 8), 0.9, (0.30, 0.15, 0.01))
    see = eyes.look
    eyes.look = lambda: ([*see()[0], elsewhere], CAMERA)
    look(sight)
    assert sight.shows_another_of(["hubcover", "case"])
    assert not sight.shows_another_of(["case"])


@pytest.mark.parametrize(("visited", "trusted"), [(True, True), (False, False)])
def test_what_was_never_seen_in_its_place_is_doubted_only_after_a_visit(
    sight, eyes, visited, trusted
):
    look(sight, times=3)
    eyes.body.inserted.add("hubcover")
    look(sight, *INSERTED, times=2)
    assert sight.takes_on_trust(["hubcover"], visited=visited) is trusted
    assert not sight.takes_on_trust(["case"], visited=visited)


def test_what_is_seen_is_not_taken_on_trust(sight):
    look(sight, times=3)
    assert not sight.takes_on_trust(["hubcover", "case"], visited=True)
    hidden = tuple(replace(each, status=AnchorStatus.ATTACHED) for each in sight.anchors)
    sight.anchors = hidden
    assert sight.takes_on_trust(["hubcover", "case"], visited=True)
