from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from aapa.lacater.classes import CLASS_NAMES, SNITCH, class_number
from aapa.lacater.generator.bodies import RADII, Body
from aapa.lacater.generator.detector import detect, look_alikes
from aapa.lacater.generator.noise import DetectorNoise
from aapa.lacater.generator.simulation import Simulation
from aapa.lacater.generator.viewpoint import DEFAULT_PLACE, Viewpoint

NONE = DetectorNoise(
    jitter_px=0,
    miss_rate=0,
    swap_rate=0,
    false_snitches=0,
    false_others=0,
    seen_slope=1e-3,
)
BOX = (100.7, 50.2, 122.9, 71.4)


def still(class_names: list[str], frames: int = 300, *, moving: bool = False) -> Simulation:
    """Things that stand still, or creep by a hundredth of a px a frame."""
    bodies = []
    for number, name in enumerate(class_names):
        size, color, shape, material = name.split("_")
        bodies.append(Body(shape, size, color, material, RADII[size], f"x_{number}", 0.0))
    count = len(bodies)
    boxes = np.broadcast_to(np.array(BOX), (count, frames, 4)).copy()
    if moving:
        boxes += 0.01 * np.arange(frames)[None, :, None]
    return Simulation(
        0,
        tuple(bodies),
        Viewpoint.at(*DEFAULT_PLACE),
        np.zeros((count, frames + 1, 3)),
        np.zeros((count, frames, 3)),
        np.zeros((count, frames)),
        ((),) * count,
        boxes,
    )


def seen(simulation: Simulation, noise: DetectorNoise, share: float = 1.0, seed: int = 0):
    shares = np.full(simulation.tilts.shape, share)
    return detect(simulation, shares, noise, np.random.default_rng(seed))


