from __future__ import annotations

from dataclasses import replace

import pytest

from icarus_lite import (
    Action,
    Agent,
    DecisionKind,
    DomainError,
    FrameError,
    Outcome,
    Percept,
    Status,
)
from icarus_lite.language.reading.reader import parse_domain

DOMAIN, PROBLEMS = parse_domain("""
(percepts (hand ^gripping) (object ^type))
(concepts ((free ?h) :elements ((hand ?h) (not (holding ?h ?any)))))
(skills
  ((pick-up ?h ?o) :elements ((free ?h) (object ?o ^type part)) :actions ((*grasp ?h ?o))
                   :effects ((holding ?h ?o)))
  ((insert ?o ?into) :elements ((holding ?h ?o) (object ?into ^type case))
                     :while ((hand ?h ^gripping yes))
                     :actions ((*insert ?h ?o ?into)) :effects ((not (holding ?h ?o)))))
(attachments
  ((pick-up ?h ?o) :until (place-down ?h ?o) :child ?o :parent ?h)
  ((insert ?o ?into) :until (take-out ?o ?into) :child ?o :parent ?into))
""")
assert DOMAIN is not None, PROBLEMS
GOAL = "(attached cover case)"
PICK = Action("pick-up", ("h1", "cover"))
INSERT = Action("insert", ("cover", "case"))


def scene(*, gripping: str = "no", cover: bool = True) -> list[Percept]:
    percepts = [
        Percept("hand", "h1", {"gripping": gripping}),
        Percept("object", "case", {"type": "case"}),
    ]
    return [*percepts, Percept("object", "cover", {"type": "part"})] if cover else percepts


@pytest.fixture
def agent() -> Agent:
    return Agent(DOMAIN, goals=[GOAL])


def test_a_task_from_the_first_look_to_the_goal(agent: Agent) -> None:
    first = agent.cycle(scene())
    assert (first.kind, first.action) == (DecisionKind.ACT, PICK)
    assert [str(c) for c in first.commands] == ["(grasp h1 cover)"]
    assert [str(s.action) for s in first.path] == [str(PICK), str(INSERT)]
    running = agent.cycle(scene(), Outcome(PICK, Status.RUNNING))
    assert (running.kind, running.action) == (DecisionKind.CONTINUE, PICK)
    second = agent.cycle(scene(gripping="yes"), Outcome(PICK))
    assert (second.kind, second.action) == (DecisionKind.ACT, INSERT)
    assert "(attached cover h1)" in map(str, second.added)
    last = agent.cycle(scene(), Outcome(INSERT))
    assert last.kind is DecisionKind.ACHIEVED
    assert last.action is None
    assert [g.satisfied for g in last.goals] == [True]
    assert {str(b) for b in last.removed} == {"(attached cover h1)", "(holding h1 cover)"}


def test_why_leads_to_the_action(agent: Agent) -> None:
    agent.cycle(scene())
    agent.cycle(scene(gripping="yes"), Outcome(PICK))
    agent.cycle(scene(), Outcome(INSERT))
    assert str(agent.why(GOAL)) == (
        "(attached cover case)  because (insert cover case) succeeded, reported in cycle 2"
    )


def test_a_broken_while_aborts_the_running_action(agent: Agent) -> None:
    agent.cycle(scene())
    agent.cycle(scene(gripping="yes"), Outcome(PICK))
    slipped = agent.cycle(scene(gripping="no"), Outcome(INSERT, Status.RUNNING))
    assert slipped.kind is DecisionKind.ABORT
    assert slipped.action is None
    assert slipped.step is not None
    assert "(hand ?h ^gripping yes) no longer holds" in slipped.reason


def test_an_action_is_aborted_when_its_object_is_no_longer_anchored(agent: Agent) -> None:
    agent.cycle(scene())
    agent.cycle(scene(gripping="yes"), Outcome(PICK))
    lost = agent.cycle(scene(gripping="yes", cover=False), Outcome(INSERT, Status.RUNNING))
    assert lost.kind is DecisionKind.ABORT
    assert lost.reason.startswith("cover is no longer anchored")
    after = agent.cycle(scene(cover=False), Outcome(INSERT, Status.FAILED, lost.reason))
    assert after.kind is DecisionKind.IMPASSE


def test_an_abort_is_said_again_until_the_body_has_stopped(agent: Agent) -> None:
    agent.cycle(scene())
    agent.cycle(scene(gripping="yes"), Outcome(PICK))
    for _ in range(2):
        again = agent.cycle(scene(gripping="no"), Outcome(INSERT, Status.RUNNING))
        assert again.kind is DecisionKind.ABORT


def test_a_failed_action_is_tried_again_three_times_at_most(agent: Agent) -> None:
    decision = agent.cycle(scene())
    tried = 0
    while decision.kind is DecisionKind.ACT:
        tried += 1
        decision = agent.cycle(scene(), Outcome(PICK, Status.FAILED, "slipped"))
    assert tried == 3
    assert decision.kind is DecisionKind.IMPASSE
    assert decision.reason.endswith("(pick-up h1 cover) failed 3 times: slipped")


def test_a_surprise_is_planned_for_anew(agent: Agent) -> None:
    agent.cycle(scene())
    other = Outcome(Action("insert", ("cover", "case")))
    helped = agent.cycle(scene(), [Outcome(PICK, Status.FAILED, "a person took it"), other])
    assert helped.kind is DecisionKind.ACHIEVED


def test_another_agents_action_counts_as_well(agent: Agent) -> None:
    assert agent.cycle(scene(), Outcome(INSERT)).kind is DecisionKind.ACHIEVED


def test_two_agents_on_the_same_percepts_decide_the_same() -> None:
    frames = [(scene(), None), (scene(gripping="yes"), Outcome(PICK)), (scene(), Outcome(INSERT))]

    def decisions() -> list[str]:
        agent = Agent(DOMAIN, [GOAL])
        cycles = [agent.cycle(*frame) for frame in frames]
        # The state is told by its beliefs and their supports: it may keep them as it likes.
        beliefs = [sorted(map(repr, decision.state.supports.items())) for decision in cycles]
        return [repr(replace(d, state=None)) for d in cycles] + [repr(each) for each in beliefs]

    assert decisions() == decisions()


def test_a_goal_that_does_not_parse_is_an_error_with_its_place() -> None:
    with pytest.raises(DomainError, match="<goal>:1"):
        Agent(DOMAIN, ["(attached cover"])


def test_why_wants_a_ground_belief(agent: Agent) -> None:
    with pytest.raises(FrameError, match="no variables"):
        agent.why("(attached ?x case)")
