"""The Lark parser of `grammar.lark`, building parts of the syntax tree while it parses.

This module is imported by the reader only when there is something to parse: Lark takes longer to
import than all the rest of the language.
"""

from __future__ import annotations

import functools
import math
import re
from typing import Any, cast

from lark import Lark, TextSlice, Token, Transformer
from lark.lexer import LexerState, LexerThread, LineCounter

from icarus_lite.language.reading.parts import (
    Clause,
    Command,
    Field,
    FieldValue,
    Form,
    FormItem,
    Group,
    MalformedTermError,
    Problem,
    Word,
)
from icarus_lite.language.reading.tables import build, grammar_text, load
from icarus_lite.language.syntax import (
    Atom,
    Bind,
    Call,
    Condition,
    Constant,
    Expression,
    PerceptType,
    Span,
    Term,
    Variable,
)

_ESCAPE = re.compile(r"\\([\s\S])")
_ESCAPES = {"\\": "\\", '"': '"', "n": "\n", "t": "\t", "r": "\r"}


@functools.cache
def parser() -> Lark:
    """Build the parser; it is stateless between parses and shared.

    Its start symbols are `file`, `conditions` (a goal) and `pattern`; each gives a tuple.
    """
    grammar = grammar_text()
    return load(grammar, _Parts()) or build(grammar, _Parts())


def parse(text: str, start: int, stop: int, place: Span, rule: str) -> object:
    """Parse a stretch of a text.

    Args:
        text: The text.
        start: The offset at which the stretch begins.
        stop: The offset behind its end.
        place: The place of its first character, so that no line before it is counted again.
        rule: The start symbol of the grammar.

    Returns:
        What the rule gives.

    Raises:
        UnexpectedInput: The text does not match the rule.
        MalformedTermError: A number or string in it cannot be represented.
    """
    counter = LineCounter("\n")  # type: ignore[no-untyped-call]
    counter.char_pos = start
    counter.line, counter.column = place.line, place.column
    counter.line_start_pos = start - place.column + 1
    frontend = parser().parser
    state = LexerState(TextSlice(text, start, stop), counter)
    return frontend.parser.parse(LexerThread(frontend.lexer, state), rule)


def token_span(token: Token) -> Span:
    """Give the place of a token."""
    return Span(token.line or 0, token.column or 0, token.end_line or 0, token.end_column or 0)


def _between(first: Token, last: Token) -> Span:
    """Give the stretch from the start of one token to the end of another."""
    return Span(first.line or 0, first.column or 0, last.end_line or 0, last.end_column or 0)


def _number(token: Token) -> Constant:
    span = token_span(token)
    try:
        value = int(token) if not set(".eE") & set(token) else float(token)
        if math.isfinite(value):
            return Constant(value, span)
    except (ValueError, OverflowError):
        pass  # more digits than Python reads, or than a float holds
    raise MalformedTermError(
        span, "the number is too large", "numbers lie between -1.7e308 and 1.7e308"
    )


def _string(token: Token) -> Word:
    """Read a string literal; its escapes are those of `_ESCAPES`."""

    def replacement(escape: re.Match[str]) -> str:
        character = _ESCAPES.get(escape[1])
        if character is None:
            raise MalformedTermError(
                _inside(token, escape.start() + 1, 2),
                f"unknown escape `{escape[0]}` in a string",
                r"the escapes are \" \\ \n \t \r; write \\ for a backslash",
            )
        return character

    return Word(_ESCAPE.sub(replacement, token[1:-1]), token_span(token))


def _inside(token: Token, offset: int, length: int) -> Span:
    """Give the place of a stretch inside a token that may run over several lines."""
    before = token[:offset]
    lines = before.count("\n")
    line = (token.line or 0) + lines
    column = offset - before.rfind("\n") if lines else (token.column or 0) + offset
    return Span(line, column, line, column + length)


def _word(token: Token) -> Word:
    return _string(token) if token.type == "STRING" else Word(str(token), token_span(token))


