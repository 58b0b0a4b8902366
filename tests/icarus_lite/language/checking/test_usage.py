from __future__ import annotations

import pytest

from icarus_lite.language import check_domain, parse_domain, render

PERCEPTS = "(percepts (object ^x) (part :is object))\n"


def unused(text):
    domain, problems = parse_domain(PERCEPTS + text, "d.icr")
    assert domain is not None, problems
    found = check_domain(domain, thorough=True)
    return [each.message for each in found if each.code == "ICR040"]


CONCEPT = "(concepts ((p ?o) :elements ((part ?o))))"


def test_a_concept_that_only_uses_itself_is_not_used():
    text = "(concepts ((p ?o) :elements ((object ?o))) ((p ?o) :elements ((p ?o) (object ?o))))"
    assert unused(text) == ["nothing uses the concept `p`"]


@pytest.mark.parametrize(
    "user",
    [
        "(concepts ((q ?o) :elements ((p ?o)))) (goals (q a))",
        "(skills ((go ?o) :elements ((p ?o)) :actions ((*go ?o))))",
        "(skills ((go ?o) :elements ((part ?o)) :while ((p ?o)) :actions ((*go ?o))))",
        "(goals (p a))",
        "(task 1 :goal ((p a)))",
        '(test "t" :expect ((p a)))',
        '(test "t" :then ((:expect-not ((p a)))))',
        "(long-term-goal g :goal (a) :relevance (p a)) (concepts ((a) :elements ((part ?_o))))",
        "(break (p ?o))",
    ],
)
def test_whoever_asks_for_a_concept_uses_it(user):
    assert unused(f"{CONCEPT} {user}") == []


def test_a_percept_type_is_used_through_its_super_and_subtypes():
    assert unused("(goals (object a))") == []
    assert unused("(goals (part a))") == []
    assert unused("(percepts (lamp)) (goals (part a))") == ["nothing uses the percept type `lamp`"]


def test_an_effect_nobody_asks_for_is_told_once_and_by_name():
    text = """(skills ((go ?o) :elements ((part ?o)) :actions ((*go ?o)) :effects ((at ?o)))
      ((leave ?o) :elements ((part ?o)) :actions ((*go ?o)) :effects ((not (at ?o)))))"""
    domain, _ = parse_domain(PERCEPTS + text, "d.icr")
    (found,) = check_domain(domain, thorough=True)
    assert render(found, domain.source) == (
        "d.icr:2:71: note[ICR040]: nothing asks for `at`, which this effect speaks of\n"
        "    2 | (skills ((go ?o) :elements ((part ?o)) :actions ((*go ?o)) :effects ((at ?o)))\n"
        f"      |{' ' * 71}^^\n"
        "   hint: remove it, or leave it for those who ask: `; noqa: ICR040` silences this"
    )
    assert unused(text + " (goals (at a))") == []


def test_nothing_is_said_of_use_while_there_are_errors():
    assert unused(f"{CONCEPT} (goals (q a))") == []
