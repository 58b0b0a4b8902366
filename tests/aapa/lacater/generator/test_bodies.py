from __future__ import annotations

import random
from collections import Counter

import numpy as np
import pytest

from aapa.lacater.classes import CLASS_NAMES, COLORS, SNITCH
from aapa.lacater.generator.bodies import Body, drawn_bodies, hull_of


def support(shape: str, directions: np.ndarray) -> np.ndarray:
    """How far a shape of radius 1 reaches in each direction."""
    hull = hull_of(shape)
    return (directions @ hull.centres.T).max(axis=1) + hull.radius


@pytest.fixture
def directions():
    chance = np.random.default_rng(1)
    found = chance.standard_normal((20_000, 3))
    return found / np.linalg.norm(found, axis=1, keepdims=True)


def test_the_snitch_reaches_as_far_as_its_mesh(directions):
    reach = support("spl", directions)
    assert 1.095 < reach.min() < 1.15
    assert 1.21 < reach.max() <= 1.22 + 1e-9


def test_the_snitchs_box_overlaps_that_of_a_ball_as_its_meshs_does():
    chance = np.random.default_rng(2)
    overlaps = []
    for _ in range(500):
        turn, _ = np.linalg.qr(chance.standard_normal((3, 3)))
        seen = hull_of("spl").centres @ turn[:, :2]
        low, high = seen.min(axis=0), seen.max(axis=0)
        shared = np.prod(np.minimum(high, 1.16) - np.maximum(low, -1.16))
        overlaps.append(shared / (np.prod(high - low) + 2.32**2 - shared))
    assert np.mean(overlaps) == pytest.approx(0.959, abs=0.004)


@pytest.mark.parametrize(
    ("shape", "direction", "reach"),
    [
        ("sphere", (1, 0, 0), 0.9995),
        ("cube", (1, 0, 0), 1.0),
        ("cube", (0, 0, -1), 1.0),
        ("cube", (1, 1, 1), 0.82 * 3**0.5 + 0.18),  # the edges are round
        ("cylinder", (0, 0, 1), 0.65),
        ("cylinder", (0, 1, 0), 1.0),
        ("cone", (0, 0, 1), 1.0),
        ("cone", (0, 0, -1), 1.0),
        ("cone", (1, 0, 0), 1.0),
    ],
)
def test_shapes_have_their_measures(shape, direction, reach):
    unit = np.array([direction], dtype=float)
    unit /= np.linalg.norm(unit)
    assert support(shape, unit)[0] == pytest.approx(reach, abs=1e-9)


def test_there_is_no_other_shape():
    with pytest.raises(KeyError):
        hull_of("torus")


def test_every_scene_has_the_snitch_and_two_cones():
    chance = random.Random(3)
    for count in range(5, 11):
        bodies = drawn_bodies(count, chance)
        assert len(bodies) == count
        assert bodies[0].class_id == SNITCH
        assert (bodies[0].instance, bodies[0].radius) == ("Spl_0", 0.3)
        assert [(b.shape, b.size, b.radius) for b in bodies[1:3]] == [
            ("cone", "medium", 0.5),
            ("cone", "large", 0.75),
        ]
        assert len({body.instance for body in bodies}) == count


def test_other_bodies_are_drawn_evenly():
    chance = random.Random(4)
    others = [body for _ in range(600) for body in drawn_bodies(10, chance)[3:]]
    for attribute, kinds in (("shape", 4), ("size", 3), ("material", 2), ("color", 8)):
        counts = Counter(getattr(body, attribute) for body in others)
        assert len(counts) == kinds
        expected = len(others) / kinds
        assert all(abs(n - expected) < 5 * expected**0.5 for n in counts.values())
    assert {body.color for body in others} == set(COLORS)
    assert all(CLASS_NAMES[body.class_id] == body.class_name for body in others)


def test_a_cone_floats_and_a_ball_stands():
    cone = Body("cone", "large", "red", "rubber", 0.75, "Cone_0", 0.0)
    ball = Body("sphere", "large", "red", "rubber", 0.75, "Sphere_0", 0.0)
    assert cone.origin_at(1, 2) == pytest.approx((1 - 0.0339, 2 - 0.0289, 0.75 + 0.1809))
    assert ball.origin_at(1, 2) == (1, 2, 0.75)
