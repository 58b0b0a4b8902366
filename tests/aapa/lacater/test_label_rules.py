"""Each rule on a case small enough to work by hand."""

from __future__ import annotations

import numpy as np
import pytest

from aapa.errors import DatasetError
from aapa.lacater.label_rules import (
    carried_frames,
    containments,
    frame_masks,
    hidden_by_others,
    perfect_perception,
)

NEAR, FAR = (2.0, -2.0, 0.5), (0.0, 0.0, 0.3)  # from the rules' camera at (7.1, -6.2, 5.6)
SNITCH_KEY = "small_gold_spl_metal_Spl_0"


def where(mask):
    return np.flatnonzero(mask).tolist()


def test_a_cone_contains_from_the_end_of_contain_to_the_start_of_its_pick_place(scene_with):
    record = [("_contain", "Spl_0", 1, 3), ("_slide", None, 4, 5), ("_pick_place", None, 7, 9)]
    scene = scene_with({"Spl_0": FAR, "Cone_0": NEAR}, {"Cone_0": record})
    inside = containments(scene, 10)
    assert where(inside[0, 1]) == [3, 4, 5, 6, 7]
    assert not inside[1].any()


def test_what_is_never_uncovered_is_contained_to_the_last_frame(scene_with):
    scene = scene_with({"Spl_0": FAR, "Cone_0": NEAR}, {"Cone_0": [("_contain", "Spl_0", 0, 6)]})
    assert where(containments(scene, 10)[0, 1]) == [6, 7, 8, 9]


def test_only_the_first_pick_place_after_the_contain_counts(scene_with):
    record = [
        ("_pick_place", None, 0, 1),
        ("_contain", "Spl_0", 2, 3),
        ("_pick_place", None, 5, 6),
        ("_pick_place", None, 8, 9),
    ]
    scene = scene_with({"Spl_0": FAR, "Cone_0": NEAR}, {"Cone_0": record})
    assert where(containments(scene, 10)[0, 1]) == [3, 4, 5]


def test_the_snitch_is_carried_while_the_cone_around_it_slides(scene_with):
    record = [
        ("_slide", None, 0, 1),  # before it was covered
        ("_contain", "Spl_0", 2, 3),
        ("_slide", None, 4, 5),
        ("_pick_place", None, 7, 8),
        ("_slide", None, 8, 9),  # after it was freed
    ]
    scene = scene_with({"Spl_0": FAR, "Cone_0": NEAR}, {"Cone_0": record})
    assert where(carried_frames(scene, "Spl_0", 10)) == [4, 5]


def test_only_the_direct_container_s_own_record_tells_of_carrying(scene_with):
    # The outer cone slides at 6-7 with all it covers; CATER writes that into both records.
    inner = [("_contain", "Spl_0", 0, 1), ("_slide", None, 6, 7)]
    outer = [("_contain", "Cone_0", 2, 3), ("_slide", None, 6, 7), ("_slide", None, 8, 9)]
    scene = scene_with(
        {"Spl_0": FAR, "Cone_0": NEAR, "Cone_1": NEAR}, {"Cone_0": inner, "Cone_1": outer}
    )
    assert where(carried_frames(scene, "Spl_0", 10)) == [6, 7]


def test_a_slide_that_ends_after_the_last_frame_is_not_counted_as_carrying(scene_with):
    # The published rule compares with frame 299, the last of 300, and CATER records to 300.
    record = [("_contain", "Spl_0", 0, 2), ("_slide", None, 5, 10)]
    scene = scene_with({"Spl_0": FAR, "Cone_0": NEAR}, {"Cone_0": record})
    assert where(carried_frames(scene, "Spl_0", 10)) == []


def hidden(scene, labels, ratio):
    return hidden_by_others(labels, scene, ratio, SNITCH_KEY)[0]


def test_what_lies_wholly_inside_a_larger_nearer_box_is_hidden(scene_with, labels_for):
    scene = scene_with({"Spl_0": FAR, "Cone_0": NEAR})
    labels = labels_for(scene, {"Spl_0": (10, 10, 19, 19), "Cone_0": (10, 10, 30, 30)})
    assert hidden(scene, labels, 0.0).all()


def test_a_box_that_sticks_out_by_one_px_is_not_wholly_hidden(scene_with, labels_for):
    # 10 x 10 px with both ends counted, of which 9 x 10 are covered: 90 %.
    scene = scene_with({"Spl_0": FAR, "Cone_0": NEAR})
    labels = labels_for(scene, {"Spl_0": (9, 10, 18, 19), "Cone_0": (10, 10, 30, 30)})
    assert not hidden(scene, labels, 0.0).any()
    assert not hidden(scene, labels, 0.09).any()
    assert hidden(scene, labels, 0.1).all()
    assert hidden(scene, labels, 0.3).all()


def test_what_is_farther_from_the_camera_hides_nothing(scene_with, labels_for):
    scene = scene_with({"Spl_0": NEAR, "Cone_0": FAR})
    labels = labels_for(scene, {"Spl_0": (10, 10, 19, 19), "Cone_0": (10, 10, 30, 30)})
    assert not hidden(scene, labels, 0.0).any()


def test_a_box_of_the_same_size_hides_nothing(scene_with, labels_for):
    scene = scene_with({"Spl_0": FAR, "Cone_0": NEAR})
    labels = labels_for(scene, {"Spl_0": (10, 10, 19, 19), "Cone_0": (10, 10, 19, 19)})
    assert not hidden(scene, labels, 0.0).any()


