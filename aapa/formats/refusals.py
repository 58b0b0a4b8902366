"""What becomes of a part of a recording that cannot be read: an error, or a counted skip."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

from aapa.errors import AnchoringError

Refused: TypeAlias = Callable[[AnchoringError], None]
"""Told of each malformed part; returns if the part is to be passed over, raises otherwise."""


def refuse(error: AnchoringError) -> None:
    """Raise, since a wrong part makes a wrong result: what is done if nothing else is asked for."""
    raise error


class Skipped:
    """Passes malformed parts over, and counts them.

    Example:
        >>> skipped = Skipped()
        >>> skipped(AnchoringError("seen.txt:3: key 'bb_width': it is -4"))
        >>> skipped.count
        1
        >>> skipped.report("part")
        "1 malformed part was passed over: seen.txt:3: key 'bb_width': it is -4"
    """

    def __init__(self) -> None:
        self.count = 0
        self._first = ""

    def __call__(self, error: AnchoringError) -> None:
        """Pass over what an error says is malformed."""
        if not self.count:
            self._first = str(error)
        self.count += 1

    def report(self, part: str) -> str:
        """Say in one sentence how many there were, and the first one; "" if there were none.

        Args:
            part: What a part is called, in the singular.
        """
        if not self.count:
            return ""
        if self.count == 1:
            return f"1 malformed {part} was passed over: {self._first}"
        return f"{self.count} malformed {part}s were passed over; the first: {self._first}"
