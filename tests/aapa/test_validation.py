from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aapa.camera import Camera
from aapa.detections import Detection
from aapa.errors import AnchoringError
from aapa.validation import (
    _are_plain,
    _checked,
    check_camera,
    check_within,
    checked_detections,
)

BOX = (10, 10, 30, 40)


def test_numbers_of_any_kind_become_floats():
    box = np.array([1, 2, 3, 4], dtype=np.int64)
    [detection] = checked_detections(
        [Detection("cone", box, np.float32(0.5), [0, 0, 1], (1, 2))], "base"
    )
    assert detection == Detection("cone", (1.0, 2.0, 3.0, 4.0), 0.5, (0.0, 0.0, 1.0), (1.0, 2.0))
    assert {type(number) for number in detection.box} == {float}


def test_a_point_like_box_is_allowed():
    assert checked_detections([Detection("hand", (5, 5, 5, 5))], "image")[0].box == (5, 5, 5, 5)


@pytest.mark.parametrize(
    ("detection", "text"),
    [
        (Detection("cone", (10, 10, 30)), r"detection 2 \(cone\) has box .*; expected 4 numbers"),
        (Detection("cone", None), "has box None; expected 4 numbers"),
        (Detection("cone", "1234"), "expected 4 numbers"),
        (Detection("cone", (1, 2, 3, "4")), "expected 4 numbers"),
        (Detection("cone", (1, 2, 3, 10**400)), "expected 4 numbers"),
        (Detection("cone", (10, 10, float("nan"), 40)), "has nan in its box; expected finite"),
        (Detection("cone", (10, 10, float("inf"), 40)), "has inf in its box"),
        (Detection("cone", (30, 10, 10, 40)), "inverted box .*; expected x1 ≤ x2 and y1 ≤ y2"),
        (Detection("cone", (10, 40, 30, 10)), "inverted box"),
        (Detection("cone", BOX, 1.5), "has score 1.5; it has to be within 0…1"),
        (Detection("cone", BOX, float("nan")), "has nan in its score"),
        (Detection("cone", BOX, "high"), "has score 'high'; expected a number"),
        (Detection("", BOX), "detection 2 has type ''; expected a name"),
        (Detection(7, BOX), "detection 2 has type 7; expected a name"),
        (Detection("hand", BOX, name=""), "has name ''; expected a name or None"),
        (Detection("cone", BOX, position=(0, 0)), "has position .*; expected 3 numbers"),
        (Detection("cone", BOX, position=(0, 0, float("nan"))), "has nan in its position"),
        (Detection("cone", BOX, size=(0.1,)), "has size .*; expected 2 numbers"),
        (Detection("cone", BOX, size=(-0.1, 0.2)), "width and height are at least 0 m"),
        (Detection("ball", BOX, name="hand"), "two detections carry the name 'hand'"),
        ("cone", "detection 2 is a str, no Detection"),
    ],
)
def test_a_malformed_detection_is_named(detection, text):
    with pytest.raises(AnchoringError, match=text):
        checked_detections([Detection("hand", BOX, name="hand"), detection], "image")


def test_base_space_needs_positions():
    with pytest.raises(AnchoringError, match=r"\(cone\) has no position; in base space every"):
        checked_detections([Detection("cone", BOX)], "base")


CAMERA = Camera(640, 480, 500.0, (0.0, 0.0, 1.0), np.eye(3))


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"width": 0}, "image is 0 x 480 px; both have to be above 0"),
        ({"focal_px": 0.0}, "focal length is 0.0 px; expected above 0"),
        ({"focal_px": float("nan")}, "focal length is nan px"),
        ({"position": (0.0, 1.0)}, "the camera has position .* expected 3 numbers"),
        ({"rotation": np.eye(2)}, r"rotation has shape \(2, 2\); expected \(3, 3\)"),
        ({"rotation": 2 * np.eye(3)}, "is not a rotation"),
        ({"rotation": np.diag([1.0, 1.0, -1.0])}, "is not a rotation; its columns are its right"),
        ({"rotation": np.full((3, 3), np.nan)}, "is not a rotation"),
    ],
)
def test_a_camera_that_cannot_project_is_refused(change, text):
    check_camera(CAMERA)
    with pytest.raises(AnchoringError, match=text):
        check_camera(dataclasses.replace(CAMERA, **change))


def test_what_is_in_order_is_handed_on_as_it_is():
    plain = Detection("cone", (1.0, 2.0, 3.0, 4.0), 0.5)
    assert checked_detections([plain], "image")[0] is plain


@given(
    st.tuples(*[st.one_of(st.integers(-5, 5), st.floats(), st.none(), st.booleans())] * 4),
    st.one_of(st.floats(), st.integers(-1, 2), st.none()),
)
def test_the_quick_look_lets_nothing_pass_that_the_close_look_refuses(box, score):
    detection = Detection("cone", box, score)
    try:
        close = _checked(1, detection, "image")
    except AnchoringError:
        assert not _are_plain([detection])
    else:
        assert not _are_plain([detection]) or close == detection


@pytest.mark.parametrize(
    "box", [(321, 5, 330, 9), (5, 241, 9, 250), (-9, 5, -1, 9), (5, -9, 9, -1)]
)
def test_a_box_wholly_outside_of_the_picture_is_of_another_one(box):
    detections = [Detection("cone", BOX), Detection("ball", box)]
    with pytest.raises(
        AnchoringError, match=r"detection 2 \(ball\) .* outside of the picture of 320"
    ):
        check_within(detections, (320, 240))


@pytest.mark.parametrize("box", [(-5, -5, 0, 0), (319, 239, 330, 250), (-9, -9, 999, 999)])
def test_a_box_may_reach_beyond_the_border(box):
    check_within([Detection("ball", box)], (320, 240))


def test_a_body_need_not_be_where_the_camera_looks():
    check_within([Detection("hand", (-9, -9, -5, -5), name="hand")], (320, 240))
