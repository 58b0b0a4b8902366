"""The anchors of a frame as columns, from which each `Anchor` is made when it is read."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import repeat
from operator import attrgetter
from typing import Any, TypeAlias, overload

import numpy as np
from numpy.typing import NDArray

from aapa.anchors import Anchor, AnchorStatus, anchors_of
from aapa.costs import Rows
from aapa.reasons import (
    AT_REST,
    FIRST_TIME,
    OUTSIDE,
    REACHES_OUT,
    SEEN_TOO_LITTLE,
    UNEXPLAINED,
    Why,
    not_seen,
    occluded_by,
)

Objects: TypeAlias = NDArray[Any]
"""(n) of dtype object: names, or None."""

STATUSES = tuple(AnchorStatus)
"""The statuses; columns hold numbers that count along here."""

_STATUS_OF = (
    AnchorStatus.VISIBLE,
    AnchorStatus.VISIBLE,
    AnchorStatus.VISIBLE,
    AnchorStatus.OUT_OF_VIEW,
    AnchorStatus.OUT_OF_VIEW,
    AnchorStatus.OCCLUDED,
    AnchorStatus.MISSING,
    AnchorStatus.MISSING,
)
_fields = attrgetter("name", "type", "box", "confidence", "streak", "last_seen")


@dataclass(frozen=True, slots=True, eq=False)
class Grounds:
    """What the sentences are made of, on why each of some anchors is where it is.

    Args:
        whys: (n) numbers of `Why`.
        squares: (n) squared distance from the last place, px²; of those that have moved.
        occluders: (n) the name of what stands in front, of those that are occluded.
        given_up: Whether the anchors are those that were given up.
    """

    whys: NDArray[np.int8]
    squares: NDArray[np.float64]
    occluders: Objects
    given_up: bool = False

    def only(self, which: NDArray[np.int64]) -> Grounds:
        """Give those of some anchors, by their numbers."""
        return Grounds(self.whys[which], self.squares[which], self.occluders[which], self.given_up)


class AnchorColumns(Sequence[Anchor]):
    """The anchors of a frame, sorted by name: columns of numbers, and a sequence of `Anchor`.

    Reading a column costs nothing. An `Anchor` is made when it is asked for.

    Args:
        names: (n) their symbols.
        types: (n) the detector's classes.
        boxes: (n, 4) last known or carried boxes, px.
        confidences: (n) in [0, 1].
        streaks: (n) for how many frames in a row each has been seen, or, below 0, missed.
        last_seen: (n) the update count at which each was last aligned with a detection.
        grounds: Why each is where it is, or the anchors themselves where there are.
        tuples: (n) the boxes once more, each as an anchor has it, where there are.
    """

    __slots__ = (
        "_grounds",
        "_made",
        "boxes",
        "confidences",
        "known_tuples",
        "last_seen",
        "names",
        "streaks",
        "types",
    )

    def __init__(
        self,
        names: Objects,
        types: Objects,
        boxes: Rows,
        confidences: NDArray[np.float64],
        streaks: NDArray[np.int64],
        last_seen: NDArray[np.int64],
        grounds: Grounds | tuple[Anchor, ...],
        tuples: Objects | None = None,
    ) -> None:
        self.names = names
        self.types = types
        self.boxes = boxes
        self.confidences = confidences
        self.streaks = streaks
        self.last_seen = last_seen
        for column in (names, types, boxes, confidences, streaks, last_seen):
            column.setflags(write=False)
        self.known_tuples = tuples
        self._grounds = grounds if isinstance(grounds, Grounds) else None
        self._made = None if isinstance(grounds, Grounds) else grounds

    @classmethod
    def of(cls, anchors: Sequence[Anchor]) -> AnchorColumns:
        """Give the columns of anchors."""
        made = tuple(anchors)
        columns = list(zip(*map(_fields, made), strict=True)) or [()] * 6
        names, types, boxes, confidences, streaks, last_seen = columns
        return cls(
            objects(names),
            objects(types),
            np.array(boxes, dtype=np.float64).reshape(len(made), 4),
            np.array(confidences, dtype=np.float64),
            np.array(streaks, dtype=np.int64),
            np.array(last_seen, dtype=np.int64),
            made,
            objects(boxes),
        )

    def __len__(self) -> int:
        return len(self.names)

    @overload
    def __getitem__(self, index: int) -> Anchor: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[Anchor, ...]: ...
    def __getitem__(self, index: int | slice) -> Anchor | tuple[Anchor, ...]:
        if self._made is not None:
            return self._made[index]
        if isinstance(index, slice):
            return self._anchors_of(np.arange(len(self))[index])
        (anchor,) = self._anchors_of(np.arange(len(self))[[index]])
        return anchor

    def __iter__(self) -> Iterator[Anchor]:
        return iter(self.anchors)

    def __repr__(self) -> str:
        return f"<AnchorColumns of {len(self)} anchors>"

    @property
    def tuples(self) -> Objects:
        """(n) the boxes as tuples."""
        if self.known_tuples is None:
            self.known_tuples = objects(list(map(tuple, self.boxes.tolist())))
        return self.known_tuples

    @property
    def grounds(self) -> Grounds:
        """What the reasons are made of.

        Raises:
            ValueError: The columns were made of anchors, which have their reasons.
        """
        if self._grounds is None:
            raise ValueError("these columns were made of anchors; their reasons stand there")
        return self._grounds

    @property
    def anchors(self) -> tuple[Anchor, ...]:
        """All of them as objects; made once."""
        if self._made is None:
            self._made = self._anchors_of(np.arange(len(self)))
        return self._made

    @property
    def statuses(self) -> NDArray[np.int8]:
        """(n) numbers of the statuses, as `STATUSES` counts them."""
        if self._grounds is not None:
            return _STATUS_NUMBERS[self._grounds.whys]
        return np.array([STATUSES.index(anchor.status) for anchor in self], dtype=np.int8)

    @property
    def are_visible(self) -> NDArray[np.bool_]:
        """(n) whether each was aligned with a detection of this frame."""
        return self.streaks > 0

    def only(self, which: NDArray[np.int64]) -> AnchorColumns:
        """Give some of them, by their numbers, ascending."""
        grounds: Grounds | tuple[Anchor, ...]
        if self._grounds is None:
            grounds = tuple([self[number] for number in which.tolist()])
        else:
            grounds = self._grounds.only(which)
        return AnchorColumns(
            self.names[which],
            self.types[which],
            self.boxes[which],
            self.confidences[which],
            self.streaks[which],
            self.last_seen[which],
            grounds,
            None if self.known_tuples is None else self.known_tuples[which],
        )

    def _anchors_of(self, which: NDArray[np.int64]) -> tuple[Anchor, ...]:
        part = self if len(which) == len(self) else self.only(which)
        grounds = part.grounds
        confidences, streaks = part.confidences.tolist(), part.streaks.tolist()
        rows = zip(
            part.names.tolist(),
            part.types.tolist(),
            part.tuples.tolist(),
            map(_STATUS_OF.__getitem__, grounds.whys.tolist()),
            repeat(None),
            confidences,
            repeat(None),
            repeat(None),
            part.last_seen.tolist(),
            _sentences(grounds, confidences, streaks),
            streaks,
        )
        return tuple(anchors_of(rows))


_STATUS_NUMBERS = np.array([STATUSES.index(status) for status in _STATUS_OF], dtype=np.int8)
_FIXED = {
    Why.AT_REST: AT_REST,
    Why.FIRST_TIME: FIRST_TIME,
    Why.OUTSIDE: OUTSIDE,
    Why.REACHES_OUT: REACHES_OUT,
}


def objects(values: Sequence[object]) -> Objects:
    """Give (n) an array of objects, of which none is looked into."""
    return np.fromiter(values, dtype=object, count=len(values))


def _sentences(grounds: Grounds, confidences: list[float], streaks: list[int]) -> list[str | float]:
    """Give the reason of each, or how far off it is seen, px."""
    sentences: list[str | float] = np.sqrt(grounds.squares).tolist()
    others = np.flatnonzero(grounds.whys != Why.MOVED)
    for number, why in zip(others.tolist(), grounds.whys[others].tolist(), strict=True):
        if why in _FIXED:
            sentences[number] = _FIXED[why]
        elif why == Why.OCCLUDED:
            sentences[number] = occluded_by(grounds.occluders[number])
        else:
            sentences[number] = not_seen(
                SEEN_TOO_LITTLE if why == Why.SEEN_TOO_LITTLE else UNEXPLAINED,
                streaks[number],
                -1.0 if grounds.given_up else confidences[number],
            )
    return sentences
