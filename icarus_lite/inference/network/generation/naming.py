"""Python identifiers for the words of a domain, so that generated source reads like it."""

from __future__ import annotations

import builtins
import keyword
import re
from collections.abc import Iterable

_RESERVED = frozenset(dir(builtins)) | frozenset(keyword.kwlist)

_OWN = frozenset(
    (
        "at",
        "before",
        "bucket",
        "by",
        "change",
        "changes",
        "column",
        "connect",
        "count",
        "cycle",
        "dist",
        "doubted",
        "finite",
        "functions",
        "gained",
        "key",
        "load",
        "lost",
        "most",
        "pairs",
        "parts",
        "record",
        "rest",
        "row",
        "slot",
        "sqrt",
        "stage",
        "stale",
        "tick",
        "too_many",
        "value",
        "work",
    )
)
"""The words that generated source uses itself."""

_DERIVED = re.compile(
    r"(ask|bind|cell|column|delete|fill|gained|grow|index|insert|kernel|load|lost|prove|see|settle"
    r"|show|side|stages|wanted|withdraw)_.*"
    r"|.*_(changes|doubted|gained|is_provable|is_stale|lost|new|reached|work)"
    r"|.*_by_\d.*|.*_\d+_(test|unless|when)_.*"
)
"""The shapes of the identifiers that are made from others."""


def identifier(word: str) -> str:
    """Give a word of a domain as a Python identifier: `in-reach` as `in_reach`, `?xa` as `xa`.

    A word that generated source uses itself, or could make from others, becomes `the_…_word`,
    which it never makes.
    """
    text = re.sub(r"\W|_", " ", word.lstrip("?"), flags=re.ASCII).lower()
    name = "_".join(text.split()) or "it"
    if name[0].isdigit():
        name = f"n{name}"
    return f"the_{name}_word" if name in _OWN or _DERIVED.fullmatch(name) else name


class Names:
    """Identifiers that are all different.

    Args:
        taken: Identifiers that must not be given out.
    """

    __slots__ = ("_taken",)

    def __init__(self, taken: Iterable[str] = ()) -> None:
        self._taken = set(taken)

    def fresh(self, wanted: str) -> str:
        """Give the wanted identifier, with a number behind it if it is taken."""
        name, number = wanted, 1
        while name in self._taken or name in _RESERVED:
            number += 1
            name = f"{wanted}_no{number}"
        self._taken.add(name)
        return name

    def __contains__(self, name: str) -> bool:
        return name in self._taken
