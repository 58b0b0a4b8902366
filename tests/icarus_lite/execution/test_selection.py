"""Which path is chosen: order, backtracking, arguments that are bound below, and passed back."""

from __future__ import annotations

import pytest

from icarus_lite import Agent, Decision, DecisionKind, Outcome, Percept
from icarus_lite.execution.selection import MAX_DEPTH
from icarus_lite.language import parse_domain
from icarus_lite.language.syntax import Domain
from icarus_lite.planning import FailureReason

WORLD = """
(percepts (thing ^at ^colour) (place ^free))
(concepts
  ((in ?t ?p) :elements ((thing ?t ^at ?p) (place ?p)))
  ((free ?p) :elements ((place ?p ^free yes))))
"""
MOVE = """
  ((move ?t ?from ?to) :elements ((in ?t ?from) (free ?to)) :tests ((/= ?from ?to))
                       :actions ((*move ?t ?to)) :effects ((in ?t ?to) (not (in ?t ?from))))"""
THINGS = [
    Percept("thing", "cup", {"at": "p1", "colour": "red"}),
    Percept("thing", "jug", {"at": "p2", "colour": "blue"}),
    Percept("place", "p1", {"free": "no"}),
    Percept("place", "p2", {"free": "no"}),
    Percept("place", "p3", {"free": "yes"}),
    Percept("place", "p4", {"free": "yes"}),
]


def domain_of(skills: str) -> Domain:
    domain, problems = parse_domain(f"{WORLD}(skills {MOVE}{skills})")
    assert domain is not None, problems
    return domain


def chosen(skills: str, call: str) -> Decision:
    return Agent(domain_of(skills), intentions=[call]).cycle(THINGS)


def test_a_free_argument_is_bound_by_the_first_that_matches() -> None:
    decision = chosen("", "(move cup ?from ?to)")
    assert str(decision.action) == "(move cup p1 p3)"
    assert decision.commands == (type(decision.action)("move", ("cup", "p3")),)


def test_clauses_are_tried_as_written() -> None:
    skills = """
      ((tidy ?t) :elements ((thing ?t)) :subskills ((move ?t ?from p4)) :effects ((in ?t p4)))
      ((tidy ?t) :elements ((thing ?t)) :subskills ((move ?t ?from p3)) :effects ((in ?t p3)))"""
    assert str(chosen(skills, "(tidy cup)").action) == "(move cup p1 p4)"


def test_what_leads_no_further_is_undone_and_the_next_tried() -> None:
    """The first clause fails only at its subskill, and so does the first binding of the second."""
    skills = """
      ((tidy ?t) :elements ((thing ?t)) :subskills ((move ?t ?from p2)) :effects ((tidied ?t)))
      ((tidy ?t) :elements ((thing ?t) (place ?p)) :subskills ((shelve ?t ?p))
                 :effects ((tidied ?t)))
      ((shelve ?t ?p) :elements ((free ?p)) :subskills ((move ?t ?_from ?p))
                      :effects ((in ?t ?p)))"""
    decision = chosen(skills, "(tidy cup)")
    assert str(decision.skill_path) == "(tidy cup) → (shelve cup p3) → (move cup p1 p3)"


def test_what_a_subskill_has_bound_goes_on_to_the_next() -> None:
    skills = """
      ((pair ?a ?b) :tests ((/= ?a ?b))
                    :subskills ((move ?a ?_from ?where) (visit ?b ?where))
                    :effects ((paired ?a ?b)))
      ((visit ?t ?p) :elements ((in ?t ?from) (place ?p)) :actions ((*visit ?t ?from ?p))
                     :effects ((in ?t ?p)))"""
    agent = Agent(domain_of(skills), intentions=["(pair cup jug)"])
    first = agent.cycle(THINGS)
    assert str(first.action) == "(move cup p1 p3)"
    assert "?where" not in dict(first.skill_path.levels[0].bindings)
    moved = [Percept("thing", "cup", {"at": "p3"}), *THINGS[1:]]
    second = agent.cycle(moved, Outcome(first.action))
    assert str(second.action) == "(visit jug p3)"
    assert dict(second.skill_path.levels[0].bindings)["?where"] == "p3"


def test_a_subskill_whose_effects_are_believed_is_passed_over_and_binds_all_the_same() -> None:
    skills = """
      ((follow ?a ?b) :elements ((thing ?a) (thing ?b)) :tests ((/= ?a ?b))
                      :subskills ((settle ?a ?where) (visit ?b ?where)) :effects ((met ?a ?b)))
      ((settle ?t ?p) :elements ((place ?p)) :actions ((*settle ?t ?p)) :effects ((in ?t ?p)))
      ((visit ?t ?p) :elements ((in ?t ?from) (place ?p)) :actions ((*visit ?t ?from ?p))
                     :effects ((in ?t ?p)))"""
    decision = chosen(skills, "(follow cup jug)")
    assert str(decision.action) == "(visit jug p1)"
    assert decision.skill_path.levels[0].position == 1


def test_arguments_that_the_caller_wants_equal_are_equal() -> None:
    skills = """
      ((swap ?t) :elements ((thing ?t)) :subskills ((carry ?t ?x ?x)) :effects ((swapped ?t)))
      ((carry ?t ?from ?to) :elements ((in ?t ?from) (place ?to)) :actions ((*carry ?t ?to))
                            :effects ((carried ?t)))"""
    assert str(chosen(skills, "(swap jug)").action) == "(carry jug p2 p2)"


