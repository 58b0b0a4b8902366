from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from aapa.lacater.generator.bodies import Body, hull_of
from aapa.lacater.generator.outlines import boxes_of, rotations, rounded_boxes
from aapa.lacater.generator.viewpoint import DEFAULT_PLACE, Viewpoint

VIEWPOINT = Viewpoint.at(*DEFAULT_PLACE)


def body(shape: str, radius: float = 0.5, yaw: float = 0.0) -> Body:
    return Body(shape, "medium", "red", "rubber", radius, f"{shape}_0", yaw)


def surface_of(shape: str) -> np.ndarray:
    """Many points on the hull of a shape of radius 1."""
    hull = hull_of(shape)
    chance = np.random.default_rng(0)
    directions = chance.standard_normal((3000, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    farthest = hull.centres[(directions @ hull.centres.T).argmax(axis=1)]
    return farthest + hull.radius * directions


@settings(max_examples=60, deadline=None)
@given(
    shape=st.sampled_from(["sphere", "cube", "cylinder", "cone", "spl"]),
    x=st.floats(-3, 3),
    y=st.floats(-3, 3),
    z=st.floats(0.3, 2.5),
    yaw=st.floats(0, 6.3),
    tilt=st.floats(0, 6.3),
)
def test_a_box_holds_its_body_and_fits_tightly(shape, x, y, z, yaw, tilt):
    thing = body(shape, 0.5, yaw)
    place, tilts = np.array([[x, y, z]]), np.array([tilt])
    [box] = boxes_of(thing, place, tilts, VIEWPOINT)
    turned = surface_of(shape) * 0.5 @ rotations(yaw, tilts)[0].T + place
    seen = np.clip(VIEWPOINT.project(turned)[:, :2], 0, (320, 240))
    low, high = seen.min(axis=0), seen.max(axis=0)
    assert (box[:2] <= low + 1e-9).all()
    assert (box[2:] >= high - 1e-9).all()
    # Three thousand points do not quite reach the border.
    assert np.abs(np.concatenate([low, high]) - box).max() < 0.6


def test_a_ball_on_the_axis_is_seen_as_its_tangents():
    place = (VIEWPOINT.place + 8.0 * VIEWPOINT.axes[2])[None]
    [box] = boxes_of(body("sphere", 1.0), place, np.zeros(1), VIEWPOINT)
    reach = 350 * 0.9995 / (64 - 0.9995**2) ** 0.5
    assert box == pytest.approx([160 - reach, 120 - reach, 160 + reach, 120 + reach])


def test_a_box_is_cut_off_at_the_border():
    place = (VIEWPOINT.place + 8.0 * VIEWPOINT.axes[2] + 3.6 * VIEWPOINT.axes[0])[None]
    [box] = boxes_of(body("sphere", 1.0), place, np.zeros(1), VIEWPOINT)
    assert box[2] == 320
    assert 0 < box[0] < 320


def test_yaw_comes_before_tilt():
    turn = rotations(np.pi / 2, np.array([np.pi / 2]))[0]
    # A tilt by a quarter about y takes x to -z, and a yaw by a quarter leaves that; z goes to y.
    assert turn @ (1, 0, 0) == pytest.approx((0, 0, -1))
    assert turn @ (0, 0, 1) == pytest.approx((0, 1, 0))


def test_corner_and_size_are_rounded_apart():
    boxes = np.array([[10.4, 20.6, 31.4, 40.4], [0.5, 1.5, 3.0, 5.0]])
    # 10.4 → 10 and 21.0 → 21; 20.6 → 21 and 19.8 → 20, although 40.4 would round to 40.
    # Halves go to the even number: 0.5 → 0, 1.5 → 2, 2.5 → 2, 3.5 → 4.
    assert rounded_boxes(boxes).tolist() == [[10, 21, 31, 41], [0, 2, 2, 6]]
