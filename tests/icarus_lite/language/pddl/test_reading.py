"""PDDL texts: what is understood, and the exact words in which the rest is refused."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from icarus_lite.language import DomainError, render
from icarus_lite.language.pddl import (
    PDDL_CODES,
    import_sources,
    read_pddl_domain,
    read_pddl_problem,
)
from icarus_lite.language.pddl.syntax import And, Fact, PddlDomain, Typed
from icarus_lite.language.syntax import Source

PROBLEMS = Path(__file__).parent / "problems"
HEAD = "(define (domain d) (:types block room - object) (:constants k - room)\n"
PREDICATES = "  (:predicates (on ?a ?b - block) (lit ?r - room) (go) (up ?a))\n"


def errors(text: str) -> list[str]:
    domain, found = read_pddl_domain(Source("d.pddl", text))
    assert (domain is None) == any(each.severity == "error" for each in found)
    return [f"{d.span.line}:{d.span.column} {d.code} {d.message}" for d in found]


def in_domain(section: str) -> list[str]:
    return errors(f"{HEAD}{PREDICATES}  {section})")


def in_action(condition: str = "()", effect: str = "(go)") -> list[str]:
    text = (
        f"(:action a :parameters (?x - block ?r - room) :precondition {condition} :effect {effect})"
    )
    return [each.split(" ", 1)[1] for each in in_domain(text)]


def in_problem(sections: str) -> list[str]:
    domain, _ = read_pddl_domain(Source("d.pddl", f"{HEAD}{PREDICATES})"))
    assert domain is not None
    text = f"(define (problem p) (:domain d) (:objects b - block) {sections})"
    _, found = read_pddl_problem(Source("p.pddl", text), domain)
    return [f"{each.code} {each.message}" for each in found]


def test_case_does_not_matter() -> None:
    domain, _ = read_pddl_domain(Source("", "(DEFINE (Domain D) (:PREDICATES (P ?X)))"))
    assert domain is not None
    assert domain.name == "d"
    assert domain.predicates[0].parameters == (Typed("?x"),)


def test_types_make_a_hierarchy_and_need_not_all_be_declared() -> None:
    domain, _ = read_pddl_domain(Source("", "(define (domain d) (:types van car - vehicle place))"))
    assert domain is not None
    assert domain.types == (
        Typed("van", "vehicle"),
        Typed("car", "vehicle"),
        Typed("place"),
        Typed("vehicle"),
    )


def test_a_message_shows_the_line_and_points_at_the_word() -> None:
    source = Source("d.pddl", f"{HEAD}{PREDICATES}  (:action a :precondition (onn k k)))")
    _, (found,) = read_pddl_domain(source)
    assert render(found, source) == (
        "d.pddl:3:29: error[PDDL008]: no predicate is called `onn`\n"
        "    3 |   (:action a :precondition (onn k k)))\n"
        "      |                             ^^^\n"
        "   hint: did you mean `on`?"
    )


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("", ["0:0 PDDL005 there is nothing to read"]),
        ("; only a comment\n", ["0:0 PDDL005 there is nothing to read"]),
        ("(define (domain d)\n(:types a", ['2:1 PDDL002 this "(" is never closed']),
        ("(define (domain d)))", ['1:20 PDDL003 this ")" closes nothing']),
        ("hello", ["1:1 PDDL006 this word stands outside all parentheses"]),
        ('(define (domain "d"))', ["1:17 PDDL001 this character has no place in PDDL"]),
        (
            "(define (domain d) (:types é))",
            ["1:28 PDDL001 `é` is neither a name, a variable, a keyword nor a number of PDDL"],
        ),
        ("(" * 101 + ")" * 101, ["1:101 PDDL004 parentheses are nested more than 100 deep"]),
        ("(domain d)", ["1:1 PDDL005 this is no PDDL domain"]),
        ("(define (problem p))", ["1:9 PDDL005 this is a problem, where a domain is expected"]),
        ("(define (domain d)) ()", ["1:21 PDDL006 a file holds one (define …)"]),
        ("(define (domain d) what)", ["1:20 PDDL006 `what` is no section"]),
        ("(define (domain d) (:typse a))", ["1:20 PDDL006 there is no section `:typse`"]),
        (
            "(define (domain d) (:types a) (:types b))",
            ["1:31 PDDL011 there are two sections `:types`"],
        ),
        ("(define (domain d) (:types a - b b - a))", ["1:28 PDDL012 the type `a` is above itself"]),
        (
            "(define (domain d) (:types a - b a - c))",
            ["1:34 PDDL011 the type `a` is declared twice"],
        ),
        (
            "(define (domain d) (:constants k - (either a b)))",
            ["1:36 PDDL007 `(either a b)`: a thing has one type here"],
        ),
        (
            "(define (domain d) (:constants k - tpye))",
            ["1:36 PDDL008 no type is called `tpye`"],
        ),
        ("(define (domain d) (:constants k k))", ["1:34 PDDL011 `k` is declared twice"]),
        (
            "(define (domain d) (:constants ?k))",
            ["1:32 PDDL006 expected a name, not a variable, but found `?k`"],
        ),
        (
            "(define (domain d) (:predicates (p) (p)))",
            ["1:38 PDDL011 the predicate `p` is declared twice"],
        ),
    ],
)
def test_a_text_that_is_no_domain(text: str, found: list[str]) -> None:
    assert errors(text) == found


@pytest.mark.parametrize(
    ("section", "message"),
    [
        ("(:durative-action a)", "`:durative-action` is an action that takes time"),
        ("(:process a)", "`:process` is a continuous process"),
        ("(:constraints (always (go)))", "`:constraints` is a constraint on the way to the goal"),
        ("(:method m)", "`:method` is a method of a hierarchy"),
    ],
)
def test_sections_without_counterpart_are_named(section: str, message: str) -> None:
    assert in_domain(section) == [f"3:4 PDDL007 {message}, which has no counterpart here"]


@pytest.mark.parametrize(
    ("condition", "message"),
    [
        ("(on ?x)", "PDDL009 `on` takes 2 arguments, not 1"),
        ("(go ?x)", "PDDL009 `go` takes 0 arguments, not 1"),
        ("(on ?x ?z)", "PDDL008 there is no variable `?z` here"),
        ("(lit kk)", "PDDL008 there is no object `kk` here"),
        ("(lit ?x)", "PDDL010 `?x` is a block, but `lit` takes a room here"),
        ("(not (go) (go))", "PDDL006 `not` takes exactly one condition"),
        ("(exists ?z (go))", "PDDL006 `exists` has a list of variables and one condition"),
        ("(= ?x)", "PDDL006 `=` compares two: (= ?x ?y)"),
        ("(= (height ?x) 3)", "PDDL007 `=` is a numeric condition here, which has no counterpart"),
        ("(> (height ?x) 3)", "PDDL007 `>` is a numeric condition, which has no counterpart here"),
        ("(imply (go) (go))", "PDDL007 `imply` is an implication, which has no counterpart here"),
        (
            "(forall (?z - block) (up ?z))",
            "PDDL007 `forall` is a condition over all objects, which has no counterpart here",
        ),
        (
            "(preference p (go))",
            "PDDL007 `preference` is a preference, which has no counterpart here",
        ),
        ("go", "PDDL006 `go` is no condition"),
        ("((go))", "PDDL006 a condition begins with a predicate: (on ?x ?y)"),
        (
            "(up (f ?x))",
            "PDDL007 `(f …)` stands where a variable or an object is expected",
        ),
    ],
)
def test_conditions_that_are_refused(condition: str, message: str) -> None:
    assert in_action(condition) == [message]


@pytest.mark.parametrize(
    ("effect", "message"),
    [
        (
            "(when (go) (up ?x))",
            "PDDL007 `when` is a conditional effect, which has no counterpart here",
        ),
        (
            "(increase (fuel ?x) 1)",
            "PDDL007 `increase` is a numeric effect, which has no counterpart here",
        ),
        (
            "(forall (?z - block) (up ?z))",
            "PDDL007 an effect on all objects can only remove: (forall (?z) (not (on ?x ?z)))",
        ),
        (
            "(forall (?z - block) (not (up ?z)))",
            "PDDL007 this removes only where ?z is a block",
        ),
        ("(forall (?z - block) (not (go)))", "PDDL007 ?z does not occur in (go …)"),
        (
            "(or (go) (up ?x))",
            "PDDL006 `or` cannot stand here: an effect is a predicate or its negation",
        ),
        ("(lit ?x)", "PDDL010 `?x` is a block, but `lit` takes a room here"),
    ],
)
def test_effects_that_are_refused(effect: str, message: str) -> None:
    assert in_action(effect=effect) == [message]


def test_costs_are_left_out_with_one_note() -> None:
    found = in_action(effect="(and (go) (increase (total-cost) 2) (increase (total-cost) 3))")
    assert found == ["PDDL013 action costs are left out: a plan is judged by its number of steps"]


def test_mistakes_in_different_actions_are_told_at_once() -> None:
    found = in_domain("(:action a :effect (gone)) (:action b :effect (gon)) (:action c :what (go))")
    assert [each.split()[1] for each in found] == ["PDDL008", "PDDL008", "PDDL006"]


@pytest.mark.parametrize(
    ("section", "message"),
    [
        ("(:action a :effect (go)) (:action a)", "3:28 PDDL011 there are two actions `a`"),
        ("(:action)", "3:3 PDDL006 an action begins with its name: (:action move :parameters …)"),
        ("(:action a :effect)", "3:14 PDDL006 `:effect` is no field of an action, or has no value"),
        ("(:action a :parameters ?x)", "3:26 PDDL006 parameters are a list: (?x ?y - block)"),
        ("(:derived (go))", "3:3 PDDL006 a derived predicate has a head and one condition"),
        (
            "(:derived (up ?x) (go)) (:action a :parameters (?x) :effect (up ?x))",
            "3:63 PDDL015 `up` is derived, and an effect cannot state it",
        ),
        (
            "(:derived (lit ?b - block) (go))",
            "3:18 PDDL010 ?b is a block here, but a room in (:predicates …)",
        ),
    ],
)
def test_actions_and_rules_of_the_wrong_shape(section: str, message: str) -> None:
    assert in_domain(section) == [message]


@pytest.mark.parametrize(
    ("sections", "message"),
    [
        ("(:init (go))", "PDDL011 the problem has no goal"),
        ("(:init (goo)) (:goal (go))", "PDDL008 no predicate is called `goo`"),
        ("(:init (up c)) (:goal (go))", "PDDL008 there is no object `c` here"),
        (
            "(:init (lit b)) (:goal (go))",
            "PDDL010 `b` is a block, but `lit` takes a room here",
        ),
        (
            "(:init (at 5 (go))) (:goal (go))",
            "PDDL007 a fact that comes true at a later time has no counterpart here",
        ),
        ("(:goal (go) (go))", "PDDL006 a goal is one condition"),
        ("(:goal (up ?x))", "PDDL008 there is no variable `?x` here"),
    ],
)
def test_problems_that_are_refused(sections: str, message: str) -> None:
    assert in_problem(sections) == [message]


def test_a_problem_for_another_domain_is_refused() -> None:
    problem = Source("p.pddl", "(define (problem p) (:domain e) (:init) (:goal (and)))")
    _, found = read_pddl_problem(problem, PddlDomain("d"))
    assert [f"{d.code} {d.message}" for d in found] == [
        "PDDL005 the problem is for the domain `e`, not for `d`"
    ]


def test_facts_that_are_false_anyway_may_be_stated() -> None:
    problem = Source(
        "p.pddl",
        "(define (problem p) (:domain d) (:init (go) (go) (not (up k)) (= (total-cost) 0))"
        " (:goal (and (go))))",
    )
    domain, _ = read_pddl_domain(Source("d.pddl", f"{HEAD}{PREDICATES})"))
    assert domain is not None
    read, _ = read_pddl_problem(problem, domain)
    assert read is not None
    assert read.init == (Fact("go"),)
    assert read.goal == And((Fact("go"),))


def test_every_code_has_a_sentence() -> None:
    assert all(text.endswith(".") for text in PDDL_CODES.values())


def attempt(domain: str, problem: str) -> None:
    """Import, and let nothing but a DomainError with a code come out."""
    message = "PDDL0"
    try:
        import_sources(Source("d.pddl", domain), Source("p.pddl", problem))
    except DomainError as error:
        message = str(error)
    assert "PDDL0" in message


DOMAIN_TEXT = (PROBLEMS / "shelves.pddl").read_text()
PROBLEM_TEXT = (PROBLEMS / "shelves-3.pddl").read_text()
WORDS = """( ) - ?x ?y and or not exists forall when = either object define domain problem :types
:init :goal :derived :action :parameters on crate spot a b 3 ; \0 é"""
PIECES = st.sampled_from(WORDS.split())


@settings(max_examples=150)
@given(st.lists(PIECES, max_size=40).map(" ".join))
def test_any_words_give_diagnostics(text: str) -> None:
    attempt(text, text)
    attempt(f"(define (domain d) {text})", PROBLEM_TEXT)
    attempt(DOMAIN_TEXT, f"(define (problem p) (:domain shelves) {text})")


@settings(max_examples=100)
@given(st.text(max_size=60))
def test_any_text_gives_diagnostics(text: str) -> None:
    attempt(text, text)


@settings(max_examples=150)
@given(st.data())
def test_any_mutation_of_a_problem_gives_diagnostics(data: st.DataObject) -> None:
    words = DOMAIN_TEXT.replace("(", " ( ").replace(")", " ) ").split()
    for _ in range(data.draw(st.integers(1, 3))):
        place = data.draw(st.integers(0, len(words) - 1))
        match data.draw(st.integers(0, 2)):
            case 0:
                del words[place]
            case 1:
                words.insert(place, data.draw(PIECES))
            case _:
                words[place] = data.draw(st.sampled_from(words))
    attempt(" ".join(words), PROBLEM_TEXT)


def test_a_predicate_may_be_declared_of_either_of_two_types():
    text = (
        "(define (domain d) (:types person plane - movable city movable - object)"
        " (:predicates (at ?x - (either person plane) ?c - city) (in ?y - (either plane city))))"
    )
    domain, found = read_pddl_domain(Source("d.pddl", text))
    assert domain is not None
    assert not found
    assert [[each.type for each in p.parameters] for p in domain.predicates] == [
        ["movable", "city"],
        ["object"],
    ]


def test_an_action_may_not_be_about_either_of_two_types():
    text = (
        "(define (domain d) (:types a b) (:action do :parameters (?x - (either a b)) :effect ()))"
    )
    domain, found = read_pddl_domain(Source("d.pddl", text))
    assert domain is None
    assert [each.code for each in found] == ["PDDL007"]
