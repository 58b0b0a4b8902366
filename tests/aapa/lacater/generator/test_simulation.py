from __future__ import annotations

import hashlib
import os
import subprocess
import sys

import numpy as np

from aapa.lacater.classes import SNITCH_KEY
from aapa.lacater.generator.simulation import changes, simulate, video_name
from aapa.lacater.label_rules import frame_masks


def test_a_video_is_the_same_whenever_it_is_made():
    alone = simulate(3, 7)
    for number in range(3):
        simulate(3, number)
    again = simulate(3, 7)
    assert np.array_equal(alone.boxes, again.boxes)
    assert alone.movements == again.movements


def test_seeds_and_numbers_give_different_videos():
    videos = [simulate(seed, number) for seed, number in ((1, 2), (2, 1), (1, 21), (12, 1))]
    starts = {tuple(video.planned[0, 0]) for video in videos}
    assert len(starts) == 4


def test_a_video_does_not_depend_on_the_order_of_hashes():
    code = (
        "import hashlib\n"
        "from aapa.lacater.generator import DetectorNoise, generate_video\n"
        "made = generate_video(5, 3, DetectorNoise())\n"
        "digest = hashlib.sha256(made.video.labels.boxes.tobytes())\n"
        "for seen in made.perceptions.values():\n"
        "    for boxes, classes in zip(seen.boxes, seen.classes):\n"
        "        digest.update(boxes.tobytes() + classes.tobytes())\n"
        "print(digest.hexdigest())\n"
    )
    prints = {
        subprocess.run(
            [sys.executable, "-c", code],
            env={**os.environ, "PYTHONHASHSEED": seed},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for seed in ("1", "2")
    }
    assert len(prints) == 1
    assert len(prints.pop().strip()) == hashlib.sha256().digest_size * 2


def test_labels_and_scene_are_of_one_kind(simulations):
    for simulation in simulations:
        labels, scene = simulation.labels(), simulation.scene()
        assert labels.keys[0] == SNITCH_KEY
        assert labels.boxes.shape == (len(simulation.bodies), 300, 4)
        assert [thing.key for thing in scene.objects] == list(labels.keys)
        assert all(thing.locations.shape == (301, 3) for thing in scene.objects)
        masks = frame_masks(labels, scene)
        parts = [masks.visible, masks.occluded, masks.contained, masks.carried]
        assert (np.sum(parts, axis=0) == 1).all()


def test_boxes_lie_in_the_picture_and_rounding_moves_them_less_than_a_pixel(simulations):
    for simulation in simulations:
        boxes = simulation.boxes
        assert boxes.min() >= 0
        assert (boxes[..., 2:] <= (320, 240)).all()
        assert np.abs(simulation.labels().boxes - boxes).max() <= 1.0


def test_snitches_have_the_published_size(simulations):
    sizes = np.concatenate(
        [s.labels().boxes[0, :, 2:] - s.labels().boxes[0, :, :2] for s in simulations]
    )
    assert sizes.min() >= 15
    assert sizes.max() <= 41


def test_the_first_frame_is_where_the_scene_file_says(simulations):
    for simulation in simulations:
        for thing, box in zip(simulation.scene().objects, simulation.boxes[:, 0], strict=True):
            u, v, depth = thing.pixel_coords
            assert (u, v) == (int(u), int(v))
            assert box[0] - 1 < u < box[2] + 1
            assert box[1] - 1 < v < box[3] + 1
            assert 4 < depth < 16


def test_relationships_turn_round(simulations):
    related = simulations[0].scene().relationships
    for one, others in enumerate(related["left"]):
        assert one not in others
        for two in others:
            assert one in related["right"][two]


def test_changes_are_told_from_the_frame_before():
    assert changes(np.array([[1.0], [1.0], [2.0], [2.0]])).tolist() == [False, False, True, False]
    assert changes(np.zeros((3, 2)), np.array([0.0, 1.0, 1.0])).tolist() == [False, True, False]


def test_names_have_six_digits():
    assert video_name(18) == "CLEVR_new_000018"
