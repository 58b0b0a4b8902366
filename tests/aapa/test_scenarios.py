"""Whole episodes: what the paper's robot and its LA-CATER videos do to the eyes."""

from __future__ import annotations

import math

import numpy as np
import pytest

from aapa import Anchoring, AnchoringParameters, AnchorStatus, Camera, Detection

GEARBOX = AnchoringParameters(
    tau=0.01,
    space="base",
    unique_types=frozenset({"case", "hubcover", "subassembly", "plug"}),
)
CHAIN = [("hubcover", "case"), ("subassembly", "case"), ("plug", "case"), ("case", "hand")]
PLACES = {
    "case": (0.40, 0.10, 0.05),
    "hubcover": (0.40, 0.10, 0.10),
    "subassembly": (0.38, 0.12, 0.06),
    "plug": (0.43, 0.09, 0.08),
}
DOWN = np.array([[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]])


def looking_down(x, y, z, angle=0.0):
    cosine, sine = math.cos(angle), math.sin(angle)
    turn = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    return Camera(640, 480, 600.0, (x, y, z), turn @ DOWN, near_m=0.12)


def in_image(type_, position, camera, *, name=None):
    u, v, depth = camera.project(position)
    half = 0.03 * camera.focal_px / depth
    return Detection(type_, (u - half, v - half, u + half, v + half), 1.0, position, name=name)


def hand_at(position):
    # The hand's place comes from the joints, and the camera on the wrist never sees it.
    return Detection("hand", (0.0, 0.0, 0.0, 0.0), 1.0, position, name="hand")


def by_name(anchors):
    return {anchor.name: anchor for anchor in anchors}


def difference(first, second):
    return tuple(a - b for a, b in zip(first, second, strict=True))


def seen_gearbox(cycles=12):
    anchoring = Anchoring(GEARBOX)
    camera = looking_down(0.4, 0.1, 0.6)
    for _ in range(cycles):
        parts = [in_image(name, place, camera) for name, place in PLACES.items()]
        anchoring.update([*parts, hand_at((0.4, 0.1, 0.2))], (), camera)
    return anchoring


def test_the_papers_chain_follows_a_hand_that_alone_is_reported():
    anchoring = seen_gearbox()
    for frame in range(1, 60):
        way = (0.01 * frame, -0.005 * frame, 0.002 * frame)
        hand = (0.4 + way[0], 0.1 + way[1], 0.2 + way[2])
        camera = looking_down(hand[0], hand[1], hand[2] + 0.1)
        anchors = by_name(anchoring.update([hand_at(hand)], CHAIN, camera))
        assert set(anchors) == {*PLACES, "hand"}
        for name, place in PLACES.items():
            assert difference(anchors[name].position, place) == pytest.approx(way)
            assert anchors[name].status is AnchorStatus.ATTACHED
            assert anchors[name].parent == dict(CHAIN)[name]
            assert anchors[name].confidence == 1.0


def test_the_papers_chain_is_lost_without_attachments():
    anchoring = seen_gearbox()
    camera = looking_down(0.4, 0.1, 0.6)
    for frame in range(1, 12):
        anchoring.update([hand_at((0.4 + 0.01 * frame, 0.1, 0.2))], (), camera)
    assert [anchor.name for anchor in anchoring.anchors] == ["hand"]
    assert {anchor.name for anchor in anchoring.dropped} == set(PLACES)


def test_what_is_assembled_stays_known_when_the_arm_drives_away():
    anchoring = seen_gearbox()
    released = CHAIN[:3]
    for frame in range(60):
        away = (0.4 + 0.02 * frame, 0.1, 0.6)
        camera = looking_down(*away)
        detections = [hand_at(away)]
        u, _, _ = camera.project(PLACES["case"])
        if u > 60:
            detections.append(in_image("case", PLACES["case"], camera))
        anchors = by_name(anchoring.update(detections, released, camera))
    for name, place in PLACES.items():
        assert anchors[name].position == pytest.approx(place)
    assert anchors["case"].status is AnchorStatus.OUT_OF_VIEW
    assert anchors["plug"].status is AnchorStatus.ATTACHED
    assert min(anchor.confidence for anchor in anchors.values()) == 1.0


def test_a_moving_camera_leaves_still_objects_where_they_are():
    anchoring = Anchoring(GEARBOX)
    statuses = set()
    for frame in range(80):
        turn = frame / 20
        camera = looking_down(0.4 + 0.5 * math.sin(turn), 0.1, 0.5 + 0.1 * math.cos(turn), turn)
        found = [in_image(name, place, camera) for name, place in PLACES.items()]
        found = [d for d in found if d.box[0] >= 0 and d.box[2] <= 640]
        found = [d for d in found if d.box[1] >= 0 and d.box[3] <= 480]
        for anchor in anchoring.update(found, (), camera):
            assert anchor.name in PLACES
            assert anchor.position == PLACES[anchor.name]
            expected = in_image(anchor.type, PLACES[anchor.name], camera).box
            assert anchor.box == pytest.approx(expected, abs=1e-6)
            statuses.add(anchor.status)
    assert statuses == {AnchorStatus.VISIBLE, AnchorStatus.OUT_OF_VIEW}
    assert len(anchoring.anchors) == len(PLACES)


