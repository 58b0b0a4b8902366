from __future__ import annotations

import random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from icarus_lite.language.editing import File, Index, Role, complete
from icarus_lite.language.functions import FUNCTIONS

BASE = """\
(percepts (object ^type ^x) (hand ^reach))
(concepts ((ball ?o) :elements ((object ?o ^type ball))))
(skills ((grasp ?h ?o) :elements ((hand ?h) (ball ?o)) :actions ((*close ?h ?o))
         :effects ((holding ?h ?o))))
"""
DEFINED = ["object", "hand", "ball", "holding"]


def completing(text, base=BASE, **options):
    """Complete at the bar."""
    text = base + text
    offset = text.index("|")
    text = text.replace("|", "", 1)
    return complete(Index([File.read("it", text)]), "it", offset, **options)


def proposed(text, **options):
    return [each.text for each in completing(text, **options).proposals]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("(concepts ((a ?x) |", [":elements", ":tests", ":binds", ":break"]),
        ("(concepts ((a ?x) :tests () |", [":elements", ":binds", ":break"]),
        ("(concepts ((a ?x) :el|", [":elements", ":tests", ":binds", ":break"]),
        ("(concepts ((a ?x) :break |", ["on-gain", "on-loss"]),
        ("(concepts ((a ?x) :break (on-gain |", ["on-loss"]),
        ("(skills ((a ?x) :break (|", ["on-start", "on-success", "on-failure"]),
        ("(skills ((a ?x) :break on-s|", ["on-start", "on-success", "on-failure"]),
        ("(concepts ((|", ["ball"]),
        ("(concepts ((a ?x) :elements ((|", ["not", *DEFINED, "a", "attached"]),
        ("(concepts ((a ?x) :elements ((not (|", [*DEFINED, "a", "attached"]),
        (
            "(concepts ((a ?x) :elements ((broken (:x)) (hand ?h) (ob|",
            ["not", *DEFINED, "a", "attached"],
        ),
        ("(concepts ((a ?x) :elements ((object ?x ^|", ["^type", "^x"]),
        ("(concepts ((a ?x) :elements ((object ?x *|", ["*type", "*x"]),
        ("(concepts ((a ?x) :elements ((object ?x ^x ?y ^|", ["^type"]),
        ("(concepts ((a ?xy) :elements ((object ?|))))", ["?xy"]),
        ("(concepts ((a ?xy) :elements ((object ?x|) (hand ?later))))", ["?xy", "?later"]),
        ("(concepts ((a ?x) :elements ((object ?x ^type |))))", ["?x", "ball"]),
        ("(concepts ((a ?x) :tests ((|", list(FUNCTIONS)),
        ("(concepts ((a ?x) :tests ((< ?x (|", list(FUNCTIONS)),
        ("(skills ((|", ["grasp"]),
        ("(skills ((a ?x) :actions ((|", ["*close", "*open"]),
        ("(skills ((a ?x) :actions ((*op|", ["*close", "*open"]),
        ("(skills ((a ?x) :subskills ((|", ["grasp", "a"]),
        ("(attachments ((|", ["grasp"]),
        ("(attachments ((grasp ?h ?o) :child ?o :parent |", ["?h", "?o"]),
        ("(test t :percepts ((|", ["object", "hand"]),
        ("(test t :action ((|", ["grasp"]),
        ("(task t :goal ((|", ["not", *DEFINED, "attached"]),
        ("(percepts (part :is |", ["object", "hand"]),
        ("(percepts (|", []),
        ("; (conc|", []),
        ('(task t "a (|', []),
        ("|", []),
    ],
)
def test_what_the_parser_would_take_is_proposed(text, expected):
    assert proposed(text, commands=("open",)) == expected


def test_forms_are_proposed_by_their_modern_names():
    found = proposed("(|")
    assert {"domain", "include", "percepts", "concepts", "skills", "task", "test"} <= set(found)
    assert not any(each.startswith("create-") for each in found)


def test_proposals_say_what_they_are():
    by_name = {each.text: each for each in completing("(task t :goal ((|").proposals}
    assert by_name["ball"].detail == "(ball ?o)"
    assert by_name["holding"].detail == "(holding ?h ?o)"
    by_name = {each.text: each for each in completing("(skills ((a ?x) |").proposals}
    assert by_name[":while"].documentation.startswith("What must keep holding")
    assert by_name[":while"].role is Role.FIELD
    by_name = {each.text: each for each in completing("(concepts ((a ?x) :tests ((|").proposals}
    assert by_name["sqrt"].documentation == FUNCTIONS["sqrt"].documentation


def test_the_whole_word_is_replaced():
    found = completing("(concepts ((a ?x) :elements ((ob|ject ?x))))")
    text = BASE + "(concepts ((a ?x) :elements ((object ?x))))"
    assert text[found.start : found.stop] == "object"


def test_a_form_that_is_broken_further_up_does_not_matter():
    assert "?h" in proposed(
        "(skills ((b ?h)\n :elements ((:oops ?h)) (stray)\n :effects ((holding ?|"
    )


def test_proposals_keep_the_file_sound_at_every_word(gearbox):
    index = Index([File.read("it", gearbox)])
    missing = []
    for word in index.words("it"):
        if word.role not in (Role.PREDICATE, Role.SKILL, Role.ATTRIBUTE, Role.FIELD, Role.FORM):
            continue
        if word.place.form in ("percepts", "concepts", "skills") and word.defines:
            continue
        written = gearbox[word.start : word.stop]
        found = complete(index, "it", word.start + 1)
        if written not in [each.text for each in found.proposals]:
            missing.append(written)
    assert not missing


@settings(max_examples=40, deadline=None)
@given(st.randoms(use_true_random=False))
def test_a_mangled_text_is_no_trouble(gearbox_text, randomness):
    text = mangled(gearbox_text, randomness)
    index = Index([File.read("it", text)])
    for _ in range(5):
        offset = randomness.randint(0, len(text))
        found = complete(index, "it", offset)
        assert 0 <= found.start <= offset <= found.stop <= len(text)


@pytest.fixture(scope="module")
def gearbox_text():
    return BASE


def mangled(text: str, randomness: random.Random) -> str:
    for _ in range(randomness.randint(1, 6)):
        start = randomness.randint(0, len(text))
        stop = min(len(text), start + randomness.randint(0, 12))
        piece = randomness.choice(
            ["", "(", ")", '"', "#|", "^", "?", ":elements", "not", "\0", "🦾"]
        )
        text = text[:start] + piece + text[stop:]
    return text
