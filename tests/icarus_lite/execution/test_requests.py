"""Several agents: what is asked of others, waited for, refused, done unasked, or done without."""

from __future__ import annotations

import random

import pytest

from icarus_lite import Action, Agent, DecisionKind, Outcome, Percept, Status
from icarus_lite.execution import NO_ANSWER
from icarus_lite.language import check_domain, parse_domain
from icarus_lite.trace import cycle_record

ASSEMBLY = """
(agents human)
(percepts (object ^type ^held) (hand))
(concepts
  ((base ?b) :elements ((object ?b ^type base)))
  ((top ?t) :elements ((object ?t ^type top)))
  ((steady ?b) :elements ((object ?b ^held yes)))
  ((steady ?b) :elements ((held ?b))))
(skills
  ((hold ?base)
   :agent human
   :elements ((base ?base) (not (steady ?base)))
   :effects ((held ?base))
   :request "please hold ?base"
   :timeout 30)
  ((pick-up ?hand ?top)
   :elements ((hand ?hand) (top ?top) (not (holding ?hand ?any)))
   :actions ((*grasp ?hand ?top))
   :effects ((holding ?hand ?top)))
  ((put-on ?hand ?top ?base)
   :elements ((holding ?hand ?top) (steady ?base))
   :while ((steady ?base))
   :actions ((*put-on ?hand ?top ?base))
   :effects ((on ?top ?base) (not (holding ?hand ?top)))))
(task 1.3 "Assemble gearbox top and bottom" :robot ur5 :agents (human) :goal ((on top1 base1)))
"""
GOAL = "(on top1 base1)"
HOLD = Action("hold", ("base1",))
PICK = Action("pick-up", ("hand1", "top1"))
PUT = Action("put-on", ("hand1", "top1", "base1"))


def read(text):
    domain, found = parse_domain(text)
    assert domain is not None, found
    wrong = [each for each in check_domain(domain) if each.severity != "note"]
    assert wrong == []
    return domain


def scene(*, held="no"):
    return [
        Percept("hand", "hand1"),
        Percept("object", "base1", {"type": "base", "held": held}),
        Percept("object", "top1", {"type": "top", "held": "no"}),
    ]


def up_to_the_request(agent, *, time_s=None):
    """Give the decision in which the human is asked."""
    first = agent.cycle(scene(), time_s=time_s)
    assert (first.kind, first.action) == (DecisionKind.ACT, PICK)
    return agent.cycle(scene(), Outcome(PICK), time_s=time_s)


@pytest.fixture
def agent():
    return Agent(read(ASSEMBLY), [GOAL])


def test_what_others_can_do_is_asked_for_as_late_as_possible(agent):
    first = agent.cycle(scene())
    assert [str(step.action) for step in first.path] == [str(PICK), str(HOLD), str(PUT)]
    asked = agent.cycle(scene(), Outcome(PICK))
    assert (asked.kind, asked.action, asked.commands) == (DecisionKind.REQUEST, None, ())
    assert asked.step.action == HOLD
    request = asked.request
    assert (request.agent, request.action, request.sentence, request.since) == (
        "human",
        HOLD,
        "please hold base1",
        1,
    )
    assert asked.reason == "asked human: please hold base1"


def test_it_is_asked_once_and_then_waited_for(agent):
    up_to_the_request(agent)
    for _ in range(5):
        waiting = agent.cycle(scene())
        assert (waiting.kind, waiting.action) == (DecisionKind.AWAIT, None)
        assert waiting.request.since == 1
        assert waiting.reason == "waiting: asked human: please hold base1"


def test_what_is_seen_to_be_done_ends_the_wait(agent):
    up_to_the_request(agent)
    agent.cycle(scene())
    seen = agent.cycle(scene(held="yes"))
    assert (seen.kind, seen.action, seen.request) == (DecisionKind.ACT, PUT, None)
    last = agent.cycle(scene(held="yes"), Outcome(PUT))
    assert last.kind is DecisionKind.ACHIEVED


def test_what_is_reported_to_be_done_ends_the_wait(agent):
    up_to_the_request(agent)
    reported = agent.cycle(scene(), Outcome(HOLD))
    assert (reported.kind, reported.action) == (DecisionKind.ACT, PUT)
    assert "(held base1)" in map(str, reported.beliefs)


def test_a_report_that_it_is_under_way_changes_nothing(agent):
    up_to_the_request(agent)
    assert agent.cycle(scene(), Outcome(HOLD, Status.RUNNING)).kind is DecisionKind.AWAIT


