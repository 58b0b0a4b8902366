"""What enters the engine and does not belong there, and Python functions that misbehave."""

from __future__ import annotations

import math

import numpy as np
import pytest

from icarus_lite import Action, Belief, FrameError, InferenceError, Outcome, Percept
from icarus_lite.inference import Budget, InferenceEngine, Memory
from icarus_lite.language import parse_domain

TEXT = """(percepts (object ^x))
(concepts
  ((good ?o) :elements ((object ?o ^x ?x)) :tests ((ok ?x)))
  ((rated ?o ^by ?r) :elements ((object ?o ^x ?x)) :binds ((?r (rate ?x)))))
(skills ((stack ?a ?b) :elements ((object ?a) (object ?b)) :actions ((*stack ?a ?b))
                       :effects ((stacked ?a ?b))))
(attachments ((stack ?a ?b) :child ?a :parent ?b))
"""
A, B = Percept("object", "a", {"x": 3}), Percept("object", "b", {"x": 4})


def fail(_: float) -> bool:
    message = "no such shape"
    raise KeyError(message)


def step(percepts, outcomes=(), memory=None, *, ok=lambda _: True, rate=lambda x: x):
    domain, problems = parse_domain(TEXT, "cell.icr")
    assert domain is not None, problems
    engine = InferenceEngine(domain, {"ok": ok, "rate": rate})
    return engine.step(memory or Memory(), percepts, outcomes)


class TestPythonFunctions:
    @pytest.mark.parametrize(
        ("function", "message"),
        [
            (
                fail,
                "cell.icr:3:52: the Python function in (ok 3) failed: KeyError: 'no such shape'",
            ),
            (lambda _: "yes", "(ok ?x) came to the symbol yes, but a test has to be true or false"),
            (lambda _: 1, "(ok ?x) came to the number 1, but a test has to be true or false"),
            (lambda _: None, "(ok 3) returned NoneType, not a number, symbol or truth value"),
            (lambda x: [x], "(ok 3) returned list, not a number, symbol or truth value"),
            (lambda _: math.nan, "(ok 3) is not a finite number"),
            (lambda: True, "the Python function in (ok 3) failed: TypeError"),
        ],
    )
    def test_a_test_that_is_none_names_the_clause(self, function, message) -> None:
        with pytest.raises(InferenceError) as caught:
            step([A], ok=function)
        assert str(caught.value).startswith("cell.icr:3:52: ")
        assert message in str(caught.value)

    @pytest.mark.parametrize(
        ("function", "message"),
        [
            (fail, "the Python function in (rate 3) failed: KeyError"),
            (lambda x: x > 1, "came to the truth value true, but a bind has to be a number"),
            (lambda _: math.inf, "(rate 3) is not a finite number"),
        ],
    )
    def test_a_bind_that_is_none_names_the_clause(self, function, message) -> None:
        with pytest.raises(InferenceError) as caught:
            step([A], rate=function)
        assert str(caught.value).startswith("cell.icr:4:")
        assert message in str(caught.value)

    def test_the_cause_is_kept_for_whoever_debugs_it(self) -> None:
        with pytest.raises(InferenceError) as caught:
            step([A], ok=fail)
        assert isinstance(caught.value.__cause__, KeyError)

    def test_numpy_scalars_are_the_values_they_stand_for(self) -> None:
        state = step([A], ok=lambda x: np.bool_(x > 2), rate=np.int64).state
        rated = next(each for each in state.supports if each.predicate == "rated")
        assert Belief("good", ("a",)) in state
        assert (rated.attributes["by"], type(rated.attributes["by"])) == (3, int)

    def test_an_array_is_no_scalar(self) -> None:
        with pytest.raises(InferenceError, match="returned ndarray"):
            step([A], ok=lambda _: np.array([True]))

    def test_the_cycle_leaves_the_memory_as_it_was(self) -> None:
        before = step([A])
        with pytest.raises(InferenceError):
            step([A, B], memory=before, ok=fail)
        assert before.state.cycle == 0
        assert Belief("good", ("a",)) in before.state


