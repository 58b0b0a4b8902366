from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from aapa import (
    Anchoring,
    AnchoringError,
    AnchoringParameters,
    AnchoringState,
    AnchorStatus,
    Camera,
    Detection,
    step,
)


def cone(x, y=100.0, *, type_="cone", side=20.0, score=1.0):
    return Detection(type_, (x, y, x + side, y + side), score)


def hand(x, y=100.0):
    return Detection("hand", (x, y, x + 10, y + 10), name="hand")


def by_name(anchors):
    return {anchor.name: anchor for anchor in anchors}


def confident(*detections, cycles=12, parameters=None, attachments=()):
    """An anchoring that has seen all of this often enough to be sure of it."""
    anchoring = Anchoring(parameters or AnchoringParameters(image_size=(320, 240)))
    for _ in range(cycles):
        anchoring.update(detections, attachments)
    return anchoring


def test_first_sightings_are_named_in_the_order_reported():
    anchors = Anchoring().update([cone(200), cone(30), cone(90, type_="ball")])
    assert [(a.name, a.box[0]) for a in anchors] == [
        ("ball-1", 90),
        ("cone-1", 200),
        ("cone-2", 30),
    ]
    for anchor in anchors:
        assert (anchor.status, anchor.confidence, anchor.parent) == (
            AnchorStatus.VISIBLE,
            0.1,
            None,
        )
        assert anchor.reason == "It is seen for the first time."


def test_without_parameters_the_papers_are_used():
    assert Anchoring().parameters == AnchoringParameters()


def test_unique_types_are_named_by_the_type():
    anchoring = Anchoring(AnchoringParameters(unique_types=frozenset({"case"})))
    anchors = anchoring.update([cone(10, type_="case"), cone(200, type_="case"), cone(100)])
    assert [anchor.name for anchor in anchors] == ["case", "case-2", "cone-1"]


def test_a_unique_object_that_was_given_up_is_the_same_when_found_again():
    anchoring = Anchoring(AnchoringParameters(unique_types=frozenset({"case"})))
    anchoring.update([cone(10, type_="case")])
    while anchoring.anchors:
        anchoring.update([])
    assert [anchor.name for anchor in anchoring.update([cone(200, type_="case")])] == ["case"]


def test_an_object_keeps_its_name_and_gains_confidence():
    anchoring = Anchoring()
    for frame in range(12):
        [anchor] = anchoring.update([cone(10.0 + 30 * frame)])
        assert anchor.name == "cone-1"
        assert anchor.box[0] == 10 + 30 * frame
        assert anchor.confidence == pytest.approx(min(1.0, 0.1 * (frame + 1)))
        assert anchor.last_seen == anchoring.frame == frame + 1
    assert anchor.reason == "It is seen 30 px from its last place."


def test_a_leap_beyond_tau_makes_another_object():
    anchoring = confident(cone(100), parameters=AnchoringParameters(tau=3000))
    anchors = by_name(anchoring.update([cone(155)]))
    assert anchors["cone-1"].status is AnchorStatus.MISSING
    assert anchors["cone-2"].box[0] == 155
    assert confident(cone(100)).update([cone(155)])[0].name == "cone-1"


def test_an_unexplained_miss_decays_for_eleven_cycles_from_full_confidence():
    anchoring = confident(cone(100))
    confidences = []
    for _ in range(10):
        anchoring.update([])
        [anchor] = anchoring.anchors
        assert anchor.status is AnchorStatus.MISSING
        confidences.append(anchor.confidence)
        assert anchoring.dropped == ()
    assert confidences == [0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1, 0.0]
    assert anchoring.update([]) == anchoring.anchors == ()
    [gone] = anchoring.dropped
    assert (gone.name, gone.last_seen, gone.confidence) == ("cone-1", 12, 0.0)
    anchoring.update([])
    assert anchoring.dropped == ()


def test_a_flicker_is_gone_after_two_cycles_and_its_name_with_it():
    anchoring = Anchoring()
    assert [a.name for a in anchoring.update([cone(100)])] == ["cone-1"]
    assert anchoring.update([]) == ()
    assert [a.name for a in anchoring.anchors] == ["cone-1"]
    anchoring.update([])
    assert [a.name for a in anchoring.dropped] == ["cone-1"]
    assert [a.name for a in anchoring.update([cone(100)])] == ["cone-2"]


@pytest.mark.parametrize("order", [1, -1])
def test_of_two_detections_equally_near_the_same_is_taken_in_any_order(order):
    anchoring = confident(cone(100))
    anchors = by_name(anchoring.update([cone(90), cone(110)][::order]))
    assert (anchors["cone-1"].box[0], anchors["cone-2"].box[0]) == (90, 110)


def test_only_confident_anchors_are_returned_but_all_bodies():
    anchoring = Anchoring(AnchoringParameters(min_report_confidence=0.3))
    assert [a.name for a in anchoring.update([cone(100), hand(10)])] == ["hand"]
    anchoring.update([cone(100), hand(10)])
    assert len(anchoring.update([cone(100), hand(10)])) == 2