def test_what_is_done_unasked_is_not_asked_for(agent):
    first = agent.cycle(scene())
    assert first.action == PICK
    second = agent.cycle(scene(held="yes"), Outcome(PICK))
    assert (second.kind, second.action) == (DecisionKind.ACT, PUT)


def test_without_conditions_of_its_own_it_is_not_asked_for_either():
    agent = Agent(read(ASSEMBLY.replace(" (not (steady ?base)))", ")")), [GOAL])
    agent.cycle(scene())
    second = agent.cycle(scene(held="yes"), Outcome(PICK))
    assert (second.kind, second.action) == (DecisionKind.ACT, PUT)


def test_a_refusal_is_named_and_the_same_is_not_asked_again_for_a_while(agent):
    up_to_the_request(agent)
    refused = agent.cycle(scene(), Outcome(HOLD, Status.FAILED, "my hands are full"))
    assert refused.kind is DecisionKind.IMPASSE
    assert "human does not do (hold base1): my hands are full" in refused.reason
    assert "request-refused" in {str(each.reason) for each in refused.failures}
    kinds = [agent.cycle(scene()).kind for _ in range(150)]
    assert kinds.index(DecisionKind.REQUEST) == 99  # a hundred cycles later
    assert set(kinds[:99]) == {DecisionKind.IMPASSE}


def test_no_answer_in_time_is_named(agent):
    up_to_the_request(agent, time_s=0.0)
    assert agent.cycle(scene(), time_s=30.0).kind is DecisionKind.AWAIT
    over = agent.cycle(scene(), time_s=30.1)
    assert over.kind is DecisionKind.IMPASSE
    assert "human does not do (hold base1): no answer within 30 s" in over.reason
    assert "request-unanswered" in {str(each.reason) for each in over.failures}
    assert agent.cycle(scene(), time_s=90.0).kind is DecisionKind.IMPASSE
    assert agent.cycle(scene(), time_s=90.1).kind is DecisionKind.REQUEST  # a minute later


def test_a_body_that_watches_the_time_may_say_so(agent):
    up_to_the_request(agent)
    over = agent.cycle(scene(), Outcome(HOLD, Status.FAILED, f"{NO_ANSWER} within 30 s"))
    assert "request-unanswered" in {str(each.reason) for each in over.failures}


def test_a_wait_has_an_end_even_if_the_skill_states_none():
    agent = Agent(read(ASSEMBLY.replace("   :timeout 30)", ")")), [GOAL])
    up_to_the_request(agent, time_s=0.0)
    assert agent.cycle(scene(), time_s=60.0).kind is DecisionKind.AWAIT
    assert agent.cycle(scene(), time_s=60.1).kind is DecisionKind.IMPASSE


def test_after_a_refusal_another_way_is_found():
    clamp = """((clamp ?hand ?base)
     :elements ((hand ?hand) (base ?base) (not (holding ?hand ?any)))
     :actions ((*clamp ?hand ?base)) :effects ((held ?base)) :cost 20)
    ((put-down ?hand ?top) :elements ((holding ?hand ?top)) :actions ((*place ?hand ?top))
     :effects ((not (holding ?hand ?top))))"""
    domain = read(ASSEMBLY.replace("(skills", "(skills " + clamp))
    agent = Agent(domain, [GOAL])
    up_to_the_request(agent)
    other = agent.cycle(scene(), Outcome(HOLD, Status.FAILED, "no"))
    assert other.kind is DecisionKind.ACT
    assert [str(step.action) for step in other.path] == [
        "(put-down hand1 top1)",
        "(clamp hand1 base1)",
        "(pick-up hand1 top1)",
        "(put-on hand1 top1 base1)",
    ]


@pytest.mark.parametrize("cost", [1, 2, 3, 8])
def test_what_one_can_do_oneself_is_not_asked_for_unless_it_costs_more(cost):
    clamp = """((fetch-clamp ?hand) :elements ((hand ?hand)) :actions ((*fetch ?hand))
     :effects ((has-clamp ?hand)))
    ((warm-up ?hand) :elements ((has-clamp ?hand)) :actions ((*warm-up ?hand))
     :effects ((warm ?hand)))
    ((clamp ?hand ?base) :elements ((warm ?hand) (base ?base)) :actions ((*clamp ?hand ?base))
     :effects ((held ?base)))
    ((test ?hand ?base) :elements ((held ?base) (warm ?hand)) :actions ((*test ?hand))
     :effects ((tested ?base)))"""
    text = ASSEMBLY.replace("(skills", "(skills " + clamp)
    domain = read(text.replace(":timeout 30", f":timeout 30 :cost {cost}"))
    decision = Agent(domain, [GOAL]).cycle(scene())
    assert any(step.action == HOLD for step in decision.path) is (cost < 3)
    both = Agent(domain, [GOAL, "(tested base1)"]).cycle(scene())
    assert all(step.action != HOLD for step in both.path)  # the clamp is needed anyway
    assert len(both.path) == 6


