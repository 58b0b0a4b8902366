from __future__ import annotations

import random

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from aapa.lacater.generator.viewpoint import DEFAULT_PLACE, Viewpoint

# CATER prints the projection of one of its cameras; these are the rows for u, v and the depth,
# in a picture that reaches from -1 to 1.
PLACE = (7.0926, -6.2661, 5.0886)
PRINTED = np.array(
    [
        [1.4503, 1.6376, 0.0, -0.0251],
        [-1.0346, 0.9163, 2.5685, 0.0095],
        [-0.6592, 0.5839, -0.4738, 10.7452],
    ]
)


def test_projection_is_the_one_cater_prints():
    points = np.array([[0.0, 0.0, 0.0], [1.0, -2.0, 0.3], [-3.0, 3.0, 2.7]])
    u, v, depth = Viewpoint.at(*PLACE).project(points).T
    rows = np.column_stack([points, np.ones(3)]) @ PRINTED.T
    assert np.allclose(depth, rows[:, 2], atol=2e-3)
    assert np.allclose((u - 160) / 160, rows[:, 0] / rows[:, 2], atol=2e-4)
    assert np.allclose((120 - v) / 120, rows[:, 1] / rows[:, 2], atol=2e-4)


@given(
    st.floats(-3, 3), st.floats(-3, 3), st.floats(0, 2.7), st.integers(min_value=0, max_value=50)
)
def test_a_ray_through_the_image_of_a_point_meets_the_point(x, y, z, seed):
    viewpoint = Viewpoint.drawn(random.Random(seed))
    point = np.array([x, y, z])
    u, v, depth = viewpoint.project(point)
    assert np.allclose(viewpoint.place + depth * viewpoint.rays(np.array([u, v])), point)


def test_the_camera_is_shaken_by_at_most_half_a_unit():
    chance = random.Random(1)
    off = np.array([Viewpoint.drawn(chance).place - DEFAULT_PLACE for _ in range(500)])
    assert np.abs(off).max() <= 0.5
    assert np.abs(off).max(axis=0).min() > 0.45
    assert np.abs(off.mean(axis=0)).max() < 0.05


def test_directions_lie_on_the_floor_and_are_the_cameras():
    directions = Viewpoint.at(*DEFAULT_PLACE).directions()
    assert list(directions) == ["behind", "front", "left", "right", "above", "below"]
    # The camera stands at the corner of +x and -y: what is behind is towards -x and +y.
    assert directions["behind"][0] < 0 < directions["behind"][1]
    assert directions["right"][0] > 0
    assert directions["right"][1] > 0
    for name in ("behind", "front", "left", "right"):
        assert directions[name][2] == 0
        assert np.isclose(np.linalg.norm(directions[name]), 1, atol=1e-5)
    assert np.isclose(np.dot(directions["behind"], directions["left"]), 0, atol=1e-5)
