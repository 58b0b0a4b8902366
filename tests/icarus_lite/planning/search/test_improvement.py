from __future__ import annotations

import random

import pytest

from icarus_lite.planning.search import Limits, improve, search
from icarus_lite.planning.search.ordering import reordered
from icarus_lite.planning.search.relaxed_plan import Relaxation
from icarus_lite.planning.search.window import shorter_way


@pytest.mark.parametrize("seed", range(60))
def test_the_plan_is_still_one_and_no_longer(problems, seed):
    task = problems.drawn(seed)
    plan = search(task).plan
    if plan is None:
        return
    better = improve(task, plan, Limits(evaluations=300))
    assert problems.leads_to_the_goal(task, better)
    assert problems.shortest(task) <= len(better) <= len(plan)


@pytest.mark.parametrize(("balls", "shortest"), [(2, 5), (3, 9), (4, 11), (6, 17)])
def test_a_robot_learns_to_use_both_hands(problems, balls, shortest):
    task = problems.balls(balls)
    one_by_one = []
    names = [operator.step.action.name for operator in task.operators]
    for ball in range(balls):
        one_by_one += [f"take-ball{ball}-left-a", "to-b", f"drop-ball{ball}-left-b", "to-a"]
    plan = tuple(names.index(name) for name in one_by_one[:-1])
    assert problems.leads_to_the_goal(task, plan)
    better = improve(task, plan, Limits(evaluations=5_000))
    assert problems.leads_to_the_goal(task, better)
    assert len(better) == shortest


def test_many_towers_are_built_in_fewer_steps_than_at_first(problems):
    first = better = 0
    for seed in range(8):
        task = problems.blocks(seed, count=9)
        plan = search(task).plan
        shorter = improve(task, plan, Limits(evaluations=1_500))
        assert problems.leads_to_the_goal(task, shorter)
        first, better = first + len(plan), better + len(shorter)
    assert better < first


def test_the_same_limit_gives_the_same_plan(problems):
    task = problems.blocks(11, count=12)
    plan = search(task).plan
    limits = Limits(evaluations=800)
    assert improve(task, plan, limits) == improve(task, plan, limits)


def test_nothing_is_judged_where_nothing_may_be(problems):
    task = problems.balls(3)
    plan = search(task).plan
    assert improve(task, plan, Limits(evaluations=0)) == plan


def test_a_small_problem_comes_to_an_end_without_limits(problems):
    task = problems.balls(2)
    assert len(improve(task, search(task).plan, Limits())) == 5


def test_an_empty_plan_stays_empty(problems):
    task = problems.of("a", "a", [("o", "a", "b", "")])
    assert improve(task, (), Limits()) == ()


@pytest.mark.parametrize("seed", range(20))
def test_another_order_is_the_same_plan(problems, seed):
    task = problems.blocks(seed, count=6)
    plan = search(task).plan
    other = reordered(task, plan, random.Random(seed))
    assert sorted(other) == sorted(plan)
    assert problems.leads_to_the_goal(task, other)


def test_steps_that_belong_together_come_to_stand_together(problems):
    task = problems.of(
        "a0 b0", "a2 b2",
        [(f"{x}{n}", f"{x}{n - 1}", f"{x}{n}", f"{x}{n - 1}") for n in (1, 2) for x in "ab"],
    )  # fmt: skip
    orders = {reordered(task, (0, 1, 2, 3), random.Random(seed)) for seed in range(20)}
    assert orders == {(0, 2, 1, 3), (1, 3, 0, 2)}


def test_a_shorter_way_must_keep_within_the_bound(problems):
    task = problems.of("p0", "p4", [(f"o{n}", f"p{n}", f"p{n + 1}", "") for n in range(4)])
    relaxation = Relaxation(task)
    need = 1 << task.goal[0]
    assert shorter_way(task, relaxation, task.initial, need, 5, 50)[0] == (0, 1, 2, 3)
    assert shorter_way(task, relaxation, task.initial, need, 4, 50) == (None, 1)


def test_a_shorter_way_ends_with_its_budget(problems):
    task = problems.balls(8)
    relaxation = Relaxation(task)
    need = sum(1 << atom for atom in task.goal)
    found, judged = shorter_way(task, relaxation, task.initial, need, 40, 7)
    assert found is None
    assert judged == 7
