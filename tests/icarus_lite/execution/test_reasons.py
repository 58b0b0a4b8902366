"""Every named reason for which execution does not go on, brought about once and read."""

from __future__ import annotations

import pytest

from icarus_lite import Action, Agent, Decision, DecisionKind, Outcome, Percept, Status
from icarus_lite.language import parse_domain
from icarus_lite.language.syntax import Domain
from icarus_lite.planning import FailureReason

LAMPS = """
(percepts (lamp ^lit ^broken) (hand ^at))
(concepts
  ((lit ?l) :elements ((lamp ?l ^lit yes)))
  ((dark ?l) :elements ((lamp ?l ^lit no)))
  ((at ?h ?l) :elements ((hand ?h ^at ?l) (lamp ?l))))
"""
GO = """
  ((go ?h ?l) :elements ((hand ?h) (lamp ?l) (not (at ?h ?l))) :actions ((*go ?h ?l))
              :effects ((at ?h ?l)))"""
PRESS = """
  ((press ?h ?l) :elements ((at ?h ?l) (dark ?l)) :actions ((*press ?h ?l)) :effects ((lit ?l)))"""


def domain_of(skills: str, base: str = LAMPS) -> Domain:
    domain, problems = parse_domain(f"{base}(skills {skills})")
    assert domain is not None, problems
    return domain


def scene(lit: str = "no", at: str = "nowhere") -> list[Percept]:
    return [Percept("lamp", "l1", {"lit": lit}), Percept("hand", "h", {"at": at})]


def reasons(decision: Decision) -> list[str]:
    return [str(failure.reason) for failure in decision.failures]


def said(decision: Decision, reason: FailureReason) -> str:
    return next(f.text for f in decision.failures if f.reason is reason)


def test_no_skill_for_goal() -> None:
    agent = Agent(domain_of(GO), ["(lit l1)"])
    decision = agent.cycle(scene())
    assert decision.kind is DecisionKind.IMPASSE
    assert reasons(decision) == ["goal-unreachable", "no-skill-for-goal"]
    assert decision.failures[0].text == "no skill can ever make (lit l1) true"
    assert decision.failures[1].text == "no skill has (lit l1) among its effects"


def test_a_subskill_that_does_not_exist() -> None:
    macro = "((light ?h ?l) :elements ((hand ?h) (dark ?l)) :subskills ((fly ?h ?l)))"
    decision = Agent(domain_of(PRESS + macro), intentions=["(light h l1)"]).cycle(scene())
    assert decision.kind is DecisionKind.IMPASSE
    text = said(decision, FailureReason.NO_SKILL_FOR_GOAL)
    assert text == "no skill is called fly with 2 arguments"


def test_conditions_unsatisfied_names_the_first_that_fails() -> None:
    agent = Agent(domain_of(PRESS), intentions=["(press h l1)"])
    decision = agent.cycle(scene())
    assert decision.kind is DecisionKind.IMPASSE
    assert said(decision, FailureReason.CONDITIONS_UNSATISFIED) == (
        "(press h l1): nothing matches (at h l1)"
    )
    assert decision.reason.startswith("conditions-unsatisfied: (press h l1): ")
    assert [c.why_not for c in decision.candidates if c.skill == "(press h l1)"] == [
        "conditions-unsatisfied: (press h l1): nothing matches (at h l1)"
    ]


def test_while_broken_of_a_primitive() -> None:
    press = PRESS.replace(":actions", ":while ((at ?h ?l)) :actions")
    agent = Agent(domain_of(press), ["(lit l1)"])
    action = agent.cycle(scene(at="l1")).action
    assert action is not None
    decision = agent.cycle(scene(at="elsewhere"), Outcome(action, Status.RUNNING))
    assert (decision.kind, reasons(decision)) == (DecisionKind.ABORT, ["while-broken"])
    assert decision.reason == "(at ?h ?l) no longer holds while (press h l1) is running"


LIGHT = """
  ((light ?h ?l) :elements ((hand ?h) (dark ?l)) :while ((lamp ?l ^broken no))
                 :subskills ((go ?h ?l) (press ?h ?l)) :effects ((lit ?l)))"""


def lamps(broken: str, at: str = "nowhere") -> list[Percept]:
    lamp = Percept("lamp", "l1", {"lit": "no", "broken": broken})
    return [lamp, Percept("hand", "h", {"at": at})]


def test_while_broken_of_a_macro_aborts_what_runs_for_it() -> None:
    agent = Agent(domain_of(GO + PRESS + LIGHT), intentions=["(light h l1)"])
    action = agent.cycle(lamps("no")).action
    assert action == Action("go", ("h", "l1"))
    decision = agent.cycle(lamps("yes"), Outcome(action, Status.RUNNING))
    assert (decision.kind, reasons(decision)) == (DecisionKind.ABORT, ["while-broken"])
    assert "while (light h l1) is carried out" in decision.reason
    # The body has stopped, and the lamp is found to work: light is called anew.
    after = agent.cycle(lamps("no"), Outcome(action, Status.FAILED, "stopped"))
    assert (after.kind, after.action) == (DecisionKind.ACT, action)


