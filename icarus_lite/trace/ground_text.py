"""Beliefs and actions back from their text, `(attached o1 "left hand")`, as traces hold them."""

from __future__ import annotations

import re
from collections.abc import Iterator

from icarus_lite.errors import TraceError
from icarus_lite.symbols import Action, Belief, Value

_WORD = re.compile(r'\s*(?:"((?:[^"\\]|\\.)*)"|([^\s()"]+))', re.DOTALL | re.ASCII)
_ESCAPED = re.compile(r"\\(.)", re.DOTALL)


def parse_belief(text: str) -> Belief:
    """Read a belief without variables, as `str` writes it.

    Raises:
        TraceError: it is not one.

    Example:
        >>> parse_belief('(at o1 0.5)')
        Belief(predicate='at', args=('o1', 0.5), attributes={})
    """
    name, args = _parts(text, "belief")
    return Belief(name, args)


def parse_action(text: str) -> Action:
    """Read an action, as `str` writes it.

    Raises:
        TraceError: it is not one.
    """
    return Action(*_parts(text, "action"))


def _parts(text: str, what: str) -> tuple[str, tuple[Value, ...]]:
    words = list(_values(text[1:-1])) if text[:1] == "(" and text[-1:] == ")" else []
    if not words or not isinstance(words[0], str):
        raise TraceError(f"{text!r} is not the text of a {what}")
    return words[0], tuple(words[1:])


def _values(text: str) -> Iterator[Value]:
    place, text = 0, text.rstrip(" ")
    while place < len(text):
        found = _WORD.match(text, place)
        if found is None:
            raise TraceError(f"{text!r} cannot be read from {text[place:]!r} on")
        quoted, bare = found.groups()
        yield _ESCAPED.sub(r"\1", quoted) if quoted is not None else _value(bare)
        place = found.end()


def _value(word: str) -> Value:
    for kind in (int, float):
        try:
            return kind(word)
        except ValueError:
            continue
    return word
