"""Words for messages: the name that was probably meant, and several names in a row."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import islice

LONGEST_WORD = 60
"""Longer words are cut off where they are quoted, and nobody looks for what they might mean."""

_LONGEST_LIST = 20


def closest(word: str, candidates: Iterable[str]) -> str | None:
    """Give the candidate that the word was probably meant to be, or None."""
    if len(word) > LONGEST_WORD:
        return None
    candidates = list(candidates)
    for each in candidates:
        if each.casefold() == word.casefold():
            return each
    import difflib  # noqa: PLC0415 - most texts have no such mistake

    alike = [each for each in candidates if 3 * len(each) >= len(word) >= len(each) / 3]
    near = difflib.get_close_matches(word, alike, n=1, cutoff=0.6)
    return near[0] if near else None


def listing(words: Iterable[str], last: str = "and") -> str:
    """Write words as `a, b and c`; of more than twenty, the first ones."""
    words = list(islice(words, _LONGEST_LIST + 1))
    if len(words) > _LONGEST_LIST:
        words, last = [*words[: _LONGEST_LIST - 1], "so on"], "and"
    return f" {last} ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)
