"""A text cut into words, comments and parentheses, whatever is wrong with it.

The parser's lexer stops at the first mistake. An editor shows texts that are being written, so
this one never stops: what is no word of the language is `ILLEGAL`, and the next word counts again.
"""

from __future__ import annotations

import re
from enum import StrEnum

from icarus_lite.records import dataclass


class Kind(StrEnum):
    """What a lexeme looks like; what it means depends on where it stands."""

    OPEN = "("
    CLOSE = ")"
    COMMENT = "comment"
    STRING = "string"
    NUMBER = "number"
    VARIABLE = "variable"
    HAT = "hat"
    STAR = "star"
    FIELD = "field"
    SYMBOL = "symbol"
    ILLEGAL = "illegal"


@dataclass(frozen=True, slots=True)
class Lexeme:
    """A word, comment or parenthesis; `stop` is the offset behind its last character."""

    kind: Kind
    text: str
    start: int
    stop: int


_NAME = r"[^ \t\n\r\f\v()\"';?:^*|#]"
_LEXEME = re.compile(
    r"""
      (?P<OPEN>   \( )
    | (?P<CLOSE>  \) )
    | (?P<COMMENT> ;[^\n]* | \#\|[\s\S]*?\|\# | \#\|[\s\S]* )
    | (?P<STRING> "[^"\\]*(?:\\[\s\S][^"\\]*)*" )
    | (?P<ILLEGAL> "[^\n]* | ' )
    | (?P<WORD>   (?:(?!\#\|)[^ \t\n\r\f\v()"';])+ )
    """,
    re.VERBOSE,
)
_NUMBER = re.compile(r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?\Z")
_SYMBOL = re.compile(rf"(?:{_NAME}+|\*)\Z")
_AFTER_MARKER = re.compile(rf"{_NAME}*\Z")
_MARKERS = {"?": Kind.VARIABLE, "^": Kind.HAT, "*": Kind.STAR, ":": Kind.FIELD}


def lexemes(text: str) -> tuple[Lexeme, ...]:
    """Cut a text into lexemes; blanks are left out. A lone marker counts as the word begun by it.

    Example:
        >>> [lexeme.kind.value for lexeme in lexemes("(near ?a ^") ]
        ['(', 'symbol', 'variable', 'hat']
    """
    found = []
    for match in _LEXEME.finditer(text):
        name = match.lastgroup or "ILLEGAL"
        word = match[0]
        kind = word_kind(word) if name == "WORD" else Kind[name]
        found.append(Lexeme(kind, word, match.start(), match.end()))
    return tuple(found)


def word_kind(word: str) -> Kind:
    """Tell what kind of word this is, from its characters alone."""
    if _NUMBER.match(word):
        return Kind.NUMBER
    if _SYMBOL.match(word):
        return Kind.SYMBOL
    kind = _MARKERS.get(word[:1])
    return kind if kind and _AFTER_MARKER.match(word, 1) else Kind.ILLEGAL
