"""Slots and their quirks, each as the published code has it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from aapa.lacater import Perception
from aapa.lacater.classes import CONES, SNITCH
from aapa.neural.features import FEATURES, SLOTS, slot_classes, slot_table, tensor_of

CONE, CUBE, SPHERE = 4, 5, 7  # large brown: cone, cube, sphere (7 is one of them)
BOX, OTHER = (10, 20, 30, 50), (100, 120, 140, 160)
Make = Callable[..., Perception]


def test_the_snitch_comes_first_and_then_the_classes_by_number(perception: Make):
    seen = perception([(150, BOX), (3, BOX)], [(SNITCH, BOX), (20, BOX)])
    assert slot_classes(seen) == (SNITCH, 3, 20, 150)


def test_a_slot_is_the_box_as_shares_of_the_picture_and_two_bits(perception: Make):
    features = tensor_of(perception([(SNITCH, (32, 24, 64, 48)), (CONE, (160, 60, 320, 240))]))
    assert features.shape == (1, SLOTS, FEATURES)
    assert features.dtype == np.float32
    assert features[0, 0].tolist() == np.float32([0.1, 0.1, 0.2, 0.2, 1, 0]).tolist()
    assert features[0, 1].tolist() == [0.5, 0.25, 1, 1, 1, 1]


def test_what_is_missing_is_zeros_but_for_the_bit_of_a_cone(perception: Make):
    seen = perception(
        [(SNITCH, BOX), (CONE, BOX), (CUBE, BOX), (SPHERE, BOX)],
        [(SPHERE, BOX)],
    )
    assert tensor_of(seen)[1, :3].tolist() == [[0] * 6, [0, 0, 0, 0, 0, 1], [0] * 6]


def test_behind_the_last_that_is_seen_a_missing_cone_has_no_bit(perception: Make):
    seen = perception([(SNITCH, BOX), (CONE, BOX)], [(SNITCH, BOX)], [])
    features = tensor_of(seen)
    assert features[0, 1, 5] == 1
    assert not features[1, 1].any()
    assert not features[2].any()


def test_of_two_detections_of_a_class_the_surer_one_counts(perception: Make):
    features = tensor_of(perception([(SNITCH, BOX), (CUBE, OTHER), (CUBE, BOX)]))
    assert (
        features[0, 1, :4].tolist() == np.float32([100 / 320, 0.5, 140 / 320, 160 / 240]).tolist()
    )


def test_of_two_snitches_the_less_sure_one_counts(perception: Make):
    table = slot_table(perception([(SNITCH, BOX), (CUBE, BOX), (SNITCH, OTHER)]))
    assert table[0, 0, :4].tolist() == list(OTHER)


def test_a_snitch_that_is_never_seen_leaves_its_slot_to_another(perception: Make):
    seen = perception([(CUBE, BOX), (CONE, OTHER)])
    assert slot_classes(seen) == (CONE, CUBE)
    assert slot_table(seen)[0, 0].tolist() == [*OTHER, 1, 1]


def test_the_sixteenth_class_has_no_slot_but_keeps_the_cones_before_it(perception: Make):
    # Fifteen classes up to 16, of which 4, 8, 12 and 16 are cones; 60 is the sixteenth.
    everything = [(SNITCH, BOX), *((number, BOX) for number in range(3, 17)), (60, BOX)]
    seen = perception(everything, [(60, OTHER)])
    table = slot_table(seen)
    assert slot_classes(seen)[SLOTS:] == (60,)
    assert (table[1, :, :5] == 0).all()
    assert [slot for slot in range(SLOTS) if table[1, slot, 5]] == [2, 6, 10, 14]


def test_a_video_without_any_detection_is_zeros(perception: Make):
    assert not tensor_of(perception([], [])).any()
    assert tensor_of(perception()).shape == (0, SLOTS, FEATURES)


def naive(seen: Perception) -> np.ndarray:
    """The same, slot by slot and frame by frame."""
    order = slot_classes(seen)
    table = np.zeros((seen.frames, SLOTS, FEATURES), dtype=np.int16)
    for frame in range(seen.frames):
        here: dict[int, list[int]] = {}
        for number, box in zip(
            seen.classes[frame].tolist(), seen.boxes[frame].tolist(), strict=True
        ):
            if number not in here or number == SNITCH:
                here[number] = box
        slots = [order.index(number) for number in here]
        for slot, number in enumerate(order[:SLOTS]):
            if number in here:
                table[frame, slot] = [*here[number], 1, number in CONES]
            elif slots and slot < max(slots):
                table[frame, slot, 5] = number in CONES
    return table


detections = st.lists(
    st.tuples(
        st.sampled_from([SNITCH, *range(3, 22), 150, 192]),
        st.tuples(*[st.integers(0, 240)] * 4),
    ),
    max_size=9,
)


@given(st.lists(detections, max_size=6))
def test_it_is_what_a_plain_reading_of_the_rules_gives(
    frames: list[list[tuple[int, tuple[int, int, int, int]]]],
):
    seen = Perception(
        tuple(np.array([b for _, b in f], dtype=np.int64).reshape(-1, 4) for f in frames),
        tuple(np.array([c for c, _ in f], dtype=np.int64) for f in frames),
    )
    assert (slot_table(seen) == naive(seen)).all()
