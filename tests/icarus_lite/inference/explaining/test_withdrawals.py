"""Questions about what was withdrawn, at once or after a while, and about what is in doubt."""

from __future__ import annotations

import pytest

from icarus_lite import Action, Agent, Outcome, Percept
from icarus_lite.inference import why_not_document
from icarus_lite.language import parse_domain

DOMAIN, PROBLEMS = parse_domain("""
(percepts (object) (hand ^gripping))
(skills ((grasp ?h ?o) :elements ((hand ?h) (object ?o)) :actions ((*grasp ?h ?o))
                       :effects ((holding ?h ?o))))
(concepts ((busy ?h) :elements ((holding ?h ?o) (object ?o))))
(contradictions
  ((holding ?h ?o) :elements ((hand ?h ^gripping no)) :cycles 2)
  ((holding ?h ?o) :elements ((hand ?h ^gripping maybe)) :cycles 4)
  ((holding ?h ?h) :elements ((hand ?h))))
""")
assert DOMAIN is not None, PROBLEMS


@pytest.fixture
def agent() -> Agent:
    return Agent(DOMAIN)


def look(agent: Agent, gripping: str, *grasped: str) -> None:
    percepts = [Percept("hand", "h", {"gripping": gripping}), Percept("object", "plug")]
    agent.cycle(percepts, [Outcome(Action("grasp", ("h", each))) for each in grasped])


def test_why_tells_of_doubts_of_each_contradiction(agent: Agent) -> None:
    look(agent, "yes", "plug")
    look(agent, "no")
    assert str(agent.why("(holding h plug)")).splitlines()[1:] == [
        "  it is in doubt: what contradicts it has held for 1 of 2 cycles"
    ]
    look(agent, "maybe")
    assert str(agent.why("(holding h plug)")).splitlines()[1:] == [
        "  it is in doubt: what contradicts it has held for 1 of 4 cycles"
    ]
    assert len(str(agent.why("(busy h)")).splitlines()) == 3  # only what was asked about


def test_a_belief_that_comes_and_goes_tells_each_time(agent: Agent) -> None:
    for _ in range(2):
        look(agent, "yes", "plug")
        look(agent, "no")
        look(agent, "no")
    reason = "because (hand h ^gripping no) held for 2 cycles"
    assert str(agent.why("(holding h plug)")).splitlines() == [
        "(holding h plug)  is not believed in cycle 5",
        "  it has been believed in cycles 0 to 1, in cycles 3 to 4",
        f"  it was withdrawn in cycle 2, {reason}",
        f"  it was withdrawn in cycle 5, {reason}",
    ]
    (past,) = agent.why_not("(holding h ?what)").past
    assert past.ended == f"withdrawn in cycle 5, {reason}"


def test_a_past_cycle_knows_only_what_had_been_withdrawn_by_then(agent: Agent) -> None:
    look(agent, "yes", "plug")
    look(agent, "no")
    look(agent, "no")
    assert agent.why("(holding h plug)", cycle=1).withdrawn == ()
    assert [cycle for cycle, _ in agent.why("(holding h plug)", cycle=2).withdrawn] == [2]


def test_what_was_asserted_and_withdrawn_at_once_is_told(agent: Agent) -> None:
    look(agent, "yes", "h")
    look(agent, "yes", "h")
    answer = agent.why_not("(holding h ?what)")
    assert answer.past == ()
    assert [str(each) for each in answer.refused] == [
        "(holding h h) was asserted in cycle 1 but not believed: (hand h) held",
        "(holding h h) was asserted in cycle 0 but not believed: (hand h) held",
    ]
    assert str(answer).splitlines()[-1] == f"  {answer.refused[1]}"
    assert why_not_document(answer)["refused"] == [
        {"belief": "(holding h h)", "cycle": cycle, "because": ["(hand h)"]} for cycle in (1, 0)
    ]


def test_a_document_says_nothing_of_it_where_there_is_nothing_to_say(agent: Agent) -> None:
    look(agent, "yes", "plug")
    assert agent.why("(holding h plug)").as_document().keys() == {"cycle", "periods", "nodes"}
    assert "refused" not in why_not_document(agent.why_not("(holding h case)"))
