from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aapa.anchors import Attachment
from aapa.errors import AnchoringError
from aapa.hierarchy import parents_of


def test_plain_pairs_and_attachments_do_alike():
    assert parents_of([Attachment("plug", "case"), ("case", "hand")]) == {
        "plug": "case",
        "case": "hand",
    }


def test_a_pair_may_be_said_twice():
    assert parents_of([("plug", "case"), ("plug", "case")]) == {"plug": "case"}


def test_a_parent_may_have_many_children():
    assert len(parents_of([(f"plug-{n}", "case") for n in range(5)])) == 5


def test_two_parents_are_refused():
    with pytest.raises(AnchoringError, match="plug is attached to both case and hand"):
        parents_of([("plug", "case"), ("plug", "hand")])


@pytest.mark.parametrize(
    ("pairs", "circle"),
    [
        ([("a", "a")], "a → a"),
        ([("a", "b"), ("b", "a")], "a → b → a"),
        ([("x", "a"), ("a", "b"), ("b", "c"), ("c", "a")], "a → b → c → a"),
    ],
)
def test_circles_are_refused(pairs, circle):
    with pytest.raises(AnchoringError, match="run in a circle: " + circle + ";"):
        parents_of(pairs)


@pytest.mark.parametrize("entry", ["ab", ("a",), ("a", "b", "c"), ("a", 1), ("", "b"), None, 7])
def test_what_is_no_pair_of_names_is_refused(entry):
    with pytest.raises(AnchoringError, match=r"is not a pair of names \(child, parent\)"):
        parents_of([entry])


@given(st.dictionaries(st.integers(1, 30), st.integers(0, 29)))
def test_every_forest_is_accepted_and_comes_to_an_end(links):
    # A child with a number above its parent's cannot be part of a circle.
    forest = {str(child): str(parent) for child, parent in links.items() if parent < child}
    parents = parents_of(forest.items())
    assert parents == forest
    for start in parents:
        name, steps = start, 0
        while name in parents:
            name, steps = parents[name], steps + 1
        assert 1 <= steps <= len(parents)
