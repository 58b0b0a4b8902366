from __future__ import annotations

import math

import numpy as np
import pytest

from aapa import Camera
from runtime.cell.arrangement import PlacedPart
from runtime.cell.raster import draw
from runtime.parts import load_parts

PARTS = load_parts()
DOWN = np.array([[0.0, -1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])


def camera(height=0.5, x=0.0, y=0.0):
    return Camera(320, 240, 230.0, (x, y, height), DOWN, 0.17)


def standing(name, x=0.0, y=0.0):
    pose = np.eye(4)
    pose[:3, 3] = x, y, PARTS[name].size[2] / 2
    return PlacedPart(f"{name}-1", PARTS[name], pose)


def test_a_disc_straight_below_has_the_area_of_its_circle():
    seen = draw(standing("hubcover"), camera())
    assert seen is not None
    radius = 0.030 * 230 / (0.5 - 0.010)
    assert seen.pixels == pytest.approx(math.pi * radius**2, rel=0.02)
    assert seen.box == pytest.approx(
        (160 - radius, 120 - radius, 160 + radius, 120 + radius), abs=0.2
    )


def test_the_outline_does_not_end_at_the_image_border():
    inside = draw(standing("bearing"), camera())
    outside = draw(standing("bearing"), camera(x=0.4))
    assert inside is not None
    assert outside is not None
    assert outside.box[3] < 0 or outside.box[1] > 240
    assert outside.pixels > inside.pixels  # seen from the side as well


def test_close_up_large_outlines_are_counted_on_a_coarser_grid():
    near, far = (draw(standing("casingtop"), camera(height)) for height in (0.10, 1.06))
    assert near is not None
    assert far is not None
    # The knob's top is the only thing nearer than the plate, and hides part of it.
    assert near.pixels > 100 * far.pixels


def test_behind_the_lens_there_is_nothing_and_beside_it_no_outline():
    assert draw(standing("output"), camera(height=-0.5)) is None
    beside = draw(standing("output"), camera(height=0.09))
    assert beside is not None
    assert beside.pixels == 0
