from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from icarus_lite.language.reading.indentation import tokens
from icarus_lite.language.reading.mending import MAX_EDITS, EditKind, Mender


def takes_it_all(_):
    return None


def balance(text):
    depth = 0
    for token in tokens(text):
        depth += (token.text == "(") - (token.text == ")")
        assert depth >= 0
    return depth


@pytest.mark.parametrize(
    ("text", "kinds", "mended"),
    [
        ("(a (b c)", [EditKind.ADD_CLOSING], "(a (b c))"),
        ("(a\n  (b c\n  (d))", [EditKind.ADD_CLOSING], "(a\n  (b c)\n  (d))"),
        ("(a\n  (b (c\n  (d))", [EditKind.ADD_CLOSING] * 2, "(a\n  (b (c))\n  (d))"),
        ("(a\n  (b))\n  (c))", [EditKind.REMOVE_CLOSING], "(a\n  (b) \n  (c))"),
        ("(a b))", [EditKind.REMOVE_CLOSING], "(a b) "),
        ("(a b ; c\n", [EditKind.ADD_CLOSING], "(a b); c\n"),
    ],
)
def test_the_edit_agrees_with_the_lines(text, kinds, mended):
    found = Mender(takes_it_all).mend(text)
    assert found is not None
    assert (found.text, [each.kind for each in found.edits]) == (mended, kinds)


def test_what_the_parser_takes_comes_first():
    def parse(text):
        return None if text.startswith("((a)") else 1

    found = Mender(parse).mend("(a) b)")
    assert found is not None
    assert found.text == "((a) b)"
    assert found.edits[0].kind is EditKind.ADD_OPENING
    assert not found.edits[0].replaces


def test_a_text_that_matches_is_left_alone_and_not_parsed():
    def parse(_):
        raise AssertionError

    found = Mender(parse).mend("(a (b))\n(c)")
    assert found is not None
    assert (found.text, found.edits) == ("(a (b))\n(c)", ())


def test_a_text_that_is_no_domain_is_given_up():
    assert Mender(takes_it_all).mend("(" * (MAX_EDITS + 1)) is None


def test_no_more_is_parsed_than_there_is_time_for():
    parsed = []

    def parse(text):
        parsed.append(len(text))
        return 0

    mender = Mender(parse, characters=100)
    for _ in range(50):
        mender.mend("(a\n  (b (c\n  (d))")
    assert 0 < sum(parsed) <= 100


@settings(max_examples=300, deadline=None)
@given(st.text(alphabet="()ab \n;'", max_size=30), st.integers(0, 30))
def test_whatever_is_mended_matches_and_keeps_every_word_in_its_line(text, place):
    found = Mender(lambda mended: min(place, len(mended))).mend(text)
    if found is None:
        return
    assert balance(found.text) == 0

    def words(given):
        return [(each.text, each.line) for each in tokens(given) if each.text not in "()"]

    assert words(found.text) == words(text)
    for edit in found.edits:
        if edit.kind in (EditKind.ADD_CLOSING, EditKind.ADD_OPENING):
            assert found.text[edit.offset] in "()"
