"""Answers as plain data: they survive JSON, and say what the text says."""

from __future__ import annotations

import json

import pytest

from icarus_lite import Action, Agent, Outcome, Percept, Status
from icarus_lite.inference.explaining import why_not_document
from icarus_lite.language import parse_domain

DOMAIN, PROBLEMS = parse_domain("""
(percepts (hand) (object ^x ^type))
(concepts
  ((free ?h) :elements ((hand ?h) (not (holding ?h ?any))))
  ((left ?o) :elements ((object ?o ^x ?x)) :tests ((< ?x 0)))
  ((ready ?h ?o) :elements ((free ?h) (left ?o)))
  ((bare ?o) :elements ((object ?o ^type bare) (not (left ?o)))))
(skills
  ((pick-up ?h ?o) :elements ((ready ?h ?o)) :while ((left ?o)) :actions ((*grasp ?h ?o))
                   :effects ((holding ?h ?o))))
""")
assert DOMAIN is not None, PROBLEMS
SCENE = [Percept("hand", "h"), Percept("object", "o", {"x": 3})]


@pytest.fixture
def agent() -> Agent:
    agent = Agent(DOMAIN)
    agent.cycle(SCENE, Outcome(Action("pick-up", ("h", "o"))))
    agent.cycle(SCENE, Outcome(Action("pick-up", ("h", "o")), Status.FAILED, "slipped"))
    agent.cycle(SCENE[:1])
    return agent


def test_a_belief(agent: Agent) -> None:
    agent.cycle(SCENE)
    document = why_not_document(agent.why_not("(left ?o)"))
    (clause,) = document["clauses"]
    assert clause["reason"] == {
        "kind": "failed-test",
        "text": "(< 3 0) fails: 3 is not less than 0",
        "test": "(< 3 0)",
        "sides": [3, 0],
    }
    assert clause["conditions"] == [
        {
            "condition": "(object ?o ^x ?x)",
            "bound": "(object o ^x 3)",
            "standing": "met",
            "fact": "(object o ^x 3)",
        },
        {"condition": "(< ?x 0)", "bound": "(< 3 0)", "standing": "failed"},
    ]
    assert (document["kind"], document["holds"], document["cycle"]) == ("belief", False, 3)


def test_an_asserted_belief_with_its_past(agent: Agent) -> None:
    document = why_not_document(agent.why_not("(holding h ?what)"))
    assert document["sources"] == [
        {"action": "(pick-up h ?o)", "lines": [9], "asserts": True},
    ]
    assert document["past"] == [
        {
            "belief": "(holding h o)",
            "periods": [[0, 1]],
            "ended": "o was no longer perceived in cycle 2",
        }
    ]
    assert document["reports"] == [
        {"cycle": 1, "action": "(pick-up h o)", "status": "failed", "reason": "slipped"}
    ]


def test_a_skill_with_what_would_break_it(agent: Agent) -> None:
    document = why_not_document(agent.why_not("(pick-up h o)"))
    (clause,) = document["clauses"]
    assert document["kind"] == "skill"
    assert clause["broken"]["kind"] == "missing"
    assert clause["outstanding_effects"] == ["(holding h o)"]
    assert clause["deeper"]["asked"] == "(ready h o)"


@pytest.mark.parametrize(
    "asked",
    [
        "(free h)",
        "(left ?o)",
        "(ready ?h ?o)",
        "(bare ?o)",
        "(bare o)",
        "(object p)",
        "(holding h o)",
        "(not (hand ?h))",
        "(pick-up ?h ?o)",
        "(pick-up h)",
        "(lefd o)",
    ],
)
def test_every_answer_survives_json_and_keeps_its_reasons(agent: Agent, asked: str) -> None:
    for scene in (SCENE, SCENE[1:], []):
        agent.cycle(scene)
        answer = agent.why_not(asked)
        document = why_not_document(answer)
        assert json.loads(json.dumps(document, allow_nan=False)) == document
        told = [clause.get("reason", {}).get("text") for clause in document.get("clauses", [])]
        assert told == [
            None if verdict.reason is None else str(verdict.reason) for verdict in answer.clauses
        ]


def test_a_proof_has_every_node_once(agent: Agent) -> None:
    agent.cycle([Percept("hand", "h"), Percept("object", "o", {"x": -3})])
    document = agent.why("(ready h o)").as_document()
    assert json.loads(json.dumps(document)) == document
    root, free, left, hand, thing = document["nodes"]
    assert (root["belief"], root["premises"]) == ("(ready h o)", [1, 2])
    assert (free["premises"], free["absences"]) == ([3], ["(holding h ?any)"])
    assert [each["because"] for each in (hand, thing)] == ["is perceived"] * 2
    assert left["belief"] == "(left o)"
    assert document["periods"] == [[3, None]]
