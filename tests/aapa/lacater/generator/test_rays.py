from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from aapa.lacater.generator.bodies import Body
from aapa.lacater.generator.outlines import boxes_of
from aapa.lacater.generator.rays import depths, local_rays
from aapa.lacater.generator.viewpoint import DEFAULT_PLACE, Viewpoint

VIEWPOINT = Viewpoint.at(*DEFAULT_PLACE)
SURFACE = {
    "sphere": lambda p: np.abs(np.linalg.norm(p, axis=1) - 0.9995),
    "spl": lambda p: np.abs(np.linalg.norm(p, axis=1) - 1.16),
    "cube": lambda p: np.abs(np.abs(p).max(axis=1) - 1.0),
    "cylinder": lambda p: np.minimum(
        np.abs(np.hypot(p[:, 0], p[:, 1]) - 1.0), np.abs(np.abs(p[:, 2]) - 0.65)
    ),
    "cone": lambda p: np.minimum(
        np.abs(np.hypot(p[:, 0], p[:, 1]) - (1 - p[:, 2]) / 2), np.abs(p[:, 2] + 1)
    ),
}


def body(shape: str, yaw: float = 0.0) -> Body:
    return Body(shape, "medium", "red", "rubber", 0.5, f"{shape}_0", yaw)


def grid(box: np.ndarray, side: int = 40) -> np.ndarray:
    u, v = np.meshgrid(np.linspace(box[0], box[2], side), np.linspace(box[1], box[3], side))
    return np.stack([u, v], axis=-1).reshape(1, -1, 2)


@settings(max_examples=60, deadline=None)
@given(
    shape=st.sampled_from(sorted(SURFACE)),
    x=st.floats(-2, 2),
    y=st.floats(-2, 2),
    z=st.floats(0.5, 2.0),
    yaw=st.floats(0, 6.3),
    tilt=st.floats(0, 6.3),
)
def test_rays_meet_the_surface_and_only_within_the_box(shape, x, y, z, yaw, tilt):
    thing, place, tilts = body(shape, yaw), np.array([[x, y, z]]), np.array([tilt])
    [box] = boxes_of(thing, place, tilts, VIEWPOINT)
    around = box + np.array([-6, -6, 6, 6])
    pixels = grid(around)
    rays = VIEWPOINT.rays(pixels)
    depth = depths(thing, place, tilts, VIEWPOINT.place, rays)
    hit = np.isfinite(depth[0])
    start, along = local_rays(thing, place, tilts, VIEWPOINT.place, rays)
    points = (start + np.where(hit, depth[0], 0)[None, :, None] * along)[0, hit]
    assert SURFACE[shape](points).max() < 1e-6
    # Edges and spikes are cut off in the boxes, and a ball stands for the snitch.
    slack = {"cube": 4.5, "spl": 3.0, "cylinder": 1.0}.get(shape, 0.3)
    seen = pixels[0, hit]
    assert (seen >= box[:2] - slack).all()
    assert (seen <= box[2:] + slack).all()
    assert 0.3 < hit.mean() * np.prod(around[2:] - around[:2]) / np.prod(box[2:] - box[:2]) < 1.4


def test_a_ball_ahead_is_as_deep_as_its_front():
    place = (VIEWPOINT.place + 8.0 * VIEWPOINT.axes[2])[None]
    ahead = VIEWPOINT.rays(np.array([[[160.0, 120.0]]]))
    depth = depths(body("sphere"), place, np.zeros(1), VIEWPOINT.place, ahead)
    assert depth[0, 0] == pytest.approx(8.0 - 0.5 * 0.9995)


def test_the_hidden_side_of_a_cone_is_not_what_a_ray_meets():
    place = (VIEWPOINT.place + 8.0 * VIEWPOINT.axes[2])[None]
    ahead = VIEWPOINT.rays(np.array([[[160.0, 120.0]]]))
    assert depths(body("cone"), place, np.zeros(1), VIEWPOINT.place, ahead)[0, 0] < 8.0


def test_a_body_in_front_is_nearer_everywhere():
    near, far = (VIEWPOINT.place + d * VIEWPOINT.axes[2] for d in (5.0, 8.0))
    [box] = boxes_of(body("cube"), far[None], np.zeros(1), VIEWPOINT)
    rays = VIEWPOINT.rays(grid(box))
    behind = depths(body("cube"), far[None], np.zeros(1), VIEWPOINT.place, rays)
    front = depths(body("cube"), near[None], np.zeros(1), VIEWPOINT.place, rays)
    both = np.isfinite(behind) & np.isfinite(front)
    assert both.sum() > 500
    assert (front[both] < behind[both]).all()
