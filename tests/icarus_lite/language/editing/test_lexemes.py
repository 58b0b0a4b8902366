from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from icarus_lite.language.editing.lexemes import Kind, lexemes, word_kind


@pytest.mark.parametrize(
    ("word", "kind"),
    [
        ("near", Kind.SYMBOL),
        ("/=", Kind.SYMBOL),
        ("*", Kind.SYMBOL),
        ("1.5e-3", Kind.NUMBER),
        ("-", Kind.SYMBOL),
        ("+.5", Kind.NUMBER),
        ("3d", Kind.SYMBOL),
        ("?obj", Kind.VARIABLE),
        ("?", Kind.VARIABLE),
        ("^x", Kind.HAT),
        ("*grasp", Kind.STAR),
        (":tests", Kind.FIELD),
        ("a?b", Kind.ILLEGAL),
        ("??a", Kind.ILLEGAL),
        ("", Kind.ILLEGAL),
    ],
)
def test_a_word_is_known_by_its_characters(word, kind):
    assert word_kind(word) is kind


def test_comments_strings_and_words():
    text = '(a;b(\n#|x (|# "s\\" ;" ?v)'
    found = [(each.kind.value, each.text) for each in lexemes(text)]
    assert found == [
        ("(", "("),
        ("symbol", "a"),
        ("comment", ";b("),
        ("comment", "#|x (|#"),
        ("string", '"s\\" ;"'),
        ("variable", "?v"),
        (")", ")"),
    ]


def test_an_unclosed_string_ends_with_its_line_and_an_unclosed_comment_with_the_text():
    assert [each.text for each in lexemes('"a b\nc #| d\ne')] == ['"a b', "c", "#| d\ne"]


@given(st.text("()\"';#|?^*:ab1. \n\\"))
def test_nothing_but_blanks_is_left_out(text):
    found = lexemes(text)
    assert all(text[each.start : each.stop] == each.text for each in found)
    end = 0
    for each in found:
        assert not text[end : each.start].strip(" \t\n\r\f\v")
        end = each.stop
    assert not text[end:].strip(" \t\n\r\f\v")
