from __future__ import annotations

import pytest

from icarus_lite.agent import Agent
from icarus_lite.errors import FrameError
from icarus_lite.inference import InferenceEngine, Memory
from icarus_lite.language.reading.reader import parse_domain
from icarus_lite.outcomes import Outcome
from icarus_lite.symbols import Action, Percept

DOMAIN, _ = parse_domain("""
(percepts (object ^x) (part :is object ^grip) (screw :is part) (hand))
(concepts
  ((left ?o) :elements ((object ?o ^x ?x)) :tests ((< ?x 0)))
  ((easy ?o) :elements ((part ?o ^grip wide ^x ?_x)))
  ((loose ?o) :elements ((screw ?o)))
  ((no-parts) :elements ((not (part ?any)))))
(skills ((take ?h ?o) :elements ((hand ?h) (object ?o)) :actions ((*take ?h ?o))
         :effects ((held ?o))))
""")
SCREW = Percept("screw", "s1", {"x": -1, "grip": "wide"})


def beliefs(*percepts):
    memory = InferenceEngine(DOMAIN).step(Memory(), percepts)
    return [str(belief) for belief in memory.state.beliefs]


def test_a_percept_matches_the_patterns_of_every_type_above_its_own():
    assert beliefs(SCREW) == ["(easy s1)", "(left s1)", "(loose s1)"]


def test_a_percept_does_not_match_the_patterns_of_its_subtypes():
    assert beliefs(Percept("object", "o1", {"x": -1, "grip": "wide"})) == [
        "(left o1)",
        "(no-parts)",
    ]


def test_percepts_stay_as_they_came_and_all_their_types_are_facts():
    state = InferenceEngine(DOMAIN).step(Memory(), [SCREW]).state
    assert state.percepts == (SCREW,)
    assert [fact.predicate for fact in state.facts()][:3] == ["screw", "part", "object"]


def test_one_object_is_not_perceived_under_two_types_of_one_lineage():
    with pytest.raises(FrameError, match="2 percepts of type part are named s1"):
        beliefs(SCREW, Percept("part", "s1"))


def test_a_belief_about_a_subtype_is_explained_by_the_percept_as_it_came():
    agent = Agent(DOMAIN)
    agent.cycle([SCREW])
    assert str(agent.why("(left s1)")).splitlines()[1].strip() == f"{SCREW}  is perceived"


def test_skills_and_plans_reach_subtypes():
    agent = Agent(DOMAIN, ["(held s1)"])
    decision = agent.cycle([SCREW, Percept("hand", "h")])
    assert decision.action == Action("take", ("h", "s1"))
    decision = agent.cycle([SCREW, Percept("hand", "h")], Outcome(decision.action))
    assert decision.kind.value == "achieved"
