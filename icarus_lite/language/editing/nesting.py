"""Lexemes put into lists as their parentheses say, closed or not."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import TypeAlias

from icarus_lite.language.editing.lexemes import Kind, Lexeme
from icarus_lite.language.reading.brackets import FORM_NAMES
from icarus_lite.language.reading.lines import MAX_DEPTH
from icarus_lite.records import dataclass, field


@dataclass(slots=True)
class Group:
    """A parenthesis with what stands inside it.

    Args:
        opening: The opening parenthesis.
        items: The words and groups inside, comments left out.
        closing: The closing parenthesis, or None if it is missing.
        stop: The offset behind it, or behind the last thing inside.
    """

    opening: Lexeme
    items: list[Node] = field(default_factory=list)
    closing: Lexeme | None = None
    stop: int = 0

    @property
    def start(self) -> int:
        """The offset of the opening parenthesis."""
        return self.opening.start

    @property
    def first(self) -> Lexeme | None:
        """The first thing inside, if it is a word."""
        return self.items[0] if self.items and isinstance(self.items[0], Lexeme) else None


Node: TypeAlias = Lexeme | Group


def nest(text: str, words: Sequence[Lexeme]) -> tuple[Node, ...]:
    """Put lexemes into groups; what closes nothing, or lies too deep, stays a lexeme.

    Only when a parenthesis is left open at the end does layout count: a form that begins a line
    then also begins anew, so that the forms after it can still be told apart.
    """
    forest, is_open = _nest(words, frozenset())
    return _nest(words, _margins(text, words))[0] if is_open else forest


def open_groups(forest: Sequence[Node]) -> list[Group]:
    """Give the groups that are open at the end, outermost first."""
    chain: list[Group] = []
    items: Sequence[Node] = forest
    while items and isinstance(items[-1], Group) and items[-1].closing is None:
        chain.append(items[-1])
        items = items[-1].items
    return chain


def innermost(forest: Sequence[Node]) -> Group | None:
    """Give the innermost group that is open at the end."""
    chain = open_groups(forest)
    return chain[-1] if chain else None


def _nest(words: Sequence[Lexeme], margins: frozenset[int]) -> tuple[tuple[Node, ...], bool]:
    forest: list[Node] = []
    stack: list[Group] = []
    too_deep = stop = 0
    for word in words:
        if word.start in margins:
            _leave_open(stack, stop)
            too_deep = 0
        if word.kind is Kind.COMMENT:
            continue
        inside = stack[-1].items if stack else forest
        stop = word.stop
        if word.kind is Kind.OPEN:
            if len(stack) > MAX_DEPTH:
                too_deep += 1
            else:
                group = Group(word, stop=word.stop)
                inside.append(group)
                stack.append(group)
        elif word.kind is Kind.CLOSE and too_deep:
            too_deep -= 1
        elif word.kind is Kind.CLOSE and stack:
            group = stack.pop()
            group.closing, group.stop = word, word.stop
        elif word.kind is not Kind.CLOSE:
            inside.append(word)
    return tuple(forest), _leave_open(stack, stop)


def _leave_open(stack: list[Group], stop: int) -> bool:
    """Let the groups that are never closed end here; tell whether there are any."""
    was_open = bool(stack)
    for group in stack:
        group.stop = stop
    stack.clear()
    return was_open


def _margins(text: str, words: Sequence[Lexeme]) -> frozenset[int]:
    """Give the offsets where a form begins at the very start of a line."""
    return frozenset(
        word.start
        for word, after in pairwise(words)
        if word.kind is Kind.OPEN
        and (word.start == 0 or text[word.start - 1] == "\n")
        and after.start == word.stop
        and after.text in FORM_NAMES
    )
