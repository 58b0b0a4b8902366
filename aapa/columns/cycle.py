"""One frame of a crowd: alignment, then the reasoning about what is lost, over columns.

The order of things is that of `aapa.anchoring`, and so is every result, to the last bit.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from aapa.anchors import Anchor
from aapa.columns.anchors import AnchorColumns, Grounds, Objects, objects
from aapa.columns.detections import DetectionColumns
from aapa.columns.lost import Lost, explained
from aapa.columns.rounding import rounded_each
from aapa.costs import CENTRE
from aapa.crowds import kinds_of, matched, others, side_of_boxes
from aapa.names import NameRegister
from aapa.parameters import AnchoringParameters
from aapa.reasons import Why
from aapa.sightings import Sightings


@dataclass(frozen=True, slots=True, eq=False)
class CrowdState:
    """What is remembered of a crowd from one frame to the next.

    Args:
        anchors: Every maintained anchor.
        dropped: The anchors given up in the last step.
        register: The names given so far.
        frame: How many steps there have been.
    """

    anchors: AnchorColumns
    dropped: AnchorColumns
    register: NameRegister
    frame: int


def suits(parameters: AnchoringParameters, register: NameRegister) -> bool:
    """Tell whether anchors can be kept as columns: in the image, nothing averaged, no bodies."""
    return (
        parameters.space == "image"
        and parameters.comparison is CENTRE
        and parameters.position_gain == 1
        and not parameters.sure_score
        and not parameters.blink
        and (parameters.reunite_after is None or not parameters.unique_types)
        and type(parameters.initial_confidence) is float
        and not register.bodies
    )


def columns_of_anchors(anchors: Sequence[Anchor]) -> AnchorColumns | None:
    """Give anchors as columns; None if one has something that columns do not hold."""
    for anchor in anchors:
        if (
            anchor.position is not None
            or anchor.size is not None
            or type(anchor.confidence) is not float
            or type(anchor.box) is not tuple
            or set(map(type, anchor.box)) != {float}
        ):
            return None
    return AnchorColumns.of(anchors)


@dataclass(frozen=True, slots=True, eq=False)
class Sighted:
    """A frame of which is known who was seen, and not yet why the others were not.

    Args:
        anchors: Everything, those that have appeared included, sorted by name. What is lost is
            as it was, but for its reason.
        register: The names given so far.
        frame: The circumstances.
    """

    anchors: AnchorColumns
    register: NameRegister
    frame: Sightings

    @property
    def seen(self) -> AnchorColumns:
        """The anchors with a detection."""
        return self.anchors.only(np.flatnonzero(self.anchors.last_seen == self.frame.number))

    @property
    def lost(self) -> AnchorColumns:
        """The others."""
        return self.anchors.only(self._lost)

    @property
    def takes_attachments(self) -> bool:
        """Whether something lost takes part in an attachment, for which columns do not do."""
        parents = self.frame.parents
        involved = {*parents, *parents.values()}
        return bool(parents) and not involved.isdisjoint(self.anchors.names[self._lost].tolist())

    def reasoned(self) -> CrowdState:
        """Give the state in which what is lost has been reasoned about as well."""
        anchors, lost = self.anchors, self._lost
        seen = np.flatnonzero(anchors.last_seen == self.frame.number)
        result = explained(
            Lost(
                anchors.names[lost],
                anchors.boxes[lost],
                anchors.confidences[lost],
                anchors.streaks[lost],
            ),
            (anchors.names[seen], anchors.boxes[seen]),
            self.frame.view,
        )
        everything = AnchorColumns(
            anchors.names,
            anchors.types,
            anchors.boxes,
            _with(anchors.confidences, lost, result.confidences),
            _with(anchors.streaks, lost, result.streaks),
            anchors.last_seen,
            Grounds(
                _with(anchors.grounds.whys, lost, result.whys),
                anchors.grounds.squares,
                _with(anchors.grounds.occluders, lost, result.occluders),
            ),
            anchors.known_tuples,
        )
        left = everything.confidences >= 0
        kept = everything if left.all() else everything.only(np.flatnonzero(left))
        gone = _given_up(everything.only(np.flatnonzero(~left)))
        return CrowdState(kept, gone, self.register, self.frame.number)

    @property
    def _lost(self) -> NDArray[np.int64]:
        return np.flatnonzero(self.anchors.last_seen != self.frame.number)


def sighted(
    anchors: AnchorColumns, detections: DetectionColumns, register: NameRegister, frame: Sightings
) -> Sighted | None:
    """Align a crowd; None where no type occurs twice, which needs no columns.

    Args:
        anchors: As they were in the last frame, at least one.
        detections: Of this one, checked, at least one.
        register: The names given so far.
        frame: The circumstances; their parameters suit columns.
    """
    kinds = kinds_of(anchors.types.tolist(), detections.types)
    if kinds is None:
        return None
    rows, columns, squares = matched(
        side_of_boxes(kinds[0], anchors.boxes),
        side_of_boxes(kinds[1], detections.boxes),
        detections,
        frame.parameters.tau,
    )
    appeared = others(len(detections), columns)
    types = [detections.types[number] for number in appeared]
    names, register = _named(types, anchors.names, register, frame.parameters)
    order = _order(anchors.names, names)
    parameters, count = frame.parameters, len(anchors)

    def column(old: NDArray[Any], seen: object, first: object) -> NDArray[Any]:
        """Give old values, those of what was seen replaced, and what has appeared among them."""
        values = np.empty((len(order), *old.shape[1:]), dtype=old.dtype)
        values[:count] = old
        values[rows] = seen
        values[count:] = first
        return values.take(order, axis=0) if len(names) else values

    tuples = None
    if detections.tuples is not None:
        boxes = objects(detections.tuples)
        tuples = column(anchors.tuples, boxes[columns], boxes[appeared])
    streaks = anchors.streaks[rows]
    merged = AnchorColumns(
        column(anchors.names, anchors.names[rows], objects(names)),
        column(anchors.types, anchors.types[rows], objects(types)),
        column(anchors.boxes, detections.boxes[columns], detections.boxes[appeared]),
        column(
            anchors.confidences,
            _grown(anchors.confidences[rows], parameters.confidence_gain),
            parameters.initial_confidence,
        ),
        column(anchors.streaks, np.where(streaks > 0, streaks + 1, 1), 1),
        column(anchors.last_seen, frame.number, frame.number),
        Grounds(
            column(
                np.zeros(count, dtype=np.int8),
                np.where(squares != 0.0, Why.MOVED, Why.AT_REST),
                Why.FIRST_TIME,
            ),
            column(np.zeros(count), squares, 0.0),
            np.full(len(order), None, dtype=object),
        ),
        tuples,
    )
    return Sighted(merged, register, frame)


def _with(old: NDArray[Any], which: NDArray[np.int64], values: NDArray[Any]) -> NDArray[Any]:
    """Give a column with some values replaced."""
    new = old.copy()
    new[which] = values
    return new


def _given_up(anchors: AnchorColumns) -> AnchorColumns:
    """Give anchors as the last that is known of them."""
    return AnchorColumns(
        anchors.names,
        anchors.types,
        anchors.boxes,
        np.zeros(len(anchors)),
        anchors.streaks,
        anchors.last_seen,
        replace(anchors.grounds, given_up=True),
        anchors.known_tuples,
    )


def _grown(confidences: NDArray[np.float64], gain: float) -> NDArray[np.float64]:
    """Give the confidences of what has been seen once more."""
    unsure = np.flatnonzero(confidences < 1.0)
    confidences[unsure] = np.minimum(1.0, rounded_each(confidences[unsure] + gain))
    return confidences


def _named(
    types: Sequence[str], old: Objects, register: NameRegister, parameters: AnchoringParameters
) -> tuple[list[str], NameRegister]:
    """Give the names of what has appeared, and the register with them."""
    unique = parameters.unique_types
    # Whether a name is taken now is asked of unique types alone.
    anchored = set(old.tolist()) if unique and types else set()
    names: list[str] = []
    for type_ in types:
        name, register = register.with_new(type_, unique=type_ in unique, anchored=anchored)
        anchored.add(name)
        names.append(name)
    return names, register


def _order(old: Objects, new: Sequence[str]) -> NDArray[np.int64]:
    """Give the order by name of old names, sorted, and new ones behind them."""
    sorted_ = sorted(range(len(new)), key=new.__getitem__)
    known = old.tolist()
    places = [bisect_left(known, new[number]) for number in sorted_]
    added = len(known) + np.array(sorted_, dtype=np.int64)
    return np.insert(np.arange(len(known)), np.array(places, dtype=np.int64), added)
