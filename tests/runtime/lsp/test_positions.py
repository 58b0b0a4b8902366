from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from lsprotocol import types

from runtime.lsp.positions import Positions

TEXT = "ab\né🦾c\n\nd"
ENCODINGS = list(types.PositionEncodingKind)


@pytest.mark.parametrize(("encoding", "column"), [("utf-8", 6), ("utf-16", 3), ("utf-32", 2)])
def test_columns_are_counted_in_code_units(encoding, column):
    positions = Positions(TEXT, encoding)
    assert positions.position(TEXT.index("c")) == types.Position(1, column)
    assert positions.offset(types.Position(1, column)) == TEXT.index("c")
    assert positions.length(TEXT.index("é"), TEXT.index("c")) == column


def test_what_lies_beyond_ends_at_the_end():
    positions = Positions(TEXT, "utf-16")
    assert positions.offset(types.Position(0, 99)) == 2
    assert positions.offset(types.Position(2, 5)) == TEXT.index("\n\n") + 1
    assert positions.offset(types.Position(99, 0)) == len(TEXT)


def test_a_position_inside_a_character_is_its_start():
    assert Positions(TEXT, "utf-16").offset(types.Position(1, 2)) == TEXT.index("🦾")


def test_a_stretch_is_cut_at_line_ends():
    positions = Positions(TEXT, "utf-16")
    pieces = [TEXT[start:stop] for start, stop in positions.lines(1, len(TEXT))]
    assert pieces == ["b", "é🦾c", "d"]


@given(st.text("ab\né🦾\r\f\u2028"), st.sampled_from(ENCODINGS))
def test_there_and_back(text, encoding):
    positions = Positions(text, encoding)
    for offset in range(len(text) + 1):
        assert positions.offset(positions.position(offset)) == offset