def test_a_macro_is_not_begun_when_its_while_does_not_hold() -> None:
    agent = Agent(domain_of(GO + PRESS + LIGHT), intentions=["(light h l1)"])
    decision = agent.cycle(lamps("yes"))
    # Planning knows no macros: it goes and presses.
    assert decision.kind is DecisionKind.ACT
    assert [str(step.action) for step in decision.path] == ["(go h l1)", "(press h l1)"]
    assert said(decision, FailureReason.WHILE_BROKEN) == (
        "(light h l1): nothing matches (lamp l1 ^broken no)"
    )


def test_unbound_action_args() -> None:
    skills = (
        "((put ?l ?where) :elements ((dark ?l)) :actions ((*put ?l ?where)) :effects ((lit ?l)))"
    )
    decision = Agent(domain_of(skills), intentions=["(put l1 ?anywhere)"]).cycle(scene())
    assert decision.kind is DecisionKind.IMPASSE
    text = said(decision, FailureReason.UNBOUND_ACTION_ARGS)
    assert text == "(put l1 ?where): nothing binds ?where"


def test_driver_failed_and_after_three_times_an_alternative() -> None:
    other = PRESS.replace("((press", "((kick").replace("*press", "*kick")
    macro = """
      ((light ?h ?l) :elements ((at ?h ?l) (dark ?l)) :subskills ((press ?h ?l))
                     :effects ((lit ?l)))
      ((light ?h ?l) :elements ((at ?h ?l) (dark ?l)) :subskills ((kick ?h ?l))
                     :effects ((lit ?l)))"""
    agent = Agent(domain_of(PRESS + other + macro), intentions=["(light h l1)"])
    decision, tried = agent.cycle(scene(at="l1")), []
    for _ in range(4):
        assert decision.action is not None
        tried.append(decision.action.name)
        decision = agent.cycle(
            scene(at="l1"), Outcome(decision.action, Status.FAILED, "it is stuck")
        )
        assert decision.failures[0].reason is FailureReason.DRIVER_FAILED
        assert decision.failures[0].text.endswith("it is stuck")
    assert tried == ["press", "press", "press", "kick"]


def test_effect_not_believed_when_it_does_nothing_three_times() -> None:
    agent = Agent(domain_of(PRESS), ["(lit l1)"])
    decision, carried_out = agent.cycle(scene(at="l1")), 0
    while decision.action is not None:
        carried_out += 1
        decision = agent.cycle(scene(at="l1"), Outcome(decision.action))
    assert carried_out == 3
    assert decision.kind is DecisionKind.IMPASSE
    assert said(decision, FailureReason.EFFECT_NOT_BELIEVED) == (
        "(press h l1) has been carried out, but (lit l1) is not believed"
    )


@pytest.mark.parametrize("status", [Status.RUNNING, Status.SUCCEEDED])
def test_effect_not_believed_in_time(status: Status) -> None:
    press = PRESS.replace(":actions", ":timeout 5 :actions")
    agent = Agent(domain_of(press), ["(lit l1)"])
    action = agent.cycle(scene(at="l1"), time_s=100.0).action
    assert action is not None
    going = agent.cycle(scene(at="l1"), Outcome(action, status), time_s=105.0)
    assert going.action == action
    decision = agent.cycle(scene(at="l1"), Outcome(action, status), time_s=105.1)
    assert FailureReason.EFFECT_NOT_BELIEVED in [f.reason for f in decision.failures]
    if status is Status.RUNNING:
        assert decision.kind is DecisionKind.ABORT
        assert decision.reason == "(press h l1) is not done within 5 s: (lit l1) is not believed"


def test_a_macro_that_takes_too_long_is_taken_down() -> None:
    light = LIGHT.replace(":while ((lamp ?l ^broken no))", ":timeout 10")
    agent = Agent(domain_of(GO + PRESS + light), intentions=["(light h l1)"])
    action = agent.cycle(scene(), time_s=0.0).action
    assert action is not None
    decision = agent.cycle(scene(), Outcome(action, Status.RUNNING), time_s=11.0)
    assert (decision.kind, reasons(decision)) == (DecisionKind.ABORT, ["effect-not-believed"])
    assert decision.reason == "(light h l1) is not done within 10 s"


def test_subskill_call_failed_when_a_macro_cannot_go_on() -> None:
    light = LIGHT.replace(":while ((lamp ?l ^broken no))", "")
    agent = Agent(domain_of(GO + PRESS + light), intentions=["(light h l1)"])
    action = agent.cycle(scene()).action
    assert action == Action("go", ("h", "l1"))
    # The lamp is gone as an unlit lamp, so that it can neither be pressed nor count as lit.
    percepts = [Percept("lamp", "l1", {"lit": "flickering"}), Percept("hand", "h", {"at": "l1"})]
    decision = agent.cycle(percepts, Outcome(action))
    assert decision.kind is DecisionKind.IMPASSE
    assert said(decision, FailureReason.SUBSKILL_CALL_FAILED) == (
        "(light h l1): (press h l1) cannot begin"
    )


