from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from icarus_lite.language.reading.indentation import oddities, tokens


def odd(text):
    """Give the lines that are at odds with their parentheses, counted from 1."""
    return [(each.token.line + 1, each.weight, each.is_deep) for each in oddities(tokens(text))]


def test_tokens_are_words_and_parentheses_with_their_places():
    found = tokens('(a "b\n c" ; no (words)\n  #| nor\n here |# ?x)')
    assert [(each.text, each.line, each.column, each.is_first) for each in found] == [
        ("(", 0, 1, True),
        ("a", 0, 2, False),
        ('"b\n c"', 0, 4, False),
        ("?x", 3, 10, False),
        (")", 3, 12, False),
    ]


@pytest.mark.parametrize(
    "text",
    [
        "(concepts\n  ((near ?a ?b)\n   :elements ((object ?a)\n              (object ?b))))",
        "(task 1\n  :goal ((on a b)\n         (on b c)))",
        "(object ?a ^x ?x\n        ^y ?y)",
        "(a)\n(b\n)\n",
        "(a\n  ; (\n  (b))",
    ],
)
def test_a_text_laid_out_as_it_is_meant_has_nothing_odd(text):
    assert odd(text) == []


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("(concepts\n  ((a) :elements ((b)))\n  ((c)))", []),
        ("(concepts\n  ((a) :elements ((b))\n  ((c)))", [(3, 1, False)]),
        ("(concepts\n  ((a) :elements ((b)\n  ((c)))", [(3, 2, False)]),
        ("(concepts\n  ((a) :elements ((b)))))\n  ((c))", [(3, 1, True)]),
        ("(concepts\n  ((a)\n   :elements ((b)))\n      ((c)))", [(4, 1, True)]),
    ],
)
def test_lines_at_odds_show_what_is_missing_or_too_many(text, expected):
    assert odd(text) == expected


@given(st.text(alphabet='()ab \n;"', max_size=40))
def test_every_token_stands_where_it_says(text):
    lines = text.split("\n")
    for each in tokens(text):
        assert text[each.offset : each.stop] == each.text
        assert lines[each.line][each.column - 1 :].startswith(each.text.split("\n")[0])
