"""The reasoning about lost anchors: why was this object not detected, and where is it now?

Each lost anchor gets the first hypothesis that holds:

a. its confidence is below the least for reasoning: it only fades;
b. it is attached to a parent that is still anchored, seen or not: it moves with that parent;
c. it is out of view: it is kept where it is;
d. it is occluded: something seen, or itself explained, stands in front: it is kept too;
e. nothing explains the miss: its confidence falls, and below 0 it is removed.

An action done on an object shows that it exists, so that one named in the attachments never
falls under a. And an object may only hide another if its own presence is explained without that
other: two vanished things do not keep each other alive. But a detector blinks: what it saw up to
`blink` frames ago may hide others, though nothing explains that it is not seen now.

Source: Liang et al. 2021, section III-B 1 (hypothesis reasoning with attachment hierarchy).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from operator import attrgetter
from typing import NamedTuple

from aapa.anchors import Anchor, AnchorStatus, anchor_of
from aapa.boxes import centre_of, moved
from aapa.detections import Box, Position
from aapa.occluders import Occluders
from aapa.reasons import SEEN_TOO_LITTLE, UNEXPLAINED, not_seen, occluded_by
from aapa.view import View


class Move(NamedTuple):
    """How far an anchor went since the last frame: dx, dy in px, and offset in m if known."""

    dx: float = 0.0
    dy: float = 0.0
    offset: Position | None = (0.0, 0.0, 0.0)


_AT_REST = Move()
_by_name = attrgetter("name")


@dataclass(frozen=True, slots=True)
class Explanation:
    """What became of the lost anchors.

    Args:
        kept: Those still maintained, with status, place and reason of this frame.
        dropped: Those given up, with the reason.
    """

    kept: tuple[Anchor, ...]
    dropped: tuple[Anchor, ...]


def move_between(old: Anchor, new: Anchor) -> Move:
    """Give the way from an anchor's last place to its new one."""
    (u, v), (new_u, new_v) = centre_of(old.box), centre_of(new.box)
    offset = None
    if old.position is not None and new.position is not None:
        (x, y, z), (new_x, new_y, new_z) = old.position, new.position
        offset = (new_x - x, new_y - y, new_z - z)
    return Move(new_u - u, new_v - v, offset)


def explain(
    lost: Iterable[Anchor],
    seen: Sequence[Anchor],
    moves: Mapping[str, Move],
    parents: Mapping[str, str],
    view: View,
) -> Explanation:
    """Find the hypothesis for each lost anchor, and what follows from it.

    Args:
        lost: The anchors of the last frame that no detection was aligned with.
        seen: The anchors that have a detection in this frame, sorted by name.
        moves: How far the seen parents went; one left out has not moved.
        parents: The attachment hierarchy, child to parent, without circles.
        view: The image of this frame.
    """
    placed = _in_this_frame(lost, moves, parents, view)
    if not placed:
        return Explanation((), ())
    grounds = _grounds(placed, seen, parents, view)
    # Only a parent is looked up.
    maintained = {anchor.name: anchor for anchor in seen} if parents else {}
    kept: list[Anchor] = []
    dropped: list[Anchor] = []
    for anchor in _parents_first(placed, parents):
        parent = maintained.get(parents.get(anchor.name, ""))
        result = _concluded(anchor, parent, grounds.get(anchor.name), view)
        if result.confidence < 0:
            dropped.append(_changed(result, result.status, result.parent, 0.0, result.reason))
        else:
            kept.append(result)
            maintained[result.name] = result
    return Explanation(tuple(kept), tuple(dropped))


class _Ground(NamedTuple):
    """A hypothesis that keeps an anchor, and the sentence for it."""

    status: AnchorStatus
    reason: str


def _in_this_frame(
    lost: Iterable[Anchor], moves: Mapping[str, Move], parents: Mapping[str, str], view: View
) -> dict[str, Anchor]:
    """Give the lost anchors, by name in order, carried along and seen from where the camera is."""
    by_name = {anchor.name: anchor for anchor in sorted(lost, key=_by_name)}
    if not parents and view.is_flat:
        return by_name
    involved = {*parents, *parents.values()}
    least = view.parameters.min_anchor_confidence
    placed: dict[str, Anchor] = {}
    for name, anchor in by_name.items():
        box, position = anchor.box, anchor.position
        if moves:
            carrier = name
            while carrier in by_name:
                carrier = parents.get(carrier, "")
            box, position = _carried(anchor, moves.get(carrier, _AT_REST))
        box = view.box_of(box, position, anchor.size)
        confidence = anchor.confidence
        if confidence < least and name in involved:
            confidence = least
        if box == anchor.box and position == anchor.position and confidence == anchor.confidence:
            placed[name] = anchor
        else:
            placed[name] = _changed(
                anchor, anchor.status, anchor.parent, confidence, anchor.reason, box, position
            )
    return placed


