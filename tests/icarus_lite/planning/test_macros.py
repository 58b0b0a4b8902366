"""Macros: what they say is right, and in the domain they do without search what search did."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

import pytest

from icarus_lite import Agent, DecisionKind, Percept, load_domain
from icarus_lite.inference import InferenceEngine, Matcher, Memory
from icarus_lite.language import diagnose_text, format_text, parse_domain
from icarus_lite.language.fragments import parse_conditions
from icarus_lite.language.syntax import Domain
from icarus_lite.planning import Imagination, Macro, Plan, find_plan, macro, project, with_links

ROOT = Path(__file__).resolve().parents[3]
BLOCKS = load_domain(ROOT / "domains" / "blocks.icr")
GRIPPER = load_domain(ROOT / "domains" / "gripper.icr")
GEARBOX = load_domain(ROOT / "domains" / "gearbox.icr")
SUSSMAN = "((on a b) (on b c))"

_spec = importlib.util.spec_from_file_location(
    "skill_worlds", ROOT / "tests" / "reference" / "skill_worlds.py"
)
worlds = importlib.util.module_from_spec(_spec)
sys.modules["skill_worlds"] = worlds
_spec.loader.exec_module(worlds)


def generalised(domain: Domain, percepts: list[Percept], goal: str, name: str = "") -> Macro:
    engine = InferenceEngine(domain)
    memory = engine.step(Memory(), percepts)
    imagination = Imagination(domain, memory, engine.closure, engine.evaluator)
    goals = parse_conditions(goal)
    found = find_plan(domain, imagination, goals)
    assert isinstance(found, Plan)
    projection = project(imagination, found.steps, goals)
    return macro(domain, with_links(imagination, found, projection), projection.stages[0], name)


def adopted(domain: Domain, made: Macro) -> Domain:
    """Put a macro at the end of a domain's text, as a person would, and read it again."""
    text = format_text(domain.source.text + "\n" + made.text)
    *_, known = diagnose_text(domain.source.text, "known.icr")
    *_, found = diagnose_text(text, "adopted.icr")
    # `icarus check` has nothing to say about it.
    assert [each.message for each in found] == [each.message for each in known]
    again, problems = parse_domain(text)
    assert again is not None, problems
    assert format_text(text) == text
    return again


def sussman() -> Macro:
    return generalised(BLOCKS, worlds.BlocksWorld([["a", "c"], ["b"]]).percepts(), SUSSMAN)


def test_the_text_is_in_the_canonical_layout() -> None:
    made = sussman()
    assert format_text(made.text) == made.text
    assert made.text.splitlines()[:4] == [
        "; (not (on ?any ?a)): not asked for at the start, where (on ?c ?a) holds",
        "(skills",
        "  ((achieve-on ?a ?b ?c)",
        "   :elements ((on ?c ?a)",
    ]


def test_the_start_conditions_are_the_goal_taken_back_through_the_plan() -> None:
    clause = sussman().clause
    assert [str(each) for each in clause.elements] == [
        "(on ?c ?a)",
        "(clear ?c)",
        "(hand-empty ?hand1)",
        "(ontable ?b ?t)",
        "(clear ?b)",
        "(ontable ?a ?t)",
        "(not (holding ?_hand ?a))",
    ]
    assert [str(each) for each in clause.tests] == ["(/= ?a ?b ?c)"]
    assert [str(each) for each in clause.effects] == ["(on ?a ?b)", "(on ?b ?c)"]


