"""What a few moved objects gain and lose, noted pair by pair as the code of a group finds it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

from icarus_lite.inference.network.kernels.group_members import Member
from icarus_lite.inference.network.kernels.relation import Change, Pair

Found: TypeAlias = dict[int, Change]
"""What members of a group gain and lose, by their number."""

Rows: TypeAlias = list[list[list[int] | None]]
"""For each member and slot the partners of an object; None where they are not known."""


class Notes:
    """Takes note of new partners, and keeps the rows of partners up to date.

    Args:
        members: The rules of the group.
        left: The partners of left objects.
        right: The partners of right objects.
    """

    __slots__ = ("_left", "_members", "_right")

    def __init__(self, members: Sequence[Member], left: Rows, right: Rows) -> None:
        self._members, self._left, self._right = members, left, right

    def mirrored(
        self,
        found: Found,
        number: int,
        slot: int,
        moved: Sequence[int],
        now: list[int],
        before: list[int],
    ) -> None:
        """Note the partners of a mover by a rule that goes both ways."""
        rows = self._left[number]
        rows[slot] = now
        for change, others in _turns(found, number, now, before):
            for other in others:
                change.append((slot, other))
                if other not in moved:
                    change.append((other, slot))
                    rows[other] = None

    def on_left(
        self,
        found: Found,
        number: int,
        slot: int,
        _moved: Sequence[int],
        now: list[int],
        before: list[int],
    ) -> None:
        """Note the partners of a mover that stands on the left."""
        self._left[number][slot] = now
        partners = self._right[number]
        for change, others in _turns(found, number, now, before):
            for other in others:
                change.append((slot, other))
                partners[other] = None

    def on_right(
        self,
        found: Found,
        number: int,
        slot: int,
        moved: Sequence[int],
        now: list[int],
        before: list[int],
    ) -> None:
        """Note the partners of a mover that stands on the right."""
        self._right[number][slot] = now
        member = self._members[number]
        known = moved if member.left == member.right else ()
        partners = self._left[number]
        for change, others in _turns(found, number, now, before):
            for other in others:
                if other not in known:
                    change.append((other, slot))
                    partners[other] = None


def _turns(
    found: Found, number: int, now: list[int], before: list[int]
) -> tuple[tuple[list[Pair], list[int]], tuple[list[Pair], list[int]]]:
    """Give what a rule gains so far, with the partners that are new; likewise what it loses."""
    change = found.get(number)
    if change is None:
        change = found[number] = ([], [])
    gained, lost = change
    return (
        (gained, [each for each in now if each not in before]),
        (lost, [each for each in before if each not in now]),
    )