def test_an_object_held_too_near_to_the_lens_keeps_its_confidence_and_hides_the_case():
    anchoring = seen_gearbox()
    held = [("plug", "hand")]
    for frame in range(40):
        # The hand lifts the plug, until it fills the view of the camera on the wrist.
        z = 0.08 + min(frame, 10) * 0.04
        camera = looking_down(0.4, 0.1, z + 0.08)
        detections = [hand_at((0.4, 0.1, z))]
        if frame == 0:
            detections.append(in_image("plug", (0.4, 0.1, z), camera))
        anchors = by_name(anchoring.update(detections, held if frame else (), camera))
    assert anchors["plug"].status is AnchorStatus.ATTACHED
    assert anchors["plug"].position == pytest.approx((0.4, 0.1, 0.48))
    assert anchors["plug"].confidence == 1.0
    assert anchors["case"].status is AnchorStatus.OCCLUDED
    assert anchors["case"].reason == "plug stands in front of it."
    assert anchors["case"].confidence > 0.5


VIDEO = AnchoringParameters(tau=6500, image_size=(320, 240), unique_types=frozenset({"snitch"}))


def square(type_, x, y, side=20.0):
    return Detection(type_, (x, y, x + side, y + side))


def test_a_contained_snitch_is_carried_by_its_cone():
    anchoring = Anchoring(VIDEO)
    for frame in range(20):
        anchoring.update([square("snitch", 150, 150), square("cone", 50 + 4 * frame, 140, 40)])
    # The cone comes down at frame 20; from 21 on the snitch goes where the cone goes.
    anchoring.update([square("cone", 140, 140, 40)])
    for frame in range(21, 60):
        cone = square("cone", 140 + 2 * (frame - 20), 140, 40)
        anchors = by_name(anchoring.update([cone], [("snitch", "cone-1")]))
        assert anchors["snitch"].box == (cone.box[0] + 10, 150, cone.box[0] + 30, 170)
        assert anchors["snitch"].status is AnchorStatus.ATTACHED
        assert anchors["snitch"].confidence == 1.0
    # The cone is lifted, and the snitch is seen beneath it.
    anchors = by_name(anchoring.update([square("cone", 218, 90, 40), square("snitch", 228, 151)]))
    assert (anchors["snitch"].status, anchors["snitch"].box[:2]) == ("visible", (228, 151))
    assert len(anchors) == 2


def test_cones_within_cones_take_everything_along():
    anchoring = Anchoring(VIDEO)
    for _ in range(12):
        anchoring.update(
            [square("snitch", 150, 150), square("cone", 145, 145, 30), square("big", 140, 140, 40)]
        )
    pairs = [("snitch", "cone-1"), ("cone-1", "big-1")]
    anchors = by_name(anchoring.update([square("big", 160, 130, 40)], pairs))
    assert anchors["cone-1"].box[:2] == (165, 135)
    assert anchors["snitch"].box[:2] == (170, 140)


def test_two_children_of_one_parent_both_follow():
    anchoring = Anchoring(VIDEO)
    for _ in range(12):
        anchoring.update(
            [square("ball", 150, 150), square("ball", 250, 150), square("tray", 80, 90)]
        )
    pairs = [("ball-1", "tray-1"), ("ball-2", "tray-1")]
    anchors = by_name(anchoring.update([square("tray", 90, 85)], pairs))
    assert anchors["ball-1"].box[:2] == (160, 145)
    assert anchors["ball-2"].box[:2] == (260, 145)


def test_a_snitch_behind_something_waits_where_it_was_seen_last():
    anchoring = Anchoring(VIDEO)
    for _ in range(12):
        anchoring.update([square("snitch", 150, 150), square("cube", 60, 140, 40)])
    for x in range(60, 240, 4):
        hidden = 110 < x < 170
        cube = square("cube", x, 140, 40)
        found = [cube] if hidden else [cube, square("snitch", 150, 150)]
        snitch = by_name(anchoring.update(found))["snitch"]
        assert snitch.box == (150, 150, 170, 170)
        assert snitch.status == ("occluded" if hidden else "visible")
        assert snitch.confidence == 1.0


def test_a_misdetection_that_flickers_leaves_no_ghost():
    anchoring = Anchoring(VIDEO)
    for frame in range(40):
        found = [square("snitch", 150, 150), square("cube", 60, 140, 40)]
        if frame % 10 == 5:
            found.append(square("cone", 250, 60))
        anchoring.update(found)
    assert [anchor.name for anchor in anchoring.anchors] == ["cube-1", "snitch"]


def test_a_container_that_flickers_does_not_wear_its_content_out():
    anchoring = Anchoring(VIDEO)
    for _ in range(12):
        anchoring.update([square("snitch", 150, 150), square("cone", 140, 140, 40)])
    for frame in range(200):
        found = [] if frame % 4 == 0 else [square("cone", 140, 140, 40)]
        snitch = by_name(anchoring.update(found, [("snitch", "cone-1")]))["snitch"]
    assert (snitch.confidence, snitch.box[:2]) == (1.0, (150, 150))
