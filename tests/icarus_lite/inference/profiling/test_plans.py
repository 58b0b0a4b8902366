"""The plan of a clause in words: every condition and test in it, once, in the order joined."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest

from icarus_lite import load_domain
from icarus_lite.inference.network import compile_domain
from icarus_lite.inference.profiling import rule_plans
from icarus_lite.language import parse_domain

DOMAINS = sorted((Path(__file__).parents[4] / "domains").glob("*.icr"))

TEXT = """(percepts (object ^type ^x ^y) (hand))
(concepts
  ((near ?a ?b) :elements ((object ?a ^x ?xa) (object ?b ^x ?xb))
                :tests ((/= ?a ?b) (< (abs (- ?xa ?xb)) 0.1)))
  ((free ?h) :elements ((hand ?h) (not (holding ?h ?any))))
  ((stacked ?a ?c) :elements ((on ?a ?c)))
  ((stacked ?a ?c) :elements ((on ?a ?b) (stacked ?b ?c)))
  ((wanted ?a ?b) :elements ((near ?a ?b) (object ?b ^type plug ^y ?y) (not (on ?_c ?b)))
                  :tests ((> ?y 3)))
  ((always))
  ((busy ?a ?b) :elements ((on ?a ?b) (on ?_c ?a) (free ?a))))
(skills ((stack ?a ?b) :elements ((object ?a) (object ?b)) :actions ((*stack ?a ?b))
                       :effects ((on ?a ?b))))
"""
DOMAIN, PROBLEMS = parse_domain(TEXT, "cell.icr")
assert DOMAIN is not None, PROBLEMS
COMPILED = compile_domain(DOMAIN)
PLANS = rule_plans(COMPILED)


def test_a_pair_rule_is_one_step_that_a_kernel_carries_out() -> None:
    plan = PLANS[0]
    (step,) = plan.steps
    assert plan.place == "cell.icr:3"
    assert step.how == "all pairs in its numeric kernel"
    assert "bounded by 0.1" in plan.kernel
    assert [*map(str, step.atoms)] == ["(object ?a ^x ?xa)", "(object ?b ^x ?xb)"]
    assert {*map(str, step.tests)} == {"(/= ?a ?b)", "(< (abs (- ?xa ?xb)) 0.1)"}
    assert plan.kept.startswith("a numeric kernel keeps its pairs")


def test_an_absence_is_asked_as_soon_as_it_can_be() -> None:
    objects, absence = PLANS[1].steps
    assert (objects.how, objects.why) == ("all of them", "fewest rows to begin with")
    assert absence.negated
    assert absence.what == "(not (holding ?h ?any))"
    assert absence.how == "by ?h, through a hash index on argument 1"


def test_a_recursive_concept_says_how_it_is_kept() -> None:
    assert PLANS[2].kept.startswith("recursive")
    first, second = PLANS[3].steps
    assert second.how == "by ?b, through a hash index on argument 1"
    assert (second.why, second.expected) == ("fewest further rows", 1.0)
    assert first.expected == 20


def test_what_can_only_lose_rows_comes_before_what_adds_some() -> None:
    steps = PLANS[6].steps
    assert [each.what for each in steps] == ["(on ?a ?b)", "(free ?a)", "(on ?_c ?a)"]
    assert [each.why for each in steps][1] == "it can only lose rows"


def test_each_condition_has_its_own_join_for_changes() -> None:
    assert [(each.lead, [s.what for s in each.steps]) for each in PLANS[1].updates] == [
        ("(hand ?h)", ["(not (holding ?h ?any))"]),
        ("(not (holding ?h ?any))", ["(hand ?h)"]),
    ]
    assert PLANS[0].updates == ()  # its kernel follows the objects themselves


def test_a_clause_without_conditions_has_no_steps() -> None:
    assert PLANS[5].steps == ()


@pytest.mark.parametrize("path", DOMAINS, ids=lambda path: path.stem)
def test_every_condition_and_test_of_every_clause_stands_in_its_plan(path: Path) -> None:
    for plan in rule_plans(compile_domain(load_domain(path))):
        stated = Counter(str(each.atom) for each in plan.clause.elements)
        planned = Counter(str(atom) for step in plan.steps for atom in step.atoms)
        assert set(stated) <= set(planned)
        tests = Counter(str(test) for step in plan.steps for test in step.tests)
        assert tests == Counter(map(str, plan.clause.tests)), plan.place
