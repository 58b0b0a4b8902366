from __future__ import annotations

from icarus_lite import Agent, Outcome, Percept
from icarus_lite.language.reading.reader import parse_domain

DOMAIN, PROBLEMS = parse_domain("""
(percepts (hand) (object ^type))
(concepts ((free ?h) :elements ((hand ?h) (not (holding ?h ?any)))))
(skills
  ((pick-up ?h ?o) :elements ((free ?h) (object ?o ^type part)) :actions ((*grasp ?h ?o))
                   :effects ((holding ?h ?o)))
  ((insert ?o ?into) :elements ((holding ?h ?o) (object ?into ^type case))
                     :actions ((*insert ?h ?o ?into)) :effects ((not (holding ?h ?o))))
  ((polish ?o) :elements ((object ?o)) :actions ((*polish ?o)) :effects ((shiny ?o))))
(attachments ((insert ?o ?into) :until (take-out ?o ?into) :child ?o :parent ?into))
""")
assert DOMAIN is not None, PROBLEMS
SCENE = [
    Percept("hand", "h1"),
    Percept("object", "case", {"type": "case"}),
    Percept("object", "cover", {"type": "part"}),
    Percept("object", "plug", {"type": "part"}),
]


def considered(agent: Agent, *outcomes: Outcome) -> list[tuple[str, bool, str]]:
    return [(c.skill, c.chosen, c.why_not) for c in agent.cycle(SCENE, outcomes).candidates]


def test_the_chosen_the_others_and_what_cannot_start() -> None:
    agent = Agent(DOMAIN, ["(attached plug case)"])
    assert considered(agent) == [
        ("(pick-up h1 cover)", False, "the plan begins with (pick-up h1 plug)"),
        ("(pick-up h1 plug)", True, ""),
        ("(insert ?o ?into)", False, "nothing matches (holding ?h ?o)"),
    ]


def test_a_plan_that_goes_on_considers_nothing_anew() -> None:
    agent = Agent(DOMAIN, ["(attached plug case)"])
    action = agent.cycle(SCENE).action
    assert action is not None
    assert considered(agent, Outcome(action)) == []


def test_an_impasse_says_what_every_skill_lacks() -> None:
    agent = Agent(DOMAIN, ["(attached case plug)"])
    assert [why_not for _, _, why_not in considered(agent)] == [
        "leads to no plan",
        "leads to no plan",
        "nothing matches (holding ?h ?o)",
    ]
