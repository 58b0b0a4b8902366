from __future__ import annotations

import random

from icarus_lite.planning import Plan, find_plan
from icarus_lite.planning.ground_task import GroundAtom, GroundOperator, GroundTask
from icarus_lite.planning.grounding import ground_task
from icarus_lite.planning.lower_bound import at_least
from icarus_lite.planning.search import search
from icarus_lite.planning.shortest import shorter_plan
from icarus_lite.symbols import Belief
from tests.icarus_lite.planning.grounding.test_task import HANDS, task
from tests.reference.ground_walks import breadth_first, imagined, random_goals
from tests.reference.skill_domains import SkillDomain


def test_each_part_takes_its_own_two_steps() -> None:
    assert at_least(task(HANDS, "((on o0 o1) (on o1 o2))")) == 4


def test_a_goal_that_holds_needs_no_step() -> None:
    assert at_least(task(HANDS, "(free h)")) == 0


def test_a_landmark_costs_what_the_cheapest_of_its_steps_does() -> None:
    ground = task(HANDS, "((on o0 o1) (on o1 o2))")
    names = [operator.step.action.name for operator in ground.operators]
    assert at_least(ground, [3 if name == "pick-up" else 10 for name in names]) == 2 * (3 + 10)


def test_no_plan_is_shorter_than_the_bound() -> None:
    compared = 0
    for seed in range(40):
        rng = random.Random(seed)
        start = SkillDomain(rng).draw()
        domain = start.engine.domain
        imagination = imagined(start.engine, start.memory)
        goals = random_goals(imagination, domain, rng, rng.randint(1, 6))
        length = breadth_first(imagination, domain, goals, 120) if goals else None
        if length is None or length <= 0:
            continue
        compared += 1
        ground = ground_task(domain, imagination.beginning, goals)
        assert at_least(ground) <= length, f"seed {seed}"
        prices = [rng.randint(1, 9) for _ in ground.operators]
        plan = search(ground).plan
        assert plan is not None
        assert at_least(ground, prices) <= sum(prices[number] for number in plan), f"seed {seed}"
        found = find_plan(domain, imagination, goals)
        assert isinstance(found, Plan)
        assert len(found.steps) == length, f"seed {seed}"
    assert compared >= 10


def test_a_step_that_needs_the_same_atom_twice_waits_for_it() -> None:
    some = task(HANDS, "(on o0 o1)").operators[0].step
    free, twice = GroundOperator(some, (), 1, ~0, 1), GroundOperator(some, (0, 0), 4, ~0, 4)
    ground = GroundTask(tuple(GroundAtom(Belief(name)) for name in "abc"), 2, (2,), (free, twice))
    assert shorter_plan(ground, (0, 1), 1_000) == ((0, 1), True)


def test_a_shorter_plan_is_found_and_a_shortest_one_is_known_to_be() -> None:
    ground = task(HANDS, "(on o0 o1)")
    names = [str(operator.step.action) for operator in ground.operators]
    pick, stack, away = (
        names.index(name) for name in ("(pick-up h o0)", "(stack o0 o1)", "(stack o0 o2)")
    )
    assert shorter_plan(ground, (pick, away, pick, stack), 1_000) == ((pick, stack), True)
    assert shorter_plan(ground, (pick, stack), 0) == ((pick, stack), True)
    assert shorter_plan(ground, (pick, away, pick, stack), 3) == ((pick, away, pick, stack), False)
