"""The `:goal` and `:plan` of a domain test."""

from __future__ import annotations

from icarus_lite.language import parse_domain
from icarus_lite.testing import CaseOutcome, describe, run_tests

DOMAIN = """\
(percepts (room) (robot) (door))
(skills
  ((go ?r ?from ?to) :elements ((in ?r ?from) (room ?to)) :tests ((/= ?from ?to))
                     :actions ((*go ?r ?to)) :effects ((in ?r ?to) (not (in ?r ?from))))
  ((enter ?r ?room) :elements ((robot ?r) (room ?room) (not (in ?r ?any)))
                    :actions ((*enter ?r)) :effects ((in ?r ?room)))
  ((tour ?r) :elements ((in ?r ?from)) :subskills ((go ?r ?from ?_to)) :effects ((toured ?r))))
"""
ROOMS = ":percepts ((robot r) (room a) (room b))"


def run(body: str) -> CaseOutcome:
    domain, problems = parse_domain(f'{DOMAIN}(test "it" {ROOMS} {body})', "d.icr")
    assert domain is not None, problems
    (outcome,) = run_tests(domain)
    return outcome


def test_a_plan_as_stated_passes() -> None:
    assert run(":goal ((in r b)) :plan ((enter r b))").passed


def test_it_is_made_from_the_last_cycle() -> None:
    assert run(":action (enter r a) :goal (in r b) :plan ((go r a b))").passed
    assert run(":then ((:action (enter r a))) :goal (in r b) :plan ((go r a b))").passed


def test_without_a_plan_stated_any_will_do() -> None:
    assert run(":goal ((in r ?somewhere))").passed


def test_a_goal_that_holds_needs_no_step() -> None:
    assert run(":action (enter r a) :goal ((in r a)) :plan ()").passed
    assert not run(":goal ((in r a)) :plan ()").passed


def test_no_plan_is_a_failure_that_says_why() -> None:
    (difference,) = run(":goal ((in r cellar))").differences
    message = "there is no plan: (in r cellar) speaks of cellar, which is not perceived"
    assert difference.message == message


def test_the_first_step_that_differs_is_marked() -> None:
    outcome = run(":goal ((in r b)) :plan ((enter r a) (go r a b))")
    assert describe(outcome).split("\n") == [
        "d.icr:8:76: :goal (in r b)",
        "    the planner's plan differs from step 1 on",
        "            stated       found",
        "      >   1 (enter r a)  (enter r b)",
        "      >   2 (go r a b)   -",
        "      the stated plan would reach the goal, too",
    ]


def test_a_stated_step_that_cannot_start_is_named_with_what_it_lacks() -> None:
    (difference,) = run(":goal ((in r b)) :plan ((enter r a) (enter r b))").differences
    assert difference.details[-1] == (
        "step 2 of the stated plan cannot start: line 5, (enter ?r ?room): "
        "(not (in r ?any)) fails: (in r a) is believed"
    )


def test_a_stated_plan_that_misses_the_goal_is_told() -> None:
    (difference,) = run(":goal ((in r b)) :plan ((enter r a))").differences
    assert difference.details[-1] == "the stated plan does not reach the goal"
    (difference,) = run(":goal ((in r b)) :plan ()").differences
    assert difference.details[-1] == "the stated plan does not reach the goal"


def test_a_stated_step_that_does_not_act_is_told() -> None:
    (macro,) = run(":goal ((in r b)) :plan ((tour r))").differences
    assert "done through subskills" in macro.details[-1]
    (unknown,) = run(":goal ((in r b)) :plan ((fly r))").differences
    assert "no skill is called `fly`" in unknown.details[-1]
