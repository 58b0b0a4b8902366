"""The floor as the camera sees it: there and back, and the camera from boxes alone."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aapa.lacater.generator.bodies import Body
from aapa.lacater.generator.outlines import boxes_of
from aapa.lacater.generator.viewpoint import Viewpoint
from aapa.lacater.models.plus.calibration import calibrated
from aapa.lacater.models.plus.ground import GroundView
from aapa.lacater.models.plus.scenery import START_VIEW
from aapa.lacater.models.plus.solids import SNITCH_SOLID, solid_of

VIEW = GroundView(height=5.3, pitch=0.5, focal=350.0, size=(320, 240))
LARGE_CONE, MEDIUM_CONE, LARGE_SPHERE = solid_of(0), solid_of(64), solid_of(3)


@given(
    st.sampled_from([LARGE_CONE, MEDIUM_CONE, LARGE_SPHERE, SNITCH_SOLID]),
    st.floats(-2.0, 2.0),
    st.floats(8.0, 11.0),
    st.floats(0.0, 1.0),
)
def test_the_place_of_a_box_is_where_it_came_from(solid, across, ahead, lift):
    box = VIEW.box(solid, (across, ahead), lift)
    if min(VIEW.free_edges(box)) == 1:
        assert VIEW.place(solid, box, lift) == pytest.approx((across, ahead), abs=1e-3)


def test_a_box_cut_off_at_the_border_still_tells_the_place():
    box = VIEW.box(LARGE_CONE, (-4.3, 9.0))
    assert box[0] < 0 < box[2]
    assert VIEW.place(LARGE_CONE, VIEW.clipped(box)) == pytest.approx((-4.3, 9.0), abs=1e-2)


def test_two_edges_cut_off_are_too_many():
    assert VIEW.place(LARGE_CONE, (0.0, 0.0, 50.0, 60.0)) is None


@pytest.mark.parametrize("shape", ["cone", "sphere"])
def test_boxes_are_those_of_the_generator(shape):
    camera = Viewpoint.at(7.2, -6.3, 5.5)
    body = Body(shape, "medium", "red", "metal", 0.5, "It", 0.3)
    place = np.array([body.origin_at(0.4, -0.2)])
    [real] = boxes_of(body, place, np.zeros(1), camera)
    seen = camera.seen_from_here(place[0])
    pitch = math.atan2(5.5 - 0.00113, math.hypot(7.2 - 0.01433, -6.3 - 0.00261))
    view = GroundView(5.5, pitch, 350.0, (320, 240))
    ahead = seen[2] * math.cos(pitch) + seen[1] * math.sin(pitch)
    number = 64 if shape == "cone" else 67
    assert view.box(solid_of(number), (seen[0], ahead)) == pytest.approx(tuple(real), abs=0.15)


def test_the_camera_follows_from_boxes_alone():
    places = [(-2.0, 8.0), (1.5, 9.0), (0.0, 10.5), (2.0, 7.5)]
    solids = [LARGE_CONE, MEDIUM_CONE, LARGE_SPHERE, LARGE_CONE]
    seen = [(s, VIEW.box(s, p)) for s, p in zip(solids, places, strict=True)]
    found = calibrated(START_VIEW, seen)
    assert found.pitch == pytest.approx(0.5, abs=1e-3)
    assert found.height == pytest.approx(5.3, abs=1e-2)


def test_a_false_box_does_not_spoil_the_camera():
    places = [(-2.0, 8.0), (1.5, 9.0), (0.0, 10.5), (2.0, 7.5), (-1.0, 9.5), (0.5, 8.0)]
    seen = [(LARGE_CONE, VIEW.box(LARGE_CONE, place)) for place in places]
    wrong = (100.0, 100.0, 130.0, 160.0)
    found = calibrated(START_VIEW, [*seen, (LARGE_CONE, wrong)])
    assert found.pitch == pytest.approx(0.5, abs=0.01)


def test_one_box_is_too_few():
    assert calibrated(START_VIEW, [(LARGE_CONE, VIEW.box(LARGE_CONE, (0.0, 9.0)))]) is None
