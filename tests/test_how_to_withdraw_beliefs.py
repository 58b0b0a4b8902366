"""The how-to on contradictions: its domain passes its tests, and says what the page shows."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from icarus_lite import Action, Agent, Outcome, Percept, Status
from icarus_lite.execution import Decision, DecisionKind
from icarus_lite.language import check_domain, format_text, parse_domain
from icarus_lite.language.syntax import Domain
from icarus_lite.testing import run_tests

PAGE = (Path(__file__).parents[1] / "docs" / "how-to" / "withdraw-beliefs.md").read_text()
(TEXT,) = re.findall(r"```lisp\n(.*?)```", PAGE, re.DOTALL)
SHOWN = dict(re.findall(r"```text ([^\n]+)\n(.*?)```", PAGE, re.DOTALL))


@pytest.fixture(scope="module")
def domain() -> Domain:
    read, problems = parse_domain(TEXT, "bench.icr")
    assert read is not None, problems
    assert check_domain(read) == ()
    return read


def test_the_domain_is_laid_out_as_the_formatter_has_it() -> None:
    assert format_text(TEXT) == TEXT


def test_its_tests_hold_and_would_fail_without_the_contradictions(domain: Domain) -> None:
    assert [str(d) for outcome in run_tests(domain) for d in outcome.differences] == []
    start, end = TEXT.index("(contradictions"), TEXT.index("(test")
    without, _ = parse_domain(TEXT[:start] + TEXT[end:], "bench.icr")
    assert without is not None
    assert [outcome.passed for outcome in run_tests(without)] == [False, True, False]


class Bench:
    """A world in which things happen that nobody reports."""

    def __init__(self, domain: Domain) -> None:
        self.agent = Agent(domain, ["(attached plug case)"])
        self.places = {"plug": 1.0, "case": 0.0}
        self.gripping = "no"
        self.outcome: Outcome | None = None

    def cycle(self) -> Decision:
        percepts = [
            Percept("object", name, {"x": x, "seen": "yes"}) for name, x in self.places.items()
        ]
        hand = Percept("hand", "hand1", {"x": 0, "gripping": self.gripping})
        decision = self.agent.cycle([*percepts, hand], self.outcome)
        self.outcome = None
        return decision

    def carry_out(self, decision: Decision) -> None:
        """Do what was decided, and report it."""
        action = decision.action
        assert action is not None
        if action.name == "pick-up":
            self.gripping = "yes"
        else:
            self.places[str(action.args[1])] = self.places[str(action.args[2])]
            self.gripping = "no"
        self.outcome = Outcome(action)


def test_what_the_page_shows_is_said(domain: Domain) -> None:
    bench = Bench(domain)
    bench.places["plug"], bench.gripping = 0.0, "yes"
    bench.outcome = Outcome(Action("insert", ("hand1", "plug", "case")))
    bench.cycle()
    bench.places["plug"] = 0.4
    assert not any(bench.cycle().withdrawn for _ in range(2))
    assert f"{bench.agent.why('(attached plug case)')}\n" == SHOWN["why (attached plug case)"]
    (withdrawal,) = bench.cycle().withdrawn
    assert f"```text\n{withdrawal}\n```" in PAGE
    assert bench.agent.state.notes == (str(withdrawal),)
    told = f"{bench.agent.why_not('(attached plug case)')}\n"
    assert told == SHOWN["why-not (attached plug case)"]


def test_a_goal_that_is_lost_is_pursued_again(domain: Domain) -> None:
    bench = Bench(domain)
    kinds = []
    for cycle in range(12):
        if cycle == 4:
            bench.places["plug"] = 1.0  # a person takes it out again
        decision = bench.cycle()
        kinds.append(decision.kind)
        if decision.action is not None:
            bench.carry_out(decision)
    act, achieved = DecisionKind.ACT, DecisionKind.ACHIEVED
    assert kinds == [act, act, *[achieved] * 4, act, act, *[achieved] * 4]


def test_an_action_is_broken_off_when_what_it_relies_on_is_withdrawn(domain: Domain) -> None:
    bench = Bench(domain)
    first = bench.cycle()
    bench.carry_out(first)
    assert str(bench.cycle().action) == "(insert hand1 plug case)"
    bench.gripping = "no"  # it slips, while the arm moves on
    bench.outcome = Outcome(Action("insert", ("hand1", "plug", "case")), Status.RUNNING)
    assert bench.cycle().kind is DecisionKind.CONTINUE
    bench.outcome = Outcome(Action("insert", ("hand1", "plug", "case")), Status.RUNNING)
    stopped = bench.cycle()
    assert stopped.kind is DecisionKind.ABORT
    assert [str(each.belief) for each in stopped.withdrawn] == ["(attached plug hand1)"]
    assert stopped.failures[0].reason == "while-broken"
    again = bench.cycle()
    assert str(again.action) == "(pick-up hand1 plug)"
    assert len(again.path) == 2


def test_a_plan_that_rested_on_it_is_made_anew() -> None:
    read, _ = parse_domain(TEXT.replace("   :while ((attached ?o ?h))\n", ""), "bench.icr")
    assert read is not None
    bench = Bench(read)
    bench.carry_out(bench.cycle())
    bench.gripping = "no"  # what was reported as a grasp was none
    second = bench.cycle()
    assert str(second.action) == "(insert hand1 plug case)"
    third = bench.cycle()
    assert [str(each.belief) for each in third.withdrawn] == ["(attached plug hand1)"]
    fourth = third if third.action is not None else bench.cycle()
    assert str(fourth.action) == "(pick-up hand1 plug)"