def test_the_initial_confidence_can_be_set():
    [anchor] = Anchoring(AnchoringParameters(initial_confidence=1.0)).update([cone(100)])
    assert anchor.confidence == 1.0


def test_a_body_is_anchored_under_its_name_however_far_it_goes():
    anchoring = Anchoring(AnchoringParameters(tau=100))
    for x in [0, 300, 20]:
        [anchor] = anchoring.update([hand(x)])
        assert (anchor.name, anchor.box[0], anchor.confidence) == ("hand", x, 1.0)
        assert anchor.status is AnchorStatus.VISIBLE
        assert anchor.reason == "It reports its own place."


def test_a_body_is_not_assigned_to_an_object_of_its_type():
    detections = [hand(100), cone(100, type_="hand", side=10.0)]
    assert [a.name for a in Anchoring().update(detections)] == ["hand", "hand-1"]


def test_a_body_that_no_longer_reports_is_gone_at_once():
    anchoring = confident(hand(100), cone(200))
    anchoring.update([cone(200)])
    assert [a.name for a in anchoring.anchors] == ["cone-1"]
    [gone] = anchoring.dropped
    assert (gone.name, gone.reason) == ("hand", "It no longer reports its place; it is given up.")
    assert "hand" in by_name(anchoring.update([cone(200), hand(50)]))


def test_a_child_follows_only_while_it_is_unseen():
    anchoring = confident(cone(100), cone(105, type_="snitch"))
    pair = [("snitch-1", "cone-1")]
    hidden = by_name(anchoring.update([cone(130)], pair))["snitch-1"]
    assert (hidden.box[0], hidden.status, hidden.parent) == (135, AnchorStatus.ATTACHED, "cone-1")
    assert hidden.confidence == 1.0
    seen = by_name(anchoring.update([cone(150), cone(160, type_="snitch")], pair))["snitch-1"]
    assert (seen.box[0], seen.status, seen.parent) == (160, AnchorStatus.VISIBLE, None)
    again = by_name(anchoring.update([cone(151)], pair))["snitch-1"]
    assert again.box[0] == 161


def test_a_seen_child_takes_its_own_children_along():
    anchoring = confident(cone(100), cone(50, type_="case"), cone(55, type_="plug"))
    pairs = [("plug-1", "case-1"), ("case-1", "cone-1")]
    anchors = by_name(anchoring.update([cone(100), cone(70, type_="case")], pairs))
    assert anchors["plug-1"].box[0] == 75
    assert anchors["plug-1"].parent == "case-1"


def test_without_attachments_it_is_perceptual_anchoring():
    plain = confident(cone(100), cone(105, type_="snitch"))
    off = confident(
        cone(100),
        cone(105, type_="snitch"),
        parameters=AnchoringParameters(use_attachments=False, image_size=(320, 240)),
    )
    for x in range(100, 200, 10):
        off.update([cone(x)], [("snitch-1", "cone-1")])
        plain.update([cone(x)])
    assert off.anchors == plain.anchors


def test_malformed_attachments_are_refused_even_when_they_are_not_used():
    anchoring = Anchoring(AnchoringParameters(use_attachments=False))
    with pytest.raises(AnchoringError, match="in a circle"):
        anchoring.update([], [("a", "a")])


def test_a_refused_frame_leaves_the_state_as_it_was():
    anchoring = confident(cone(100))
    before = anchoring.state
    with pytest.raises(AnchoringError, match="inverted box"):
        anchoring.update([cone(100), Detection("ball", (10, 0, 0, 10))])
    assert anchoring.state is before


def test_a_body_with_an_objects_name_is_refused():
    anchoring = confident(cone(100))
    with pytest.raises(AnchoringError, match="'cone-1' already stands for an anchored object"):
        anchoring.update([Detection("cone", (0, 0, 5, 5), name="cone-1")])


def test_the_state_is_a_value():
    empty, parameters = AnchoringState(), AnchoringParameters()
    first = step(empty, [cone(100)], (), None, parameters)
    assert step(empty, [cone(100)], (), None, parameters) == first
    assert (empty.anchors, empty.frame, first.frame) == ((), 0, 1)
    with pytest.raises(dataclasses.FrozenInstanceError):
        first.frame = 7


def test_a_running_mean_goes_part_of_the_way():
    anchoring = confident(
        cone(100), parameters=AnchoringParameters(position_gain=0.25, image_size=(320, 240))
    )
    [anchor] = anchoring.update([cone(108, side=24.0)])
    assert anchor.box == (102.0, 100.0, 123.0, 121.0)
    assert anchor.reason == "It is seen 10.2 px from its last place."


def test_what_is_carried_is_taken_where_it_is_seen():
    parameters = AnchoringParameters(position_gain=0.25)
    anchoring = confident(cone(100), hand(100), parameters=parameters)
    carried = by_name(anchoring.update([cone(108), hand(108)], [("cone-1", "hand")]))
    assert carried["cone-1"].box[0] == 108
    anchoring.update([hand(120)], [("cone-1", "hand")])
    released = by_name(anchoring.update([cone(124), hand(120)]))
    assert released["cone-1"].box[0] == 124


