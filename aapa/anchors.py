"""Anchors: the symbols that stand for physical objects, seen or hidden."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, fields
from enum import StrEnum
from types import MemberDescriptorType
from typing import NamedTuple, TypeAlias, cast, overload

from aapa.detections import Box, Position
from aapa.reasons import seen_off


class AnchorStatus(StrEnum):
    """Why an anchor is believed to be where it is."""

    VISIBLE = "visible"  # aligned with a detection of this frame
    OCCLUDED = "occluded"  # not seen, something nearer stands in front
    ATTACHED = "attached"  # not seen, moves with an anchored parent
    OUT_OF_VIEW = "out-of-view"  # not seen, the camera does not look there
    MISSING = "missing"  # not seen, and nothing explains why


class Attachment(NamedTuple):
    """`child` is physically bound to move together with `parent`. Plain pairs do as well."""

    child: str
    parent: str


@dataclass(frozen=True, slots=True)
class Anchor:
    """The maintained state of one object.

    Args:
        name: Its symbol, unique; never reused but for the one object of a unique type.
        type: The detector's class.
        box: Last known (or carried) box, px.
        status: Why it is believed to be there.
        parent: The parent it moves with, when `status` is attached.
        confidence: In [0, 1]; grows with sightings, falls with unexplained misses.
        position: Centre in the base frame, m, if detections carry one.
        size: Width and height, m, if detections carry one.
        last_seen: The update count at which it was last aligned with a detection.
        reason: One sentence on why it is believed to be there.
        streak: For how many frames in a row it has been seen, or, below 0, missed.
    """

    name: str
    type: str
    box: Box
    status: AnchorStatus
    parent: str | None = None
    confidence: float = 0.0
    position: Position | None = None
    size: tuple[float, float] | None = None
    last_seen: int = 0
    reason: str = ""
    streak: int = 0


class _Reason:
    """The slot of the reason, in which a distance stands until the sentence is read.

    Most anchors of a frame are seen a little way off, few are asked why they are believed to be
    there, and writing a number out takes as long as making the rest of an anchor.

    Args:
        slot: The slot of the class.
    """

    def __init__(self, slot: MemberDescriptorType) -> None:
        self._slot = slot

    @overload
    def __get__(self, anchor: None, owner: type[Anchor]) -> _Reason: ...
    @overload
    def __get__(self, anchor: Anchor, owner: type[Anchor]) -> str: ...
    def __get__(self, anchor: Anchor | None, owner: type[Anchor]) -> str | _Reason:
        if anchor is None:
            return self
        reason: str | float = self._slot.__get__(anchor, owner)
        if isinstance(reason, float):
            reason = seen_off(reason)
            self._slot.__set__(anchor, reason)
        return reason

    def __set__(self, anchor: Anchor, reason: str) -> None:
        self._slot.__set__(anchor, reason)


Anchor.reason = _Reason(Anchor.reason)  # type: ignore[assignment, arg-type, misc]


@dataclass(slots=True)
class AnchorDraft:
    """The fields of an anchor, in its order and with its layout, before it is frozen.

    `anchor_of` says why; where a call for each would count too, its two lines are written out.
    """

    name: str
    type: str
    box: Box
    status: AnchorStatus
    parent: str | None
    confidence: float
    position: Position | None
    size: tuple[float, float] | None
    last_seen: int
    reason: str
    streak: int


def anchor_of(  # noqa: PLR0913, PLR0917 - the fields of an anchor
    name: str,
    type_: str,
    box: Box,
    status: AnchorStatus,
    parent: str | None,
    confidence: float,
    position: Position | None,
    size: tuple[float, float] | None,
    last_seen: int,
    reason: str,
    streak: int,
) -> Anchor:
    """Give what `Anchor(…)` of the same arguments gives, in a third of the time.

    Every frame makes every anchor anew, and a frozen dataclass sets each field by a call of its
    own, which was a third of a whole frame. A class of the same layout is filled instead, and
    then becomes an anchor.
    """
    draft = AnchorDraft(
        name,
        type_,
        box,
        status,
        parent,
        confidence,
        position,
        size,
        last_seen,
        reason,
        streak,
    )
    draft.__class__ = Anchor  # type: ignore[assignment]
    return draft  # type: ignore[return-value]


AnchorFields: TypeAlias = tuple[
    str,
    str,
    Box,
    AnchorStatus,
    str | None,
    float,
    Position | None,
    tuple[float, float] | None,
    int,
    str | float,
    int,
]
"""The fields of an anchor, in its order; for the reason the distance from the last place, px."""


class AnchorRow:
    """The same draft, filled at one go: of many that are made at once it takes half the time."""

    __slots__ = tuple(field.name for field in fields(Anchor))

    def __init__(self, row: AnchorFields) -> None:
        (
            self.name,
            self.type,
            self.box,
            self.status,
            self.parent,
            self.confidence,
            self.position,
            self.size,
            self.last_seen,
            self.reason,
            self.streak,
        ) = row


def anchors_of(rows: Iterable[AnchorFields]) -> list[Anchor]:
    """Give what `Anchor(*row)` gives for each row, the reasons in words."""
    drafts = list(map(AnchorRow, rows))
    for draft in drafts:
        draft.__class__ = Anchor  # type: ignore[assignment]
    return cast("list[Anchor]", drafts)
