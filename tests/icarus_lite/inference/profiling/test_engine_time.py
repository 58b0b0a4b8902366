"""The engine's own time: shared out among the clauses, and never more than there was."""

from __future__ import annotations

import pytest

from icarus_lite import InferenceError
from icarus_lite.inference.network import compile_domain
from icarus_lite.inference.profiling import DomainProfiler, engine_time
from icarus_lite.language import parse_domain
from icarus_lite.outcomes import Outcome
from icarus_lite.symbols import Action, Belief, Percept

TEXT = """(percepts (object ^x ^y) (hand))
(concepts
  ((near ?a ?b) :elements ((object ?a ^x ?xa) (object ?b ^x ?xb))
                :tests ((/= ?a ?b) (< (abs (- ?xa ?xb)) 2)))
  ((friend ?a) :elements ((near ?a ?_b)))
  ((lonely ?a) :elements ((object ?a) (not (friend ?a))))
  ((asleep ?h) :elements ((hand ?h) (dreams ?h))))
(skills ((sleep ?h) :elements ((hand ?h)) :actions ((*sleep ?h)) :effects ((dreams ?h))))
"""
DOMAIN, PROBLEMS = parse_domain(TEXT, "cell.icr")
assert DOMAIN is not None, PROBLEMS
COMPILED = compile_domain(DOMAIN)


def scene(cycle: int) -> list[Percept]:
    moved = [Percept("object", f"o{n}", {"x": (n * (cycle + 3)) % 40, "y": 0}) for n in range(30)]
    return [Percept("hand", "h"), *moved]


def test_no_cycles_take_no_time() -> None:
    nothing = engine_time(COMPILED, [])
    assert (nothing.cycles, nothing.seconds, nothing.first) == (0, 0, 0)
    assert nothing.clauses == (0, 0, 0, 0)


def test_one_cycle_is_the_first() -> None:
    one = engine_time(COMPILED, [(scene(0), ())])
    assert (one.cycles, one.seconds) == (0, 0)
    assert one.first > 0


def test_what_the_clauses_took_is_part_of_what_was_spent() -> None:
    spent = engine_time(COMPILED, [(scene(n), ()) for n in range(12)])
    near, friend, lonely, asleep = spent.clauses
    assert spent.cycles == 11
    assert 0 < sum(spent.clauses) <= spent.seconds
    assert min(near, friend, lonely) > 0
    assert asleep == 0  # nothing about hands ever changed
    assert near > asleep


def test_a_clause_whose_conditions_change_is_charged_for_it() -> None:
    dreams = Belief("dreams", ("h",))
    spent = engine_time(COMPILED, [(scene(0), [dreams] if n % 2 else []) for n in range(12)])
    _near, friend, lonely, asleep = spent.clauses
    assert asleep > 0
    assert friend == lonely == 0


def test_a_profile_of_a_domain_has_both_sorts_of_time() -> None:
    profiler = DomainProfiler(COMPILED)
    for cycle in range(6):
        done = [Outcome(Action("sleep", ("h",)))] if cycle == 3 else []
        profiler.cycle(scene(cycle), done)
    profile = profiler.result()
    assert (profile.cycles, profile.engine.cycles) == (6, 5)
    assert profile.engine.clauses[3] > 0  # what actions assert reaches the network as well
    assert profile.slowest is not None
    assert profile.engine.clauses[profile.slowest.plan.number] == max(profile.engine.clauses)


def test_an_error_in_a_test_is_told() -> None:
    with pytest.raises(InferenceError, match=r"cell\.icr:4:.*the symbol left"):
        engine_time(COMPILED, [([Percept("object", n, {"x": "left"}) for n in "ab"], ())])
