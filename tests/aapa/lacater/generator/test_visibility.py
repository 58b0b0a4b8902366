from __future__ import annotations

import math

import numpy as np
import pytest

from aapa.lacater.generator.bodies import Body
from aapa.lacater.generator.simulation import Simulation, filmed_boxes
from aapa.lacater.generator.viewpoint import DEFAULT_PLACE, Viewpoint
from aapa.lacater.generator.visibility import visible_shares
from aapa.lacater.label_rules import contained_frames, frame_masks

VIEWPOINT = Viewpoint.at(*DEFAULT_PLACE)


def filmed(*things: tuple[str, float, np.ndarray]) -> Simulation:
    """A video of balls and cubes: shape, radius, and places (f, 3)."""
    bodies = tuple(
        Body(shape, "medium", "red", "rubber", radius, f"{shape}_{n}", 0.0)
        for n, (shape, radius, _) in enumerate(things)
    )
    places = np.stack([path for _, _, path in things])
    tilts = np.zeros(places.shape[:2])
    boxes = filmed_boxes(bodies, places, tilts, VIEWPOINT)
    return Simulation(0, bodies, VIEWPOINT, places, places, tilts, ((),) * len(bodies), boxes)


def along_the_axis(depth: float, frames: int, right: float = 0.0) -> np.ndarray:
    place = VIEWPOINT.place + depth * VIEWPOINT.axes[2] + right * VIEWPOINT.axes[0]
    return np.repeat(place[None], frames, axis=0)


def uncontained(simulation: Simulation) -> np.ndarray:
    return np.zeros(simulation.tilts.shape, dtype=np.bool_)


def test_what_nothing_overlaps_is_seen_whole():
    video = filmed(
        ("sphere", 0.5, along_the_axis(8, 4)), ("sphere", 0.5, along_the_axis(8, 4, right=2))
    )
    assert (visible_shares(video, uncontained(video)) == 1).all()


def test_what_is_wholly_behind_is_not_seen_and_the_other_is():
    video = filmed(("sphere", 0.3, along_the_axis(9, 3)), ("cube", 0.75, along_the_axis(6, 3)))
    assert visible_shares(video, uncontained(video)).tolist() == [[0, 0, 0], [1, 1, 1]]


def test_half_behind_is_half_seen():
    # The edge of the cube, seen along its side, is at the middle of the ball.
    near = VIEWPOINT.place + 6 * VIEWPOINT.axes[2]
    cover = Body("sphere", "medium", "red", "rubber", 0.5, "sphere_1", 0.0)
    reach = math.tan(math.asin(0.5 * 0.9995 / 6)) * 6
    path = np.repeat((near + reach * VIEWPOINT.axes[0])[None], 2, axis=0)
    video = filmed(("sphere", 0.3, along_the_axis(9, 2)), (cover.shape, cover.radius, path))
    share = visible_shares(video, uncontained(video))[0, 0]
    # The border of the covering ball is curved, so that a little more than half is seen.
    assert 0.5 < share < 0.65


def test_a_body_that_passes_hides_for_as_long_as_it_is_there():
    frames = 41
    passing = np.stack([along_the_axis(6, 1, right)[0] for right in np.linspace(-2.0, 2.0, frames)])
    video = filmed(("sphere", 0.3, along_the_axis(9, frames)), ("cube", 0.5, passing))
    shares = visible_shares(video, uncontained(video))[0]
    assert (shares[0], shares[frames // 2], shares[-1]) == (1, 0, 1)
    hidden = np.flatnonzero(shares < 1)
    assert (np.diff(hidden) == 1).all()
    falling, rising = shares[: frames // 2], shares[frames // 2 :]
    assert (np.diff(falling) <= 0).all()
    assert (np.diff(rising) >= 0).all()


def test_what_a_cone_contains_is_not_seen_and_hides_nothing():
    video = filmed(("sphere", 0.3, along_the_axis(9, 2)), ("cube", 0.75, along_the_axis(6, 2)))
    contained = uncontained(video)
    contained[1] = True
    assert visible_shares(video, contained).tolist() == [[1, 1], [0, 0]]


def test_shares_are_those_of_every_frame_computed_by_itself(simulations):
    """What rests is not looked at again; that must not change anything."""
    video = simulations[0]
    contained = contained_frames(video.scene(), 300)
    shares = visible_shares(video, contained)
    for frame in range(0, 300, 23):
        one = slice(frame, frame + 1)
        still = Simulation(
            video.number,
            video.bodies,
            video.viewpoint,
            video.planned,
            video.filmed[:, one],
            video.tilts[:, one],
            video.movements,
            video.boxes[:, one],
        )
        assert visible_shares(still, contained[:, one])[:, 0] == pytest.approx(shares[:, frame])


def test_frames_labelled_occluded_are_mostly_hidden_and_visible_ones_mostly_seen(simulations):
    occluded, visible = [], []
    for video in simulations:
        scene = video.scene()
        masks = frame_masks(video.labels(), scene)
        snitch = visible_shares(video, contained_frames(scene, 300))[0]
        occluded.append(snitch[masks.occluded])
        visible.append(snitch[masks.visible])
    assert np.mean(np.concatenate(occluded) < 0.5) > 0.6
    assert np.mean(np.concatenate(visible) > 0.5) > 0.9
