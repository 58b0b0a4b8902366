"""What a task gives at its start is believed as if a skill had asserted it."""

from __future__ import annotations

from icarus_lite.agent import Agent, DecisionKind
from icarus_lite.inference import (
    GIVEN,
    InferenceEngine,
    Memory,
    explain,
    given_memory,
    given_percepts,
)
from icarus_lite.language import parse_domain
from icarus_lite.language.syntax import Domain
from icarus_lite.symbols import Belief, Percept

TEXT = """
(percepts (room) (robot ^at) (crate))
(concepts ((reachable ?r) :elements ((robot ?_ ^at ?here) (door ?here ?r))))
(skills ((go ?robot ?r) :elements ((robot ?robot) (reachable ?r)) :actions ((*drive ?robot ?r))
         :effects ((visited ?r))))
(task t :init ((robot robby ^at hall) (room hall) (room kitchen) (crate box) (crate lid)
               (door hall kitchen) (attached lid box))
        :goal ((visited kitchen)))
"""


def domain() -> Domain:
    read, found = parse_domain(TEXT)
    assert read is not None, found
    return read


def started() -> Memory:
    read = domain()
    init = read.tasks[0].init
    return InferenceEngine(read).step(given_memory(read, init), given_percepts(read, init))


def test_percepts_keep_their_attributes() -> None:
    read = domain()
    assert given_percepts(read, read.tasks[0].init)[0] == Percept("robot", "robby", {"at": "hall"})


def test_facts_are_asserted_attached_and_derived_from() -> None:
    memory = started()
    beliefs = [str(belief) for belief in memory.state.beliefs]
    assert beliefs == ["(attached lid box)", "(door hall kitchen)", "(reachable kitchen)"]
    assert memory.asserted[Belief("door", ("hall", "kitchen"))].action == GIVEN
    assert list(memory.state.hierarchy.pairs()) == [("lid", "box")]


def test_why_says_that_it_is_given() -> None:
    text = str(explain(Belief("door", ("hall", "kitchen")), started().state))
    assert text == "(door hall kitchen)  is given from the start"


def test_given_facts_outlast_the_first_cycle_and_go_with_their_objects() -> None:
    engine, memory = InferenceEngine(domain()), started()
    memory = engine.step(memory, [p for p in memory.state.percepts if p.name != "lid"])
    beliefs = [str(belief) for belief in memory.state.beliefs]
    assert beliefs == ["(door hall kitchen)", "(reachable kitchen)"]


def test_an_attachment_in_a_circle_is_refused_with_a_note() -> None:
    read, _ = parse_domain(
        "(percepts (o)) (task t :init ((attached a b) (attached b a)) :goal ((o a)))"
    )
    assert read is not None
    memory = given_memory(read, read.tasks[0].init)
    assert list(memory.state.hierarchy.pairs()) == [("a", "b")]
    assert "already moves with" in memory.state.notes[0]


def test_an_agent_believes_from_the_start_what_no_camera_sees() -> None:
    read = domain()
    percepts = [Percept("robot", "robby", {"at": "hall"}), Percept("room", "kitchen")]
    goals = read.tasks[0].goals
    assert Agent(read, goals).cycle(percepts).kind is DecisionKind.IMPASSE
    decision = Agent(read, goals, given=read.tasks[0].init).cycle(percepts)
    assert str(decision.action) == "(go robby kitchen)"
