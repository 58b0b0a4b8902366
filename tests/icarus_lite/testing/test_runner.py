"""Domain tests: what they state against what the engine believes."""

from __future__ import annotations

import pytest

from icarus_lite.language import parse_domain
from icarus_lite.testing import CaseOutcome, Kind, describe, run_tests

DOMAIN = """\
(domain d)
(percepts (hand ^x) (object ^type ^x))
(concepts
  ((free ?h) :elements ((hand ?h) (not (holding ?h ?any))))
  ((near ?a ?b)
   :elements ((object ?a ^x ?x) (object ?b ^x ?y))
   :tests ((/= ?a ?b) (< (distance ?x ?y) 0.1)))
  ((gap ?a ?b ^size ?d)
   :elements ((object ?a ^x ?x) (object ?b ^x ?y)) :tests ((< ?x ?y)) :binds ((?d (- ?y ?x)))))
(skills
  ((grab ?h ?o) :elements ((free ?h) (object ?o)) :actions ((*grasp ?h ?o))
                :effects ((holding ?h ?o)))
  ((drop ?h ?o) :elements ((holding ?h ?o)) :actions ((*open ?h ?o))
                :effects ((not (holding ?h ?o)))))
(attachments ((grab ?h ?o) :until (drop ?h ?o) :child ?o :parent ?h))
"""
SCENE = "(hand h1 ^x 0) (object a ^type plug ^x 0.25) (object b ^type case ^x 0.5)"


def run(body: str, percepts: str = SCENE) -> CaseOutcome:
    domain, problems = parse_domain(f'{DOMAIN}(test "it" :percepts ({percepts})\n{body})', "d.icr")
    assert domain is not None, problems
    (outcome,) = run_tests(domain)
    assert outcome.passed == (not outcome.differences)
    return outcome


@pytest.mark.parametrize(
    "body",
    [
        ":init ((holding h1 a) (attached b a)) :expect ((holding h1 a)) :expect-not ((free h1))",
        ":init ((holding h1 a) (attached b a)) :action (drop h1 a) :expect ((attached b a))",
        ":init ((holding h1 a)) :goal ((holding h1 b)) :plan ((drop h1 a) (grab h1 b))",
        ":expect ((free h1)) :expect-not ((near a b))",
        ":expect ((object ?o ^type plug) (free ?_))",
        ":expect ((gap a b ^size 0.25)) :expect-not ((gap a b ^size 0.3) (gap b a))",
        ":action (grab h1 a) :expect ((holding h1 a) (attached a h1)) :expect-not ((free h1))",
        ":action ((grab h1 a) (drop h1 a)) :expect ((free h1)) :expect-not ((attached a ?any))",
        "",
    ],
)
def test_what_is_as_stated_passes(body: str) -> None:
    assert run(body).passed


@pytest.mark.parametrize(
    ("body", "kind", "message"),
    [
        (":expect ((near a b))", Kind.MISSING, "it is not believed"),
        (":expect ((near a ?o))", Kind.MISSING, "nothing believed matches it"),
        (":expect ((gap a b ^size 0.3))", Kind.MISSING, "it is not believed"),
        (":expect-not ((free ?h))", Kind.UNEXPECTED, "(free h1) is believed"),
        (":expect-not ((object a))", Kind.UNEXPECTED, "(object a) is believed"),
    ],
)
def test_what_is_otherwise_fails(body: str, kind: Kind, message: str) -> None:
    (difference,) = run(body).differences
    assert (difference.kind, difference.message) == (kind, message)


def test_every_difference_is_told_not_only_the_first() -> None:
    outcome = run(":expect ((near a b) (holding h1 a)) :expect-not ((free h1))")
    assert [d.kind for d in outcome.differences] == [Kind.MISSING, Kind.MISSING, Kind.UNEXPECTED]


def test_a_missing_belief_comes_with_what_each_clause_lacks() -> None:
    (difference,) = run(":expect ((near a b))").differences
    assert difference.details == (
        "nothing at all is believed of `near`",
        "line 5, (near ?a ?b): (< (distance 0.25 0.5) 0.1) is not so",
    )


