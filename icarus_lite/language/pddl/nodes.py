"""PDDL text into nested lists of words, each with its place."""

from __future__ import annotations

import re
from collections.abc import Sequence

from icarus_lite.language.checking.report import Report
from icarus_lite.language.reading.brackets import MAX_DEPTH
from icarus_lite.language.syntax import Span
from icarus_lite.records import dataclass

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import TypeGuard

_TOKEN = re.compile(r"[()]|[^\s();\"]+|;.*|(?P<alien>\")")
_LEGAL = re.compile(r"[?:]?[A-Za-z][A-Za-z0-9_-]*|[A-Za-z0-9_.+-]+|[<>]=?|[=*/#-]", re.ASCII)


@dataclass(frozen=True, slots=True)
class Word:
    """A name, variable, keyword or number; in lower case, for PDDL does not tell case apart."""

    text: str
    span: Span

    def __str__(self) -> str:
        return self.text


@dataclass(frozen=True, slots=True)
class Group:
    """What stands between two parentheses."""

    items: tuple[Node, ...]
    span: Span

    @property
    def head(self) -> str:
        """Its first word, or "" if it does not begin with one."""
        first = self.items[0] if self.items else None
        return first.text if isinstance(first, Word) else ""


Node = Word | Group


def is_word(node: Node | None) -> TypeGuard[Word]:
    """Tell whether a node is a word."""
    return isinstance(node, Word)


def read_nodes(report: Report) -> tuple[Group, ...] | None:
    """Read the text of a report's source.

    Returns:
        The lists at the top level; or None, with every unbalanced parenthesis and illegal
        character in the report.
    """
    tokens: list[Word] = []
    for number, line in enumerate(report.source.text.split("\n"), 1):
        for found in _TOKEN.finditer(line):
            place = Span(number, found.start() + 1, number, found.end() + 1)
            if found["alien"]:
                report.error(place, "PDDL001", "this character has no place in PDDL", "remove it")
                return None
            if found[0][0] != ";":
                tokens.append(Word(found[0], place))
    if not all([_check_words(tokens, report), _check_brackets(tokens, report)]):
        return None
    return _groups(tokens, report)


def _groups(tokens: Sequence[Word], report: Report) -> tuple[Group, ...] | None:
    """Nest the tokens, whose parentheses are balanced."""
    groups: list[Group] = []
    opened: list[tuple[Span, list[Node]]] = []
    for token in tokens:
        if token.text == "(":
            opened.append((token.span, []))
        elif token.text == ")":
            first, items = opened.pop()
            span = Span(first.line, first.column, token.span.end_line, token.span.end_column)
            inside = opened[-1][1] if opened else groups
            inside.append(Group(tuple(items), span))
        elif opened:
            opened[-1][1].append(Word(token.text.lower(), token.span))
        else:
            place = Span(token.span.line, token.span.column, token.span.line, token.span.column + 1)
            hint = "a PDDL file is one (define …)"
            report.error(place, "PDDL006", "this word stands outside all parentheses", hint)
            return None
    return tuple(groups)


def _check_words(tokens: Sequence[Word], report: Report) -> bool:
    sound = True
    for token in tokens:
        if token.text not in ("(", ")") and not _LEGAL.fullmatch(token.text):
            shown = token.text if len(token.text) <= 30 else f"{token.text[:29]}…"
            message = f"`{shown}` is neither a name, a variable, a keyword nor a number of PDDL"
            hint = "names are letters, digits, - and _, and begin with a letter"
            report.error(token.span, "PDDL001", message, hint)
            sound = False
    return sound


def _check_brackets(tokens: Sequence[Word], report: Report) -> bool:
    opened: list[Word] = []
    sound = True
    for token in tokens:
        if token.text == "(":
            opened.append(token)
            if len(opened) == MAX_DEPTH + 1:
                message = f"parentheses are nested more than {MAX_DEPTH} deep"
                report.error(token.span, "PDDL004", message, "split the expression")
                sound = False
        elif token.text == ")":
            if opened:
                opened.pop()
                continue
            hint = 'remove it, or look for a ")" too many before it'
            report.error(token.span, "PDDL003", 'this ")" closes nothing', hint)
            sound = False
    if opened:
        last, count = opened[-1], len(opened)
        hint = f'{count} ")" {"is" if count == 1 else "are"} missing at the end of the file'
        report.error(last.span, "PDDL002", 'this "(" is never closed', hint)
        sound = False
    return sound
