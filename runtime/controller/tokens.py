"""Cutting URScript text into tokens.

Source: Universal Robots, "The URScript Programming Language".
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

Kind: TypeAlias = Literal["name", "keyword", "number", "string", "sign", "newline", "end of text"]

KEYWORDS: Final = frozenset(
    (
        *("and", "break", "continue", "def", "elif", "else", "end", "enter_critical"),
        *("exit_critical", "False", "global", "halt", "if", "join", "kill", "local", "not", "or"),
        *("return", "run", "sec", "thread", "True", "while", "xor"),
    )
)
"""Words that cannot name a variable. `async`, `type` and `time` are ordinary names."""

_TOKEN: Final = re.compile(
    r"""
      (?P<blank>[ \t\r\f]+|\#[^\n]*)
    | (?P<newline>\n)
    | (?P<number>(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)
    | (?P<name>[A-Za-z_][A-Za-z0-9_]*)
    | (?P<string>"[^"\n]*")
    | (?P<sign>==|!=|<=|>=|[-+*/%^<>=()\[\],:])
    """,
    re.VERBOSE,
)


class ScriptError(Exception):
    """A program cannot be translated or cannot go on; the text is for whoever wrote it."""


@dataclass(frozen=True, slots=True)
class Token:
    """One token: its kind, its text as written, and its line, counted from 1."""

    kind: Kind
    text: str
    line: int


def tokenise(text: str) -> list[Token]:
    """Cut a program into tokens, comments and blanks dropped, newlines outside brackets kept.

    Raises:
        ScriptError: A character belongs to no token; the text names the line.
    """
    tokens: list[Token] = []
    line, at, brackets = 1, 0, 0
    while at < len(text):
        matched = _TOKEN.match(text, at)
        if matched is None:
            raise ScriptError(f"line {line}: {text[at]!r} is not part of URScript")
        at = matched.end()
        match matched.lastgroup:
            case "blank":
                pass
            case "newline":
                if brackets <= 0:
                    tokens.append(Token("newline", "\n", line))
                line += 1
            case "name":
                kind: Kind = "keyword" if matched[0] in KEYWORDS else "name"
                tokens.append(Token(kind, matched[0], line))
            case "number":
                tokens.append(Token("number", matched[0], line))
            case "string":
                tokens.append(Token("string", matched[0], line))
            case _:
                brackets += (matched[0] in "([") - (matched[0] in ")]")
                tokens.append(Token("sign", matched[0], line))
    tokens.append(Token("end of text", "", line))
    return tokens
