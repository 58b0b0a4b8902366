"""Where in a text something stands, and how deep it may be nested."""

from __future__ import annotations

from bisect import bisect_right

from icarus_lite.language.syntax import Span

MAX_DEPTH = 100
"""How deep parentheses may be nested. Real clauses need about ten."""


class Lines:
    """Turns offsets into lines and columns, for one text."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._starts, end = [0], text.find("\n")
        while end >= 0:
            self._starts.append(end + 1)
            end = text.find("\n", end + 1)

    def span(self, start: int, stop: int) -> Span:
        """Give the span from one offset up to another, exclusive."""
        first_line, first_column = self._place(start)
        last_line, last_column = self._place(stop)
        return Span(first_line, first_column, last_line, last_column)

    def offset(self, line: int, column: int) -> int:
        """Give the offset of a line and column, both counted from 1."""
        return min(self._starts[line - 1] + column - 1, len(self._text))

    def _place(self, offset: int) -> tuple[int, int]:
        line = bisect_right(self._starts, offset)
        return line, offset - self._starts[line - 1] + 1
