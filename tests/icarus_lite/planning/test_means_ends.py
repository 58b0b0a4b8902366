"""Means-ends analysis on problems without variables: chaining, dead ends, interference, bounds."""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path

import pytest

from icarus_lite import Percept, load_domain
from icarus_lite.inference import Change, InferenceEngine, Memory
from icarus_lite.language.fragments import parse_conditions
from icarus_lite.language.syntax import Atom, SkillClause
from icarus_lite.planning import Ending, Imagination, NoPlan, Plan, PlanStep, Subgoal, find_plan
from icarus_lite.planning.ground_task import GroundAtom, GroundOperator, GroundRule, GroundTask
from icarus_lite.planning.grounding import ground_task
from icarus_lite.planning.means_ends import means_ends
from icarus_lite.planning.search import Limits, search
from icarus_lite.planning.solving import solve
from icarus_lite.symbols import Action, Belief

DOMAINS = Path(__file__).resolve().parents[3] / "domains"


def task_of(
    initial: str,
    goal: str,
    skills: Mapping[str, tuple[str, str, str]],
    rules: Sequence[tuple[str, str]] = (),
) -> GroundTask:
    """Write a problem down: atoms are words; skills have conditions, additions, deletions."""
    texts = [initial, goal, *(t for each in skills.values() for t in each)]
    texts += [text for rule in rules for text in rule]
    names = list(dict.fromkeys(word for text in texts for word in text.split()))
    number = {name: i for i, name in enumerate(names)}
    derived = {atom for atom, _ in rules}

    def mask(text: str) -> int:
        return sum(1 << number[word] for word in text.split())

    def places(text: str) -> tuple[int, ...]:
        return tuple(number[word] for word in text.split())

    def close(state: int) -> int:
        state &= ~sum(1 << number[name] for name in derived)
        for _ in rules:
            for atom, conditions in rules:
                if state & mask(conditions) == mask(conditions):
                    state |= 1 << number[atom]
        return state

    operators = tuple(
        GroundOperator(
            PlanStep(Action(name), (Action(name),), SkillClause(Atom(name)), (), Change()),
            places(conditions),
            mask(adds),
            ~mask(deletes) | mask(adds),
            mask(adds),
        )
        for name, (conditions, adds, deletes) in skills.items()
    )
    return GroundTask(
        tuple(GroundAtom(Belief(name), derived=name in derived) for name in names),
        close(mask(initial)),
        places(goal),
        operators,
        tuple(GroundRule(number[atom], places(conditions)) for atom, conditions in rules),
        close if rules else None,
    )


def steps(task: GroundTask, plan: tuple[int, ...] | None) -> list[str] | None:
    return None if plan is None else [task.operators[each].step.action.name for each in plan]


def leads(task: GroundTask, plan: tuple[int, ...]) -> bool:
    """Carry a plan out with the semantics of the problem alone."""
    state = task.initial
    for number in plan:
        operator = task.operators[number]
        if not all(state >> atom & 1 for atom in operator.conditions):
            return False
        state = task.after(state, operator)
    return task.reached(state)


def text(subgoals: Sequence[Subgoal]) -> list[str]:
    return [line for subgoal in subgoals for line in subgoal.lines()]


def test_skill_chaining_goes_back_from_the_goal_to_what_holds() -> None:
    skills = {
        "eat": ("cooked", "full", "cooked"),
        "cook": ("bought hot", "cooked", "bought"),
        "heat": ("", "hot", ""),
        "buy": ("money", "bought", "money"),
    }
    task = task_of("money", "full", skills)
    found = means_ends(task)
    assert steps(task, found.plan) == ["buy", "heat", "cook", "eat"]
    assert text(found.goals) == [
        "(full): achieved",
        "  by (eat)",
        "    (cooked): achieved",
        "      by (cook)",
        "        (bought): achieved",
        "          by (buy)",
        "            holds: (money)",
        "        (hot): achieved",
        "          by (heat)",
    ]


def test_concept_chaining_makes_the_parts_of_a_definition_subgoals() -> None:
    skills = {"wash": ("", "clean", ""), "dry": ("clean", "dry", "")}
    task = task_of("", "ready", skills, [("ready", "clean dry")])
    found = means_ends(task)
    assert steps(task, found.plan) == ["wash", "dry"]
    assert text(found.goals)[:2] == ["(ready): achieved", "  by its parts (clean) (dry)"]


def test_what_nothing_brings_about_is_unchainable_and_not_worked_on() -> None:
    task = task_of("", "gold", {"alchemy": ("stone", "gold", ""), "melt": ("gold", "lead", "")})
    found = means_ends(task)
    assert found.plan is None
    assert [goal.ending for goal in found.goals] == [Ending.FAILED]
    assert found.goals[0].ways == ()  # the one skill needs what cannot be had
    (stone,) = means_ends(task_of("", "stone", {"melt": ("gold", "lead", "")})).goals
    assert stone.ending is Ending.UNCHAINABLE


def test_a_way_in_circles_is_not_gone() -> None:
    skills = {
        "unlock": ("key", "open", ""),
        "fetch": ("open", "key", ""),
        "break": ("hammer", "open", ""),
        "borrow": ("friend", "hammer", ""),
        "call": ("", "friend", ""),
        "pick": ("friend hammer", "key", ""),
    }
    task = task_of("", "open", skills)
    found = means_ends(task)
    assert found.plan is not None
    assert leads(task, found.plan)


