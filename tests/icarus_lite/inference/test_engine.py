from __future__ import annotations

import math

import pytest

from icarus_lite import Action, FrameError, Outcome, Percept, Status
from icarus_lite.inference import Assertion, InferenceEngine, Memory
from icarus_lite.language.reading.reader import parse_domain

TEXT = """
(percepts (hand) (object ^type) (lamp))
(concepts
  ((free ?h) :elements ((hand ?h) (not (holding ?h ?any)))))
(skills
  ((pick-up ?h ?o) :elements ((hand ?h) (object ?o ^type output) (free ?h))
                   :actions ((*grasp ?h ?o)) :effects ((holding ?h ?o)))
  ((pick-up ?h ?o) :elements ((hand ?h) (object ?o ^type plug) (free ?h))
                   :actions ((*grasp ?h ?o)) :effects ((holding ?h ?o) (warm ?o)))
  ((place-down ?h ?o) :elements ((holding ?h ?o)) :actions ((*place ?h ?o))
                      :effects ((not (holding ?h ?o)) (free ?h)))
  ((insert ?o ?into) :elements ((holding ?h ?o) (object ?into)) :actions ((*insert ?h ?o ?into))
                     :effects ((not (holding ?h ?o))))
  ((glue ?a ?b) :elements ((object ?a) (object ?b)) :actions ((*glue ?a ?b))
                :effects ((attached ?a ?b))))
(attachments
  ((pick-up ?h ?o) :until (place-down ?h ?o) :child ?o :parent ?h)
  ((insert ?o ?into) :until (take-out ?o ?into) :child ?o :parent ?into))
"""
DOMAIN, PROBLEMS = parse_domain(TEXT)
assert DOMAIN is not None, PROBLEMS

HAND = Percept("hand", "h1")
PLUG = Percept("object", "o1", {"type": "plug"})
CASE = Percept("object", "c1", {"type": "case"})
ALL = (HAND, PLUG, CASE)


def outcome(name: str, *args: str, status: Status = Status.SUCCEEDED) -> Outcome:
    return Outcome(Action(name, args), status)


def run(*frames: tuple) -> list[set[str]]:
    engine, memory, history = InferenceEngine(DOMAIN), Memory(), []
    for percepts, *outcomes in frames:
        memory = engine.step(memory, percepts, outcomes)
        history.append({str(belief) for belief in memory.state.beliefs})
    return history


def test_attached_holds_from_the_attach_to_the_line_before_the_detach() -> None:  # fixture F9
    frames = [(ALL, outcome("pick-up", "h1", "o1"))]
    frames += [(ALL,)] * 8
    frames += [(ALL, outcome("place-down", "h1", "o1"))]
    history = run(*frames)
    assert [("(attached o1 h1)" in beliefs) for beliefs in history] == [True] * 9 + [False]


def test_the_same_without_any_percepts() -> None:
    frames = [((), outcome("pick-up", "h1", "o1")), ((),), ((), outcome("place-down", "h1", "o1"))]
    assert [("(attached o1 h1)" in b) for b in run(*frames)] == [True, True, False]


@pytest.mark.parametrize("status", [Status.FAILED, Status.RUNNING])
def test_an_action_that_did_not_succeed_asserts_nothing(status: Status) -> None:
    assert run((ALL, outcome("pick-up", "h1", "o1", status=status))) == [{"(free h1)"}]


def test_an_effect_persists_until_an_effect_removes_it() -> None:
    history = run(
        (ALL,),
        (ALL, outcome("pick-up", "h1", "o1")),
        (ALL,),
        (ALL, outcome("place-down", "h1", "o1")),
    )
    assert [("(holding h1 o1)" in beliefs) for beliefs in history] == [False, True, True, False]


def test_an_effect_ends_with_its_object() -> None:
    history = run((ALL, outcome("pick-up", "h1", "o1")), ((HAND, CASE),), (ALL,))
    assert history[1] == {"(free h1)"}
    assert "(holding h1 o1)" not in history[2]


def test_an_effect_on_a_defined_concept_is_left_to_perception() -> None:
    history = run(((HAND,), outcome("place-down", "h1", "o1")), ((),))
    assert history == [{"(free h1)"}, set()]


def test_a_variable_that_the_record_does_not_name_removes_every_match() -> None:
    history = run((ALL, outcome("pick-up", "h1", "o1")), (ALL, outcome("insert", "o1", "c1")))
    assert history[1] == {"(attached o1 c1)", "(free h1)", "(warm o1)"} - {"(warm o1)"}


def test_the_clause_that_was_applicable_before_decides_the_effects() -> None:
    history = run((ALL,), (ALL, outcome("pick-up", "h1", "o1")))
    assert "(warm o1)" in history[1]


