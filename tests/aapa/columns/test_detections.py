from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from aapa import AnchoringError, Detection, DetectionColumns
from aapa.columns.detections import columns_of

PLAIN = [Detection("cone", (1.0, 2.0, 3.0, 4.0), 0.5), Detection("ball", (0.0, 0.0, 9.0, 9.0))]


def test_one_type_may_stand_for_all_and_scores_may_be_left_out():
    columns = DetectionColumns("cone", np.array([[1, 2, 3, 4], [5, 6, 7, 8]], dtype=np.float32))
    assert columns.objects() == [
        Detection("cone", (1.0, 2.0, 3.0, 4.0)),
        Detection("cone", (5.0, 6.0, 7.0, 8.0)),
    ]
    assert columns.are_sound


def test_no_detections_are_no_columns_but_no_mistake():
    empty = DetectionColumns([], [])
    assert (len(empty), empty.objects(), empty.are_sound) == (0, [], True)


def test_what_the_caller_does_with_the_array_later_does_not_count():
    boxes = np.array([[1.0, 2.0, 3.0, 4.0]])
    columns = DetectionColumns("cone", boxes)
    boxes[:] = 0
    assert columns.boxes.tolist() == [[1.0, 2.0, 3.0, 4.0]]
    with pytest.raises(ValueError, match="read-only"):
        columns.boxes[:] = 0


@pytest.mark.parametrize(
    ("given", "text"),
    [
        (("cone", [[1, 2, 3]]), r"shape \(1, 3\); expected \(n, 4\)"),
        (("cone", [1, 2, 3, 4]), r"shape \(4,\)"),
        (("cone", [[1, 2, 3, 4], [1, 2]]), "the boxes are not all numbers, in rows of one length"),
        (("cone", [["1", "2", "3", "4"]]), "the boxes are not all numbers"),
        ((["cone"], [[1, 2, 3, 4], [1, 2, 3, 4]]), "2 boxes, 1 types"),
        (("cone", [[1, 2, 3, 4]], [0.5, 0.5]), r"scores of the shape \(2,\)"),
        (("cone", [[1, 2, 3, 4]], [None]), "the scores are not all numbers"),
    ],
)
def test_columns_that_do_not_fit_are_refused(given, text):
    with pytest.raises(AnchoringError, match=text):
        DetectionColumns(*given)


@pytest.mark.parametrize(
    "change",
    [
        {"box": (3.0, 2.0, 1.0, 4.0)},
        {"box": (float("nan"), 2.0, 3.0, 4.0)},
        {"box": (1.0, 2.0, 3.0, 2e9)},
        {"score": 1.5},
        {"score": float("nan")},
        {"type": ""},
    ],
)
def test_a_detection_that_is_wrong_is_noticed(change):
    wrong = replace(PLAIN[0], **change)
    columns = DetectionColumns([wrong.type, "ball"], [wrong.box, PLAIN[1].box], [wrong.score, 1.0])
    assert not columns.are_sound
    assert columns_of([PLAIN[1], wrong]) is None


@pytest.mark.parametrize(
    "other",
    [
        "a text",
        replace(PLAIN[0], position=(1.0, 2.0, 3.0)),
        replace(PLAIN[0], size=(1.0, 2.0)),
        replace(PLAIN[0], name="hand"),
        replace(PLAIN[0], box=[1.0, 2.0, 3.0, 4.0]),
        replace(PLAIN[0], box=(1.0, 2.0, 3.0)),
        replace(PLAIN[0], box=(1, 2, 3, 4)),
        replace(PLAIN[0], box=tuple(np.array([1.0, 2.0, 3.0, 4.0]))),
        replace(PLAIN[0], score=1),
        replace(PLAIN[0], type=None),
    ],
)
def test_what_is_not_plain_has_no_columns(other):
    assert columns_of([*PLAIN, other]) is None


def test_plain_detections_become_columns_and_back():
    columns = columns_of(PLAIN)
    assert columns.objects() == PLAIN
    assert columns.tuples == [detection.box for detection in PLAIN]
