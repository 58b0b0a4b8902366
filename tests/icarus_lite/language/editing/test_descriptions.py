from __future__ import annotations

import pytest

from icarus_lite.language.editing import describe
from icarus_lite.language.functions import FUNCTIONS
from icarus_lite.language.keywords import FIELDS, FORMS, NOT

TEXT = """\
(percepts (object ^type ^x))
(concepts
  ; Round, and
  ; not too far.
  ((ball ?o)
   :elements ((object ?o ^type ball ^x ?x) (not (object ?any ^x ?far)))
   :tests ((< ?x 1))))
(skills
  ; Closes the hand.
  ((grasp ?o) :elements ((ball ?o)) :actions ((*close ?o)) :effects ((held ?o))))
(attachments ((grasp ?o) :child ?o :parent hand))
(test "it is held" :action ((grasp b)) :expect ((held b)))
"""


@pytest.fixture
def said(reading):
    index = reading(TEXT)

    def describing(needle, within=0):
        word = index.at("it", TEXT.index(needle) + within)
        return describe(index, "it", word, commands=("close",))

    return describing


@pytest.mark.parametrize(
    ("needle", "text"),
    [
        (
            "object ^type",
            "**`object`** · percept type\n\n```icarus\n(object ^type ^x)\n```\n\nUsed by `ball`.",
        ),
        (
            "ball ?o)",
            (
                "**`ball`** · concept\n\nRound, and not too far.\n\n```icarus\n((ball ?o)\n"
                " :elements ((object ?o ^type ball ^x ?x) (not (object ?any ^x ?far)))\n"
                " :tests ((< ?x 1)))\n```\n\nUsed by `grasp`."
            ),
        ),
        (
            "held ?o",
            (
                "**`held`** · asserted by effects\n\n```icarus\n((grasp ?o) :elements ((ball ?o)) "
                ":actions ((*close ?o)) :effects ((held ?o)))\n```\n\nUsed by test “it is held”."
            ),
        ),
        (
            "grasp b",
            (
                "**`grasp`** · skill\n\nCloses the hand.\n\n```icarus\n((grasp ?o) :elements "
                "((ball ?o)) :actions ((*close ?o)) :effects ((held ?o)))\n```\n\n"
                "Used by the attachment by `grasp` and test “it is held”."
            ),
        ),
        (
            "^type",
            "**`^type`** · attribute of `object`\n\nValues that occur: `ball`.\n\nUsed by `ball`.",
        ),
        ("?x)", "**`?x`** · variable of `ball`\n\nBound by the `^x` of `object`."),
        (
            "?far",
            (
                "**`?far`** · variable of `ball`\n\n"
                "It occurs only inside `not`, which reads: there is none."
            ),
        ),
        ("*close", "**`*close`** · command for the driver that the arm's driver offers"),
        ("ball ^x", "**`ball`** · value of `^type` of `object`"),
        ("hand)", "**`hand`** · symbol"),
        ("not (object", f"**`not`** · negation\n\n{NOT.documentation}"),
        ("skills", f"**`skills`** · form\n\n{FORMS['skills'].documentation}"),
        (":tests", f"**`:tests`** · field\n\n{FIELDS[':tests'].documentation}"),
        (
            "< ?x",
            (
                f"**`<`** · function of at least 2 arguments, gives a boolean\n\n"
                f"{FUNCTIONS['<'].documentation}"
            ),
        ),
        ("1))", ""),
        ("; Round", ""),
    ],
)
def test_hover_says(said, needle, text):
    assert said(needle) == text


def test_attached_is_explained_although_no_clause_defines_it(reading):
    text = "(task t :goal ((attached a b)))"
    index = reading(text)
    found = describe(index, "it", index.at("it", text.index("attached")))
    assert found.startswith("**`attached`** · attachment hierarchy\n\n`(attached child parent)` is")
    assert found.endswith("Used by task `t`.")


def test_what_nothing_defines_or_uses(reading):
    text = "(concepts ((a ?x) :elements ((b ?x)) :tests ((huh ?x))))"
    index = reading(text)
    assert describe(index, "it", index.at("it", text.index("b ?x"))).startswith(
        "**`b`** · nothing defines it"
    )
    assert describe(index, "it", index.at("it", text.index("a ?x"))).endswith("Nothing uses it.")
    assert describe(index, "it", index.at("it", text.index("huh"))) == ""


def test_many_clauses_and_many_users_are_cut_short(reading):
    text = "(concepts " + " ".join(f"((a {i}))" for i in range(9)) + ")"
    text += "".join(f"(task t{i} :goal ((a x)))" for i in range(20))
    index = reading(text)
    found = describe(index, "it", index.at("it", text.index("a 0")))
    assert "… and 5 more" in found
    assert found.endswith("task `t11` and 8 more.")
