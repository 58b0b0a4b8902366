"""What a network is handed of a video: fifteen slots a frame, six numbers a slot.

A slot is a class of objects that the detector reports somewhere in the video: the snitch first,
then by class number. Its six numbers are the box, as shares of the picture, whether it is seen,
and whether it is a cone. Three quirks of the published code are kept, because weights depend on
them:

* What is missing in a frame is zeros but for the cone's bit; behind the last slot that is seen in
  the frame, zeros altogether, a cone or not.
* Of two detections of one class in a frame the surer one counts. Of two snitches it is the less
  sure one, since the published order puts whichever snitch comes later in front.
* Sixteen classes or more: those that come last have no slot. Nor has the snitch slot 0 to itself
  if it is never detected: the first other class has it.

Source: Shamsian et al., Learning Object Permanence from Video, ECCV 2020 (the published code).
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from aapa.lacater.classes import CLASS_NAMES, CONES, SNITCH
from aapa.lacater.video import HEIGHT, WIDTH, Perception

SLOTS: Final = 15
"""How many classes a network has room for."""

FEATURES: Final = 6
"""The numbers of a slot: x1 y1 x2 y2 as shares of the picture, seen, cone."""

SCALE: Final = np.array([WIDTH, HEIGHT, WIDTH, HEIGHT, 1, 1], dtype=np.float32)
"""What the whole numbers of `slot_table` are divided by."""

BOX_SCALE: Final = np.array([WIDTH, HEIGHT, WIDTH, HEIGHT], dtype=np.float32)
"""What a box in px is divided by: a network gives shares of the picture, too."""

_IS_CONE: Final = np.array([number in CONES for number in range(len(CLASS_NAMES))])


def slot_classes(perception: Perception) -> tuple[int, ...]:
    """Give the classes of a video in the order of their slots; there may be more than slots.

    Example:
        >>> seen = np.array([150, 140, 3])
        >>> slot_classes(Perception((np.zeros((3, 4), dtype=np.int64),), (seen,)))
        (140, 3, 150)
    """
    if not perception.frames:
        return ()
    seen = np.unique(np.concatenate(perception.classes)).tolist()
    return tuple(sorted(seen, key=lambda number: (number != SNITCH, number)))


def slot_table(perception: Perception) -> NDArray[np.int16]:
    """Give a video's slots in whole numbers, which take a quarter of the space.

    Returns:
        (frames, 15, 6): the box in px, seen, cone. Divided by `SCALE` they are the features.
    """
    order = slot_classes(perception)
    table = np.zeros((perception.frames, SLOTS, FEATURES), dtype=np.int16)
    if not order:
        return table
    classes = np.concatenate(perception.classes)
    boxes = np.concatenate(perception.boxes)
    frames = np.repeat(np.arange(perception.frames), [len(each) for each in perception.classes])
    slot_of = np.zeros(len(CLASS_NAMES), dtype=np.int64)
    slot_of[list(order)] = np.arange(len(order))
    slots = slot_of[classes]

    last = np.full(perception.frames, -1)
    np.maximum.at(last, frames, slots)
    cones = _IS_CONE[list(order[:SLOTS])]
    table[:, : len(cones), 5] = cones & (np.arange(len(cones)) < last[:, None])

    # Where an index is repeated the last one written stays: of a class the surest detection,
    # which comes first in a frame; of the snitch the last.
    inside = np.flatnonzero(slots < SLOTS)
    snitches = classes[inside] == SNITCH
    for rows in (inside[~snitches][::-1], inside[snitches]):
        table[frames[rows], slots[rows], :4] = boxes[rows]
        table[frames[rows], slots[rows], 4] = 1
        table[frames[rows], slots[rows], 5] = _IS_CONE[classes[rows]]
    return table


def tensor_of(perception: Perception) -> NDArray[np.float32]:
    """Give what a network is handed of a video.

    Args:
        perception: A video's detections, of each frame the surest first.

    Returns:
        (frames, 15, 6): x1 y1 x2 y2 as shares of the picture, seen, cone.
    """
    return scaled(slot_table(perception))


def scaled(table: NDArray[np.int16]) -> NDArray[np.float32]:
    """Give the features of (…, 15, 6) whole numbers."""
    features: NDArray[np.float32] = np.divide(table, SCALE, dtype=np.float32)
    return features


def shares(boxes: NDArray[np.int16]) -> NDArray[np.float32]:
    """Give (…, 4) boxes in px as shares of the picture, as the networks do."""
    scaled_boxes: NDArray[np.float32] = np.divide(boxes, BOX_SCALE, dtype=np.float32)
    return scaled_boxes