def test_what_is_contained_itself_hides_nothing(scene_with, labels_for):
    places = {"Spl_0": FAR, "Sphere_0": NEAR, "Cone_0": NEAR}
    scene = scene_with(places, {"Cone_0": [("_contain", "Sphere_0", 0, 4)]})
    boxes = {"Spl_0": (10, 10, 19, 19), "Sphere_0": (8, 8, 30, 30), "Cone_0": (200, 0, 260, 60)}
    labels = labels_for(scene, boxes)
    assert where(hidden(scene, labels, 0.0)) == [0, 1, 2, 3]


def test_the_four_labels_part_the_frames(scene_with, labels_for):
    record = [("_contain", "Spl_0", 3, 4), ("_slide", None, 6, 7), ("_pick_place", None, 8, 9)]
    scene = scene_with({"Spl_0": FAR, "Cone_0": NEAR}, {"Cone_0": record})
    snitch = [(10, 10, 19, 19)] * 10
    cone = [(100, 100, 150, 160)] * 2 + [(5, 5, 40, 40)] * 7 + [(100, 100, 150, 160)]
    masks = frame_masks(scene=scene, labels=labels_for(scene, {"Spl_0": snitch, "Cone_0": cone}))
    assert where(masks.visible) == [0, 1, 9]
    assert where(masks.occluded) == [2, 3]
    assert where(masks.contained) == [4, 5, 8]
    assert where(masks.carried) == [6, 7]
    assert where(masks.containment) == [4, 5, 6, 7, 8]


def test_stricter_ratios_see_less(scene_with, labels_for):
    scene = scene_with({"Spl_0": FAR, "Cone_0": NEAR})
    # Two of ten columns are covered in frame 0, eight in frame 1, all ten in frame 2.
    cone = [(18, 0, 60, 40), (12, 0, 60, 40), (10, 0, 60, 40)]
    snitch = [(10, 10, 19, 19)] * 3
    masks = frame_masks(labels_for(scene, {"Spl_0": snitch, "Cone_0": cone}), scene)
    assert masks.visible_0.tolist() == [True, True, False]
    assert masks.visible_30.tolist() == [True, False, False]
    assert masks.visible_99.tolist() == [False, False, False]


def test_perfect_perception_leaves_out_what_is_contained_or_mostly_hidden(scene_with, labels_for):
    places = {"Spl_0": FAR, "Sphere_0": FAR, "Cone_0": NEAR}
    scene = scene_with(places, {"Cone_0": [("_contain", "Spl_0", 0, 2)]}, frames=4)
    boxes = {
        "Spl_0": (10, 10, 19, 19),
        "Sphere_0": [(100, 100, 109, 109)] * 3 + [(10, 10, 19, 19)],
        "Cone_0": (5, 5, 40, 40),
    }
    seen = perfect_perception(labels_for(scene, boxes, 4), scene)
    # The snitch is behind the cone before it is in it.
    assert [classes.tolist() for classes in seen.classes] == [[156, 48], [156, 48], [156, 48], [48]]
    assert seen.boxes[0].tolist() == [[100, 100, 109, 109], [5, 5, 40, 40]]


def test_the_twin_of_what_is_contained_vanishes_with_it(scene_with, labels_for):
    places = {"Spl_0": FAR, "Sphere_0": FAR, "Sphere_1": FAR, "Cone_0": NEAR}
    scene = scene_with(places, {"Cone_0": [("_contain", "Sphere_0", 0, 1)]}, frames=3)
    boxes = {
        "Spl_0": (10, 10, 19, 19),
        "Sphere_0": (205, 105, 214, 114),
        "Sphere_1": (100, 100, 109, 109),
        "Cone_0": (200, 100, 240, 140),
    }
    seen = perfect_perception(labels_for(scene, boxes, 3), scene)
    assert [classes.tolist() for classes in seen.classes] == [[140, 156, 48], [140, 48], [140, 48]]


def test_scene_and_labels_have_to_name_the_same_objects(scene_with, labels_for):
    scene = scene_with({"Spl_0": FAR, "Cone_0": NEAR})
    other = scene_with({"Spl_0": FAR, "Sphere_0": NEAR})
    labels = labels_for(scene, {"Spl_0": (1, 1, 2, 2), "Cone_0": (1, 1, 2, 2)})
    with pytest.raises(DatasetError, match=r"do not name the same objects.*Cone_0"):
        frame_masks(labels, other)


def test_a_scene_shorter_than_its_labels_is_refused(scene_with, labels_for):
    scene = scene_with({"Spl_0": FAR, "Cone_0": NEAR}, frames=5)
    labels = labels_for(scene, {"Spl_0": (1, 1, 2, 2), "Cone_0": (1, 1, 2, 2)}, 10)
    with pytest.raises(DatasetError, match="Spl_0 has 6 locations for 10 frames"):
        frame_masks(labels, scene)


def test_a_video_without_the_snitch_has_no_labels(scene_with, labels_for):
    scene = scene_with({"Cone_0": NEAR})
    with pytest.raises(DatasetError, match="no snitch"):
        frame_masks(labels_for(scene, {"Cone_0": (1, 1, 2, 2)}), scene)
