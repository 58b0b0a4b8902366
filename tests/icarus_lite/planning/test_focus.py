from __future__ import annotations

import random
from collections.abc import Sequence

from icarus_lite import Percept
from icarus_lite.inference import InferenceEngine, Memory
from icarus_lite.language.fragments import parse_conditions
from icarus_lite.language.reading.reader import parse_domain
from icarus_lite.planning import Plan, find_plan, validate
from icarus_lite.planning.focus import Focus
from icarus_lite.planning.grounding import PlanningDomain, ground_goals
from icarus_lite.planning.layers import LayeredFacts, fluents_of
from icarus_lite.planning.steps import PlanStep
from icarus_lite.symbols import Belief
from tests.icarus_lite.planning.grounding.test_task import HANDS, SCENE
from tests.reference.ground_walks import imagined, random_goals
from tests.reference.skill_domains import SkillDomain


def borne_out(goal: str, change: Sequence[int] | None) -> str:
    """Plan for a goal, take these steps of the plan only, and give what does not work."""
    domain, problems = parse_domain(HANDS)
    assert domain is not None, problems
    engine = InferenceEngine(domain)
    imagination = imagined(engine, engine.step(Memory(), SCENE))
    goals = parse_conditions(goal)
    plan = find_plan(domain, imagination, goals)
    assert isinstance(plan, Plan)
    steps: list[PlanStep] = list(plan.steps)
    if change is not None:
        steps = [steps[number] for number in change]
    ground = ground_goals(PlanningDomain(domain), imagination.beginning, goals)
    return Focus(imagination, domain, ground.closure(), ground.fluents).bears_out(steps, goals)


def test_a_plan_that_works_is_borne_out() -> None:
    assert not borne_out("((on o0 o1) (shiny o2))", None)


def test_a_step_that_cannot_start_is_named() -> None:
    assert borne_out("(on o0 o1)", [1]) == "(stack o0 o1) cannot start"


def test_a_goal_that_is_not_reached_is_named() -> None:
    assert borne_out("(on o0 o1)", [0]) == "(on o0 o1) does not hold in the end"


def test_goals_that_share_a_variable_are_judged_together() -> None:
    shared_by_both = "((shiny ?what) (not (red ?what)) (red o0))"
    assert not borne_out(shared_by_both, None)


def test_it_agrees_with_the_whole_imagination() -> None:
    agreed = {True: 0, False: 0}
    for seed in range(40):
        rng = random.Random(seed)
        start = SkillDomain(rng).draw()
        domain = start.engine.domain
        imagination = imagined(start.engine, start.memory)
        goals = random_goals(imagination, domain, rng, 4)
        plan = find_plan(domain, imagination, goals) if goals else None
        if not isinstance(plan, Plan) or not plan.steps:
            continue
        ground = ground_goals(PlanningDomain(domain), imagination.beginning, goals)
        for steps in (plan.steps, plan.steps[:-1], plan.steps[::-1]):
            focus = Focus(imagination, domain, ground.closure(), ground.fluents)
            works = not focus.bears_out(steps, goals)
            assert works is (validate(imagination, steps, goals) is None), f"seed {seed}"
            agreed[works] += 1
    assert agreed[True] >= 10
    assert agreed[False] >= 10


def test_facts_in_two_layers_are_matched_and_listed_together() -> None:
    domain, _ = parse_domain(HANDS)
    assert domain is not None
    engine = InferenceEngine(domain)
    memory = engine.step(Memory(), [*SCENE, Percept("hand", "h2")])
    fluents = fluents_of(domain)
    assert fluents == {"free", "holding", "on", "shiny", "red"}
    facts = LayeredFacts(memory.state.facts(), fluents)
    facts.add(Belief("free", ("h2",)))
    assert Belief("hand", ("h",)) in facts
    assert Belief("free", ("h2",)) in facts
    assert Belief("free", ("h",)) not in facts  # the layer below does not count for it
    assert [str(fact) for fact in facts.changing] == ["(free h2)"]
    assert "(bigger o2 o1)" in {str(fact) for fact in facts}
    (wanted,) = parse_conditions("(free ?h)")
    assert [str(fact) for _, fact in facts.matches(wanted.atom, {})] == ["(free h2)"]
