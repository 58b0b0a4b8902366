from __future__ import annotations

import pytest

from icarus_lite import Action, Belief, Outcome, Percept
from icarus_lite.inference import BeliefState, Derivation, InferenceEngine, Memory
from icarus_lite.language import parse_domain

TEXT = """
(percepts (obj ^x))
(concepts
  ((near ?a ?b)
   :elements ((obj ?a ^x ?xa) (obj ?b ^x ?xb))
   :tests ((/= ?a ?b) (< (abs (- ?xa ?xb)) 3)))
  ((free ?a) :elements ((obj ?a) (not (held ?a)))))
(skills
  ((grasp ?a) :elements ((free ?a)) :actions ((*grasp ?a)) :effects ((held ?a))))
"""
DOMAIN, PROBLEMS = parse_domain(TEXT)
assert DOMAIN is not None, PROBLEMS


def scene(*places: float) -> list[Percept]:
    return [Percept("obj", f"o{i}", {"x": x}) for i, x in enumerate(places)]


def steps() -> tuple[InferenceEngine, list[Memory]]:
    engine = InferenceEngine(DOMAIN)
    memories = [engine.step(Memory(), scene(0, 2, 9))]
    memories.append(engine.step(memories[-1], scene(0, 9, 9)))
    grasped = [Outcome(Action("grasp", ("o0",)))]
    memories.append(engine.step(memories[-1], scene(0, 9, 9), grasped))
    return engine, memories


def told(state: BeliefState) -> dict[str, list[str]]:
    """Give each belief with the premises of each support, by what a person would read."""
    return {
        str(belief): sorted(
            " ".join(map(str, each.matched)) if isinstance(each, Derivation) else str(each.action)
            for each in supports
        )
        for belief, supports in state.supports.items()
    }


def test_a_state_stays_what_it_was_when_the_engine_has_gone_on() -> None:
    engine = InferenceEngine(DOMAIN)
    memory, then, later = Memory(), [], []
    for places in ((0, 2, 9), (0, 9, 9), (0, 9, 1)):
        memory = engine.step(memory, scene(*places))
        then.append((memory.state, told(memory.state), memory.state.beliefs))
    for state, supports, beliefs in then:
        later.append((state, told(state), state.beliefs))
        assert later[-1] == (state, supports, beliefs)
    first = then[0][0]
    assert Belief("near", ("o0", "o1")) in first
    assert Belief("near", ("o1", "o2")) not in first
    assert Belief("near", ("o0", "o1")) not in then[1][0]
    with pytest.raises(KeyError):
        first.supports[Belief("near", ("o1", "o2"))]


def test_the_facts_of_a_state_can_be_asked_for_later() -> None:
    _, memories = steps()
    expected = [
        "(free o0)", "(free o1)", "(free o2)", "(near o0 o1)", "(near o1 o0)", "(obj o0)",
        "(obj o1)", "(obj o2)",
    ]  # fmt: skip
    assert sorted(map(str, memories[0].state.facts())) == expected
    assert [str(f) for ((_, f, _),) in memories[2].state.facts().rows("held").values()] == [
        "(held o0)"
    ]


def test_what_was_added_and_removed_since_another_cycle() -> None:
    _, memories = steps()
    states = [memory.state for memory in memories]
    near = [Belief("near", pair) for pair in (("o0", "o1"), ("o1", "o0"))]
    other = [Belief("near", pair) for pair in (("o1", "o2"), ("o2", "o1"))]
    assert states[1].since(states[0]) == (tuple(other), tuple(near))
    assert states[2].since(states[1]) == ((Belief("held", ("o0",)),), (Belief("free", ("o0",)),))
    assert states[2].since(states[0])[0] == (Belief("held", ("o0",)), *other)
    assert states[0].since(BeliefState()) == (states[0].beliefs, ())


def test_the_engine_can_go_on_from_any_memory() -> None:
    engine, memories = steps()
    again = engine.step(memories[0], scene(0, 9, 9))
    assert told(again.state) == told(memories[1].state)
    assert again.state.since(memories[0].state) == memories[1].state.since(memories[0].state)
