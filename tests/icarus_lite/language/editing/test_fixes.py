from __future__ import annotations

import pytest

from icarus_lite.language import diagnose_text
from icarus_lite.language.editing import fixes

BASE = """(percepts (object ^type ^x) (hand))
(skills
  ((grasp ?h ?o) :elements ((hand ?h) (object ?o)) :actions ((*grasp ?h ?o)) :effects ((held ?o))))
(concepts ((plug ?o) :elements ((object ?o ^type plug))))
"""


def offered(text):
    """Give what is offered for each finding: the code, the title, and the text afterwards."""
    _, _, found = diagnose_text(text, "d.icr")
    return [
        (each.code, fix.title, applied(text, fix)) for each in found for fix in fixes(text, each)
    ]


def applied(text, fix):
    for each in sorted(fix.replacements, key=lambda each: each.start, reverse=True):
        text = text[: each.start] + each.text + text[each.stop :]
    return text


@pytest.mark.parametrize(
    ("wrong", "code", "title", "right"),
    [
        ("(concpts)", "ICR007", "Write `concepts`", "(concepts)"),
        ("(goals (plg o1))", "ICR013", "Write `plug`", "(goals (plug o1))"),
        (
            "(concepts ((a ?o) :elemnts ((plug ?o))))",
            "ICR008",
            "Write `:elements`",
            "(concepts ((a ?o) :elements ((plug ?o))))",
        ),
        (
            "(concepts ((a ?o) :elements ((object ?o ^tpe 1))))",
            "ICR015",
            "Write `^type`",
            "(concepts ((a ?o) :elements ((object ?o ^type 1))))",
        ),
        (
            "(concepts ((a ?o) :elements ((object ?o ^x ?xx)) :tests ((< ?x 1) (> ?xx 0))))",
            "ICR012",
            "Write `?xx`",
            "(concepts ((a ?o) :elements ((object ?o ^x ?xx)) :tests ((< ?xx 1) (> ?xx 0))))",
        ),
        ("(percepts (part :is objct))", "ICR039", "Write `object`", "(percepts (part :is object))"),
        (
            "(concepts ((a ?o) :elements ((plug ?o)) :break on-gian))",
            "ICR046",
            "Write `on-gain`",
            "(concepts ((a ?o) :elements ((plug ?o)) :break on-gain))",
        ),
        ("(goals (plug o1)", "ICR002", "Add ) at the end of line 5", "(goals (plug o1))"),
        ("(goals (plug o1)))", "ICR003", "Remove )", "(goals (plug o1))"),
        ("(goals ((plug o1))", "ICR002", "Remove (", "(goals (plug o1))"),
        ("goals (plug o1))", "ICR003", "Add (", "(goals (plug o1))"),
        (
            "(concepts ((a ?o :elements ((plug ?o))))",
            "ICR002",
            "Add ) before :elements",
            "(concepts ((a ?o) :elements ((plug ?o))))",
        ),
        (
            "(skills ((b ?o) :elements ((plug ?o)) :actions ((push ?o))))",
            "ICR026",
            "Write it with a star",
            "(skills ((b ?o) :elements ((plug ?o)) :actions ((*push ?o))))",
        ),
        (
            "(concepts ((a ?o) :elements ((object ?o ^x ?x))))",
            "ICR029",
            "Call it ?_x: any value will do",
            "(concepts ((a ?o) :elements ((object ?o ^x ?_x))))",
        ),
        (
            "(concepts ((a ?o) :elements ((plug ?o) (not (object ?p ^x ?p)))))",
            "ICR030",
            "Call it ?_p: any value will do",
            "(concepts ((a ?o) :elements ((plug ?o) (not (object ?_p ^x ?_p)))))",
        ),
        ("(goals (plug 'o1))", "ICR009", "Remove the quote", "(goals (plug o1))"),
        (
            "(create-concepts ((a ?o) :relations ((plug ?o))))",
            "ICR028",
            "Write this form as it is written today",
            "(concepts\n  ((a ?o) :elements ((plug ?o))))",
        ),
    ],
)
def test_a_fix_writes_what_was_meant(wrong, code, title, right):
    assert (code, title, BASE + right) in offered(BASE + wrong)
    before = [each.code for each in diagnose_text(BASE + wrong, "d.icr")[2]]
    after = [each.code for each in diagnose_text(BASE + right, "d.icr")[2]]
    assert code in before
    assert code not in after


def test_the_whole_file_can_be_written_as_today():
    text = "(create-goals (a))\n(create-goals (b))\n"
    whole = [each for each in offered(text) if "whole file" in each[1]]
    assert {each[2] for each in whole} == {"(goals (a))\n(goals (b))\n"}


def test_nothing_is_offered_where_only_the_author_knows():
    text = BASE + "(concepts ((a ?o) :elements ((plug ?o ?o) (unheard-of ?o))))"
    assert offered(text) == []


def test_a_finding_without_a_place_has_no_fix():
    _, _, (found,) = diagnose_text("", "d.icr")
    assert fixes("", found) == ()
