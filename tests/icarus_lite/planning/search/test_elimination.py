from __future__ import annotations

import random

import pytest

from icarus_lite.planning.search.elimination import without_needless_steps


def test_a_detour_goes_with_all_that_belongs_to_it(problems):
    task = problems.of(
        "home", "fed",
        [("go", "home", "out", "home"), ("back", "out", "home", "out"), ("eat", "home", "fed", "")],
    )  # fmt: skip
    assert without_needless_steps(task, (0, 1, 0, 1, 2)) == (2,)


def test_the_step_that_takes_most_with_it_goes_first(problems):
    task = problems.of(
        "s", "g",
        [("long1", "s", "x", ""), ("long2", "x", "g", ""), ("short", "s", "g", "")],
    )  # fmt: skip
    assert without_needless_steps(task, (0, 1, 2)) == (2,)


@pytest.mark.parametrize("seed", range(60))
def test_what_is_left_is_a_plan_of_which_no_step_can_be_spared(problems, seed):
    task = problems.drawn(seed)
    chance = random.Random(seed)
    state, walk = task.initial, []
    for _ in range(60):
        ready = [
            number
            for number, operator in enumerate(task.operators)
            if all(state >> atom & 1 for atom in operator.conditions)
        ]
        if not ready or task.reached(state):
            break
        walk.append(chance.choice(ready))
        state = task.after(state, task.operators[walk[-1]])
    if not task.reached(state):
        return
    plan = without_needless_steps(task, tuple(walk))
    assert problems.leads_to_the_goal(task, plan)
    assert len(plan) <= len(walk)
    for position in range(len(plan)):
        assert not problems.leads_to_the_goal(task, plan[:position] + plan[position + 1 :])


def test_a_long_plan_loses_its_needless_steps_in_one_pass(problems):
    corridor = [(f"go{n}", f"at{n}", f"at{n + 1}", f"at{n}") for n in range(150)]
    back = [(f"back{n}", f"at{n + 1}", f"at{n}", f"at{n + 1}") for n in range(150)]
    task = problems.of("at0", "at150", corridor + back)
    walk = [step for n in range(150) for step in (n, 150 + n, n)]
    assert problems.leads_to_the_goal(task, tuple(walk))
    assert without_needless_steps(task, tuple(walk)) == tuple(range(150))