class TestWhatEnters:
    @pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, np.float64("nan")])
    def test_a_number_that_is_not_finite_is_refused_by_name(self, value) -> None:
        with pytest.raises(FrameError, match=r"^attribute x of a is .*(nan|inf).*, not finite$"):
            step([Percept("object", "a", {"x": value})])

    @pytest.mark.parametrize("value", [True, None, [1], np.int64(2)])
    def test_what_is_no_value_is_refused_by_name(self, value) -> None:
        with pytest.raises(FrameError, match=r"^attribute x of a is .*, neither a number "):
            step([Percept("object", "a", {"x": value})])

    @pytest.mark.parametrize("status", ["succeeded", "failed"])
    def test_the_arguments_of_an_action_are_checked_as_well(self, status) -> None:
        with pytest.raises(FrameError, match=r"^argument 2 of stack is nan, not finite$"):
            step([A], [Outcome(Action("stack", ("a", math.nan)), status)])

    def test_integers_may_be_as_large_as_they_like(self) -> None:
        assert Belief("good", ("a",)) in step([Percept("object", "a", {"x": 2**70})]).state


class TestAttachments:
    def test_a_circle_is_refused_and_the_rest_of_the_action_counts(self) -> None:
        memory = step([A, B], [Outcome(Action("stack", ("a", "b")))])
        memory = step([A, B], [Outcome(Action("stack", ("b", "a")))], memory)
        assert memory.state.notes == (
            "refused: (stack b a) would attach b to a, but a already moves with b",
        )
        assert Belief("stacked", ("b", "a")) in memory.state
        assert set(memory.state.hierarchy.pairs()) == {("a", "b")}

    def test_nothing_is_attached_to_itself(self) -> None:
        memory = step([A], [Outcome(Action("stack", ("a", "a")))])
        assert memory.state.notes == (
            "refused: (stack a a) would attach a to a, but it is the same",
        )
        assert not list(memory.state.hierarchy.pairs())


def test_a_cycle_beyond_the_budget_names_the_clause_and_the_next_one_goes_on() -> None:
    domain, _ = parse_domain(
        "(percepts (thing ^x))\n(concepts ((pair ?a ?b) :elements ((thing ?a) (thing ?b))))",
        "d.icr",
    )
    engine = InferenceEngine(domain, budget=Budget(facts=50))
    things = [Percept("thing", f"t{number}", {"x": number}) for number in range(8)]
    memory = engine.step(Memory(), things[:7])
    assert len(memory.state.beliefs) == 49
    with pytest.raises(InferenceError, match=r"d\.icr:2:.*more than 50 beliefs, the budget"):
        engine.step(memory, things)
    again = engine.step(memory, things[:2])
    assert [str(belief) for belief in again.state.beliefs] == [
        "(pair t0 t0)",
        "(pair t0 t1)",
        "(pair t1 t0)",
        "(pair t1 t1)",
    ]


@pytest.mark.parametrize(
    ("clauses", "clause"),
    [
        (
            """((num ?x ^k ?x) :elements ((thing ?o ^x ?x)))
               ((num ?m ^k ?n) :elements ((num ?n)) :binds ((?m (+ ?n 1))))""",
            r"d\.icr:4: \(num \?m",
        ),
        (
            """((to ?a ?b ^k ?x) :elements ((thing ?a ^x ?x) (thing ?b)))
               ((to ?a ?c ^k ?k) :elements ((to ?a ?b ^k ?k) (to ?b ?c)))""",
            r"d\.icr:[34]: \(to \?a",
        ),
    ],
)
@pytest.mark.parametrize("budget", [Budget(facts=200), Budget(seconds=0.2)])
def test_recursion_that_computes_attributes_keeps_to_the_budget(clauses, clause, budget) -> None:
    domain, _ = parse_domain(f"(percepts (thing ^x))\n(concepts\n{clauses})", "d.icr")
    engine = InferenceEngine(domain, budget=budget)
    memory = engine.step(Memory(), [])
    things = [Percept("thing", f"t{number:03}", {"x": number}) for number in range(120)]
    said = "more than 200 beliefs" if budget.facts == 200 else r"was being joined .* 0\.2 s"
    with pytest.raises(InferenceError, match=f"^{clause}.*{said}, (the|its) budget"):
        engine.step(memory, things)
    assert engine.step(memory, []).state.beliefs == ()


def test_a_count_without_an_end_names_the_clause_that_counts() -> None:
    domain, _ = parse_domain(
        "(percepts (thing ^x))\n(concepts\n((num ?x) :elements ((thing ?o ^x ?x)))\n"
        "((num ?m) :elements ((num ?n)) :binds ((?m (+ ?n 1)))))",
        "d.icr",
    )
    engine = InferenceEngine(domain, budget=Budget(facts=100))
    with pytest.raises(InferenceError, match=r"^d\.icr:4: \(num \?m\) concludes more than 100"):
        engine.step(Memory(), [Percept("thing", "t", {"x": 1})])
