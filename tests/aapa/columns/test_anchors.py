from __future__ import annotations

import numpy as np
import pytest

from aapa import Anchor, AnchorColumns, AnchorStatus
from aapa.columns.anchors import STATUSES, Grounds, objects
from aapa.reasons import SEEN_TOO_LITTLE, Why


def columns(*, given_up=False):
    """One anchor of each reason."""
    count = len(Why)
    occluders = np.full(count, None, dtype=object)
    occluders[Why.OCCLUDED] = "cone-9"
    return AnchorColumns(
        objects([f"a-{n}" for n in range(count)]),
        objects(["a"] * count),
        np.arange(4.0 * count).reshape(count, 4),
        np.array([0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0]),
        np.array([3, 2, 1, -1, -2, -3, -1, -4]),
        np.array([7, 7, 7, 6, 5, 4, 6, 3]),
        Grounds(np.array(list(Why), dtype=np.int8), np.full(count, 2.25), occluders, given_up),
    )


def test_each_reason_has_its_sentence_and_status():
    visible, missing = AnchorStatus.VISIBLE, AnchorStatus.MISSING
    assert [(anchor.status, anchor.reason) for anchor in columns()] == [
        (visible, "It is seen at its last place."),
        (visible, "It is seen 1.5 px from its last place."),
        (visible, "It is seen for the first time."),
        (AnchorStatus.OUT_OF_VIEW, "It lies outside the image."),
        (AnchorStatus.OUT_OF_VIEW, "Part of it reaches out of the image."),
        (AnchorStatus.OCCLUDED, "cone-9 stands in front of it."),
        (
            missing,
            f"It is not seen and {SEEN_TOO_LITTLE}; its confidence falls to 0.9.",
        ),
        (
            missing,
            "It is not seen for 4 frames and nothing explains why; its confidence falls to 1.",
        ),
    ]
    assert [STATUSES[number] for number in columns().statuses] == [a.status for a in columns()]


def test_what_was_given_up_says_so():
    assert columns(given_up=True)[-1].reason == (
        "It is not seen for 4 frames and nothing explains why; it is given up."
    )


def test_they_are_a_sequence_of_anchors():
    some = columns()
    expected = Anchor(
        "a-5",
        "a",
        (20.0, 21.0, 22.0, 23.0),
        AnchorStatus.OCCLUDED,
        confidence=0.8,
        last_seen=4,
        reason="cone-9 stands in front of it.",
        streak=-3,
    )
    assert some[5] == some[-3] == expected
    assert some[4:6] == (some[4], some[5])
    assert expected in some
    assert some[5] == list(some)[5]
    assert some[4:6] == some.anchors[4:6]
    assert (len(some), len(some[8:]), some.are_visible.sum()) == (8, 0, 3)
    with pytest.raises(IndexError):
        some[8]


def test_a_part_of_them_is_the_same_whether_made_or_not():
    which = np.array([0, 5, 7])
    made = AnchorColumns.of(columns().anchors)
    assert columns().only(which).anchors == made.only(which).anchors
    assert made.statuses.tolist() == columns().statuses.tolist()
    assert made.boxes.tolist() == columns().boxes.tolist()
    assert AnchorColumns.of([]).anchors == ()
    with pytest.raises(ValueError, match="made of anchors"):
        made.grounds  # noqa: B018 - reading it fails


def test_no_column_can_be_changed():
    with pytest.raises(ValueError, match="read-only"):
        columns().boxes[0] = 0
