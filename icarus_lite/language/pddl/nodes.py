"""PDDL text into nested lists of words, each with its place."""

from __future__ import annotations

import re

from icarus_lite.language.checking.report import Report
from icarus_lite.language.reading.brackets import MAX_DEPTH
from icarus_lite.language.syntax import Span
from icarus_lite.records import dataclass

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import TypeGuard

_TOKEN = re.compile(
    r"([?:]?[A-Za-z][A-Za-z0-9_-]*|[A-Za-z0-9_.+-]+|[<>]=?|[=*/#-])(?![^\s();\"])"
    r"|(\()|(\))|(;.*)|([^\s();\"]+)|(\")"
)
"""The parts of a line. Which of its groups it is tells what stands there, as numbered below."""
_WORD, _OPENING, _CLOSING, _COMMENT, _ILLEGAL, _ALIEN = range(1, 7)
_SHOWN = 30
"""How many characters of an illegal word are shown."""


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
    groups: list[Node] = []
    inside, around = groups, list[tuple[int, int, list[Node]]]()
    sound = True
    for number, line in enumerate(report.source.text.split("\n"), 1):
        for found in _TOKEN.finditer(line):
            kind, (start, end) = found.lastindex, found.span()
            if kind == _WORD:
                span = Span(number, start + 1, number, end + 1)
                inside.append(Word(found[0].lower(), span))
            elif kind == _OPENING:
                around.append((number, start + 1, inside))
                inside = []
                if len(around) == MAX_DEPTH + 1:
                    _refuse(report, kind, "(", Span(number, start + 1, number, end + 1))
                    sound = False
            elif kind == _CLOSING and around:
                first, column, outside = around.pop()
                outside.append(Group(tuple(inside), Span(first, column, number, end + 1)))
                inside = outside
            elif kind != _COMMENT:
                _refuse(report, kind, found[0], Span(number, start + 1, number, end + 1))
                sound = False
                if kind == _ALIEN:
                    return None
    if around:
        (number, column, _), count = around[-1], len(around)
        hint = f'{count} ")" {"is" if count == 1 else "are"} missing at the end of the file'
        place = Span(number, column, number, column + 1)
        report.error(place, "PDDL002", 'this "(" is never closed', hint)
        return None
    return _only_groups(report, groups) if sound else None


def _only_groups(report: Report, nodes: list[Node]) -> tuple[Group, ...] | None:
    """Refuse words at the top level."""
    for each in nodes:
        if isinstance(each, Word):
            at, hint = each.span, "a PDDL file is one (define …)"
            place = Span(at.line, at.column, at.line, at.column + 1)
            report.error(place, "PDDL006", "this word stands outside all parentheses", hint)
            return None
    return tuple([each for each in nodes if isinstance(each, Group)])


def _refuse(report: Report, kind: int | None, text: str, span: Span) -> None:
    """Say what is wrong with a part of a line."""
    if kind == _OPENING:
        message = f"parentheses are nested more than {MAX_DEPTH} deep"
        report.error(span, "PDDL004", message, "split the expression")
    elif kind == _CLOSING:
        hint = 'remove it, or look for a ")" too many before it'
        report.error(span, "PDDL003", 'this ")" closes nothing', hint)
    elif kind == _ALIEN:
        report.error(span, "PDDL001", "this character has no place in PDDL", "remove it")
    else:
        shown = text if len(text) <= _SHOWN else f"{text[: _SHOWN - 1]}…"
        message = f"`{shown}` is neither a name, a variable, a keyword nor a number of PDDL"
        hint = "names are letters, digits, - and _, and begin with a letter"
        report.error(span, "PDDL001", message, hint)
