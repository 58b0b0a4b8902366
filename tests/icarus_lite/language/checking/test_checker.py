from __future__ import annotations

from pathlib import Path

import pytest

from icarus_lite.errors import InferenceError
from icarus_lite.language import Severity, check_domain, parse_domain
from icarus_lite.language.syntax import Atom, ConceptClause, Condition, Domain, Variable

DOMAINS = Path(__file__).parents[4] / "domains"
PERCEPTS = "(percepts (object ^type ^x ^y) (hand ^x))\n"


def findings(text, functions=None):
    domain, problems = parse_domain(text, "d.icr")
    assert domain is not None, problems
    return check_domain(domain, functions)


def codes(text, functions=None):
    return [found.code for found in findings(text, functions)]


def concept(body):
    return f"{PERCEPTS}(concepts ((p ?o) {body}))"


def skill(body, head="(go ?h)"):
    return f"{PERCEPTS}(skills ({head} {body}))"


@pytest.mark.parametrize(
    "text",
    [
        concept(":elements ((object ?o ^x ?x)) :tests ((< ?x 1))"),
        concept(":elements ((object ?o) (not (attached ?o ?any)) (not (attached ?_x ?o)))"),
        concept(":elements ((object ?o ^x ?_x))"),
        f"{PERCEPTS}(concepts ((none) :elements ((not (object ?any)))))",
        # binds see earlier binds, and give attributes
        PERCEPTS
        + """(concepts
        ((wide ?o ^w ?w)
         :elements ((object ?o ^x ?a ^y ?b))
         :binds ((?d (- ?a ?b)) (?w (abs ?d))))
        ((q ?o) :elements ((wide ?o ^w 3))))""",
        f"{PERCEPTS}(concepts ((at ?o ?w) :elements ((object ?o ^x ?a)) :binds ((?w (+ ?a 1)))))",
        skill(":elements ((hand ?h)) :actions ((*go ?h)) :effects ((at ?h) (not (at ?any)))"),
        # a macro's calls may bind variables and pass them back
        PERCEPTS
        + """(skills
        ((go ?h) :elements ((hand ?h)) :actions ((*go ?h)) :effects ((at ?h ?h)))
        ((tour ?h) :subskills ((go ?t)) :effects ((at ?h ?t))))""",
        # observed actions need no skills
        "(attachments ((contain ?c ?o) :until (move ?c) :child ?o :parent ?c))",
        f"{PERCEPTS}(concepts ((attached ?o ?h) :elements ((object ?o ^x ?x) (hand ?h ^x ?x))))",
        f'{PERCEPTS}(test "t" :percepts ((object o1 ^x 1)) :expect ((attached o1 ?what)))',
    ],
)
def test_sound_domains_have_nothing_said_about_them(text):
    assert codes(text) == []


def test_the_gearbox_domain_has_nothing_said_about_it():
    assert codes((DOMAINS / "gearbox.icr").read_text(encoding="utf-8")) == []


def test_everything_is_found_in_one_go():
    text = f"""{PERCEPTS}
    (concepts ((p ?o ?q) :elements ((objct ?o)) :tests ((foo ?x))))
    (skills ((go)))
    (task 1)"""
    assert codes(text) == ["ICR012", "ICR013", "ICR016", "ICR012", "ICR022", "ICR021"]


def test_a_test_does_not_make_a_predicate_known():
    text = f'{PERCEPTS}(test "t" :expect ((shiny o1)))\n(goals (shiny o1))'
    assert codes(text) == ["ICR013", "ICR013"]


def test_a_removing_effect_does_not_make_a_predicate_known():
    assert codes(skill(":actions ((*go)) :effects ((not (at home)))", "(go)")) == ["ICR013"]


def test_python_functions_are_known_with_their_arity():
    text = concept(":elements ((object ?o ^x ?x)) :tests ((sharp ?x) (sharp ?x ?x))")
    assert codes(text) == ["ICR016", "ICR016"]
    assert codes(text, {"sharp": lambda x: x > 3}) == ["ICR017"]
    with pytest.raises(InferenceError):
        findings(text, {"<": lambda a, b: a < b})


def test_a_domain_without_percept_types_says_what_it_takes_for_one():
    found = findings("(concepts ((p ?o) :elements ((objct ?o ^x 1) (object ?o ^x 1) (object ?o))))")
    assert [(each.code, each.severity) for each in found] == [("ICR027", Severity.WARNING)] * 2


def test_older_domains_may_name_a_concept_like_its_percept():
    text = "(concepts ((block ?b) :elements ((block ?b ^x 1))) ((q ?b) :elements ((block ?b))))"
    assert codes(text) == ["ICR027"]


def test_known_arity_is_watched_without_percept_types_as_well():
    assert codes("(concepts ((p)) ((q) :elements ((p a))))") == ["ICR014"]


@pytest.mark.parametrize(
    ("code", "severity"),
    [("ICR029", Severity.WARNING), ("ICR030", Severity.NOTE)],
)
def test_only_real_errors_are_errors(code, severity):
    text = concept(":elements ((object ?o ^x ?x) (not (object ?o ^type ?y)))")
    assert {each.code: each.severity for each in findings(text)}[code] is severity


def test_a_variable_shared_by_two_elements_is_not_alone():
    assert (
        codes(concept(":elements ((object ?o ^x ?x) (hand ?h ^x ?x) (not (attached ?o ?h)))")) == []
    )


def test_a_clause_without_place_is_checked_too():
    clause = ConceptClause(
        Atom("p", (Variable("?x"),)),
        (Condition(Atom("q", (Variable("?y"),), (("a", Variable("?z")),))),),
    )
    found = check_domain(Domain("made", concepts=(clause,)))
    assert {each.code for each in found} == {"ICR012", "ICR027", "ICR029"}


def test_the_order_is_that_of_the_text():
    found = findings((DOMAINS / "gearbox.icr").read_text(encoding="utf-8").replace("?xa", "?q"))
    places = [(each.span.line, each.span.column) for each in found]
    assert places == sorted(places)
    assert "ICR029" not in {each.code for each in found}