def test_what_comes_back_far_away_is_taken_where_it_is_seen():
    parameters = AnchoringParameters(position_gain=0.25, tau=6400, image_size=(320, 240))
    anchoring = confident(cone(100), parameters=parameters)
    anchoring.update([])
    assert anchoring.update([cone(139)])[0].box[0] == 100 + 39 / 4
    anchoring = confident(cone(100), parameters=parameters)
    anchoring.update([])
    assert anchoring.update([cone(141)])[0].box[0] == 141


DOWN = np.array([[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]])
BASE = AnchoringParameters(space="base", tau=0.01)


def above(x, y=0.0, z=1.0):
    return Camera(640, 480, 500.0, (x, y, z), DOWN, near_m=0.1)


def part(type_, position, camera, size=0.1, *, with_size=True):
    u, v, depth = camera.project(position)
    half = size * camera.focal_px / depth / 2
    extent = (size, size) if with_size else None
    return Detection(type_, (u - half, v - half, u + half, v + half), 1.0, position, extent)


def test_in_base_space_distances_are_metres():
    anchoring = Anchoring(BASE)
    camera = above(0.0)
    anchoring.update([part("plug", (0.0, 0.0, 0.0), camera)], (), camera)
    [near] = anchoring.update([part("plug", (0.09, 0.0, 0.0), camera)], (), camera)
    assert (near.name, near.position) == ("plug-1", (0.09, 0.0, 0.0))
    assert near.reason == "It is seen 0.09 m from its last place."
    far = anchoring.update([part("plug", (0.2, 0.0, 0.0), camera)], (), camera)
    assert [anchor.name for anchor in far] == ["plug-1", "plug-2"]


def test_in_base_space_the_mean_is_of_positions_and_the_box_is_of_this_image():
    anchoring = Anchoring(dataclasses.replace(BASE, position_gain=0.5))
    camera = above(0.0)
    anchoring.update([part("plug", (0.0, 0.0, 0.0), camera)], (), camera)
    seen = part("plug", (0.02, 0.0, 0.0), camera)
    [anchor] = anchoring.update([seen], (), camera)
    assert anchor.position == (0.01, 0.0, 0.0)
    assert anchor.box == seen.box


def test_a_size_is_worked_out_from_the_box_where_it_is_not_reported():
    camera = above(0.0)
    detection = part("plug", (0.0, 0.0, 0.0), camera, with_size=False)
    [anchor] = Anchoring(BASE).update([detection], (), camera)
    assert anchor.size == pytest.approx((0.1, 0.1))


def test_a_size_once_known_stays_known():
    anchoring = Anchoring(BASE)
    camera = above(0.0)
    anchoring.update([part("plug", (0.0, 0.0, 0.0), camera)])
    [anchor] = anchoring.update([part("plug", (0.0, 0.0, 0.0), camera, with_size=False)])
    assert anchor.size == (0.1, 0.1)


def test_base_space_without_positions_is_refused():
    with pytest.raises(AnchoringError, match="has no position"):
        Anchoring(BASE).update([cone(100)])


def test_a_broken_camera_is_refused():
    with pytest.raises(AnchoringError, match="focal length"):
        Anchoring().update([], (), dataclasses.replace(above(0.0), focal_px=-1.0))


def test_an_anchor_counts_for_how_many_frames_it_was_seen_or_missed():
    anchoring = Anchoring()
    seen = [Detection("cone", (100, 100, 120, 120))]
    streaks = []
    for frame in (seen, seen, seen, [], [], seen, []):
        anchoring.update(frame)
        streaks.append(anchoring.anchors[0].streak)
    assert streaks == [1, 2, 3, -1, -2, 1, -1]


def test_the_reason_of_a_miss_tells_for_how_long():
    anchoring = Anchoring()
    for _ in range(8):
        anchoring.update([Detection("cone", (100, 100, 120, 120))])
    anchoring.update([])
    first = anchoring.anchors[0].reason
    anchoring.update([])
    second = anchoring.anchors[0].reason
    assert first.startswith("It is not seen and nothing explains why")
    assert second.startswith("It is not seen for 2 frames and nothing explains why")


def test_a_hidden_child_s_streak_goes_on_while_it_is_carried():
    anchoring = Anchoring()
    cone, ball = Detection("cone", (100, 100, 140, 150)), Detection("ball", (110, 120, 125, 135))
    for _ in range(4):
        anchoring.update([cone, ball])
    for shift in range(3):
        moved = Detection("cone", (100 + shift, 100, 140 + shift, 150))
        anchoring.update([moved], [("ball-1", "cone-1")])
    child = next(a for a in anchoring.anchors if a.name == "ball-1")
    assert (child.status, child.streak) == ("attached", -3)