def _form(children: list[Any]) -> Form:
    """Make a form of `( keyword word … item … )`."""
    keyword = _word(children[1])
    words: list[Word] = []
    items: list[FormItem] = []
    for child in children[2:-1]:
        if isinstance(child, Token):
            words.append(_word(child))
        elif isinstance(child, Word):
            words.append(child)
        else:
            items.append(child)
    return Form(keyword, tuple(words), tuple(items), _between(children[0], children[-1]))


def _atom(children: list[Any]) -> Atom:
    """Make an atom of `( name term … attribute … )`; a leading star is not part of the name."""
    args: list[Term] = []
    attributes: list[tuple[str, Term]] = []
    for child in children[2:-1]:
        if isinstance(child, tuple):
            attributes.append(child)
        else:
            args.append(child)
    name = str(children[1])
    if children[1].type == "STAR":
        name = name[1:]
    return Atom(name, tuple(args), tuple(attributes), _between(children[0], children[-1]))


class _Parts(Transformer[Token, tuple[Form, ...]]):
    """Turns each grammar rule into a part of the tree as soon as it is complete."""

    def file(self, children: list[Any]) -> tuple[Form, ...]:
        return tuple(children)

    domain_form = percepts_form = concepts_form = skills_form = staticmethod(_form)
    attachments_form = contradictions_form = agents_form = task_form = staticmethod(_form)
    goals_form = test_form = staticmethod(_form)
    include_form = long_term_goal_form = break_form = problems_form = staticmethod(_form)
    atom = staticmethod(_atom)

    def percept_type(self, children: list[Any]) -> PerceptType:
        supertype = str(children[3]) if children[2].type == "IS" else None
        markers = children[2 if supertype is None else 4 : -1]
        names = tuple([str(marker)[1:] for marker in markers])
        span = _between(children[0], children[-1])
        return PerceptType(str(children[1]), names, supertype, span)

    def problem(self, children: list[Any]) -> Problem:
        return Problem(tuple(children[1:-1]), _between(children[0], children[-1]))

    def clause(self, children: list[Any]) -> Clause:
        span = _between(children[0], children[-1])
        return Clause(children[1], tuple(children[2:-1]), span)

    def field(self, children: list[Any]) -> Field:
        values = tuple([child for child in children[1:] if not isinstance(child, Token)])
        if values and isinstance(values[0], tuple):
            values = values[0]
        return Field(_word(children[0]), cast("tuple[FieldValue, ...]", values))

    def later_cycle(self, children: list[Any]) -> Group:
        return Group(tuple(children[1:-1]), _between(children[0], children[-1]))

    def goal(self, children: list[Any]) -> tuple[Condition, ...]:
        return tuple([child for child in children if isinstance(child, Condition)])

    conditions = goal

    def pattern(self, children: list[Any]) -> tuple[Atom, ...]:
        return tuple(children)

    def positive(self, children: list[Any]) -> Condition:
        return Condition(children[0], span=children[0].span)

    def negative(self, children: list[Any]) -> Condition:
        return Condition(children[2], negated=True, span=_between(children[0], children[-1]))

    def command(self, children: list[Any]) -> Command:
        return Command(_atom(children), starred=children[1].type == "STAR")

    def attribute(self, children: list[Any]) -> tuple[str, Term]:
        return str(children[0])[1:], children[1]

    def bind(self, children: list[Any]) -> Bind:
        return Bind(children[1], children[2])

    def call(self, children: list[Any]) -> Call:
        expressions = cast("list[Expression]", children[2:-1])
        span = _between(children[0], children[-1])
        return Call(str(children[1]), tuple(expressions), span)

    def name(self, children: list[Any]) -> Word:
        return _word(children[0])

    moment = choice = name

    def variable(self, children: list[Any]) -> Variable:
        return Variable(str(children[0]), token_span(children[0]))

    def symbol(self, children: list[Any]) -> Constant:
        return Constant(str(children[0]), token_span(children[0]))

    def string(self, children: list[Any]) -> Constant:
        word = _string(children[0])
        return Constant(word.text, word.span)

    def number(self, children: list[Any]) -> Constant:
        return _number(children[0])
