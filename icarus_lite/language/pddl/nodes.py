"""PDDL text into nested lists of words, each with its place."""

from __future__ import annotations

from icarus_lite.language.checking.report import Report
from icarus_lite.language.reading.lines import MAX_DEPTH
from icarus_lite.language.syntax import Span
from icarus_lite.records import dataclass

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import TypeGuard

_LETTERS = frozenset("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ")
_NAME = _LETTERS | frozenset("0123456789_-")
_NUMBER = _NAME | frozenset(".+")
_SIGNS = frozenset(("=", "*", "/", "#", "<", ">", "<=", ">="))
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
    nesting = _Nesting(report)
    for number, line in enumerate(report.source.text.split("\n"), 1):
        code, _, _ = line.partition(";")
        before, quote, _ = code.partition('"')
        nesting.take(number, before)
        if quote:
            span = Span(number, len(before) + 1, number, len(before) + 2)
            report.error(span, "PDDL001", "this character has no place in PDDL", "remove it")
            return None
    return nesting.groups()


class _Nesting:
    """Lists, as far as they have been read."""

    def __init__(self, report: Report) -> None:
        self._report = report
        self._inside: list[Node] = []
        self._around: list[tuple[int, int, list[Node]]] = []
        self._legal: set[str] = set()

    def take(self, number: int, code: str) -> None:
        """Go on with a line, from which comments have been taken."""
        inside, around, legal, stop = self._inside, self._around, self._legal, 0
        for piece in code.replace("(", " ( ").replace(")", " ) ").split():
            start = code.index(piece, stop)
            stop = start + len(piece)
            if piece == "(":
                around.append((number, start + 1, inside))
                inside = []
                if len(around) == MAX_DEPTH + 1:
                    self._refuse_depth(Span(number, start + 1, number, stop + 1))
            elif piece == ")" and around:
                line, column, outside = around.pop()
                outside.append(Group(tuple(inside), Span(line, column, number, stop + 1)))
                inside = outside
            else:
                span = Span(number, start + 1, number, stop + 1)
                if piece not in legal:
                    self._check(piece, span)
                inside.append(Word(piece.lower(), span))
        self._inside = inside

    def groups(self) -> tuple[Group, ...] | None:
        """Give the lists at the top level, unless something was wrong, or is."""
        report, around = self._report, self._around
        if around:
            (line, column, _), count = around[-1], len(around)
            hint = f'{count} ")" {"is" if count == 1 else "are"} missing at the end of the file'
            place = Span(line, column, line, column + 1)
            report.error(place, "PDDL002", 'this "(" is never closed', hint)
        if report.has_errors:
            return None
        for each in self._inside:
            if isinstance(each, Word):
                at, hint = each.span, "a PDDL file is one (define …)"
                place = Span(at.line, at.column, at.line, at.column + 1)
                report.error(place, "PDDL006", "this word stands outside all parentheses", hint)
                return None
        return tuple([each for each in self._inside if isinstance(each, Group)])

    def _check(self, text: str, span: Span) -> None:
        """Say what is wrong with a word, if something is."""
        if text == ")":
            hint = 'remove it, or look for a ")" too many before it'
            self._report.error(span, "PDDL003", 'this ")" closes nothing', hint)
        elif is_legal(text):
            self._legal.add(text)
        else:
            shown = text if len(text) <= _SHOWN else f"{text[: _SHOWN - 1]}…"
            message = f"`{shown}` is neither a name, a variable, a keyword nor a number of PDDL"
            hint = "names are letters, digits, - and _, and begin with a letter"
            self._report.error(span, "PDDL001", message, hint)

    def _refuse_depth(self, span: Span) -> None:
        message = f"parentheses are nested more than {MAX_DEPTH} deep"
        self._report.error(span, "PDDL004", message, "split the expression")


def is_legal(text: str) -> bool:
    """Tell whether a word is a name, a variable, a keyword, a number or a sign of PDDL."""
    if text[0] in "?:":
        return text[1:2] in _LETTERS and _NAME.issuperset(text[2:])
    return _NUMBER.issuperset(text) or text in _SIGNS
