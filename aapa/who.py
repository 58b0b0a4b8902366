"""Which detection is which anchor: the way of alignment that fits a frame."""

from __future__ import annotations

from collections.abc import Sequence
from operator import attrgetter

from aapa.alignment import align, squared_distance
from aapa.anchors import Anchor
from aapa.costs import CENTRE
from aapa.crowds import align_crowd, are_many
from aapa.detections import Box, Detection
from aapa.sightings import Sightings
from aapa.singles import Aligned, align_singles

_in_image = attrgetter("type", "box", "score")


def who_is_who(
    anchors: Sequence[Anchor], detections: Sequence[Detection], frame: Sightings
) -> Aligned:
    """Align by the fastest way there is; all of them give the optimum.

    Args:
        anchors: As they were in the last frame.
        detections: Of this one.
        frame: The circumstances.
    """
    parameters = frame.parameters
    if parameters.comparison is CENTRE:
        if parameters.space == "image":
            aligned = align_singles(anchors, detections, parameters.tau)
            if aligned is not None:
                return aligned
        if are_many(anchors, detections):
            return align_crowd(anchors, detections, parameters.tau, parameters.space)
    return _align_each(anchors, detections, frame)


def _align_each(
    anchors: Sequence[Anchor], detections: Sequence[Detection], frame: Sightings
) -> Aligned:
    """Align with any cost, in either space."""
    order = _order(detections)
    old = [frame.place(anchor) for anchor in anchors]
    found = [frame.place(detections[index]) for index in order]
    alignment = align(old, found, frame.parameters.tau, frame.parameters.comparison)
    pairs = [
        (
            anchors[row],
            detections[order[column]],
            squared_distance(old[row].centre, found[column].centre),
        )
        for row, column in alignment.pairs
    ]
    # New objects are numbered as the detector lists them.
    appeared = sorted(order[number] for number in alignment.appeared)
    return Aligned(
        pairs,
        [anchors[row] for row in alignment.lost],
        [detections[column] for column in appeared],
    )


def _order(detections: Sequence[Detection]) -> Sequence[int]:
    """Give an order to align in, in which even ties do not depend on the detector's."""
    if len({detection.type for detection in detections}) == len(detections):
        return range(len(detections))  # no two compete
    plain = all(detection.position is None for detection in detections)
    keys = list(map(_in_image if plain else _canonical, detections))
    return sorted(range(len(detections)), key=keys.__getitem__)


def _canonical(detection: Detection) -> tuple[str, Box, tuple[float, ...], float]:
    return detection.type, detection.box, detection.position or (), detection.score
