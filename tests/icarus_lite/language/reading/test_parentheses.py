"""Parentheses forgotten or doubled: what is said, and that it does not hide the rest."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

import pytest

from icarus_lite.language import diagnose_text, parse_domain

ROOT = Path(__file__).parents[4]
PERCEPTS = "(percepts (object ^type ^x) (hand ^x))\n"


@pytest.fixture(scope="module")
def script():
    path = ROOT / "benchmarks" / "parentheses.py"
    spec = importlib.util.spec_from_file_location("parentheses_benchmark", path)
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


def told(text):
    _, _, found = diagnose_text(text, "d.icr")
    return [(each.code, each.span.line, each.message, each.hint) for each in found]


def test_nearly_every_slip_is_told_where_it_was_made_and_nothing_else(script):
    text = (ROOT / "domains" / "gearbox.icr").read_text(encoding="utf-8")
    slips = list(script.slips(text))[::7]
    tally = script.Tally()
    for slip in slips:
        tally.add(slip, diagnose_text(slip.text, "d.icr")[2])
    assert tally.slips > 100
    assert tally.right >= 0.98 * tally.slips
    assert tally.further[0] >= 0.98 * tally.slips


def test_layouts_differ_in_nothing_but_layout(script):
    text = (ROOT / "domains" / "gearbox.icr").read_text(encoding="utf-8")
    domain, _ = parse_domain(text, "d.icr")
    for layout in (script.by_depth, script.not_at_all):
        assert layout(text) != text
        assert parse_domain(layout(text), "d.icr")[0] == domain


def test_a_field_that_cannot_stand_there_shows_the_place_in_its_line():
    text = PERCEPTS + "(concepts ((near ?a ?b :elements ((object ?a) (object ?b))))"
    assert told(text) == [
        (
            "ICR002",
            2,
            'this "(" in the clause of `near` is never closed',
            'add ")" before `:elements` in line 2',
        )
    ]


def test_the_clause_is_named_and_the_others_are_checked():
    text = (
        PERCEPTS
        + "(concepts\n  ((left ?o) :elements ((object ?o ^x ?x)) :tests ((< ?x 0))\n"
        + "  ((far ?o) :elements ((objct ?o)))\n  ((plug ?o) :elemnts ((object ?o))))"
    )
    assert [each[:2] for each in told(text)] == [("ICR002", 3), ("ICR008", 5)]
    assert told(text)[0][2:] == (
        "the clause of `left` is never closed",
        'add ")" at the end of line 3',
    )
    mended = text.replace(":elemnts", ":elements")
    assert [each[:2] for each in told(mended)] == [("ICR002", 3), ("ICR013", 4)]


def test_several_at_one_place_are_one_remark():
    text = (
        PERCEPTS
        + "(concepts\n  ((left ?o) :elements ((object ?o ^x 1\n"
        + "  ((any ?h) :elements ((hand ?h))))\n"
    )
    assert [each[:2] + each[3:] for each in told(text)] == [
        ("ICR002", 3, 'add ")))" at the end of line 3')
    ]


def test_one_too_many_is_told_where_it_closes_too_early():
    text = (
        PERCEPTS
        + "(concepts\n  ((left ?o) :elements ((object ?o))))\n  ((any ?h) :elements ((hand ?h))))\n"
    )
    assert told(text) == [
        (
            "ICR003",
            3,
            'this ")" is one too many: it closes the form `concepts` too early',
            "remove it: what follows still belongs inside",
        )
    ]


def test_an_opening_one_may_be_too_many_or_missing():
    text = PERCEPTS + "(concepts (((left ?o) :elements ((object ?o)))))"
    assert [each[2] for each in told(text.replace(")))))", "))))"))] == ['this "(" is one too many']
    text = PERCEPTS + "(concepts (left ?o) :elements ((object ?o))))"
    assert told(text) == [("ICR003", 2, 'a "(" is missing before `left`', "write (left")]
    text = PERCEPTS + "concepts ((left ?o) :elements ((object ?o))))"
    assert [each[2] for each in told(text)] == ['a "(" is missing before `concepts`']


def test_forms_whose_mistakes_make_up_for_each_other_are_told_apart():
    text = (
        PERCEPTS + "(concepts\n  ((left ?o) :elements ((object ?o ^x 1)))\n" + "(goals (left o1)))"
    )
    assert [each[:2] for each in told(text)] == [("ICR002", 2), ("ICR003", 4)]


def test_a_domain_with_a_parenthesis_wrong_is_never_used():
    domain, _ = parse_domain(PERCEPTS + "(concepts\n  ((left ?o) :elements ((object ?o)))\n")
    assert domain is None


def test_an_included_file_is_mended_as_well(tmp_path):
    (tmp_path / "parts.icr").write_text("(percepts\n  (object ^x)\n", encoding="utf-8")
    text = '(include "parts.icr")\n(concepts ((left ?o) :elements ((objct ?o))))'
    _, _, found = diagnose_text(text, tmp_path / "d.icr")
    told_of = {(Path(each.path).name, each.code) for each in found}
    assert told_of == {("d.icr", "ICR013"), ("parts.icr", "ICR002")}
