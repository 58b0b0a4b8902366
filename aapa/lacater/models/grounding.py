"""Which anchor is the object that an action names.

An action says "Cone_0" and that this is a large green rubber cone. Where one such cone stands,
that is it. Where two do, the one that ends up over what it was set over is the one that was set
over it: of all anchors that could be meant, child and parent are the closest pair.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence

from aapa.alignment import squared_distance
from aapa.anchors import Anchor, Attachment
from aapa.boxes import centre_of
from aapa.lacater.classes import CLASS_NAMES


class Grounding:
    """Remembers which anchor stands for which named object.

    Args:
        cast: The class number of each object that actions may name.
    """

    def __init__(self, cast: Mapping[str, int]) -> None:
        self._types = {instance: CLASS_NAMES[number] for instance, number in cast.items()}
        self._twins = Counter(self._types.values())
        self._anchor_of: dict[str, str] = {}

    def grounded(
        self, attachments: Iterable[Attachment], anchors: Sequence[Anchor]
    ) -> list[Attachment]:
        """Give the attachments by the names of anchors.

        Args:
            attachments: By the names that actions use.
            anchors: All that are maintained.

        Returns:
            One for each attachment whose child and parent are both anchored. No two objects share
            an anchor, so that what was a hierarchy stays one.
        """
        pairs = list(attachments)
        # What is attached to nothing is free to be another anchor next time: two of a kind may
        # have been taken for each other since, and the next action shows which is which.
        involved = {name for pair in pairs for name in pair}
        alive = {anchor.name for anchor in anchors}
        self._anchor_of = {
            who: name for who, name in self._anchor_of.items() if who in involved and name in alive
        }
        for child, parent in pairs:
            if child not in self._anchor_of or parent not in self._anchor_of:
                self._bind(child, parent, anchors)
        known = self._anchor_of
        return [Attachment(known[c], known[p]) for c, p in pairs if c in known and p in known]

    def _bind(self, child: str, parent: str, anchors: Sequence[Anchor]) -> None:
        ways = [
            (squared_distance(centre_of(inner.box), centre_of(outer.box)), inner.name, outer.name)
            for inner in self._candidates(child, anchors)
            for outer in self._candidates(parent, anchors)
            if inner.name != outer.name
        ]
        if ways:
            _, self._anchor_of[child], self._anchor_of[parent] = min(ways)

    def _candidates(self, who: str, anchors: Sequence[Anchor]) -> list[Anchor]:
        """Give the anchors that could be this object, no more than there are of its class."""
        if who not in self._types:
            return []
        bound = self._anchor_of.get(who)
        taken = {name for other, name in self._anchor_of.items() if other != who}
        possible = [
            anchor
            for anchor in anchors
            if anchor.type == self._types[who]
            and (anchor.name == bound or (bound is None and anchor.name not in taken))
        ]
        return surest(possible)[: self._twins[self._types[who]]]


def surest(anchors: Iterable[Anchor]) -> list[Anchor]:
    """Sort anchors: the highest confidence first, then what was seen last, then the oldest."""
    return sorted(anchors, key=lambda a: (-a.confidence, -a.last_seen, len(a.name), a.name))
