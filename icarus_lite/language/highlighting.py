"""Colours for `.icr` in terminals and documentation: a lexer for Pygments, by the name `icarus`.

It colours by what a word stands for, as the language server does: a skill is told from a concept,
the head of a clause from its use.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from types import MappingProxyType

from pygments.lexer import Lexer
from pygments.token import (
    Comment,
    Error,
    Keyword,
    Literal,
    Name,
    Number,
    Operator,
    Punctuation,
    String,
    Whitespace,
    _TokenType,
)

from icarus_lite.language.editing.occurrences import Occurrence, Role, occurrences

_TOKENS: Mapping[Role, _TokenType] = MappingProxyType(
    {
        Role.FORM: Keyword.Declaration,
        Role.FIELD: Keyword,
        Role.NOT: Operator.Word,
        Role.PREDICATE: Name.Class,
        Role.SKILL: Name.Function,
        Role.COMMAND: Name.Builtin,
        Role.FUNCTION: Name.Builtin.Pseudo,
        Role.ATTRIBUTE: Name.Attribute,
        Role.VARIABLE: Name.Variable,
        Role.SYMBOL: Literal,
        Role.NUMBER: Number,
        Role.STRING: String,
        Role.NAME: Name.Namespace,
        Role.MOMENT: Keyword.Constant,
        Role.AGENT: Name.Namespace,
        Role.COMMENT: Comment,
        Role.PARENTHESIS: Punctuation,
        Role.ILLEGAL: Error,
    }
)


class IcarusLexer(Lexer):
    """Splits the text of an ICARUS domain, sound or not, into coloured pieces."""

    name = "ICARUS"
    aliases = ("icarus", "icr")
    filenames = ("*.icr",)
    mimetypes = ("text/x-icarus",)
    url = "https://en.wikipedia.org/wiki/ICARUS_(cognitive_architecture)"

    def get_tokens_unprocessed(self, text: str) -> Iterator[tuple[int, _TokenType, str]]:
        """Give every piece of the text with its offset and colour, blanks included."""
        end = 0
        for word in occurrences(text):
            if word.start > end:
                yield end, Whitespace, text[end : word.start]
            yield word.start, token_of(word), text[word.start : word.stop]
            end = word.stop
        if end < len(text):
            yield end, Whitespace, text[end:]


def token_of(word: Occurrence) -> _TokenType:
    """Give the colour of a word."""
    if word.role is Role.COMMENT:
        return Comment.Single if word.name.startswith(";") else Comment.Multiline
    return _TOKENS[word.role]
