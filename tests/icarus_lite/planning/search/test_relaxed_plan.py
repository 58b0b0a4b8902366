from __future__ import annotations

import random

import pytest

from icarus_lite.planning.search.relaxed_plan import Estimate, Relaxation, bits

CORRIDOR = [(f"go{n}", f"at{n}", f"at{n + 1}", f"at{n}") for n in range(5)]


def test_the_bits_of_a_mask_come_lowest_first():
    assert bits(0) == []
    assert bits(0b1010_0000_0001) == [0, 9, 11]


def test_on_a_straight_way_the_estimate_is_the_distance(problems):
    task = problems.of("at0", "at5", CORRIDOR)
    assert Relaxation(task).estimate(task.initial, task.goal) == Estimate(5, [0], [0])


def test_an_operator_that_serves_two_goals_counts_once(problems):
    task = problems.of(
        "key",
        "door lamp",
        [
            ("enter", "key", "inside", ""),
            ("open", "inside", "door", ""),
            ("light", "inside", "lamp", ""),
        ],
    )
    estimate = Relaxation(task).estimate(task.initial, task.goal)
    assert estimate is not None
    assert estimate.steps == 3


def test_what_cannot_be_reached_even_without_deletions_has_no_estimate(problems):
    task = problems.of("at3", "at5 at1", CORRIDOR)
    relaxation = Relaxation(task)
    assert relaxation.estimate(task.initial, task.goal) is None
    [atom] = relaxation.unreachable(task.initial, task.goal)
    assert str(task.atoms[atom]) == "(at1)"


def test_rules_cost_nothing(problems):
    task = problems.of(
        "start", "ready", [("wash", "start", "clean", ""), ("dry", "clean", "dry", "")],
        rules=[("ready", "tidy dry"), ("tidy", "clean")],
    )  # fmt: skip
    estimate = Relaxation(task).estimate(task.initial, task.goal)
    assert estimate is not None
    assert estimate.steps == 2
    assert estimate.preferred == [0]


def test_an_operator_that_only_a_promise_of_a_rule_lets_start_is_not_applicable(problems):
    task = problems.of(
        "start", "end", [("finish", "free", "end", "")], rules=[("free", "start")]
    )  # fmt: skip
    estimate = Relaxation(task).estimate(task.initial, task.goal)
    assert estimate == Estimate(1, [], [])


def test_costs_beyond_all_bounds_do_not_confuse_the_count_of_conditions(problems):
    doubling = [(f"o{n}", f"x{n} y{n}", f"x{n + 1} y{n + 1}", "") for n in range(60)]
    task = problems.of("x0 y0", "x60", doubling)
    estimate = Relaxation(task).estimate(task.initial, task.goal)
    assert estimate is not None
    assert estimate.steps == 60


@pytest.mark.parametrize("seed", range(40))
def test_what_was_asked_before_makes_no_difference(problems, seed):
    task = problems.drawn(seed)
    chance = random.Random(seed)
    kept = Relaxation(task)
    for _ in range(20):
        state = chance.getrandbits(len(task.atoms))
        estimate = kept.estimate(state, task.goal)
        assert estimate == Relaxation(task).estimate(state, task.goal)
        if estimate is not None:
            assert estimate.applicable == [
                number
                for number, operator in enumerate(task.operators)
                if all(state >> atom & 1 for atom in operator.conditions)
            ]
            assert set(estimate.preferred) <= set(estimate.applicable)


@pytest.mark.parametrize("seed", range(40))
def test_the_estimate_counts_a_plan_of_the_problem_without_deletions(problems, seed):
    task = problems.drawn(seed)
    relaxed = problems.of(
        " ".join(_words(task, task.initial)),
        " ".join(str(task.atoms[atom])[1:-1] for atom in task.goal),
        [
            (op.step.action.name, " ".join(str(task.atoms[a])[1:-1] for a in op.conditions),
             " ".join(_words(task, op.add)), "")
            for op in task.operators
        ],
    )  # fmt: skip
    best = problems.shortest(relaxed)
    estimate = Relaxation(task).estimate(task.initial, task.goal)
    if best is None:
        assert estimate is None
    else:
        assert estimate is not None
        assert estimate.steps >= best
        assert (estimate.steps == 0) == (best == 0)


def _words(task, mask):
    return [str(task.atoms[atom])[1:-1] for atom in bits(mask)]
