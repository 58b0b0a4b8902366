"""Each number here was worked out by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aapa import AnchoringError
from aapa.lacater.metric import (
    VideoScore,
    centre_distances,
    exact_iou,
    first_sighting,
    iou,
    mean_over_videos,
    score_video,
    table_row,
)


def boxes(*rows):
    return np.array(rows, dtype=np.float64)


def test_sides_are_counted_with_both_ends():
    # 10 x 10 and 10 x 10 share 5 x 10: 50 of 150.
    assert iou(boxes((0, 0, 9, 9)), boxes((5, 0, 14, 9)))[0] == pytest.approx(50 / 150)


def test_boxes_that_only_touch_share_a_column_of_px():
    # x 0…4 and 4…8: one column of five, of 45 px in all.
    assert iou(boxes((0, 0, 4, 4)), boxes((4, 0, 8, 4)))[0] == pytest.approx(5 / 45)


def test_boxes_apart_share_nothing():
    assert iou(boxes((0, 0, 4, 4)), boxes((5, 0, 8, 4)))[0] == 0


def test_boxes_are_cut_to_whole_px_towards_zero():
    assert iou(boxes((0.9, 0.9, 9.9, 9.9)), boxes((0, 0, 9, 9)))[0] == 1
    assert iou(boxes((-0.9, -0.9, 9.9, 9.9)), boxes((0, 0, 9, 9)))[0] == 1


def test_the_exact_overlap_cuts_nothing_and_adds_nothing():
    # 10 x 10 and 10 x 10 share 2.5 x 10: 25 of 175.
    found = exact_iou(boxes((0, 0, 10, 10), (1, 1, 1, 1)), boxes((7.5, 0, 17.5, 10), (1, 1, 1, 1)))
    assert found.tolist() == pytest.approx([25 / 175, 0])


def test_the_distance_of_centres_keeps_fractions():
    assert centre_distances(boxes((0, 0, 3, 4)), boxes((3, 4, 6, 8)))[0] == 5
    assert centre_distances(boxes((0, 0, 1, 0)), boxes((0, 0, 0, 0)))[0] == 0.5


def test_a_video_s_score_is_the_mean_over_its_frames_of_each_label(masks_of):
    true = boxes(*[(0, 0, 9, 9)] * 4)
    predicted = boxes((0, 0, 9, 9), (5, 0, 14, 9), (10, 0, 19, 9), (0, 0, 9, 9))
    score = score_video(predicted, true, masks_of("VVCO"), 0)
    assert score.miou["visible"] == pytest.approx((1 + 1 / 3) / 2)
    assert score.miou["contained"] == 0
    assert score.miou["occluded"] == 1
    assert score.miou["overall"] == pytest.approx((1 + 1 / 3 + 0 + 1) / 4)
    assert score.ml2["visible"] == 2.5
    assert score.ml2["contained"] == 10
    assert score.ml2["overall"] == pytest.approx(15 / 4)
    assert math.isnan(score.miou["carried"])
    assert math.isnan(score.ml2["carried"])


def test_frames_before_the_first_sighting_do_not_count(masks_of):
    true = boxes(*[(0, 0, 9, 9)] * 3)
    predicted = boxes((np.nan,) * 4, (0, 0, 9, 9), (5, 0, 14, 9))
    score = score_video(predicted, true, masks_of("VVV"), 1)
    assert score.miou["overall"] == pytest.approx((1 + 1 / 3) / 2)


@pytest.mark.parametrize("wrong", [(np.nan,) * 4, (np.inf, 0, 1, 1), (5, 0, 4, 9), (0, 9, 9, 8)])
def test_a_frame_without_a_proper_box_is_an_error_not_a_number(masks_of, wrong):
    true = boxes(*[(0, 0, 9, 9)] * 3)
    predicted = boxes((0, 0, 9, 9), (0, 0, 9, 9), wrong)
    with pytest.raises(AnchoringError, match="frame 2 has no proper box"):
        score_video(predicted, true, masks_of("VVV"), 0)


def test_the_first_sighting_is_the_first_frame_with_the_snitch(perception_of):
    box = (0, 0, 9, 9)
    frames = [[], [(48, box)], [(48, box), (140, box)], [(140, box)]]
    assert first_sighting(perception_of(frames)) == 2
    assert first_sighting(perception_of(frames[:2])) is None


def test_a_table_s_number_is_the_mean_over_videos_and_its_standard_error():
    mean = mean_over_videos([1.0, 2.0, 4.0, float("nan")])
    # Deviations -4/3, -1/3, 5/3: variance (16 + 1 + 25) / 9 / 2 = 7/3.
    assert mean.mean == pytest.approx(7 / 3)
    assert mean.sem == pytest.approx(math.sqrt(7 / 3) / math.sqrt(3))
    assert mean.videos == 3


def test_without_videos_there_is_no_mean_and_with_one_no_error():
    assert math.isnan(mean_over_videos([float("nan")]).mean)
    one = mean_over_videos([0.25])
    assert (one.mean, one.videos) == (0.25, 1)
    assert math.isnan(one.sem)


def test_videos_count_alike_however_many_frames_of_a_label_they_have():
    tasks = ("visible", "occluded", "contained", "carried", "overall")
    first = VideoScore(dict.fromkeys(tasks, 1.0), dict.fromkeys(tasks, 0.0))
    second = VideoScore(
        {**dict.fromkeys(tasks, 0.5), "carried": math.nan},
        {**dict.fromkeys(tasks, 2.0), "carried": math.nan},
    )
    miou, ml2 = table_row([first, second])
    assert miou["visible"].mean == 75
    assert miou["carried"].mean == 100
    assert (ml2["overall"].mean, ml2["carried"].mean) == (1, 0)


whole = st.integers(0, 319)
any_box = st.tuples(whole, whole, whole, whole).map(
    lambda b: (min(b[0], b[2]), min(b[1], b[3]), max(b[0], b[2]), max(b[1], b[3]))
)


@given(any_box, any_box)
def test_the_overlap_agrees_with_counting_px(first, second):
    def px(box):
        return {(x, y) for x in range(box[0], box[2] + 1) for y in range(box[1], box[3] + 1)}

    small = [tuple(side // 16 for side in box) for box in (first, second)]
    one, two = px(small[0]), px(small[1])
    assert iou(boxes(small[0]), boxes(small[1]))[0] == pytest.approx(
        len(one & two) / len(one | two)
    )


@given(any_box, any_box)
def test_the_overlap_is_symmetric_within_bounds_and_one_only_for_equal_boxes(first, second):
    value = iou(boxes(first), boxes(second))[0]
    assert value == iou(boxes(second), boxes(first))[0]
    assert 0 <= value <= 1
    assert (value == 1) == (first == second)
