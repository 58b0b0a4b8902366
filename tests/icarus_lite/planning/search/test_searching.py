from __future__ import annotations

from dataclasses import replace

import pytest

from icarus_lite.planning.search import Limits, search


@pytest.mark.parametrize("seed", range(200))
def test_a_plan_is_found_exactly_where_there_is_one(problems, seed):
    task = problems.drawn(seed)
    result = search(task)
    shortest = problems.shortest(task)
    if shortest is None:
        assert result.plan is None
        assert result.exhausted
    else:
        assert result.plan is not None
        assert len(result.plan) >= shortest
        assert problems.leads_to_the_goal(task, result.plan)


def test_some_drawn_problems_have_plans_and_some_have_none(problems):
    lengths = [problems.shortest(problems.drawn(seed)) for seed in range(200)]
    assert sum(length is None for length in lengths) > 20
    assert sum(length is not None and length >= 3 for length in lengths) > 20


@pytest.mark.parametrize("seed", range(30))
def test_blocks_are_brought_where_they_belong(problems, seed):
    task = problems.blocks(seed, count=4 + seed % 9)
    result = search(task, Limits(evaluations=20_000))
    assert result.plan is not None
    assert problems.leads_to_the_goal(task, result.plan)


def test_the_order_of_operators_does_not_decide_whether_large_towers_are_built(problems):
    task = problems.blocks(7, count=16)
    backwards = replace(task, operators=task.operators[::-1])
    for each in (task, backwards):
        result = search(each, Limits(evaluations=20_000))
        assert result.plan is not None
        assert problems.leads_to_the_goal(each, result.plan)


def test_a_goal_that_holds_takes_no_steps_and_no_effort(problems):
    task = problems.of("a b", "b", [("o", "a", "b", "")])
    result = search(task)
    assert result.plan == ()
    assert not result.exhausted
    assert result.effort.evaluations == 0


def test_goal_atoms_that_nothing_makes_true_are_named(problems):
    task = problems.of("a", "b moon c", [("o", "a", "b", ""), ("p", "b", "c", "")])
    result = search(task)
    assert result.plan is None
    assert result.exhausted
    assert [str(task.atoms[atom]) for atom in result.unreachable] == ["(moon)"]


def test_goals_that_exclude_each_other_exhaust_the_search_and_name_no_atom(problems):
    task = problems.of(
        "heads",
        "heads tails",
        [("turn", "heads", "tails", "heads"), ("back", "tails", "heads", "tails")],
    )
    result = search(task)
    assert result.plan is None
    assert result.exhausted
    assert result.unreachable == ()
    assert result.effort.evaluations == 2


def test_a_limit_of_evaluations_ends_the_search_without_a_verdict(problems):
    task = problems.blocks(3, count=12)
    result = search(task, Limits(evaluations=5))
    assert result.plan is None
    assert not result.exhausted
    assert result.effort.evaluations == 5


def test_a_limit_of_seconds_ends_the_search_by_the_clock_given(problems):
    ticks = iter(range(1_000))
    result = search(problems.blocks(3, count=12), Limits(seconds=4, clock=lambda: next(ticks)))
    assert result.plan is None
    assert not result.exhausted
    assert 1 <= result.effort.evaluations <= 5


def test_progress_tells_how_the_goal_came_nearer(problems):
    task = problems.blocks(5, count=8)
    result = search(task)
    estimates = [each.estimate for each in result.progress]
    assert len(estimates) > 2
    assert estimates == sorted(set(estimates), reverse=True)
    assert result.progress[0].steps == 0


def test_derived_atoms_follow_their_closure(problems):
    operators = [
        ("left", "", "at-left", "at-right lit"),
        ("right", "", "at-right", "at-left lit"),
        ("go", "lit", "done", ""),
    ]
    task = problems.of("at-left", "done", operators, rules=[("lit", "at-right")])
    lit, right = (
        1 << next(n for n, atom in enumerate(task.atoms) if str(atom) == word)
        for word in ("(lit)", "(at-right)")
    )
    closed = replace(task, closure=lambda state: state | lit if state & right else state & ~lit)
    result = search(closed)
    assert [closed.operators[step].step.action.name for step in result.plan or ()] == [
        "right",
        "go",
    ]


def test_an_exception_decides_on_the_state_after_an_operator(problems):
    task = problems.of(
        "start",
        "end",
        [
            ("leap", "start", "end", ""),
            ("walk", "start", "way", "start"),
            ("arrive", "way", "end", ""),
        ],
    )
    leap = replace(task.operators[0], add=0, exception=lambda before, _after: before)
    refused = replace(task, operators=(leap, *task.operators[1:]))
    result = search(refused)
    assert [refused.operators[step].step.action.name for step in result.plan or ()] == [
        "walk",
        "arrive",
    ]
