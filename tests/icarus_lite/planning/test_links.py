"""Causal links: what they say is so at every stage, and is enough for the plan to work."""

from __future__ import annotations

import random
from functools import cache
from itertools import pairwise
from pathlib import Path

import pytest

from icarus_lite import Percept, load_domain
from icarus_lite.inference import InferenceEngine, Memory
from icarus_lite.language.fragments import parse_conditions
from icarus_lite.language.reading.reader import parse_domain
from icarus_lite.language.syntax import Domain
from icarus_lite.planning import (
    Imagination,
    NoPlan,
    Plan,
    Projection,
    find_plan,
    project,
    purpose,
    unmet,
    with_links,
)

DOMAINS = Path(__file__).resolve().parents[3] / "domains"
BLOCKS = load_domain(DOMAINS / "blocks.icr")
GRIPPER = load_domain(DOMAINS / "gripper.icr")


def domain_of(text: str) -> Domain:
    domain, problems = parse_domain(text)
    assert domain is not None, problems
    return domain


@cache
def engine_of(text: str) -> InferenceEngine:
    return InferenceEngine(domain_of(text))  # compiling it is most of the work


def imagine(domain: Domain, percepts: list[Percept]) -> Imagination:
    engine = engine_of(domain.source.text)
    memory = engine.step(Memory(), percepts)
    return Imagination(engine.domain, memory, engine.closure, engine.evaluator)


def planned(
    domain: Domain, percepts: list[Percept], goal: str
) -> tuple[Imagination, Plan, Projection]:
    imagination, goals = imagine(domain, percepts), parse_conditions(goal)
    found = find_plan(domain, imagination, goals)
    assert isinstance(found, Plan), found
    projection = project(imagination, found.steps, goals)
    assert projection.valid
    return imagination, with_links(imagination, found, projection), projection


def towers(*names: str, held: str = "") -> list[Percept]:
    blocks = [
        Percept("block", name, {"x": 0.1 * column, "y": 0.05 * row, "height": 0.05})
        for column, tower in enumerate(names)
        for row, name in enumerate(tower)
    ]
    if held:
        blocks.append(Percept("block", held, {"x": -1.0, "y": 1.0, "height": 0.05}))
    hand = Percept("hand", "hand1", {"holding": held} if held else {})
    return [*blocks, Percept("table", "t", {"y": 0.0}), hand]


def random_towers(rng: random.Random, blocks: str) -> list[Percept]:
    names = list(blocks)
    rng.shuffle(names)
    held = names.pop() if rng.random() < 0.3 else ""
    stacks: list[str] = []
    for name in names:
        if stacks and rng.random() < 0.6:
            place = rng.randrange(len(stacks))
            stacks[place] += name
        else:
            stacks.append(name)
    return towers(*stacks, held=held)


def random_goal(rng: random.Random, blocks: str) -> str:
    names = list(blocks)
    rng.shuffle(names)
    return f"({' '.join(f'(on {a} {b})' for a, b in pairwise(names[: rng.randint(2, 3)]))})"


def rooms(*balls: float) -> list[Percept]:
    return [
        Percept("room", "hall", {"left": 0, "right": 4}),
        Percept("room", "kitchen", {"left": 4.1, "right": 8}),
        Percept("robot", "robby", {"x": 1}),
        Percept("gripper", "left"),
        Percept("gripper", "right"),
        *(Percept("ball", f"ball{i}", {"x": x}) for i, x in enumerate(balls, 1)),
    ]


SCENES = [
    (BLOCKS, towers("ac", "b"), "((on a b) (on b c))"),
    (BLOCKS, towers("abcd"), "((clear a) (hand-empty hand1))"),
    (GRIPPER, rooms(2, 3), "((lies-in ball1 kitchen) (lies-in ball2 kitchen))"),
    (GRIPPER, rooms(5), "((lies-in ball1 hall))"),
    *(
        (
            BLOCKS,
            random_towers(random.Random(seed), "abcde"),
            random_goal(random.Random(seed), "abcde"),
        )
        for seed in range(12)
    ),
]


@pytest.mark.parametrize(("domain", "percepts", "goal"), SCENES)
def test_a_link_holds_from_its_producer_to_its_consumer_and_not_before(
    domain: Domain, percepts: list[Percept], goal: str
) -> None:
    imagination, plan, projection = planned(domain, percepts, goal)
    last = len(plan.steps)
    for link in plan.links:
        begin = 0 if link.producer is None else link.producer + 1
        end = last if link.consumer is None else link.consumer
        assert begin <= end
        for stage in projection.stages[begin : end + 1]:
            assert imagination.holds([link.fact], stage.facts), (str(link.fact), begin, end)
        if link.producer is not None:
            assert not imagination.holds([link.fact], projection.stages[link.producer].facts)


@pytest.mark.parametrize(("domain", "percepts", "goal"), SCENES)
def test_every_step_of_a_shortest_plan_is_for_something_down_to_a_goal(
    domain: Domain, percepts: list[Percept], goal: str
) -> None:
    _, plan, _ = planned(domain, percepts, goal)
    for number in range(len(plan.steps)):
        answer = purpose(plan, number)
        assert answer.serves
        assert answer.onward[0] in answer.serves
        assert answer.onward[-1].consumer is None
        assert all(a.consumer == b.producer for a, b in pairwise(answer.onward))