def test_a_goal_is_served_by_the_skill_whose_effect_it_is() -> None:
    decision = Agent(domain_of(""), ["(in jug p4)"]).cycle(THINGS)
    assert str(decision.skill_path) == "(in jug p4) → (move jug p2 p4)"
    assert [str(step.action) for step in decision.path] == ["(move jug p2 p4)"]
    assert [(c.skill, c.chosen) for c in decision.candidates] == [("(move jug p2 p4)", True)]


def test_a_goal_that_something_is_not_so_is_served_by_what_makes_it_so() -> None:
    decision = Agent(domain_of(""), ["(not (in ?any p2))"]).cycle(THINGS)
    assert str(decision.action) == "(move jug p2 p3)"


def test_goals_are_pursued_in_their_order() -> None:
    goals = ["(in jug p3)", "(in cup p4)"]
    assert str(Agent(domain_of(""), goals).cycle(THINGS).action) == "(move jug p2 p3)"
    assert str(Agent(domain_of(""), goals[::-1]).cycle(THINGS).action) == "(move cup p1 p4)"


def test_what_is_to_be_moved_anywhere_is_not_there_already() -> None:
    """An open argument: that the cup is somewhere does not make `move` done."""
    assert chosen("", "(move cup ?from ?to)").kind is DecisionKind.ACT
    nowhere_free = [*THINGS[:4], *(Percept("place", p, {"free": "no"}) for p in ("p3", "p4"))]
    decision = Agent(domain_of(""), intentions=["(move cup ?from ?to)"]).cycle(nowhere_free)
    assert decision.kind is DecisionKind.IMPASSE
    assert not decision.intentions[0].done
    there = Agent(domain_of(""), intentions=["(move cup p4 p1)"]).cycle(THINGS)
    assert there.kind is DecisionKind.ACHIEVED


def test_planning_is_asked_only_where_no_skill_leads_on(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[object] = []

    def never(*args: object, **_options: object) -> None:
        asked.append(args)
        raise AssertionError("planning was asked")

    monkeypatch.setattr("icarus_lite.execution.executor.find_plan", never)
    Agent(domain_of(""), ["(in jug p4)"]).cycle(THINGS)
    assert not asked
    with pytest.raises(AssertionError, match="planning was asked"):
        Agent(domain_of(""), ["(in jug p1)"]).cycle(THINGS)  # p1 has to be freed, by nobody


def test_a_macro_without_effects_is_done_when_its_subskills_are() -> None:
    skills = "((both) :subskills ((move cup ?a p3) (move jug ?b p4)))"
    agent = Agent(domain_of(skills), intentions=["(both)"])
    first = agent.cycle(THINGS)
    assert str(first.action) == "(move cup p1 p3)"
    moved = [Percept("thing", "cup", {"at": "p3"}), *THINGS[1:]]
    second = agent.cycle(moved, Outcome(first.action))
    assert str(second.action) == "(move jug p2 p4)"
    there = [moved[0], Percept("thing", "jug", {"at": "p4"}), *THINGS[2:]]
    assert agent.cycle(there, Outcome(second.action)).kind is DecisionKind.ACHIEVED
    assert (
        Agent(domain_of(skills), intentions=["(both)"]).cycle(there).kind is DecisionKind.ACHIEVED
    )


def test_a_skill_that_calls_itself_again_after_acting_is_no_loop() -> None:
    """Pouring until the glass is full: each round goes a level deeper, and each has acted."""
    domain, problems = parse_domain("""
      (percepts (glass ^level))
      (concepts ((full ?g) :elements ((glass ?g ^level ?l)) :tests ((>= ?l 30))))
      (skills ((pour ?g) :elements ((glass ?g)) :actions ((*pour ?g)))
              ((fill ?g) :elements ((glass ?g)) :subskills ((pour ?g) (fill ?g))
                         :effects ((full ?g))))
      """)
    assert domain is not None, problems
    agent, outcome, level, depths = Agent(domain, intentions=["(fill g)"]), None, 0, []
    while True:
        decision = agent.cycle([Percept("glass", "g", {"level": level})], outcome)
        if decision.kind is DecisionKind.ACHIEVED:
            break
        depths.append(len(decision.skill_path.levels))
        outcome, level = Outcome(decision.action), level + 1
    assert (level, depths) == (30, list(range(2, 32)))


def test_a_recursion_without_end_is_refused_with_its_depth() -> None:
    """Each thing hands on to another, round and round: no two levels are alike for long."""
    domain, problems = parse_domain("""
      (percepts (link ^to))
      (skills ((go ?a) :elements ((link ?a ^to ?b)) :subskills ((go ?b)) :effects ((gone ?a))))
      """)
    assert domain is not None, problems
    length = MAX_DEPTH + 200
    links = [Percept("link", f"n{i}", {"to": f"n{i + 1}"}) for i in range(length)]
    decision = Agent(domain, intentions=["(go n0)"]).cycle(links)
    assert decision.kind is DecisionKind.IMPASSE
    loops = [f.text for f in decision.failures if f.reason is FailureReason.LOOP]
    assert loops == [f"(go n{MAX_DEPTH}): skills call one another {MAX_DEPTH} levels deep"]
    ring = [*links[:9], Percept("link", "n9", {"to": "n0"})]
    decision = Agent(domain, intentions=["(go n0)"]).cycle(ring)
    loops = [f.text for f in decision.failures if f.reason is FailureReason.LOOP]
    assert loops == ["(go n0): it calls itself, and nothing is done in between"]
