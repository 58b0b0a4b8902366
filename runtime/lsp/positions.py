"""Offsets into a text, as the positions of the Language Server Protocol, and back.

The protocol counts lines and columns from 0, and columns in the code units of an encoding that
client and server agree on, UTF-16 unless they say otherwise (LSP 3.17, "Position").
"""

from __future__ import annotations

import re
from bisect import bisect_right

from lsprotocol import types

_BYTES_PER_UNIT = {
    types.PositionEncodingKind.Utf8: ("utf-8", 1),
    types.PositionEncodingKind.Utf16: ("utf-16-le", 2),
    types.PositionEncodingKind.Utf32: ("utf-32-le", 4),
}


class Positions:
    """Turns offsets of one text into positions and back.

    Args:
        text: The text, its lines ending in LF only.
        encoding: What columns count.
    """

    def __init__(self, text: str, encoding: types.PositionEncodingKind | str) -> None:
        self._text = text
        self._starts = [0, *(match.end() for match in re.finditer("\n", text))]
        self._codec, self._bytes = _BYTES_PER_UNIT[types.PositionEncodingKind(encoding)]

    def position(self, offset: int) -> types.Position:
        """Give the position of an offset."""
        line = bisect_right(self._starts, offset) - 1
        return types.Position(line, self._units(self._text[self._starts[line] : offset]))

    def range(self, start: int, stop: int) -> types.Range:
        """Give the range from one offset up to another, exclusive."""
        return types.Range(self.position(start), self.position(stop))

    def offset(self, position: types.Position) -> int:
        """Give the offset of a position; one beyond a line's or the text's end is its end."""
        if position.line >= len(self._starts):
            return len(self._text)
        start = self._starts[position.line]
        stop = self._text.find("\n", start)
        line = self._text[start : stop if stop >= 0 else len(self._text)]
        data = line.encode(self._codec, "surrogatepass")[: position.character * self._bytes]
        return start + len(data.decode(self._codec, "ignore"))

    def length(self, start: int, stop: int) -> int:
        """Give the length of a stretch in code units."""
        return self._units(self._text[start:stop])

    def lines(self, start: int, stop: int) -> list[tuple[int, int]]:
        """Cut a stretch at its line ends."""
        first, last = (bisect_right(self._starts, offset) for offset in (start, stop))
        ends = self._starts[first:last]
        bounds = zip([start, *ends], [*(each - 1 for each in ends), stop], strict=True)
        return [(begin, end) for begin, end in bounds if begin < end]

    def _units(self, text: str) -> int:
        if text.isascii():
            return len(text)
        return len(text.encode(self._codec, "surrogatepass")) // self._bytes