def test_goals_are_not_left_to_others_while_a_plan_of_ones_own_will_do():
    fetch = """((bring ?top) :agent human :elements ((top ?top)) :effects ((on ?top base1)))"""
    domain = read(ASSEMBLY.replace("(skills", "(skills " + fetch))
    held = Agent(domain, [GOAL]).cycle(scene(held="yes"))
    assert (held.kind, held.action) == (DecisionKind.ACT, PICK)
    # Not held, each way takes a request; then the shorter one is taken.
    assert Agent(domain, [GOAL]).cycle(scene()).request.sentence == "please bring top1"


def test_a_macro_may_call_what_others_do():
    macro = """((assemble ?hand ?top ?base)
     :elements ((hand ?hand) (top ?top) (base ?base))
     :subskills ((pick-up ?hand ?top) (hold ?base) (put-on ?hand ?top ?base))
     :effects ((on ?top ?base)))"""
    agent = Agent(read(ASSEMBLY.replace("(skills", "(skills " + macro)), [GOAL])
    up_to_the_request(agent)
    waiting = agent.cycle(scene())
    assert waiting.kind is DecisionKind.AWAIT
    assert str(waiting.skill_path) == (
        "(on top1 base1) → (assemble hand1 top1 base1) → (hold base1)"
    )
    assert agent.cycle(scene(), Outcome(HOLD)).action == PUT


def test_what_others_do_of_themselves_is_waited_for_without_a_word():
    text = ASSEMBLY.replace(':request "please hold ?base"', ":request no")
    agent = Agent(read(text), [GOAL])
    waiting = up_to_the_request(agent)
    assert (waiting.kind, waiting.request.sentence) == (DecisionKind.AWAIT, "")
    assert waiting.reason == "human is expected to do (hold base1)"
    assert agent.cycle(scene(held="yes")).action == PUT


@pytest.mark.parametrize(
    ("request_field", "sentence"),
    [
        ("", "please hold base1"),
        (':request "hold ?base, please."', "hold base1, please."),
        (':request "?base?"', "base1?"),
    ],
)
def test_the_sentence_names_the_objects(request_field, sentence):
    text = ASSEMBLY.replace(':request "please hold ?base"', request_field)
    assert up_to_the_request(Agent(read(text), [GOAL])).request.sentence == sentence


def test_whoever_is_there_may_be_asked_and_after_a_refusal_somebody_else():
    text = ASSEMBLY.replace("(hand))", "(hand) (person))", 1)
    text = text.replace("((hold ?base)\n   :agent human", "((hold ?who ?base)\n   :agent ?who")
    text = text.replace("((base ?base) (not", "((person ?who) (base ?base) (not")
    agent = Agent(read(text), [GOAL])
    people = [Percept("person", "ann"), Percept("person", "ben")]
    agent.cycle([*scene(), *people])
    asked = agent.cycle([*scene(), *people], Outcome(PICK))
    assert (asked.request.agent, asked.request.sentence) == ("ann", "please hold base1")
    refused = Outcome(Action("hold", ("ann", "base1")), Status.FAILED, "busy")
    assert agent.cycle([*scene(), *people], refused).request.agent == "ben"
    gone = agent.cycle([*scene(), people[0]])
    assert gone.kind is DecisionKind.IMPASSE  # ben has left while he was waited for
    assert "while-broken" in {str(each.reason) for each in gone.failures}


def test_only_those_who_take_part_are_asked():
    domain = read(ASSEMBLY)
    alone = Agent(domain, [GOAL], others=()).cycle(scene())
    assert alone.kind is DecisionKind.IMPASSE
    assert Agent(domain, [GOAL], others=domain.tasks[0].agents).cycle(scene()).action == PICK


def test_each_agent_has_its_own_view_of_one_domain():
    text = """(agents left right)
    (percepts (part ^at))
    (skills
      ((pass ?p) :agent left :elements ((part ?p ^at left)) :actions ((*pass ?p))
       :effects ((passed ?p)))
      ((receive ?p) :agent right :elements ((passed ?p)) :actions ((*take ?p))
       :effects ((received ?p))))"""
    domain, percepts = read(text), [Percept("part", "p", {"at": "left"})]
    left = Agent(domain, ["(received p)"], me="left").cycle(percepts)
    right = Agent(domain, ["(received p)"], me="right").cycle(percepts)
    assert (left.kind, str(left.action)) == (DecisionKind.ACT, "(pass p)")
    assert (right.kind, right.request.agent) == (DecisionKind.REQUEST, "left")