def test_without_an_earlier_state_only_what_all_clauses_agree_on_is_asserted() -> None:
    (beliefs,) = run((ALL, outcome("pick-up", "h1", "o1")))
    assert "(holding h1 o1)" in beliefs
    assert "(warm o1)" not in beliefs


def test_an_attached_effect_goes_through_the_hierarchy() -> None:
    history = run((ALL, outcome("pick-up", "h1", "o1")), (ALL, outcome("glue", "o1", "c1")))
    assert "(attached o1 c1)" in history[1]
    assert "(attached o1 h1)" not in history[1]


def test_a_refused_attachment_is_noted() -> None:
    engine = InferenceEngine(DOMAIN)
    memory = engine.step(Memory(), ALL, [outcome("insert", "o1", "c1")])
    memory = engine.step(memory, ALL, [outcome("insert", "c1", "o1")])
    assert "already moves with" in memory.state.notes[0]


def test_an_asserted_belief_knows_its_action_and_cycle() -> None:
    engine = InferenceEngine(DOMAIN)
    memory = engine.step(Memory(), ALL)
    memory = engine.step(memory, ALL, [outcome("pick-up", "h1", "o1")])
    memory = engine.step(memory, ALL)
    supports = {str(belief): s for belief, s in memory.state.supports.items()}
    cause = Assertion(Action("pick-up", ("h1", "o1")), 1)
    assert supports["(holding h1 o1)"] == (cause,)
    assert supports["(attached o1 h1)"] == (cause,)


def test_two_percepts_of_one_name_are_refused() -> None:
    with pytest.raises(FrameError, match="2 percepts of type object are named o1"):
        InferenceEngine(DOMAIN).step(Memory(), [PLUG, PLUG])


@pytest.mark.parametrize("value", [math.nan, math.inf, True])
def test_an_attribute_that_is_no_finite_number_is_refused(value: float) -> None:
    with pytest.raises(FrameError, match="attribute x of o1"):
        InferenceEngine(DOMAIN).step(Memory(), [Percept("object", "o1", {"x": value})])


def test_a_step_leaves_the_memory_it_was_given_alone() -> None:
    engine = InferenceEngine(DOMAIN)
    first = engine.step(Memory(), ALL, [outcome("pick-up", "h1", "o1")])
    before = (first.state.beliefs, dict(first.asserted))
    engine.step(first, ALL, [outcome("place-down", "h1", "o1")])
    assert (first.state.beliefs, dict(first.asserted)) == before


def test_each_outcome_is_judged_by_what_the_one_before_it_has_left() -> None:
    text = """(percepts (hand) (object))
    (concepts ((free ?h) :elements ((hand ?h) (not (holding ?h ?any)))))
    (skills
      ((place-down ?h ?o) :elements ((holding ?h ?o)) :actions ((*place ?h ?o))
                          :effects ((not (holding ?h ?o))))
      ((pick-up ?h ?o) :elements ((free ?h) (object ?o)) :actions ((*grasp ?h ?o))
                       :effects ((holding ?h ?o)))
      ((take-out ?o ?from) :elements ((free ?h) (object ?o) (object ?from))
                           :actions ((*take-out ?h ?o ?from)) :effects ((holding ?h ?o))))"""
    domain, problems = parse_domain(text)
    assert domain is not None, problems
    engine, memory = InferenceEngine(domain), Memory()
    memory = engine.step(memory, ALL)
    memory = engine.step(memory, ALL, [outcome("pick-up", "h1", "c1")])
    both = [outcome("place-down", "h1", "c1"), outcome("take-out", "o1", "c1")]
    assert [str(b) for b in engine.step(memory, ALL, both).state.beliefs] == ["(holding h1 o1)"]
    assert [str(b) for b in engine.step(memory, ALL, both[::-1]).state.beliefs] == ["(free h1)"]


def test_what_is_asserted_anew_with_another_value_is_looked_back_to_with_the_old_one() -> None:
    text = """(percepts (object))
    (skills
      ((paint ?o ?c) :elements ((object ?o)) :actions ((*paint ?o ?c)) :effects ((mark ?o ^is ?c)))
      ((strip ?o) :elements ((object ?o)) :actions ((*strip ?o))
                  :effects ((not (mark ?o)))))"""
    domain, problems = parse_domain(text)
    assert domain is not None, problems
    engine, memory = InferenceEngine(domain), Memory()
    memory = engine.step(memory, ALL[1:], [outcome("paint", "o1", "red")])
    memory = engine.step(memory, ALL[1:], [outcome("strip", "o1"), outcome("paint", "o1", "blue")])
    for state, colour in ((engine.look_back(0), "red"), (memory.state, "blue")):
        assert [dict(belief.attributes) for belief in state.supports] == [{"is": colour}]
