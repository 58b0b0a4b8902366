from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aapa.boxes import centre_of, centred, has_area, moved, overlap, reaches_out

numbers = st.integers(-50, 50).map(float)
boxes = st.builds(
    lambda x, y, w, h: (x, y, x + w, y + h), numbers, numbers, *[st.integers(0, 40).map(float)] * 2
)


@given(boxes, numbers, numbers)
def test_moving_moves_the_centre_and_keeps_the_size(box, dx, dy):
    u, v = centre_of(box)
    there = moved(box, dx, dy)
    assert centre_of(there) == (u + dx, v + dy)
    assert (there[2] - there[0], there[3] - there[1]) == (box[2] - box[0], box[3] - box[1])


@given(boxes)
def test_a_box_is_its_centre_and_its_size(box):
    assert centred(*centre_of(box), box[2] - box[0], box[3] - box[1]) == box


@given(boxes, boxes, st.integers(0, 10).map(float))
def test_overlap_is_symmetric_and_grows_with_the_margin(first, second, margin):
    assert overlap(first, second, margin) == overlap(second, first, margin)
    if overlap(first, second, margin):
        assert overlap(first, second, margin + 1)


@pytest.mark.parametrize(
    ("second", "margin", "expected"),
    [
        ((5, 5, 15, 15), 0.0, True),
        ((10, 0, 20, 10), 0.0, False),
        ((10, 0, 20, 10), 0.5, True),
        ((12, 0, 20, 10), 2.0, False),
        ((0, 12, 10, 20), 2.5, True),
        ((2, 2, 3, 3), 0.0, True),
        ((5, 5, 5, 9), 5.0, False),
    ],
)
def test_overlap(second, margin, expected):
    assert overlap((0, 0, 10, 10), second, margin) is expected


def test_a_box_without_area_covers_nothing():
    assert has_area((0, 0, 1, 1))
    assert not has_area((3, 3, 3, 9))
    assert not has_area((3, 3, 9, 3))


@pytest.mark.parametrize(
    ("box", "expected"),
    [
        ((2, 2, 318, 238), False),
        ((1.9, 50, 60, 60), True),
        ((50, 1.9, 60, 60), True),
        ((50, 50, 318.1, 60), True),
        ((50, 50, 60, 238.1), True),
        ((400, 50, 420, 60), True),
    ],
)
def test_reaching_out_of_the_image(box, expected):
    assert reaches_out(box, (320, 240), 2.0) is expected
