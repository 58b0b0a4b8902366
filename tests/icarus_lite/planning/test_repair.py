"""What still works of a plan: kept for another reason, begun later, begun earlier, thinned out."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from icarus_lite import Action, Percept, load_domain
from icarus_lite.inference import InferenceEngine, given_memory, given_percepts
from icarus_lite.language.fragments import parse_conditions
from icarus_lite.language.reading.reader import parse_domain
from icarus_lite.planning import (
    Imagination,
    Plan,
    find_plan,
    later_start,
    project,
    sparse_rest,
    unmet,
    validate,
    with_links,
    working_rest,
)

DOMAINS = Path(__file__).resolve().parents[3] / "domains"

WALK = """
(percepts (place))
(skills
  ((walk ?from ?to) :elements ((at ?from) (path ?from ?to)) :actions ((*walk ?to))
                    :effects ((at ?to) (not (at ?from))))
  ((ride ?from ?to) :elements ((at ?from) (bus ?from ?to)) :actions ((*ride ?to))
                    :effects ((at ?to) (not (at ?from))))
  ((buy ?what ?place) :elements ((at ?place) (sold ?what ?place)) :actions ((*buy ?what))
                      :effects ((have ?what))))
"""
WORLD = "(path home a) (path a b) (path b c) (path c home) (sold milk a) (sold bread b)"


@cache
def engine_of(text: str) -> InferenceEngine:
    domain, problems = parse_domain(text)
    assert domain is not None, problems
    return InferenceEngine(domain)


def imagine(facts: str, text: str = WALK) -> Imagination:
    engine = engine_of(text)
    atoms = [c.atom for c in parse_conditions(f"({facts})")]
    memory = engine.step(given_memory(engine.domain, atoms), given_percepts(engine.domain, atoms))
    return Imagination(engine.domain, memory, engine.closure, engine.evaluator)


def planned(facts: str, goal: str) -> Plan:
    imagination, goals = imagine(facts), parse_conditions(goal)
    found = find_plan(engine_of(WALK).domain, imagination, goals)
    assert isinstance(found, Plan), found
    return with_links(imagination, found, project(imagination, found.steps, goals))


def steps(plan: Plan) -> list[str]:
    return [str(step.action) for step in plan.steps]


SHOPPING = planned(f"(at home) {WORLD}", "((have milk) (have bread) (at c))")


def test_the_plan_that_the_others_are_about() -> None:
    assert steps(SHOPPING) == [
        "(walk home a)",
        "(buy milk a)",
        "(walk a b)",
        "(buy bread b)",
        "(walk b c)",
    ]
    assert [str(r) for r in SHOPPING.required(3)] == [
        "(at b)",
        "(sold bread b)",
        "(path b c)",
        "(have milk)",
    ]


def test_a_later_step_is_found_to_be_possible_only_if_nothing_before_it_is_needed() -> None:
    helped = imagine(f"(at b) (have milk) {WORLD}")
    rest = later_start(helped, SHOPPING, 0)
    assert rest is not None
    assert (rest.start, rest.position, rest.plan.steps) == (3, 3, SHOPPING.steps)
    carried = imagine(f"(at b) {WORLD}")  # but the milk is still to be bought
    assert later_start(carried, SHOPPING, 0) is None


def test_what_has_been_undone_is_done_once_more() -> None:
    back = imagine(f"(at home) {WORLD}")
    assert [str(r) for r in unmet(SHOPPING, 2, back.now)] == ["(at a)", "(have milk)"]
    rest = working_rest(back, SHOPPING)
    assert rest is not None
    assert (rest.start, rest.position) == (0, 0)


def test_a_rest_that_works_for_other_reasons_gets_links_of_its_own() -> None:
    text = """
    (percepts (cup))
    (concepts ((fit ?c) :elements ((washed ?c))) ((fit ?c) :elements ((new ?c))))
    (skills
      ((wash ?c) :elements ((cup ?c)) :actions ((*wash ?c)) :effects ((washed ?c)))
      ((pour ?c) :elements ((fit ?c)) :actions ((*pour ?c)) :effects ((full ?c)))
      ((drink ?c) :elements ((full ?c) (fit ?c)) :actions ((*drink ?c)) :effects ((drunk ?c))))
    """
    goals = parse_conditions("((drunk c) (washed c))")
    imagination = imagine("(cup c)", text)
    found = find_plan(engine_of(text).domain, imagination, goals)
    assert isinstance(found, Plan)
    plan = with_links(imagination, found, project(imagination, found.steps, goals))
    assert steps(plan) == ["(wash c)", "(pour c)", "(drink c)"]
    # Somebody brings a new cup, and fills it: the plan needs (washed c) only for the goal.
    elsewhere = imagine("(cup c) (new c) (washed c)", text)
    rest = working_rest(elsewhere, plan)
    assert rest is not None
    assert rest.start == 1
    assert validate(elsewhere, rest.plan.steps[rest.position :], goals) is None


def test_steps_that_cannot_start_are_left_out_if_nothing_needs_them_any_longer() -> None:
    """Somebody has bought the bread, the last one: the others are still to be done."""
    sold_out = WORLD.replace("(sold bread b)", "")
    helped = imagine(f"(at a) (have bread) {sold_out}")
    assert working_rest(helped, SHOPPING) is None
    rest = sparse_rest(helped, SHOPPING, 1)
    assert rest is not None
    assert steps(rest.plan) == ["(buy milk a)", "(walk a b)", "(walk b c)"]
    assert rest.left_out == 1
    assert rest.projection.valid
    assert all(link.consumer is None or link.consumer < 3 for link in rest.plan.links)


def test_what_serves_nothing_without_them_is_left_out_too() -> None:
    plan = planned(f"(at home) {WORLD}", "((have milk) (have bread))")
    assert steps(plan)[-2:] == ["(walk a b)", "(buy bread b)"]
    helped = imagine(f"(at home) (have bread) {WORLD.replace('(sold bread b)', '')}")
    rest = sparse_rest(helped, plan, 0)
    assert rest is not None
    assert steps(rest.plan) == ["(walk home a)", "(buy milk a)"]
    assert rest.left_out == 2


def test_a_goal_that_is_lost_is_not_repaired_by_leaving_steps_out() -> None:
    lost = imagine(f"(at b) {WORLD}")  # the milk is gone, and there is none ahead
    assert sparse_rest(lost, SHOPPING, 3) is None


def test_an_action_that_must_not_be_used_is_in_no_rest() -> None:
    helped = imagine(f"(at b) (have milk) {WORLD}")
    barred = [Action("walk", ("b", "c"))]
    assert later_start(helped, SHOPPING, 0, barred) is None
    assert working_rest(helped, SHOPPING, barred) is None
    assert sparse_rest(helped, SHOPPING, 3, barred) is None


def test_a_plan_that_does_not_work_has_a_flaw_that_says_where() -> None:
    flaw = validate(imagine(f"(at home) {WORLD}"), SHOPPING.steps[1:], SHOPPING.goals)
    assert flaw is not None
    assert flaw.step == 0
    assert str(flaw) == "(buy milk a) cannot start: nothing matches (at a)"
    flaw = validate(imagine(f"(at home) {WORLD}"), SHOPPING.steps[:1], SHOPPING.goals)
    assert flaw is not None
    assert flaw.step is None
    assert str(flaw) == "(have milk) (have bread) (at c) does not hold in the end"


def test_a_step_is_bound_to_where_its_object_is_by_now() -> None:
    """A ball can be picked up in whichever room it is; the plan need not be another one."""
    domain = load_domain(DOMAINS / "gripper.icr")

    def look(robot: float, ball: float) -> Imagination:
        engine = engine_of(domain.source.text)
        percepts = [
            Percept("room", "hall", {"left": 0, "right": 4}),
            Percept("room", "kitchen", {"left": 4.1, "right": 8}),
            Percept("robot", "robby", {"x": robot}),
            Percept("gripper", "left"),
            Percept("ball", "ball1", {"x": ball}),
        ]
        memory = engine.step(given_memory(engine.domain, []), percepts)
        return Imagination(engine.domain, memory, engine.closure, engine.evaluator)

    goals, imagination = parse_conditions("(attached ball1 left)"), look(1, 2)
    found = find_plan(engine_of(domain.source.text).domain, imagination, goals)
    assert isinstance(found, Plan)
    assert dict(found.steps[0].bindings)["?room"] == "hall"
    projection = project(look(6, 7), found.steps, goals)
    assert projection.valid
    assert dict(projection.steps[0].bindings)["?room"] == "kitchen"
    assert not project(look(1, 7), found.steps, goals).valid
