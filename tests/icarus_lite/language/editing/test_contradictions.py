"""Contradictions while they are written: outlined, completed, explained, renamed."""

from __future__ import annotations

import pytest

from icarus_lite.language.editing import EntryKind, complete, describe, occurrences, outline

HEAD = """(percepts (object ^x) (hand ^gripping))
(concepts
  ((apart ?a ?b)
   :elements ((object ?a ^x ?xa) (object ?b ^x ?xb))
   :tests ((> (- ?xb ?xa) 1))))
(skills
  ((grasp ?h ?o)
   :elements ((hand ?h) (object ?o))
   :actions ((*grasp ?h ?o))
   :effects ((holding ?h ?o)))
  ((insert ?o ?into)
   :elements ((object ?o) (object ?into))
   :actions ((*insert ?o ?into))))
(attachments ((insert ?o ?into) :child ?o :parent ?into))
"""
FORM = """(contradictions
  ; Seen elsewhere.
  ((attached ?o ?into) :elements ((apart ?o ?into)) :cycles 5))
"""


def test_the_outline_lists_them():
    (form,) = outline(occurrences(FORM))
    assert [(each.kind, each.name, each.detail) for each in form.children] == [
        (EntryKind.CONTRADICTION, "attached", "?o ?into")
    ]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("(contradictions ((|", ["holding", "attached"]),
        ("(contradictions ((hol|", ["holding", "attached"]),
        ("(contradictions ((holding ?h ?o) |", [":elements", ":tests", ":cycles"]),
        ("(contradictions ((holding ?h ?o) :cycles 3 :e|", [":elements", ":tests"]),
        ("(contradictions ((holding ?h ?o) :elements ((hand |", ["?h", "?o", "^gripping"]),
        ("(contradictions ((holding ?h ?o) :elements ((hand ?h ^|", ["^gripping"]),
        ("(contradi|", None),
    ],
)
def test_what_could_be_written_is_proposed(reading, text, expected):
    whole = HEAD + text
    offset = whole.index("|")
    found = complete(reading(whole.replace("|", "")), "it", offset)
    proposed = [each.text for each in found.proposals]
    if expected is None:
        assert "contradictions" in proposed
    else:
        assert proposed == expected


def test_what_a_word_means_is_said(reading):
    whole = HEAD + FORM
    index = reading(whole)

    def said(needle: str, within: int = 0) -> str:
        return describe(index, "it", index.at("it", whole.rindex(needle) + within))

    assert "What ends a belief that would persist" in said("(contradictions", 1)
    assert "For how many cycles in a row" in said(":cycles", 1)
    assert "the contradiction of `attached`" in said("(apart", 1)
    assert "`(attached child parent)`" in said("((attached", 2)
    assert "the contradiction of `attached`" in said("((attached", 2)


def test_a_variable_is_renamed_within_its_clause(reading):
    whole = HEAD + FORM
    index = reading(whole)
    word = index.at("it", whole.rindex("?into"))
    found = index.occurrences(index.thing("it", word))
    assert [whole[e.occurrence.start : e.occurrence.stop] for e in found] == ["?into"] * 2
