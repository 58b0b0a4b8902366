"""The alignment of a frame in which no type occurs twice: the common case needs no solver.

Where every type has one anchor and one detection at most, each assignment problem is a question
of tau alone. Answering it without costs, matrices or copies makes plain anchoring twice as fast.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

from aapa.anchors import Anchor
from aapa.detections import Detection


class Aligned(NamedTuple):
    """Who is who.

    Args:
        pairs: Anchors in their order, each with its detection and the squared distance of their
            centres, px² or m²; to be gone through once.
        lost: The anchors without a detection, in their order.
        appeared: The detections without an anchor, in their order.
    """

    pairs: Iterable[tuple[Anchor, Detection, float]]
    lost: list[Anchor]
    appeared: list[Detection]


def align_singles(
    anchors: Sequence[Anchor], detections: Sequence[Detection], tau: float
) -> Aligned | None:
    """Match by type what is near enough in the image; None if a type occurs twice on a side.

    Args:
        anchors: As they were in the last frame.
        detections: Of this one.
        tau: The largest squared distance of the centres of the boxes, px².
    """
    left = {detection.type: detection for detection in detections}
    if len(left) < len(detections) or len({anchor.type for anchor in anchors}) < len(anchors):
        return None
    pairs: list[tuple[Anchor, Detection, float]] = []
    lost: list[Anchor] = []
    for anchor in anchors:
        detection = left.pop(anchor.type, None)
        if detection is None:
            lost.append(anchor)
            continue
        here, there = anchor.box, detection.box
        if here == there:
            pairs.append((anchor, detection, 0.0))
            continue
        a, b, c, d = here
        x1, y1, x2, y2 = there
        dx, dy = (a + c) / 2 - (x1 + x2) / 2, (b + d) / 2 - (y1 + y2) / 2
        squared = dx * dx + dy * dy
        if squared <= tau:
            pairs.append((anchor, detection, squared))
        else:
            lost.append(anchor)
            left[anchor.type] = detection
    if len(left) < 2:
        return Aligned(pairs, lost, list(left.values()))
    # What was put back stands behind now; the detector's order counts.
    return Aligned(pairs, lost, [each for each in detections if each.type in left])