def _changed(
    anchor: Anchor,
    status: AnchorStatus,
    parent: str | None,
    confidence: float,
    reason: str,
    box: Box | None = None,
    position: Position | None = None,
    streak: int | None = None,
) -> Anchor:
    # Written out, since `dataclasses.replace` would take a fifth of the time of a whole frame.
    return anchor_of(
        anchor.name,
        anchor.type,
        anchor.box if box is None else box,
        status,
        parent,
        confidence,
        anchor.position if box is None else position,
        anchor.size,
        anchor.last_seen,
        reason,
        anchor.streak if streak is None else streak,
    )


def _carried(anchor: Anchor, move: Move) -> tuple[Box, Position | None]:
    box = moved(anchor.box, move.dx, move.dy)
    if anchor.position is None or move.offset is None:
        return box, None
    (x, y, z), (dx, dy, dz) = anchor.position, move.offset
    return box, (x + dx, y + dy, z + dz)


def _grounds(
    placed: Mapping[str, Anchor],
    seen: Sequence[Anchor],
    parents: Mapping[str, str],
    view: View,
) -> dict[str, _Ground]:
    """Find the lost anchors whose presence follows, step by step, from what is seen."""
    least = view.parameters.min_anchor_confidence
    pending = [anchor for anchor in placed.values() if anchor.confidence >= least]
    outside = {anchor.name: view.why_out_of_view(anchor.box, anchor.position) for anchor in pending}
    standing = {anchor.name for anchor in seen} if parents else set()
    grounds: dict[str, _Ground] = {}
    front = Occluders(seen, view)
    blink = view.parameters.blink
    while pending and (front or not grounds):
        attached = {a.name for a in pending if parents.get(a.name) in standing} if parents else ()
        asked = [a for a in pending if outside[a.name] is None and a.name not in attached]
        occluder_of = {
            anchor.name: occluder
            for anchor, occluder in zip(asked, front.first_hiding_each(asked), strict=True)
        }
        found: dict[str, _Ground] = {}
        for anchor in pending:
            reason = outside[anchor.name]
            if anchor.name in attached:
                found[anchor.name] = _Ground(AnchorStatus.ATTACHED, "")
            elif reason is not None:
                found[anchor.name] = _Ground(AnchorStatus.OUT_OF_VIEW, reason)
            elif (occluder := occluder_of[anchor.name]) is not None:
                found[anchor.name] = _Ground(AnchorStatus.OCCLUDED, occluded_by(occluder))
        grounds.update(found)
        # The next round asks only about what this one has added: the rest has been asked.
        added = {name: placed[name] for name in found}
        if not added:
            # Last of all, so that what is explained keeps its explanation; and once.
            added = {a.name: a for a in pending if min(a.streak, 0) > -blink}
            blink = 0
        if not added:
            break
        front = Occluders(list(added.values()), view)
        standing.update(added)
        pending = [anchor for anchor in pending if anchor.name not in added]
    return grounds


def _parents_first(placed: Mapping[str, Anchor], parents: Mapping[str, str]) -> list[Anchor]:
    if not parents:
        return list(placed.values())
    depths: dict[str, int] = {}
    for name in placed:
        depths[name] = 0
        above = parents.get(name, "")
        while above in placed:
            depths[name] += 1
            above = parents.get(above, "")
    return sorted(placed.values(), key=lambda anchor: depths[anchor.name])


def _concluded(anchor: Anchor, parent: Anchor | None, ground: _Ground | None, view: View) -> Anchor:
    """Give the anchor as it is believed to be; a confidence below 0 says that it is given up."""
    streak = min(anchor.streak, 0) - 1
    if anchor.confidence < view.parameters.min_anchor_confidence:
        return _faded(anchor, SEEN_TOO_LITTLE, view, streak)
    if parent is not None:
        return _changed(
            anchor,
            AnchorStatus.ATTACHED,
            parent.name,
            anchor.confidence,
            f"It is attached to {parent.name} ({parent.status}) and moves with it.",
            streak=streak,
        )
    if ground is not None:
        return _changed(
            anchor, ground.status, None, anchor.confidence, ground.reason, streak=streak
        )
    return _faded(anchor, UNEXPLAINED, view, streak)


def _faded(anchor: Anchor, why: str, view: View, streak: int) -> Anchor:
    # Rounded, so that ten losses of 0.1 are 1 and the last cycle does not depend on float dust.
    confidence = round(anchor.confidence - view.parameters.confidence_loss, 9)
    return _changed(
        anchor,
        AnchorStatus.MISSING,
        None,
        confidence,
        not_seen(why, streak, confidence),
        streak=streak,
    )
