from __future__ import annotations

import pytest

from icarus_lite.inference.explaining.fitting import fit
from icarus_lite.language import parse_atom, parse_domain
from icarus_lite.language.syntax import Bind, Call, Constant, Variable

GAP = Bind(Variable("?d"), Call("-", (Variable("?x"), Variable("?y"))))
HALF = Bind(Variable("?h"), Call("/", (Variable("?d"), Constant(2))))


def demands(head: str, asked: str, *binds: Bind) -> list[str] | None:
    found = fit(parse_atom(head), parse_atom(asked), binds)
    return None if found is None else [*map(str, found.demands)]


@pytest.mark.parametrize(
    ("head", "asked"),
    [
        ("(p ?a)", "(q a)"),
        ("(p ?a)", "(p a b)"),
        ("(p a)", "(p b)"),
        ("(p ?a ?a)", "(p a b)"),
        ("(p a b)", "(p ?x ?x)"),
        ("(p ?a ^size ?s)", "(p a ^color red)"),
        ("(p ?a ^size 1)", "(p a ^size 2)"),
    ],
)
def test_heads_that_can_never_stand_for_it(head: str, asked: str) -> None:
    assert demands(head, asked) is None


def test_constants_bind_the_variables_of_the_head() -> None:
    found = fit(parse_atom("(p ?a ?b ^size ?s)"), parse_atom("(p a ?x ^size 3)"))
    assert found is not None
    assert (found.bindings, found.demands) == ({"?a": "a", "?s": 3}, ())


def test_a_variable_asked_for_twice_demands_that_two_agree() -> None:
    assert demands("(p ?a ?b ?c)", "(p ?x ?y ?x)") == ["(= ?a ?c)"]
    assert demands("(p ?a ?a)", "(p ?x ?x)") == []


def test_a_variable_asked_for_twice_takes_over_a_constant_of_the_head() -> None:
    found = fit(parse_atom("(p ?a nobody)"), parse_atom("(p ?x ?x)"))
    assert found is not None
    assert found.bindings == {"?a": "nobody"}


def test_its_own_names_mean_nothing_to_the_head() -> None:
    found = fit(parse_atom("(p ?a ?b)"), parse_atom("(p ?b c)"))
    assert found is not None
    assert found.bindings == {"?b": "c"}


def test_a_computed_attribute_is_demanded_by_what_computes_it() -> None:
    assert demands("(p ?a ^gap ?d)", "(p a ^gap 3)", GAP) == ["(= (- ?x ?y) 3)"]
    assert demands("(p ?a ^half ?h)", "(p a ^half 3)", GAP, HALF) == ["(= (/ (- ?x ?y) 2) 3)"]
    assert demands("(p ?d ?h)", "(p ?x ?x)", GAP, HALF) == ["(= (- ?x ?y) (/ (- ?x ?y) 2))"]


def test_the_text_of_a_domain_gives_such_binds() -> None:
    domain, problems = parse_domain(
        "(percepts (o ^x)) (concepts ((p ?a ^d ?d) :elements ((o ?a ^x ?x))"
        " :binds ((?d (* 2 ?x)))))"
    )
    assert domain is not None, problems
    (clause,) = domain.concepts
    found = fit(clause.head, parse_atom("(p ?q ^d 4)"), clause.binds)
    assert found is not None
    assert [*map(str, found.demands)] == ["(= (* 2 ?x) 4)"]
