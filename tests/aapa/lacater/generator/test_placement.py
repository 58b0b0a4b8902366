from __future__ import annotations

import itertools
import math
import random

import numpy as np

from aapa.lacater.generator.placement import drawn_scene
from aapa.lacater.generator.viewpoint import DEFAULT_PLACE, Viewpoint


def scenes(count: int):
    viewpoint, chance = Viewpoint.at(*DEFAULT_PLACE), random.Random(5)
    return viewpoint, [drawn_scene(viewpoint, chance) for _ in range(count)]


def test_things_stand_apart_and_none_quite_behind_or_beside_another():
    viewpoint, drawn = scenes(80)
    directions = viewpoint.directions()
    for bodies, places in drawn:
        assert len(places) == len(bodies)
        assert np.abs(places).max() <= 3
        for (one, (x, y)), (two, (u, v)) in itertools.combinations(
            zip(bodies, places, strict=True), 2
        ):
            assert math.hypot(x - u, y - v) - one.radius - two.radius >= 0.25
            for name in ("left", "behind"):
                along = (x - u) * directions[name][0] + (y - v) * directions[name][1]
                assert along == 0 or abs(along) >= 0.4


def test_there_are_five_to_ten_things():
    _, drawn = scenes(300)
    counts = np.bincount([len(bodies) for bodies, _ in drawn], minlength=11)
    assert counts[:5].sum() == 0
    assert (counts[5:] > 25).all()


def test_crowded_scenes_have_smaller_things():
    # Sizes are drawn evenly, 0.5 on average; those that find no place are drawn anew.
    _, drawn = scenes(700)
    radii = [body.radius for bodies, _ in drawn if len(bodies) == 10 for body in bodies[3:]]
    standard_error = 0.204 / len(radii) ** 0.5
    assert np.mean(radii) < 0.5 - 3 * standard_error