@pytest.mark.parametrize("goal", ["ceiling red", "red ceiling"])
def test_a_goal_that_bars_the_way_to_another_comes_after_it(goal: str) -> None:
    skills = {"paint": ("ladder", "ceiling", ""), "paint-ladder": ("", "red", "ladder")}
    task = task_of("ladder", goal, skills)
    assert steps(task, means_ends(task).plan) == ["paint", "paint-ladder"]


def test_a_goal_that_undoes_another_comes_before_it() -> None:
    skills = {
        "paint": ("ladder", "ceiling", "ladder"),
        "fetch": ("", "ladder", ""),
        "sweep": ("", "swept", ""),
    }
    task = task_of("", "ladder ceiling swept", skills)
    assert steps(task, means_ends(task).plan) == ["fetch", "paint", "fetch", "sweep"]


def test_it_gives_up_when_it_has_taken_up_too_much() -> None:
    skills = {f"step{i}": (f"s{i}", f"s{i + 1}", f"s{i}") for i in range(30)}
    task = task_of("s0", "s30", skills)
    assert means_ends(task).plan is not None
    found = means_ends(task, most=10)
    assert found.plan is None
    assert found.subgoals == 10
    assert any("given up" in line for line in text(found.goals))


def random_task(rng: random.Random) -> GroundTask:
    names = [f"p{i}" for i in range(8)]

    def some(least: int, most: int) -> str:
        return " ".join(rng.sample(names, rng.randint(least, most)))

    skills = {f"do{i}": (some(0, 2), some(1, 2), some(0, 2)) for i in range(10)}
    rules = [("d", some(1, 2))] if rng.random() < 0.5 else []
    goal = some(1, 3) + (" d" if rules else "")
    return task_of(some(0, 3), goal, skills, rules)


def test_whatever_it_finds_is_a_plan_and_problem_solving_is_never_worse_than_search() -> None:
    rng, solved, alike = random.Random(3), 0, 0
    for _ in range(300):
        task = random_task(rng)
        searched = search(task)
        found = means_ends(task)
        if found.plan is not None:
            assert leads(task, found.plan)
            assert searched.plan is not None  # search has no limit here
            solved += 1
            alike += len(found.plan) <= len(searched.plan)
        solution = solve(task, Limits(1_000), Limits(100))
        assert (solution.plan is None) == (searched.plan is None)
        if solution.plan is not None and searched.plan is not None:
            assert leads(task, solution.plan)
            assert len(solution.plan) <= len(searched.plan)
    assert solved > 100  # otherwise the test shows little
    assert alike > solved // 2


@cache
def engine_of(name: str) -> InferenceEngine:
    return InferenceEngine(load_domain(DOMAINS / name))


def blocks(*towers: str) -> list[Percept]:
    rows = [
        Percept("block", name, {"x": 0.1 * x, "y": 0.05 * y, "height": 0.05})
        for x, tower in enumerate(towers)
        for y, name in enumerate(tower)
    ]
    return [*rows, Percept("table", "t", {"y": 0.0}), Percept("hand", "hand1")]


def imagine(name: str, percepts: list[Percept]) -> Imagination:
    engine = engine_of(name)
    memory = engine.step(Memory(), percepts)
    return Imagination(engine.domain, memory, engine.closure, engine.evaluator)


def test_sussmans_anomaly_is_solved_though_either_goal_undoes_the_other() -> None:
    imagination = imagine("blocks.icr", blocks("ac", "b"))
    goals = parse_conditions("((on a b) (on b c))")
    task = ground_task(engine_of("blocks.icr").domain, imagination.beginning, goals)
    found = means_ends(task)
    assert found.plan is not None
    assert leads(task, found.plan)
    solution = solve(task, Limits(1_000), Limits(500))
    assert solution.plan is not None
    assert len(solution.plan) == 6
    assert solution.account.analysed == 6  # the detour is left out
    assert solution.account.shortest


@pytest.mark.parametrize("goal", ["((on a b) (on b c))", "((on d a) (clear c))", "((on a e))"])
def test_the_plan_says_how_it_was_found(goal: str) -> None:
    imagination = imagine("blocks.icr", blocks("ac", "bd", "e"))
    domain, goals = engine_of("blocks.icr").domain, parse_conditions(goal)
    found = find_plan(domain, imagination, goals)
    assert isinstance(found, Plan)
    assert found.account is not None
    assert len(found.account.goals) >= len(goals)
    lines = list(found.account.lines())
    assert lines[0].startswith("means-ends analysis: a plan of ")
    assert found.account.as_dict()["means_ends"]
    assert find_plan(domain, imagination, goals).account == found.account


def test_where_a_limit_is_reached_both_say_so() -> None:
    imagination = imagine("blocks.icr", blocks("ac", "bd", "e"))
    goals = parse_conditions("((on a b) (on b c))")
    found = find_plan(engine_of("blocks.icr").domain, imagination, goals, limit=3)
    assert isinstance(found, NoPlan)
    assert found.account is not None
    shown = "\n".join(found.account.lines())
    assert "means-ends analysis: no plan, 3 subgoals" in shown
    assert "search: no plan, 3 situations judged" in shown
