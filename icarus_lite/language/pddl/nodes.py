"""PDDL text into nested lists of words, each with its place."""

from __future__ import annotations

import functools
import re
from dataclasses import dataclass
from importlib import resources
from typing import TYPE_CHECKING, Any, TypeAlias, TypeGuard

from icarus_lite.language.checking.report import Report
from icarus_lite.language.reading.brackets import MAX_DEPTH
from icarus_lite.language.syntax import Span

if TYPE_CHECKING:
    from lark import Lark, Token

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


Node: TypeAlias = Word | Group


def is_word(node: Node | None) -> TypeGuard[Word]:
    """Tell whether a node is a word."""
    return isinstance(node, Word)


def read_nodes(report: Report) -> tuple[Group, ...] | None:
    """Read the text of a report's source.

    Returns:
        The lists at the top level; or None, with every unbalanced parenthesis and illegal
        character in the report.
    """
    from lark import UnexpectedInput  # noqa: PLC0415 - Lark takes long to import

    text = report.source.text
    try:
        tokens = list(_parser().lex(text))
    except UnexpectedInput as error:
        place = Span(error.line, error.column, error.line, error.column + 1)
        report.error(place, "PDDL001", "this character has no place in PDDL", "remove it")
        return None
    if not all([_check_words(tokens, report), _check_brackets(tokens, report)]):
        return None
    try:
        parsed = _parser().parse(text)
    except UnexpectedInput as error:  # a word outside all parentheses
        place = Span(error.line, error.column, error.line, error.column + 1)
        hint = "a PDDL file is one (define …)"
        report.error(place, "PDDL006", "this word stands outside all parentheses", hint)
        return None
    return _groups(parsed)


def _groups(parsed: Any) -> tuple[Group, ...]:
    return tuple(parsed)


def _check_words(tokens: list[Token], report: Report) -> bool:
    sound = True
    for token in tokens:
        if token.type == "WORD" and not _LEGAL.fullmatch(token):
            shown = str(token) if len(token) <= 30 else f"{token[:29]}…"
            message = f"`{shown}` is neither a name, a variable, a keyword nor a number of PDDL"
            hint = "names are letters, digits, - and _, and begin with a letter"
            report.error(_span(token, token), "PDDL001", message, hint)
            sound = False
    return sound


def _check_brackets(tokens: list[Token], report: Report) -> bool:
    opened: list[Token] = []
    sound = True
    for token in tokens:
        if token.type == "LPAR":
            opened.append(token)
            if len(opened) == MAX_DEPTH + 1:
                message = f"parentheses are nested more than {MAX_DEPTH} deep"
                report.error(_span(token, token), "PDDL004", message, "split the expression")
                sound = False
        elif token.type == "RPAR":
            if opened:
                opened.pop()
                continue
            hint = 'remove it, or look for a ")" too many before it'
            report.error(_span(token, token), "PDDL003", 'this ")" closes nothing', hint)
            sound = False
    if opened:
        last, count = opened[-1], len(opened)
        hint = f'{count} ")" {"is" if count == 1 else "are"} missing at the end of the file'
        report.error(_span(last, last), "PDDL002", 'this "(" is never closed', hint)
        sound = False
    return sound


def _span(first: Token, last: Token) -> Span:
    return Span(first.line or 0, first.column or 0, last.end_line or 0, last.end_column or 0)


@functools.cache
def _parser() -> Lark:
    from lark import Lark, Transformer  # noqa: PLC0415 - Lark takes long to import

    class _Nodes(Transformer[Any, Any]):
        """Makes a group of each list as soon as it is complete."""

        def file(self, children: list[Any]) -> tuple[Group, ...]:
            return tuple(children)

        def group(self, children: list[Any]) -> Group:
            inner = [
                child if isinstance(child, Group) else Word(str(child).lower(), _span(child, child))
                for child in children[1:-1]
            ]
            return Group(tuple(inner), _span(children[0], children[-1]))

    grammar = resources.files(__package__).joinpath("pddl.lark").read_text(encoding="utf-8")
    return Lark(
        grammar,
        parser="lalr",
        lexer="basic",
        start="file",
        transformer=_Nodes(),
        maybe_placeholders=False,
        propagate_positions=False,
    )