def runs(mask: np.ndarray) -> list[int]:
    """The lengths of the runs of true."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], mask.astype(int), [0]])))
    return (edges[1::2] - edges[::2]).tolist()


def test_without_noise_boxes_are_cut_down_to_whole_px():
    reported = seen(still(["small_red_cube_metal"]), NONE)
    assert reported.frames == 300
    assert {tuple(map(tuple, boxes)) for boxes in reported.boxes} == {((100, 50, 122, 71),)}
    assert {tuple(c) for c in reported.classes} == {(class_number("small_red_cube_metal"),)}


def test_class_0_is_never_reported():
    assert CLASS_NAMES[0] == "large_blue_cone_metal"
    reported = seen(still(["large_blue_cone_metal", "small_red_cube_metal"]), NONE)
    assert 0 not in np.concatenate(reported.classes)
    assert all(len(classes) == 1 for classes in reported.classes)


@pytest.mark.parametrize(("share", "found"), [(0.0, 0.0), (0.2, 0.0), (0.3, 0.5), (0.4, 1.0)])
def test_what_is_hidden_is_found_less(share, found):
    things = still(["small_red_cube_metal"] * 8)
    reported = seen(things, NONE, share)
    assert np.mean([len(c) for c in reported.classes]) / 8 == pytest.approx(found, abs=0.1)


def test_nothing_is_found_of_what_is_not_seen_at_all():
    loose = replace(NONE, half_seen=0.0, seen_slope=1.0)
    assert not np.concatenate(seen(still(["small_red_cube_metal"]), loose, 0.0).classes).size


def test_misses_have_their_rate_and_come_in_bursts():
    noise = replace(NONE, miss_rate=0.05)
    counts = seen(still(["small_red_cube_metal"] * 60), noise)
    missed = 1 - np.mean([len(c) for c in counts.classes]) / 60
    assert missed == pytest.approx(0.05, abs=0.012)
    lengths = [
        length
        for seed in range(40)
        for length in runs(
            np.array(
                [len(c) == 0 for c in seen(still(["small_red_cube_metal"]), noise, 1, seed).classes]
            )
        )
    ]
    apart = [
        length
        for seed in range(40)
        for length in runs(
            np.array(
                [
                    len(c) == 0
                    for c in seen(
                        still(["small_red_cube_metal"]),
                        replace(noise, miss_correlation=0.0),
                        1,
                        seed,
                    ).classes
                ]
            )
        )
    ]
    assert np.mean(apart) < 1.2
    assert np.mean(lengths) > 1.6


def test_jitter_is_as_large_as_it_says_and_larger_for_what_is_hidden():
    noise = replace(NONE, jitter_px=3.0, hidden_jitter=1.0, half_seen=0.0)
    free = np.concatenate(seen(still(["small_red_cube_metal"] * 40, moving=True), noise).boxes)
    hidden = np.concatenate(
        seen(still(["small_red_cube_metal"] * 40, moving=True), noise, 0.5).boxes
    )
    assert free.std(axis=0) == pytest.approx([3.1] * 4, rel=0.08)
    assert hidden.std(axis=0) == pytest.approx([4.6] * 4, rel=0.08)


@pytest.mark.parametrize(("lasting", "moving", "kept"), [(1, 0, 1.0), (0, 0, 0.0), (1, 1, 0.8)])
def test_what_lasts_of_the_jitter_stays_while_nothing_changes(lasting, moving, kept):
    noise = replace(NONE, jitter_px=8.0, lasting=float(lasting), settling=0.8)
    edges = np.stack(
        [
            np.concatenate(
                seen(still(["small_red_cube_metal"], 300, moving=bool(moving)), noise, 1, s).boxes
            )
            for s in range(30)
        ]
    )[..., 0]
    centred = edges - 100.2 - (0.01 * np.arange(300) if moving else 0)
    correlation = np.mean(centred[:, 1:] * centred[:, :-1]) / np.mean(centred**2)
    assert correlation == pytest.approx(kept, abs=0.06)


def test_boxes_stay_in_the_picture():
    noise = replace(NONE, jitter_px=200.0)
    boxes = np.concatenate(seen(still(["small_red_cube_metal"] * 5), noise).boxes)
    assert boxes.min() >= 0
    assert boxes[:, [0, 2]].max() <= 320
    assert boxes[:, [1, 3]].max() <= 240


def test_classes_are_mistaken_for_a_while_and_for_their_like():
    noise = replace(NONE, swap_rate=0.01, swap_frames=4.0)
    name = "small_yellow_sphere_metal"
    reported = [np.concatenate(seen(still([name]), noise, 1, seed).classes) for seed in range(60)]
    own = class_number(name)
    wrong = np.concatenate(reported) != own
    assert wrong.mean() == pytest.approx(0.04, abs=0.012)
    assert set(np.concatenate(reported)) == {own, *look_alikes(name)}
    assert SNITCH in look_alikes(name)
    lengths = [length for one in reported for length in runs(one != own)]
    assert 3 < np.mean(lengths) < 5.5


def test_no_class_is_its_own_look_alike_and_all_have_one():
    for number, name in enumerate(CLASS_NAMES):
        others = look_alikes(name)
        assert others
        assert number not in others


def test_false_boxes_have_their_rate():
    noise = replace(NONE, false_snitches=0.02, false_others=0.01, false_frames=3.0)
    hidden = still(["small_red_cube_metal"])
    reported = [seen(hidden, noise, 0.0, seed) for seed in range(60)]
    snitches = sum(int(np.sum(np.concatenate(one.classes) == SNITCH)) for one in reported)
    everything = sum(len(np.concatenate(one.classes)) for one in reported)
    assert snitches / (60 * 300) == pytest.approx(0.06, rel=0.2)
    assert (everything - snitches) / (60 * 300) == pytest.approx(0.03, rel=0.25)
    assert 0 not in np.concatenate([np.concatenate(one.classes) for one in reported])
    sizes = np.concatenate(
        [b[c == SNITCH] for one in reported for b, c in zip(one.boxes, one.classes, strict=True)]
    )
    assert (sizes[:, 2:] - sizes[:, :2]).min() > 10
    assert (sizes[:, 2:] - sizes[:, :2]).max() < 45