@pytest.mark.parametrize("names", ["abc", "xyz", "cab"])
def test_in_the_domain_it_solves_the_same_and_renamed_instances_without_search(
    names: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    domain = adopted(BLOCKS, sussman())

    def no_search(*_args: object, **_options: object) -> None:
        raise AssertionError("planning was asked")

    monkeypatch.setattr("icarus_lite.execution.executor.find_plan", no_search)
    a, b, c = names
    world = worlds.BlocksWorld([["w", "v"], [a, c], [b]])
    agent = Agent(domain, [f"(on {a} {b})", f"(on {b} {c})"])
    decisions = worlds.run(world, agent)
    assert decisions[-1].kind is DecisionKind.ACHIEVED
    assert len(world.done) == 6
    assert str(decisions[0].skill_path.levels[0]) == f"(achieve-on {a} {b} {c})"


def test_where_its_start_conditions_do_not_hold_it_is_not_used() -> None:
    domain = adopted(BLOCKS, sussman())
    world = worlds.BlocksWorld([["c"], ["a"], ["b"]])
    decisions = worlds.run(world, Agent(domain, ["(on a b)", "(on b c)"]))
    assert decisions[-1].kind is DecisionKind.ACHIEVED
    paths = [str(each.skill_path) for each in decisions if each.skill_path is not None]
    assert not any("achieve-on" in path for path in paths)


def test_what_the_domain_names_itself_stays_as_it_is() -> None:
    percepts = [
        Percept("object", "cup", {"type": "cup", "x": 1}),
        Percept("object", "box", {"type": "box", "x": 2}),
        Percept("hand", "h"),
    ]
    domain, problems = parse_domain("""
(percepts (object ^type ^x) (hand))
(skills
  ((lift ?h ?o) :elements ((hand ?h) (object ?o ^type cup ^x ?x)) :tests ((< ?x 5))
                :actions ((*lift ?h ?o ?x)) :effects ((held ?h ?o)))
  ((put ?o ?place) :elements ((held ?h ?o) (object ?place)) :tests ((/= ?o ?place))
                   :actions ((*put ?o ?place)) :effects ((in ?o ?place) (not (held ?h ?o)))))
""")
    assert domain is not None, problems
    made = generalised(domain, percepts, "(in cup box)", name="tidy")
    assert str(made.clause.elements[1]) == "(object ?cup ^type cup ^x ?cup-x)"
    assert [str(test) for test in made.clause.tests] == ["(/= ?cup ?box)", "(< ?cup-x 5)"]
    adopted(domain, made)


@pytest.mark.parametrize(
    ("domain", "percepts", "goal"),
    [
        (
            GRIPPER,
            [
                Percept("room", "hall", {"left": 0, "right": 4}),
                Percept("room", "kitchen", {"left": 4.1, "right": 8}),
                Percept("robot", "robby", {"x": 1}),
                Percept("gripper", "left"),
                Percept("ball", "ball1", {"x": 5}),
            ],
            "((lies-in ball1 hall))",
        ),
        (BLOCKS, worlds.BlocksWorld([["a", "b", "c", "d"]]).percepts(), "((clear a))"),
        (BLOCKS, worlds.BlocksWorld([["a", "b"], ["c"]]).percepts(), "((on c b) (not (on b a)))"),
    ],
)
def test_a_macro_fits_its_domain(domain: Domain, percepts: list[Percept], goal: str) -> None:
    made = generalised(domain, percepts, goal)
    again = adopted(domain, made)
    clause = again.skills[-1]
    engine = InferenceEngine(again)
    memory = engine.step(Memory(), percepts)
    imagination = Imagination(again, memory, engine.closure, engine.evaluator)
    facts = imagination.facts(imagination.start)
    assert list(Matcher(clause.elements, clause.tests).matches(facts))  # it could start here


def test_a_second_macro_for_the_same_goal_has_another_name() -> None:
    domain = adopted(BLOCKS, sussman())
    percepts = worlds.BlocksWorld([["c"], ["b"], ["a"]]).percepts()
    assert generalised(domain, percepts, SUSSMAN).clause.head.predicate == "achieve-on-2"


def test_objects_with_awkward_names_become_variables_all_the_same() -> None:
    percepts = worlds.BlocksWorld([["block no. 1"], ["2"]]).percepts()
    made = generalised(BLOCKS, percepts, '((on "block no. 1" "2"))')
    adopted(BLOCKS, made)
    assert made.clause.head.variables == ("?block-no-1", "?2")


def test_a_plan_without_steps_makes_no_macro() -> None:
    with pytest.raises(ValueError, match="only a plan with steps"):
        generalised(BLOCKS, worlds.BlocksWorld([["a", "b"]]).percepts(), "((on b a))")
