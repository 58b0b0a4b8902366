from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aapa.boxes import centre_of
from aapa.camera import Camera
from aapa.parameters import AnchoringParameters
from aapa.view import View

# One metre above the base frame's origin, looking down; right is x, down in the image is -y.
DOWN = np.array([[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]])
CAMERA = Camera(640, 480, 500.0, (0.0, 0.0, 1.0), DOWN, near_m=0.1)
BASE = AnchoringParameters(space="base", tau=0.01)
OLD = (1.0, 2.0, 31.0, 42.0)


def test_a_box_is_where_the_camera_would_see_it():
    box = View(BASE, CAMERA).box_of(OLD, (0.1, 0.0, 0.0), (0.2, 0.1))
    assert box == pytest.approx((320, 215, 420, 265))


def test_without_a_size_the_box_keeps_its_extent():
    box = View(BASE, CAMERA).box_of(OLD, (0.1, 0.0, 0.0), None)
    assert box == pytest.approx((355, 220, 385, 260))


@pytest.mark.parametrize(
    "view", [View(BASE), View(AnchoringParameters(), CAMERA), View(AnchoringParameters())]
)
def test_without_a_pose_in_base_space_nothing_is_projected(view):
    assert view.box_of(OLD, (0.1, 0.0, 0.0), (0.2, 0.1)) == OLD
    assert view.size_of(OLD, (0.1, 0.0, 0.0)) is None


def test_behind_the_camera_there_is_no_box():
    assert View(BASE, CAMERA).box_of(OLD, (0.0, 0.0, 1.0), (0.2, 0.1)) == OLD
    assert View(BASE, CAMERA).size_of(OLD, (0.0, 0.0, 2.0)) is None
    assert View(BASE, CAMERA).size_of((5, 5, 5, 9), (0.0, 0.0, 0.0)) is None


@given(st.floats(-0.5, 0.5), st.floats(-0.4, 0.4), st.floats(0, 0.8), st.floats(0.01, 0.3))
def test_size_and_box_are_each_others_inverse(x, y, z, side):
    view = View(BASE, CAMERA)
    box = view.box_of(OLD, (x, y, z), (side, side / 2))
    assert centre_of(box) == pytest.approx(CAMERA.project((x, y, z))[:2])
    assert view.size_of(box, (x, y, z)) == pytest.approx((side, side / 2))


@pytest.mark.parametrize(
    ("position", "reason"),
    [
        ((0.0, 0.0, 0.0), None),
        ((0.0, 0.0, 1.5), "It lies behind the camera."),
        ((0.0, 0.0, 0.95), "It is 0.050 m from the camera, which detects nothing nearer than"),
        ((2.0, 0.0, 0.0), "It lies outside the image."),
        ((0.0, -2.0, 0.0), "It lies outside the image."),
        ((0.62, 0.0, 0.0), "Part of it reaches out of the image."),
    ],
)
def test_out_of_view_in_base_space(position, reason):
    view = View(BASE, CAMERA)
    found = view.why_out_of_view(view.box_of(OLD, position, (0.1, 0.1)), position)
    assert (found is None) if reason is None else found.startswith(reason)


def test_out_of_view_in_the_image_needs_its_size():
    edge = (0.0, 50.0, 20.0, 70.0)
    assert View(AnchoringParameters()).why_out_of_view(edge, None) is None
    for view in [
        View(AnchoringParameters(image_size=(320, 240))),
        View(AnchoringParameters(), CAMERA),
    ]:
        assert view.why_out_of_view(edge, None) == "Part of it reaches out of the image."
        assert view.why_out_of_view((50.0, 50.0, 70.0, 70.0), None) is None


def test_the_camera_knows_the_size_of_the_image_better():
    view = View(AnchoringParameters(image_size=(320, 240)), CAMERA)
    assert view.why_out_of_view((310.0, 50.0, 330.0, 70.0), None) is None


def test_in_the_image_either_of_two_overlapping_things_may_hide_the_other():
    view = View(AnchoringParameters())
    first, second = ((0, 0, 10, 10), None), ((5, 5, 15, 15), None)
    assert view.hides(first, second)
    assert view.hides(second, first)
    assert not view.hides(first, ((30, 30, 40, 40), None))


def test_in_base_space_only_the_nearer_hides_the_other():
    view = View(BASE, CAMERA)
    low, high = ((0, 0, 10, 10), (0.0, 0.0, 0.0)), ((5, 5, 15, 15), (0.0, 0.0, 0.5))
    assert view.hides(high, low)
    assert not view.hides(low, high)
    assert not view.hides(((5, 5, 15, 15), (0.0, 0.0, 1.5)), low)
    assert View(BASE).hides(low, high)
