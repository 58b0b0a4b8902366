from __future__ import annotations

import pytest

from icarus_lite.language.editing import File, Index, signature

BASE = """(percepts (object ^type ^x))
(concepts ((near ?a ?b ^gap ?g) :elements ((object ?a ^x ?g) (object ?b))))
(skills ((grasp ?h ?o) :elements ((near ?h ?o)) :actions ((*grasp ?h))))
"""


def at_bar(text):
    text = BASE + text
    offset = text.index("|")
    found = signature(Index([File.read("it", text.replace("|", "", 1))]), "it", offset)
    if found is None:
        return None
    return found.label, [found.label[a:b] for a, b in found.parameters], found.active


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("(goals (near |", ("(near ?a ?b ^gap ?g)", ["?a", "?b"], 0)),
        ("(goals (near pl|", ("(near ?a ?b ^gap ?g)", ["?a", "?b"], 0)),
        ("(goals (near plug |", ("(near ?a ?b ^gap ?g)", ["?a", "?b"], 1)),
        ("(goals (near plug |case) (near a b))", ("(near ?a ?b ^gap ?g)", ["?a", "?b"], 1)),
        ("(goals (near plug case |", ("(near ?a ?b ^gap ?g)", ["?a", "?b"], 2)),
        ("(goals (near plug ^gap |", ("(near ?a ?b ^gap ?g)", ["?a", "?b"], 2)),
        ("(test t :plan ((grasp h |", ("(grasp ?h ?o)", ["?h", "?o"], 1)),
        ("(concepts ((a) :tests ((< (abs |", ("(abs …)", ["…"], 0)),
        ("(goals (near|", None),
        ("(goals (unheard-of |", None),
        ("(goals |", None),
        ("(concepts ((far ?a |", None),
        ("|", None),
    ],
)
def test_what_a_pattern_takes(text, expected):
    assert at_bar(text) == expected
