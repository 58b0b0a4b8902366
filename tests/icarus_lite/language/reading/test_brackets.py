from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from icarus_lite.language.reading.brackets import first_word, innermost_open, scan
from icarus_lite.language.reading.lines import MAX_DEPTH, Lines
from icarus_lite.language.syntax import Span


def pieces(text):
    return [text[segment.start : segment.stop].strip() for segment in scan(text).segments]


def test_a_text_is_cut_into_its_forms():
    assert pieces('(a (b))\n; c )\n(d ")") x') == ["(a (b))", '; c )\n(d ")")', "x"]


def test_brackets_in_comments_and_strings_do_not_count():
    assert scan('(a ; (\n #| (( |# "(\\"(")').is_sound


@pytest.mark.parametrize("text", ["(a", "a)", '(a "b)', "(a) #| b", "(" * 101 + ")" * 101])
def test_what_is_not_sound(text):
    assert not scan(text).is_sound


def test_nesting_is_measured():
    text = "(" * MAX_DEPTH + ")" * MAX_DEPTH
    assert scan(text).is_sound
    assert scan(f"({text})").segments[0].too_deep == MAX_DEPTH


def test_a_form_at_the_margin_counts_only_when_one_is_left_open():
    closed, left_open = "(goals\n(task))", "(goals (a)\n(task 1)"
    assert pieces(closed) == [closed, ""]
    assert pieces(left_open) == ["(goals (a)", "(task 1)", ""]
    assert scan(left_open).segments[0].unclosed == (0,)


def test_the_innermost_open_parenthesis_and_its_word():
    text = '(a (b ")") ( c d'
    assert innermost_open(text, 0, len(text)) == 11
    assert first_word(text, 11) == "c"
    assert innermost_open(text, 0, 0) is None
    assert first_word("(", 0) == ""


def test_lines_know_places_and_offsets():
    lines = Lines("ab\n\ncd")
    assert lines.span(1, 5) == Span(1, 2, 3, 2)
    assert lines.offset(3, 2) == 5
    assert lines.offset(3, 99) == 6


@given(st.text('()";#|\\\n a', max_size=40))
def test_segments_and_strays_cover_the_text_in_order(text):
    scanned = scan(text)
    end = 0
    for segment in scanned.segments:
        assert end <= segment.start <= segment.stop
        assert set(text[end : segment.start]) <= {")"}
        end = segment.stop
    if scanned.unclosed_quote is None:
        assert set(text[end:]) <= {")"}


@given(st.text("ab\n", max_size=30), st.data())
def test_offset_and_span_are_inverse(text, data):
    offset = data.draw(st.integers(0, len(text)))
    lines = Lines(text)
    span = lines.span(offset, offset)
    assert lines.offset(span.line, span.column) == offset
