"""How well the parentheses of a text agree with its indentation.

Authors, and `icarus fmt`, begin each line where it belongs. A parenthesis forgotten, or one too
many, sets everything behind it at odds with that: the lines at odds show where it was.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from icarus_lite.records import dataclass, field

_WORD = re.compile(
    r'[()]|;[^\n]*|#\|[\s\S]*?\|#|"[^"\\]*(?:\\[\s\S][^"\\]*)*"|[^ \t\n\r\f\v()"\';]+|[\'"]'
)
_BLANKS = " \t\r\f\v"


@dataclass(frozen=True, slots=True)
class Token:
    """A parenthesis or word.

    Args:
        text: As written.
        offset: Where it begins.
        line: Its line, counted from 0 at the start of the stretch.
        column: Its column, counted from 1.
        is_first: Whether nothing but blanks stands before it on its line.
    """

    text: str
    offset: int
    line: int
    column: int
    is_first: bool

    @property
    def stop(self) -> int:
        """The offset behind it."""
        return self.offset + len(self.text)


def tokens(text: str) -> tuple[Token, ...]:
    """Cut a text into parentheses and words; comments are left out."""
    found = []
    line = start = seen = 0
    for match in _WORD.finditer(text):
        offset, word = match.start(), match[0]
        line += text.count("\n", seen, offset)
        start = max(start, text.rfind("\n", seen, offset) + 1)
        seen = offset
        if not word.startswith((";", "#|")):
            is_first = not text[start:offset].strip(_BLANKS)
            found.append(Token(word, offset, line, offset - start + 1, is_first))
    return tuple(found)


@dataclass(slots=True)
class Open:
    """A parenthesis that is open at some place, with the columns where its lines may begin."""

    token: Token
    count: int = 0
    anchors: set[int] = field(default_factory=set)
    after_field: bool = False

    def add(self, token: Token) -> None:
        """Take in the next thing that stands directly inside."""
        if self.count < 2 or token.is_first or self.after_field:
            self.anchors.add(token.column)
        self.count += 1
        self.after_field = token.text.startswith(":")

    def admits(self, column: int) -> bool:
        """Tell whether a line inside may begin at a column."""
        own = self.token.column
        return column in self.anchors or column in (own + 1, own + 2)


@dataclass(frozen=True, slots=True)
class Oddity:
    """A line that begins where its parentheses would not have it.

    Args:
        token: The first token of the line.
        before: The position of the token before it, or -1.
        weight: How many parentheses are at odds with it.
        is_deep: Whether it is indented as if more were open; otherwise as if fewer were.
    """

    token: Token
    before: int
    weight: int
    is_deep: bool


def oddities(words: Sequence[Token]) -> Iterator[Oddity]:
    """Find the lines that are at odds with the parentheses before them, in order."""
    stack: list[Open] = []
    for position, token in enumerate(words):
        if token.text == ")":
            if stack:
                stack.pop()
            continue
        if token.is_first and position:
            found = _oddity(token, position - 1, stack)
            if found is not None:
                yield found
        if stack:
            stack[-1].add(token)
        if token.text == "(":
            stack.append(Open(token))


def _oddity(token: Token, before: int, stack: Sequence[Open]) -> Oddity | None:
    right_of_it = sum(1 for each in stack if each.token.column >= token.column)
    if right_of_it:
        return Oddity(token, before, right_of_it, is_deep=False)
    is_welcome = stack[-1].admits(token.column) if stack else token.column == 1
    return None if is_welcome else Oddity(token, before, 1, is_deep=True)
