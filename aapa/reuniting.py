"""One object, two anchors: what is unique cannot be unseen here and seen there.

A unique part that was lost, dropped or taken away turns up too far from its anchor to be aligned
with it, and gets an anchor of its own. A single sighting there may be a wrong class; several in a
row are the part itself. Then its old anchor, attached to something or not, goes to where it is
seen, and whoever believed it to be elsewhere can see that it is not.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from aapa.alignment import squared_distance
from aapa.anchors import Anchor
from aapa.parameters import AnchoringParameters


def reunited(
    seen: Sequence[Anchor], lost: Sequence[Anchor], parameters: AnchoringParameters
) -> tuple[Sequence[Anchor], Sequence[Anchor]]:
    """Give the anchors with a detection and those without, each unique object with one anchor.

    Args:
        seen: The anchors that have a detection, sorted by name.
        lost: Those that have none.
        parameters: Which types are unique, and after how many sightings in a row a second anchor
            of such a type is the first one; None leaves both as they are.
    """
    after = parameters.reunite_after
    if after is None or not parameters.unique_types:
        return seen, lost
    here = {anchor.type for anchor in seen if anchor.name == anchor.type}
    found: dict[str, Anchor] = {}
    for anchor in seen:
        kind = anchor.type
        if kind in parameters.unique_types and kind not in here and anchor.streak >= after:
            longest = found.get(kind)
            if longest is None or anchor.streak > longest.streak:
                found[kind] = anchor
    if not found:
        return seen, lost
    missed = {anchor.name: anchor for anchor in lost if anchor.name in found}
    renamed = {other.name: _taken_over(missed.get(kind), other) for kind, other in found.items()}
    united = sorted((renamed.get(each.name, each) for each in seen), key=lambda each: each.name)
    return united, [anchor for anchor in lost if anchor.name not in found]


def _taken_over(old: Anchor | None, other: Anchor) -> Anchor:
    """Give the old anchor where the other one is; None if it was given up before."""
    if old is None:
        reason = f"It is seen {other.streak} times in a row, and there is only one {other.type}."
        return replace(other, name=other.type, reason=reason)
    far = ""
    if old.position is not None and other.position is not None:
        far = f" {squared_distance(old.position, other.position) ** 0.5:.2f} m"
    reason = (
        f"It is seen{far} away from where it was believed to be, {other.streak} times in a row, "
        f"and there is only one {old.type}."
    )
    return replace(
        other, name=old.name, confidence=max(old.confidence, other.confidence), reason=reason
    )
