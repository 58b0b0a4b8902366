"""Lines in the making: columns are counted, and comments at line ends aligned."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby

from icarus_lite.language.formatting.tree import is_block

_GAP = 2
_FARTHEST = 24


class Lines:
    """What has been written so far.

    Attributes:
        column: How many columns of the current line are filled.
        must_break: Whether a comment ends the current line, so that nothing may follow on it.
        should_break: Whether a comment behind the last item does, even if a parenthesis may follow.
    """

    def __init__(self) -> None:
        self.column = 0
        self.must_break = False
        self.should_break = False
        self._done: list[tuple[str, str]] = []
        self._code: list[str] = []
        self._comment = ""

    def put(self, text: str) -> None:
        """Write on the current line; text over several lines is written as it is."""
        self.should_break = False
        if "\n" not in text:
            self._code.append(text)
            self.column += len(text)
            return
        first, *between, last = text.split("\n")
        self._done.append(("".join((*self._code, first)), ""))
        self._done += [(line, "") for line in between]
        self._code = [last]
        self.column = len(last)

    def comment(self, text: str) -> None:
        """Write a comment where the current line stands."""
        self.put(text)
        self.must_break = not is_block(text)

    def trail(self, text: str) -> None:
        """Write a comment behind what the current line holds."""
        if is_block(text):
            self.put(f" {text}")
        else:
            self._comment = text
            self.must_break = True
        self.should_break = True

    def newline(self, indent: int, *, blank: bool = False) -> None:
        """Begin a new line, which must not remain empty; `blank` leaves a line free before it."""
        self._finish_line()
        if blank:
            self._done.append(("", ""))
        self._code = [" " * indent]
        self.column = indent

    def text(self) -> str:
        """Give all lines, the last one ended as well."""
        if not self._done and not self._code and not self._comment:
            return ""
        self._finish_line()
        written: list[str] = []
        for has_comments, neighbours in groupby(self._done, key=lambda line: bool(line[1])):
            lines = list(neighbours)
            written += _aligned(lines) if has_comments else [code for code, _ in lines]
        return "\n".join([*written, ""])

    def _finish_line(self) -> None:
        self._done.append(("".join(self._code), self._comment))
        self._code = []
        self._comment = ""
        self.must_break = self.should_break = False


def _aligned(lines: Sequence[tuple[str, str]]) -> list[str]:
    """Join code and comments, in one column unless some comments would come to stand far off."""
    widths = [len(code) for code, _ in lines]
    farthest = max(widths)
    column = farthest if farthest - min(widths) <= _FARTHEST else 0
    return [f"{code.ljust(column)}{' ' * _GAP}{comment}" for code, comment in lines]