def test_a_more_important_goal_need_not_wait_for_somebody_else():
    lamp = """((press ?hand) :elements ((hand ?hand)) :actions ((*press ?hand))
     :effects ((lit ?hand)))"""
    agent = Agent(read(ASSEMBLY.replace("(skills", "(skills " + lamp)), [GOAL])
    up_to_the_request(agent)
    agent.add_goal("(lit hand1)", priority=5)
    urgent = agent.cycle(scene())
    assert (urgent.kind, str(urgent.action)) == (DecisionKind.ACT, "(press hand1)")
    again = agent.cycle(scene(), Outcome(Action("press", ("hand1",))))
    assert again.kind is DecisionKind.REQUEST


def test_what_was_refused_waits_while_other_goals_have_their_turn_and_is_asked_for_again():
    lamp = """((press ?hand) :elements ((hand ?hand)) :actions ((*press ?hand))
     :effects ((lit ?hand)))"""
    agent = Agent(read(ASSEMBLY.replace("(skills", "(skills " + lamp)))
    agent.add_goal(GOAL, priority=5)
    agent.add_goal("(lit hand1)", priority=1)
    up_to_the_request(agent, time_s=0.0)
    refused = agent.cycle(scene(), Outcome(HOLD, Status.FAILED, "no"), time_s=1.0)
    assert {each.name: str(each.standing) for each in refused.agenda} == {
        GOAL: "suspended",
        "(lit hand1)": "pursued",
    }
    assert "human does not do (hold base1): no" in refused.agenda[0].reason
    agent.cycle(scene(), Outcome(refused.action), time_s=2.0)
    agent.add_goal("(not (lit hand1))", maintain=True)  # hopeless as well: both are set aside
    assert agent.cycle(scene(), time_s=60.9).kind is DecisionKind.IMPASSE
    assert agent.cycle(scene(), time_s=61.0).kind is DecisionKind.REQUEST


HABITS = ("does it", "says so", "refuses", "keeps silent")


@pytest.mark.parametrize("seed", range(12))
def test_whatever_the_others_do_the_arm_keeps_still_meanwhile(seed):
    """Somebody does what is asked, only says so, refuses, or keeps silent; or lets go again."""
    rng = random.Random(seed)
    agent, held, outcomes, asked = Agent(read(ASSEMBLY), [GOAL]), "no", [], 0
    for now in range(600):
        decision = agent.cycle(scene(held=held), outcomes, time_s=float(now))
        outcomes = []
        if decision.kind is DecisionKind.ACHIEVED:
            break
        if decision.request is not None:
            assert (decision.action, decision.commands) == (None, ())
            asked += decision.kind is DecisionKind.REQUEST
            habit = rng.choice(HABITS) if rng.random() < 0.1 else "keeps silent"
            if habit == "does it":
                held = "yes"
            elif habit == "says so":
                outcomes = [Outcome(HOLD)]
            elif habit == "refuses":
                outcomes = [Outcome(HOLD, Status.FAILED, "not now")]
        elif decision.kind is DecisionKind.ACT:
            if decision.action == PUT and rng.random() < 0.3 and held == "yes":
                held = "no"  # it is let go of at the last moment
                outcomes = [Outcome(PUT, Status.FAILED, "the base slipped away")]
            else:
                outcomes = [Outcome(decision.action)]
        elif decision.kind is DecisionKind.ABORT:
            outcomes = [Outcome(decision.step.action, Status.FAILED, "stopped")]
    # An action that has failed three times is given up; nothing else keeps the goal from it.
    given_up = "failed 3 times: the base slipped away" in decision.reason
    assert decision.kind is DecisionKind.ACHIEVED or given_up
    assert asked >= 1


def test_the_wait_ends_when_the_goal_is_reached_otherwise(agent):
    up_to_the_request(agent)
    done = agent.cycle(scene(), [Outcome(HOLD), Outcome(PUT)])
    assert done.kind is DecisionKind.ACHIEVED


def test_the_record_has_the_request(agent):
    row = cycle_record(up_to_the_request(agent), scene(), ())
    assert row["request"] == {
        "agent": "human",
        "action": "(hold base1)",
        "sentence": "please hold base1",
        "since": 1,
    }
    assert row["decision"]["kind"] == "request"
    assert row["decision"]["commands"] == []
