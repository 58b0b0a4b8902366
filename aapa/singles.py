"""The alignment of a frame in which no type occurs twice: the common case needs no solver.

Where every type has one anchor and one detection at most, each assignment problem is a question
of tau alone. Answering it without costs, matrices or copies makes plain anchoring twice as fast.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from aapa.anchors import Anchor
from aapa.detections import Detection


class Singles(NamedTuple):
    """Who is who.

    Args:
        pairs: Anchors in their order, each with its detection and the squared distance, px².
        lost: The anchors without a detection, in their order.
        appeared: The detections without an anchor, in their order.
    """

    pairs: list[tuple[Anchor, Detection, float]]
    lost: list[Anchor]
    appeared: list[Detection]


def align_singles(
    anchors: Sequence[Anchor], detections: Sequence[Detection], tau: float
) -> Singles | None:
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
        detection = left.get(anchor.type)
        if detection is None:
            lost.append(anchor)
            continue
        a, b, c, d = anchor.box
        x1, y1, x2, y2 = detection.box
        dx, dy = (a + c) / 2 - (x1 + x2) / 2, (b + d) / 2 - (y1 + y2) / 2
        squared = dx * dx + dy * dy
        if squared <= tau:
            pairs.append((anchor, detection, squared))
            del left[anchor.type]
        else:
            lost.append(anchor)
    return Singles(pairs, lost, list(left.values()))
