from __future__ import annotations

import pytest

from icarus_lite import Action, Percept
from icarus_lite.inference import InferenceEngine, Memory
from icarus_lite.language.fragments import parse_conditions
from icarus_lite.language.reading.reader import parse_domain
from icarus_lite.planning import FailureReason, Imagination, NoPlan, Plan, find_plan

BLOCKS = """
(percepts (block ^x ^y) (table) (hand ^status))
(concepts
  ((on ?a ?b) :elements ((block ?a ^x ?x ^y ?ya) (block ?b ^x ?x ^y ?yb))
              :tests ((= ?ya (+ ?yb 1))))
  ((ontable ?a ?t) :elements ((block ?a ^y 0) (table ?t)))
  ((clear ?b) :elements ((block ?b) (not (on ?other ?b))))
  ((holding ?g ?b) :elements ((hand ?g ^status ?b) (block ?b)))
  ((hand-empty ?g) :elements ((hand ?g ^status empty))))
(skills
  ((unstack ?g ?b ?from) :elements ((on ?b ?from) (clear ?b) (hand-empty ?g))
     :actions ((*grasp ?g ?b))
     :effects ((holding ?g ?b) (clear ?from) (not (on ?b ?from)) (not (hand-empty ?g))
               (not (clear ?b))))
  ((take ?g ?b ?t) :elements ((ontable ?b ?t) (clear ?b) (hand-empty ?g)) :actions ((*grasp ?g ?b))
     :effects ((holding ?g ?b) (not (ontable ?b ?t)) (not (hand-empty ?g)) (not (clear ?b))))
  ((put-down ?g ?b ?t) :elements ((holding ?g ?b) (table ?t)) :actions ((*place ?g ?b ?t))
     :effects ((ontable ?b ?t) (clear ?b) (hand-empty ?g) (not (holding ?g ?b))))
  ((stack ?g ?b ?to) :elements ((holding ?g ?b) (clear ?to)) :actions ((*place-on ?g ?b ?to))
     :effects ((on ?b ?to) (clear ?b) (hand-empty ?g) (not (clear ?to)) (not (holding ?g ?b)))))
"""

ASSEMBLY = """
(percepts (hand) (object ^type))
(concepts ((free ?h) :elements ((hand ?h) (not (holding ?h ?any))))
          ((loose ?o) :elements ((object ?o) (not (attached ?o ?any)))))
(skills
  ((pick-up ?h ?o) :elements ((free ?h) (loose ?o) (object ?o ^type part)) :actions ((*grasp ?h ?o))
                   :effects ((holding ?h ?o)))
  ((insert ?o ?into) :elements ((holding ?h ?o) (object ?into ^type case))
                     :actions ((*insert ?h ?o ?into)) :effects ((not (holding ?h ?o))))
  ((polish ?o) :elements ((loose ?o)) :actions ((*polish ?o)) :effects ((shiny ?o))))
(attachments
  ((pick-up ?h ?o) :until (place-down ?h ?o) :child ?o :parent ?h)
  ((insert ?o ?into) :until (take-out ?o ?into) :child ?o :parent ?into))
"""
PARTS = tuple(Percept("object", name, {"type": "part"}) for name in ("hubcover", "plug", "shaft"))
SCENE = (Percept("hand", "h1"), Percept("object", "case", {"type": "case"}), *PARTS)


def plan(text: str, percepts: tuple[Percept, ...], goal: str, **options: object) -> Plan | NoPlan:
    domain, problems = parse_domain(text)
    assert domain is not None, problems
    engine = InferenceEngine(domain)
    memory = engine.step(Memory(), percepts)
    imagination = Imagination(domain, memory, engine.closure, engine.evaluator)
    return find_plan(domain, imagination, parse_conditions(goal), **options)


def steps(found: Plan | NoPlan) -> list[str]:
    assert isinstance(found, Plan), found
    return [str(step.action) for step in found.steps]


def blocks(*towers: str) -> tuple[Percept, ...]:
    rows = [
        Percept("block", name, {"x": x, "y": y})
        for x, tower in enumerate(towers)
        for y, name in enumerate(tower)
    ]
    return (*rows, Percept("table", "t"), Percept("hand", "h", {"status": "empty"}))


def test_the_goal_of_task_one_takes_two_skills() -> None:
    assert steps(plan(ASSEMBLY, SCENE, "(attached hubcover case)")) == [
        "(pick-up h1 hubcover)",
        "(insert hubcover case)",
    ]


def test_several_goals_share_one_hand() -> None:
    goal = "((attached plug case) (attached shaft case))"
    assert len(steps(plan(ASSEMBLY, SCENE, goal))) == 4


def test_a_negated_goal() -> None:
    assert steps(plan(ASSEMBLY, SCENE, "(not (loose plug))")) == ["(pick-up h1 plug)"]


def test_a_goal_that_holds_needs_no_step() -> None:
    assert steps(plan(ASSEMBLY, SCENE, "(free h1)")) == []


def test_sussmans_anomaly() -> None:  # fixture F12: C on A, B beside
    found = plan(BLOCKS, blocks("ac", "b"), "((on a b) (on b c))")
    assert steps(found) == [
        "(unstack h c a)",
        "(put-down h c t)",
        "(take h b t)",
        "(stack h b c)",
        "(take h a t)",
        "(stack h a b)",
    ]


def test_a_tower_is_cleared_from_the_top() -> None:
    assert steps(plan(BLOCKS, blocks("abc"), "(clear a)")) == [
        "(unstack h c b)",
        "(put-down h c t)",
        "(unstack h b a)",
    ]


def test_a_literal_that_no_skill_changes_is_said_to_be_so() -> None:
    found = plan(ASSEMBLY, SCENE, "(melted case)")
    assert found == NoPlan("no skill can ever make (melted case) true", final=True)


def test_what_is_out_of_reach_is_traced_to_the_condition_at_which_the_best_way_ends() -> None:
    found = plan(ASSEMBLY, SCENE, "(attached case hubcover)")
    assert found == NoPlan(
        "no skill can ever make (attached case hubcover) true: "
        "(insert ?o ?into) needs (holding ?h case); "
        "(pick-up ?h ?o) needs (object case ^type part)",
        final=True,
    )


def test_an_impasse_names_what_could_start() -> None:
    found = plan(ASSEMBLY, SCENE, "((attached plug case) (attached plug h1))")
    assert isinstance(found, NoPlan)
    assert found.final
    assert "(pick-up h1 hubcover)" in found.reason


def test_the_limit_is_said_to_be_a_limit() -> None:
    found = plan(BLOCKS, blocks("ac", "b"), "((on a b) (on b c))", limit=3)
    reason = "no plan among the first 3 situations imagined"
    assert found == NoPlan(reason, final=False, failure=FailureReason.SEARCH_LIMIT)


def test_an_excluded_action_is_not_used() -> None:
    excluded = [Action("pick-up", ("h1", "hubcover"))]
    found = plan(ASSEMBLY, SCENE, "(attached hubcover case)", excluded=excluded)
    assert found == NoPlan("no other way leads to (attached hubcover case)", final=True)


@pytest.mark.parametrize("goal", ["(attached hubcover case)", "(on a b)"])
def test_the_same_question_gives_the_same_plan(goal: str) -> None:
    text, percepts = (ASSEMBLY, SCENE) if "case" in goal else (BLOCKS, blocks("ac", "b"))
    assert plan(text, percepts, goal) == plan(text, percepts, goal)