@pytest.mark.parametrize(("domain", "percepts", "goal"), SCENES)
def test_all_conditions_of_all_steps_and_all_goals_have_their_links(
    domain: Domain, percepts: list[Percept], goal: str
) -> None:
    _, plan, _ = planned(domain, percepts, goal)
    for number, step in enumerate(plan.steps):
        linked = dict.fromkeys(link.condition for link in plan.links if link.consumer == number)
        assert len(plan.needs[number].conditions) == len(step.clause.elements)
        assert set(linked) == {need.literal for need in plan.needs[number].conditions}
    goals = [need.literal for need in plan.needs[-1].conditions]
    assert goals == list(parse_conditions(goal))


def test_what_the_rest_of_a_plan_needs_is_enough_for_it() -> None:
    """The kernel theorem of triangle tables, tried on states that the plan was not made for."""
    rng, applies = random.Random(7), 0
    for _ in range(30):
        percepts, goal = random_towers(rng, "abcd"), random_goal(rng, "abcd")
        imagination, goals = imagine(BLOCKS, percepts), parse_conditions(goal)
        found = find_plan(BLOCKS, imagination, goals)
        if isinstance(found, NoPlan) or not found.steps:
            continue
        plan = with_links(imagination, found, project(imagination, found.steps, goals))
        for _ in range(30):
            elsewhere = imagine(BLOCKS, random_towers(rng, "abcd"))
            facts = elsewhere.facts(elsewhere.start)
            for position in range(len(plan.steps)):
                if not unmet(plan, position, facts):
                    applies += 1
                    rest = project(elsewhere, plan.steps[position:], goals)
                    assert rest.valid, (percepts, goal, position, rest.flaw)
    assert applies > 100  # otherwise the test shows nothing


def test_a_derived_condition_is_linked_through_what_supports_it() -> None:
    _, plan, _ = planned(BLOCKS, towers("ac", "b"), "((on a b) (on b c))")
    assert str(plan.steps[4].action) == "(pick-up hand1 a t)"
    links = [link for link in plan.links if link.consumer == 4 and link.producer is not None]
    assert [(link.producer, str(link.fact), str(link.condition)) for link in links] == [
        (0, "(not (on c a))", "(clear a)"),
        (1, "(not (holding hand1 c))", "(hand-empty hand1)"),
        (3, "(not (holding hand1 b))", "(hand-empty hand1)"),
    ]


CHAIN = domain_of("""
(percepts (thing))
(concepts
  ((washed-or-new ?t) :elements ((washed ?t)))
  ((washed-or-new ?t) :elements ((new ?t)))
  ((ready ?t) :elements ((washed-or-new ?t) (not (in-the-way ?t))))
  ((in-the-way ?t) :elements ((dirt ?t)))
  ((in-the-way ?t) :elements ((dust ?t))))
(skills
  ((soil ?t) :elements ((thing ?t)) :actions ((*soil ?t)) :effects ((dirt ?t) (dust ?t)))
  ((wash ?t) :elements ((thing ?t)) :actions ((*wash ?t)) :effects ((washed ?t) (not (dirt ?t))))
  ((wipe ?t) :elements ((thing ?t)) :actions ((*wipe ?t)) :effects ((not (dust ?t))))
  ((sell ?t) :elements ((ready ?t)) :actions ((*sell ?t)) :effects ((sold ?t))))
""")


def carried_out(names: list[str], goal: str) -> Plan:
    """Link a plan that is given, with dirt and dust on the thing to begin with."""
    imagination = imagine(CHAIN, [Percept("thing", "cup")])
    clauses = {clause.head.predicate: clause for clause in CHAIN.skills}
    facts = imagination.facts(imagination.start)
    steps = []
    for name in names:
        steps += list(imagination.instances(clauses[name], facts, {}))
        if not steps or steps[-1].action.name != name:  # it needs what earlier steps bring about
            reached = project(imagination, steps).stages[-1].facts
            steps += list(imagination.instances(clauses[name], reached, {}))
    goals = parse_conditions(goal)
    projection = project(imagination, steps, goals)
    assert projection.valid, projection.flaw
    return with_links(imagination, Plan(tuple(steps), goals), projection)


def test_every_way_in_which_something_was_in_the_way_has_to_be_ended() -> None:
    plan = carried_out(["soil", "wash", "wipe", "sell"], "(sold cup)")
    served = {link.producer for link in plan.links if link.consumer == 3}
    assert served == {1, 2}  # washing alone leaves the dust, wiping alone the dirt
    assert purpose(plan, 0).serves == ()


def test_a_step_that_serves_nothing_is_said_to() -> None:
    plan = carried_out(["wash", "wipe", "sell"], "(sold cup)")
    assert "serves nothing" in str(purpose(plan, 1))
    assert str(purpose(plan, 0)).splitlines() == [
        "(wash cup), step 1 of 3",
        "  needs (thing cup): holds",
        "  brings about (washed cup), so that (ready cup), which step 3 (sell cup) needs",
        "  and so: step 3 (sell cup) → (sold cup)",
    ]


def test_the_last_step_that_brings_something_about_is_the_one_that_counts() -> None:
    plan = carried_out(["soil", "wash", "soil", "wash", "wipe", "sell"], "(sold cup)")
    links = [link for link in plan.links if str(link.fact) == "(not (dirt cup))"]
    assert {link.producer for link in links} == {3}


def test_a_plan_that_does_not_work_has_no_links() -> None:
    imagination, plan, _ = planned(BLOCKS, towers("ab"), "(on b a)")
    assert plan.steps == ()
    broken = project(imagination, (), parse_conditions("(on a b)"))
    assert with_links(imagination, Plan((), parse_conditions("(on a b)")), broken).needs == ()


def test_a_step_that_is_not_there_is_an_error() -> None:
    _, plan, _ = planned(BLOCKS, towers("ac", "b"), "(clear a)")
    with pytest.raises(IndexError, match="there is no step 9"):
        purpose(plan, 9)
