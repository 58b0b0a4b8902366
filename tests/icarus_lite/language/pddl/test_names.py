"""Names that are legal in PDDL, and stay apart."""

from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from icarus_lite.language.pddl.names import Names, pddl_word


@pytest.mark.parametrize(
    ("text", "word"),
    [("hubcover", "hubcover"), ("Hub.Cover 2", "hub-cover-2"), ("0.31", "n0-31"), ("-", "n")],
)
def test_any_text_becomes_a_word(text: str, word: str) -> None:
    assert pddl_word(text) == word


@given(st.text())
def test_a_word_is_always_legal(text: str) -> None:
    assert re.fullmatch(r"[a-z][a-z0-9_-]*", pddl_word(text))


@given(st.lists(st.sampled_from(["a", "A", "a-2", "a.2", "b"])))
def test_different_things_have_different_names(things: list[str]) -> None:
    names = Names(["b"])
    given_names = {thing: names.of(thing, pddl_word(thing)) for thing in things}
    assert len(set(given_names.values())) == len(given_names)
    assert "b" not in given_names.values()
    assert all(names.of(thing, "other") == name for thing, name in given_names.items())