def test_macro_exhausted_when_its_effects_are_still_missing() -> None:
    light = LIGHT.replace(":while ((lamp ?l ^broken no))", "").replace("(press ?h ?l)", "")
    agent = Agent(domain_of(GO + light), intentions=["(light h l1)"])
    action = agent.cycle(scene()).action
    assert action is not None
    decision = agent.cycle(scene(at="l1"), Outcome(action))
    assert decision.kind is DecisionKind.IMPASSE
    assert said(decision, FailureReason.MACRO_EXHAUSTED) == (
        "(light h l1): all its subskills are done, but (lit l1) is not believed"
    )


def test_loop_when_a_skill_calls_itself_without_doing_anything() -> None:
    skills = """
      ((light ?l) :elements ((dark ?l)) :subskills ((shine ?l)) :effects ((lit ?l)))
      ((shine ?l) :elements ((dark ?l)) :subskills ((light ?l)) :effects ((lit ?l)))"""
    decision = Agent(domain_of(skills), intentions=["(light l1)"]).cycle(scene())
    assert decision.kind is DecisionKind.IMPASSE
    assert said(decision, FailureReason.LOOP) == (
        "(light l1): it calls itself, and nothing is done in between"
    )


def test_loop_when_it_comes_back_to_the_same_state_again_and_again() -> None:
    """Going there and coming back, over and over, without ever lighting the lamp."""
    skills = (
        GO
        + """
      ((leave ?h ?l) :elements ((at ?h ?l)) :actions ((*leave ?h ?l))
                     :effects ((not (at ?h ?l))))
      ((dance ?h ?l) :elements ((hand ?h) (dark ?l)) :subskills ((go ?h ?l) (leave ?h ?l))
                     :effects ((lit ?l)))"""
    )
    agent = Agent(domain_of(skills), intentions=["(dance h l1)"])
    at, outcome, acts = "nowhere", None, 0
    while True:
        decision = agent.cycle(scene(at=at), outcome)
        if decision.action is None:
            break
        acts += 1
        at = "l1" if decision.action.name == "go" else "nowhere"
        outcome = Outcome(decision.action)
    assert acts == 6
    assert decision.kind is DecisionKind.IMPASSE
    assert said(decision, FailureReason.LOOP) == (
        "(dance h l1): it was begun in this same state in cycles 0, 2, 4"
    )


def test_a_goal_is_not_achieved_by_undoing_another() -> None:
    skills = """
      ((swap ?a ?b) :elements ((dark ?a) (lit ?b)) :tests ((/= ?a ?b)) :actions ((*swap ?a ?b))
                    :effects ((lit ?a) (not (lit ?b))))"""
    agent = Agent(domain_of(skills), ["(lit l2)", "(lit l1)"])
    percepts = [Percept("lamp", "l1", {"lit": "no"}), Percept("lamp", "l2", {"lit": "yes"})]
    decision = agent.cycle(percepts)
    assert decision.kind is DecisionKind.IMPASSE
    assert said(decision, FailureReason.LOOP) == "(swap l1 l2): it would undo (lit l2), which holds"


def test_loop_when_plans_are_carried_through_and_do_not_help() -> None:
    """A skill that promises two things that cannot both be so: its plans never come true."""
    skills = """
      ((bright ?l) :elements ((dark ?l)) :actions ((*on ?l)) :effects ((lit ?l)))
      ((dim ?l) :elements ((lit ?l)) :actions ((*off ?l)) :effects ((dark ?l)))"""
    agent, lit, acts = Agent(domain_of(skills), ["(lit ?l)", "(dark ?l)"]), "no", 0
    decision = agent.cycle(scene(lit))
    while decision.action is not None:
        acts += 1
        lit = "yes" if decision.action.name == "bright" else "no"
        decision = agent.cycle(scene(lit), Outcome(decision.action))
    assert decision.kind is DecisionKind.IMPASSE
    assert acts <= 30
    assert FailureReason.LOOP in [failure.reason for failure in decision.failures]
    assert "carried through 10 times" in decision.reason


def test_search_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("icarus_lite.execution.selection.MAX_TRIED", 2)
    light = LIGHT.replace(":while ((lamp ?l ^broken no))", "").replace("(go ?h ?l)", "")
    agent = Agent(domain_of(PRESS + light), intentions=["(light ?h ?l)"])
    percepts = [*scene(), Percept("hand", "h2"), Percept("hand", "h3")]
    decision = agent.cycle(percepts)
    assert decision.kind is DecisionKind.IMPASSE
    assert said(decision, FailureReason.SEARCH_LIMIT) == (
        "no skill path among the first 2 instances tried"
    )


def test_an_unknown_skill_is_said_at_once_with_the_one_that_was_meant() -> None:
    with pytest.raises(ValueError, match="no skill called `pres`; did you mean `press`"):
        Agent(domain_of(PRESS), intentions=["(pres h l1)"])
    with pytest.raises(ValueError, match="has 1 arguments; the skill is"):
        Agent(domain_of(PRESS), intentions=["(press h)"])