def test_a_missing_belief_comes_with_its_neighbours_attributes_included() -> None:
    (difference,) = run(":expect ((gap a b ^size 0.3))").differences
    assert difference.details == (
        "nearest: (gap a b ^size 0.25)",
        "line 8, (gap ?a ?b ^size ?d): (= (- 0.5 0.25) 0.3) is not so",
    )


def test_a_missing_effect_names_the_skills_that_assert_it() -> None:
    holding, attached = run(":expect ((holding h1 a) (attached a h1))").differences
    assert holding.details[-1] == "line 11, the success of (grab ?h ?o) would assert it"
    assert attached.details[-1] == "line 15, the success of (grab ?h ?o) would assert it"


def test_an_unexpected_belief_is_explained() -> None:
    (difference,) = run(":expect-not ((free ?h))").differences
    assert difference.details == (
        "(free h1)  by its definition (line 4)",
        "  (hand h1 ^x 0)  is perceived",
        "  (not (holding h1 ?any))  nothing like it is believed",
    )


class TestLaterCycles:
    def test_memory_is_kept_from_cycle_to_cycle(self) -> None:
        later = ":then ((:expect ((holding h1 a))) (:action (drop h1 a) :expect ((free h1))))"
        assert run(f":action (grab h1 a) {later}").passed

    def test_percepts_not_stated_stay_as_they_were(self) -> None:
        assert run(":then ((:expect ((object a))))").passed

    def test_percepts_stated_replace_all_others(self) -> None:
        later = ":then ((:percepts ((hand h1 ^x 0)) :expect ((free h1)) :expect-not ((object ?o))))"
        assert run(f":action (grab h1 a) {later}").passed

    def test_no_percepts_are_percepts_too(self) -> None:
        assert run(":then ((:percepts () :expect-not ((hand ?h) (object ?o))))").passed

    def test_a_difference_tells_its_cycle(self) -> None:
        outcome = run(":then (() (:expect ((holding h1 a))))")
        assert [d.cycle for d in outcome.differences] == [2]
        assert ":expect (holding h1 a) in cycle 2 of the test" in describe(outcome)


def test_two_percepts_of_one_name_fail_the_test_in_words() -> None:
    (difference,) = run("", "(hand h1) (hand h1)").differences
    assert difference.kind is Kind.ERROR
    assert difference.message == "2 percepts of type hand are named h1; names are unique"


def test_a_test_that_cannot_be_evaluated_fails_the_test_with_its_place() -> None:
    outcome = run(":expect ((free h1))", "(hand h1) (object a ^x 0) (object b ^x left)")
    (difference,) = outcome.differences
    assert difference.kind is Kind.ERROR
    assert difference.message.startswith("d.icr:7:")


def test_without_declared_percepts_a_percept_still_has_one_name() -> None:
    domain, _ = parse_domain(
        '(concepts ((two ?a) :elements ((thing ?a)))) (test "it" :percepts ((thing a b)))'
    )
    assert domain is not None
    (outcome,) = run_tests(domain)
    assert [d.kind for d in outcome.differences] == [Kind.ERROR]
    assert "one name" in outcome.differences[0].message


def test_what_the_engine_refuses_is_told_with_the_failure() -> None:
    domain, problems = parse_domain(
        "(percepts (box)) (skills ((put ?a ?b) :elements ((box ?a) (box ?b)) :actions ((*put ?a))))"
        "(attachments ((put ?a ?b) :child ?a :parent ?b))"
        '(test "it" :percepts ((box a) (box b)) :action ((put a b) (put b a))'
        " :expect ((attached b a)))"
    )
    assert domain is not None, problems
    (outcome,) = run_tests(domain)
    assert "note: refused: (put b a) would attach b to a" in describe(outcome)


def test_python_functions_can_be_called() -> None:
    domain, _ = parse_domain(
        "(percepts (o ^x)) (concepts ((even ?o) :elements ((o ?o ^x ?x)) :tests ((is-even ?x))))"
        '(test "it" :percepts ((o a ^x 2) (o b ^x 3)) :expect ((even a)) :expect-not ((even b)))'
    )
    assert domain is not None
    (outcome,) = run_tests(domain, {"is-even": lambda x: x % 2 == 0})
    assert outcome.passed
