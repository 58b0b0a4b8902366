"""Ground states against imagined situations, wherever random walks lead."""

from __future__ import annotations

import random

import pytest

from icarus_lite import load_domain
from icarus_lite.inference import InferenceEngine, Memory, given_percepts
from icarus_lite.planning import NoPlan, Plan, find_plan
from tests.reference.ground_walks import breadth_first, goal_of, imagined, random_goals, walk
from tests.reference.skill_domains import SkillDomain


@pytest.mark.parametrize("name", ["blocks", "cater", "gearbox", "gripper", "hanoi"])
def test_states_of_our_domains_are_what_imagination_has(name: str) -> None:
    domain = load_domain(f"domains/{name}.icr")
    engine, states = InferenceEngine(domain), 0
    for number, test in enumerate(domain.tests):
        memory = engine.step(Memory(), given_percepts(domain, test.percepts))
        states += walk(engine, memory, random.Random(number), 25)
    assert states > 40


@pytest.mark.parametrize(("valued", "anew"), [(0.0, False), (1.0, False), (0.3, True)])
def test_states_of_random_domains_are_what_imagination_has(valued: float, *, anew: bool) -> None:
    states = 0
    for seed in range(40):
        rng = random.Random(seed)
        start = SkillDomain(rng, valued, anew=anew).draw()
        states += walk(start.engine, start.memory, rng, 20)
    assert states > 400


@pytest.mark.parametrize("anew", [False, True])
def test_a_plan_is_found_wherever_there_is_one_and_never_elsewhere(*, anew: bool) -> None:
    found = {"plans": 0, "none": 0}
    for seed in range(60):
        rng = random.Random(seed)
        start = SkillDomain(rng, anew=anew).draw()
        domain = start.engine.domain
        imagination = imagined(start.engine, start.memory)
        goals = random_goals(imagination, domain, rng, rng.randint(1, 5))
        if rng.random() < 0.3:
            facts = sorted(set(imagination.facts(imagination.start)), key=str)
            chosen = rng.sample(facts, 2)
            goals += [goal_of(fact, negated=rng.random() < 0.5) for fact in chosen]
        if not goals:
            continue
        plan = find_plan(domain, imagination, goals)
        length = breadth_first(imagination, domain, goals, 150)
        if isinstance(plan, Plan):
            found["plans"] += 1
            assert length is None or 0 <= length <= len(plan.steps), f"seed {seed}"
        else:
            assert isinstance(plan, NoPlan)
            found["none"] += plan.final
            assert length in (None, -1), f"seed {seed}: {plan.reason}"
            assert plan.final or length is None
    assert found["plans"] >= 20
    assert found["none"] >= 3
