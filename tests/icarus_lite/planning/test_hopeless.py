"""Why nothing can ever lead to a goal."""

from __future__ import annotations

import pytest

from icarus_lite import Percept
from icarus_lite.inference import InferenceEngine, Memory
from icarus_lite.language.fragments import parse_conditions
from icarus_lite.language.reading.reader import parse_domain
from icarus_lite.planning import FailureReason, NoPlan, find_plan
from tests.reference.ground_walks import imagined

TEXT = """
(percepts (hand) (object ^type ^weight))
(concepts
  ((free ?h) :elements ((hand ?h) (not (holding ?h ?any))))
  ((done ?o) :elements ((painted ?o) (object ?o ^type part)))
  ((safe ?o) :elements ((object ?o) (not (object ?o ^type glass)) (not (holding ?_h ?o)))))
(skills
  ((pick-up ?h ?o) :elements ((free ?h) (object ?o ^weight ?w)) :tests ((< ?w 5))
                   :actions ((*grasp ?h ?o)) :effects ((holding ?h ?o)))
  ((paint ?o) :elements ((holding ?h ?o) (brush ?b)) :actions ((*paint ?h ?o))
              :effects ((painted ?o)))
  ((wash ?o) :elements ((safe ?o)) :actions ((*wash ?o)) :effects ((clean ?o)))
  ((fetch ?b) :elements ((hand ?b)) :actions ((*fetch ?b)) :effects ((brush ?b)))
  ((drop ?h ?o) :elements ((holding ?h ?o)) :actions ((*drop ?h ?o))
                :effects ((not (holding ?h ?o)))))
"""
SCENE = [
    Percept("hand", "h"),
    Percept("object", "anvil", {"type": "part", "weight": 50}),
    Percept("object", "vase", {"type": "glass", "weight": 1}),
]


def answer(goal: str, text: str = TEXT) -> NoPlan:
    domain, problems = parse_domain(text)
    assert domain is not None, problems
    engine = InferenceEngine(domain)
    imagination = imagined(engine, engine.step(Memory(), SCENE))
    found = find_plan(domain, imagination, parse_conditions(goal))
    assert isinstance(found, NoPlan)
    return found


@pytest.mark.parametrize(
    ("goal", "why"),
    [
        ("(melted vase)", ""),
        ("(holding h anvil)", "for (pick-up ?h ?o), (< 50 5) is not so"),
        (
            "(painted anvil)",
            "(paint ?o) needs (holding ?h anvil); for (pick-up ?h ?o), (< 50 5) is not so",
        ),
        ("(done vase)", "(done ?o) needs (object vase ^type part)"),
        (
            "(clean vase)",
            (
                "(wash ?o) needs (safe vase); "
                "for (safe ?o), (not (object vase ^type glass)) fails: (object vase) is believed"
            ),
        ),
    ],
)
def test_the_ways_to_a_goal_are_followed_to_where_they_end(goal: str, why: str) -> None:
    found = answer(goal)
    assert found.final
    assert found.failure is FailureReason.GOAL_UNREACHABLE
    assert found.reason == f"no skill can ever make {goal} true" + (f": {why}" if why else "")


def test_of_several_goals_the_hopeless_one_is_named() -> None:
    assert answer("((holding h vase) (clean vase))").reason.startswith(
        "no skill can ever make (clean vase) true"
    )


def test_what_is_never_ended_is_hopeless_to_be_rid_of() -> None:
    found = answer("((brush h) (painted vase) (not (hand h)))")
    assert found.reason == "no skill can ever make (not (hand h)) true"


def test_an_object_that_is_nowhere_to_be_seen() -> None:
    assert answer("(holding h sofa)").reason == (
        "(holding h sofa) speaks of sofa, which is not perceived"
    )


def test_an_object_that_only_the_domain_names_need_not_be_seen() -> None:
    domain, _ = parse_domain("""(percepts (hand)) (skills
        ((ask ?h) :elements ((hand ?h)) :actions ((*ask)) :effects ((asked foreman))))""")
    assert domain is not None
    engine = InferenceEngine(domain)
    imagination = imagined(engine, engine.step(Memory(), SCENE[:1]))
    found = find_plan(domain, imagination, parse_conditions("(asked foreman)"))
    assert not isinstance(found, NoPlan)


def test_goals_that_exclude_each_other_are_each_within_reach() -> None:
    found = answer("((holding h vase) (free h))")
    assert found.final
    assert found.reason == (
        "no sequence of skills reaches (holding h vase) (free h), "
        "though (pick-up h vase) could start now"
    )
