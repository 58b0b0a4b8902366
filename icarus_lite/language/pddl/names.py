"""Names that stay apart: each thing gets a name of its own in the other language."""

from __future__ import annotations

from collections.abc import Hashable, Iterable
from itertools import groupby

_LEGAL = frozenset("abcdefghijklmnopqrstuvwxyz0123456789_-")


class Names:
    """Hands out names that no other thing has.

    Args:
        reserved: Names that mean something already.
    """

    __slots__ = ("_given", "_taken")

    def __init__(self, reserved: Iterable[str] = ()) -> None:
        self._taken = set(reserved)
        self._given: dict[Hashable, str] = {}

    def of(self, thing: Hashable, wish: str) -> str:
        """Give a thing its name: the one it has, or the one wished for, or that with a number."""
        if thing not in self._given:
            name, number = wish, 2
            while name in self._taken:
                name, number = f"{wish}-{number}", number + 1
            self._taken.add(name)
            self._given[thing] = name
        return self._given[thing]

    def known(self, thing: Hashable) -> str | None:
        """Give the name that a thing has, or None."""
        return self._given.get(thing)


def pddl_word(text: str, prefix: str = "n") -> str:
    """Make a legal PDDL name of any text: lower case, letters, digits, - and _, a letter first.

    Example:
        >>> pddl_word("Hub.Cover 2"), pddl_word("0.31")
        ('hub-cover-2', 'n0-31')
    """
    parts = groupby(text.lower(), _LEGAL.__contains__)
    word = "".join(["".join(part) if legal else "-" for legal, part in parts])
    word = word.strip("-_") or prefix
    return word if word[0].isalpha() else prefix + word
