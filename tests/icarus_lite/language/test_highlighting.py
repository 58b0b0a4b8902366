from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pygments import highlight
from pygments.formatters import NullFormatter
from pygments.lexers import get_lexer_by_name, get_lexer_for_filename
from pygments.token import Comment, Error, Keyword, Name, Operator, String, Whitespace

from icarus_lite.language.highlighting import IcarusLexer

DOMAINS = sorted((Path(__file__).parents[3] / "domains").glob("*.icr"))


def coloured(text):
    return [
        (piece, kind)
        for _, kind, piece in IcarusLexer().get_tokens_unprocessed(text)
        if kind is not Whitespace
    ]


def test_colours_follow_the_meaning():
    found = dict(
        coloured('(skills ((go ?x) :elements ((not (at ?x ^y 1))) :actions ((*move "a")))) ; end')
    )
    assert found["skills"] is Keyword.Declaration
    assert found["go"] is Name.Function
    assert found["at"] is Name.Class
    assert found["not"] is Operator.Word
    assert found["*move"] is Name.Builtin
    assert found['"a"'] is String
    assert found["; end"] is Comment.Single


@pytest.mark.parametrize("path", DOMAINS, ids=lambda path: path.stem)
def test_shipped_domains_have_no_error_tokens(path):
    assert Error not in [kind for _, kind in coloured(path.read_text(encoding="utf-8"))]


@given(st.text("()\"';#|?^*:ab1. \n\\🦾"))
def test_no_character_is_lost(text):
    pieces = list(IcarusLexer().get_tokens_unprocessed(text))
    assert "".join(piece for _, _, piece in pieces) == text
    assert [start for start, _, _ in pieces] == [
        sum(len(piece) for _, _, piece in pieces[:i]) for i in range(len(pieces))
    ]


def test_pygments_finds_it_by_name_and_by_file():
    assert isinstance(get_lexer_by_name("icarus"), IcarusLexer)
    assert isinstance(get_lexer_for_filename("gearbox.icr"), IcarusLexer)
    assert highlight("(goals)\n", get_lexer_by_name("icr"), NullFormatter()) == "(goals)\n"
