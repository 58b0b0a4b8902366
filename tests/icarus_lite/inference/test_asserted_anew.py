"""A belief that is asserted anew has the attributes it comes with now: engine, plans, execution."""

from __future__ import annotations

import pytest

from icarus_lite import Action, Outcome, Percept
from icarus_lite.execution.moment import Moment
from icarus_lite.inference import InferenceEngine, Memory
from icarus_lite.language import parse_domain
from icarus_lite.language.fragments import parse_conditions
from icarus_lite.language.syntax import Domain
from icarus_lite.planning import Plan, find_plan, project, unmet, with_links
from icarus_lite.planning.situation import Situation
from icarus_lite.planning.steps import plan_step
from icarus_lite.symbols import Belief
from tests.reference.ground_walks import imagined

TEXT = """
(percepts (block))
(concepts
  ((red ?b) :elements ((block ?b) (painted ?b ^colour red)))
  ((blue ?b) :elements ((block ?b) (painted ?b ^colour blue))))
(skills
  ((paint-red ?b) :elements ((block ?b)) :actions ((*paint ?b))
                  :effects ((painted ?b ^colour red)))
  ((paint-blue ?b) :elements ((block ?b)) :actions ((*paint ?b))
                   :effects ((painted ?b ^colour blue)))
  ((varnish ?b) :elements ((block ?b) (not (red ?b))) :actions ((*varnish ?b))
                :effects ((varnished ?b)))
  ((patch ?b) :elements ((block ?b) (not (painted ?b ^colour red))) :actions ((*patch ?b))
              :effects ((patched ?b)))
  ((twice ?b) :elements ((block ?b)) :actions ((*paint ?b))
              :effects ((painted ?b ^colour red) (painted ?b ^colour blue))))
"""
BLOCK = (Percept("block", "b1"),)


@pytest.fixture(scope="module")
def domain() -> Domain:
    found, problems = parse_domain(TEXT)
    assert found is not None, problems
    return found


def painted(engine: InferenceEngine, *skills: str) -> Memory:
    memory = engine.step(Memory(), BLOCK)
    for skill in skills:
        memory = engine.step(memory, BLOCK, [Outcome(Action(skill, ("b1",)))])
    return memory


def test_the_engine_believes_the_new_value(domain: Domain) -> None:
    memory = painted(InferenceEngine(domain), "paint-red", "paint-blue")
    (belief,) = memory.asserted
    assert belief.attributes == {"colour": "blue"}
    assert memory.asserted[belief].action == Action("paint-blue", ("b1",))
    assert {str(each) for each in memory.state.beliefs} == {"(blue b1)", "(painted b1)"}


def test_what_is_asserted_with_the_same_value_stays(domain: Domain) -> None:
    memory = painted(InferenceEngine(domain), "paint-red", "paint-red")
    assert {str(each) for each in memory.state.beliefs} == {"(painted b1)", "(red b1)"}


def test_a_plan_imagines_the_new_value(domain: Domain) -> None:
    engine = InferenceEngine(domain)
    imagination = imagined(engine, painted(engine, "paint-red"))
    blue = plan_step(domain.skills[1], {"?b": "b1"})
    assert blue is not None
    after = imagination.after(imagination.start, blue)
    (belief,) = after.asserted
    assert belief.attributes == {"colour": "blue"}
    facts = imagination.facts(after)
    assert Belief("blue", ("b1",)) in facts
    assert Belief("red", ("b1",)) not in facts


def test_of_two_values_in_one_action_the_first_counts(domain: Domain) -> None:
    engine = InferenceEngine(domain)
    memory = painted(engine, "paint-blue", "twice")
    assert Belief("red", ("b1",)) in memory.state
    before = painted(engine, "paint-blue")
    imagination = imagined(engine, before)
    twice = plan_step(domain.skills[-1], {"?b": "b1"})
    assert twice is not None
    facts = imagination.facts(imagination.after(imagination.start, twice))
    assert Belief("red", ("b1",)) in facts
    assert Belief("blue", ("b1",)) not in facts


def test_what_is_perceived_keeps_its_attributes(domain: Domain) -> None:
    engine = InferenceEngine(domain)
    seen = [*BLOCK, Percept("painted", "b1", {"colour": "red"})]
    memory = engine.step(Memory(), seen)
    memory = engine.step(memory, seen, [Outcome(Action("paint-blue", ("b1",)))])
    assert Belief("red", ("b1",)) in memory.state
    assert Belief("blue", ("b1",)) not in memory.state


def test_the_past_keeps_its_value(domain: Domain) -> None:
    engine = InferenceEngine(domain)
    memory = painted(engine, "paint-red", "paint-blue", "paint-red", "paint-blue")
    for cycle, colour in ((1, "red"), (2, "blue"), (3, "red"), (4, "blue")):
        (belief, _), *_ = engine.look_back(cycle).asserted()
        assert belief.attributes == {"colour": colour}
        assert Belief(colour, ("b1",)) in engine.look_back(cycle)
    assert Belief("red", ("b1",)) not in memory.state


def test_situations_and_moments_with_other_values_are_others(domain: Domain) -> None:
    engine = InferenceEngine(domain)
    red, blue, again = (painted(engine, f"paint-{colour}") for colour in ("red", "blue", "red"))
    scenes = [Moment(engine, memory).scene for memory in (red, blue, again)]
    assert scenes[0] == scenes[2] != scenes[1]
    keys = [
        Situation(frozenset(memory.asserted), memory.state.hierarchy).key for memory in (red, blue)
    ]
    assert keys[0] != keys[1]


@pytest.mark.parametrize(
    ("goal", "names"),
    [
        ("((blue b1))", ["paint-blue"]),
        ("((painted b1 ^colour blue))", ["paint-blue"]),
        ("((varnished b1))", ["paint-blue", "varnish"]),
        ("((patched b1))", ["paint-blue", "patch"]),
        ("((varnished b1) (red b1))", ["paint-blue", "varnish", "paint-red"]),
    ],
)
def test_a_plan_paints_over_and_says_what_for(domain: Domain, goal: str, names: list[str]) -> None:
    engine, goals = InferenceEngine(domain), parse_conditions(goal)
    imagination = imagined(engine, painted(engine, "paint-red"))
    found = find_plan(domain, imagination, goals)
    assert isinstance(found, Plan), found
    assert [step.action.name for step in found.steps] == names
    plan = with_links(imagination, found, project(imagination, found.steps, goals))
    assert {link.producer for link in plan.links} >= set(range(len(names)))
    assert not unmet(plan, 0, imagination.facts(imagination.start))
    later = imagined(engine, painted(engine, "paint-red", "paint-blue"))
    if len(names) > 1:  # once it has begun, the rest needs what it has brought about
        assert unmet(plan, 1, imagination.facts(imagination.start))
        assert not unmet(plan, 1, later.facts(later.start))
