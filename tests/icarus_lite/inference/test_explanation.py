from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from icarus_lite import Action, Agent, Belief, Outcome, Percept
from icarus_lite.inference import (
    BeliefState,
    Budget,
    Explanation,
    ForgottenError,
    InferenceEngine,
    Memory,
    explain,
    percept_facts,
)
from icarus_lite.inference.explaining import Period
from icarus_lite.inference.explaining.grounds import well_founded
from icarus_lite.language.reading.reader import parse_domain

DOMAIN, _ = parse_domain("""(percepts (hand) (object))
(concepts
  ((idle ?h) :elements ((hand ?h) (not (holding ?h ?any))))
  ((busy ?h) :elements ((holding ?h ?o) (object ?o))))
(skills ((pick-up ?h ?o) :elements ((hand ?h) (object ?o)) :actions ((*grasp ?h ?o))
                         :effects ((holding ?h ?o))))""")
PERCEPTS = (Percept("hand", "h1"), Percept("hand", "h2"), Percept("object", "o1"))


def state():
    engine = InferenceEngine(DOMAIN)
    memory = engine.step(Memory(), PERCEPTS)
    done = Outcome(Action("pick-up", ("h1", "o1")))
    return engine.step(memory, PERCEPTS, [done]).state


def test_a_tree_down_to_percepts_and_actions() -> None:
    assert str(explain(Belief("busy", ("h1",)), state())) == (
        "(busy h1)  by its definition (line 4)\n"
        "  (holding h1 o1)  because (pick-up h1 o1) succeeded, reported in cycle 1\n"
        "  (object o1)  is perceived"
    )


def test_what_was_absent_is_said() -> None:
    assert str(explain(Belief("idle", ("h2",)), state())).splitlines()[-1] == (
        "  (not (holding h2 ?any))  nothing like it is believed"
    )


def test_what_is_not_believed_is_said_to_be_so() -> None:
    assert str(explain(Belief("busy", ("h2",)), state())) == (
        "(busy h2)  is not believed in cycle 1"
    )


RING, PROBLEMS = parse_domain("""(percepts (link ^from ^to))
(concepts
  ((joined ?a ?b) :elements ((link ?_l ^from ?a ^to ?b)))
  ((joined ?a ?c) :elements ((joined ?a ?b) (joined ?b ?c))))""")
assert RING is not None, PROBLEMS


def ring(*ends: str) -> BeliefState:
    percepts = [
        Percept("link", f"l{n}", {"from": pair[0], "to": pair[1]}) for n, pair in enumerate(ends)
    ]
    return InferenceEngine(RING).step(Memory(), percepts).state


def joined(ends: str) -> Belief:
    return Belief("joined", tuple(ends))


def leaves(explanation: Explanation) -> Iterator[Explanation]:
    if not explanation.premises:
        yield explanation
    for premise in explanation.premises:
        yield from leaves(premise)


def paths(explanation: Explanation, above: tuple[Belief, ...] = ()) -> Iterator[tuple[Belief, ...]]:
    here = (*above, explanation.belief)
    yield here
    for premise in explanation.premises:
        yield from paths(premise, here)


LINKS = st.lists(
    st.tuples(st.sampled_from("abcd"), st.sampled_from("abcd")).map("".join),
    min_size=1,
    max_size=7,
    unique=True,
)


@given(LINKS)
def test_no_proof_and_no_alternative_goes_round_in_a_circle(links: list[str]) -> None:
    state = ring(*links)
    for belief in state.supports:
        found = explain(belief, state, alternatives=True)
        for each in (found, *found.alternatives):
            assert all(len(set(path)) == len(path) for path in paths(each))
            assert all(isinstance(leaf.support, Percept) for leaf in leaves(each))
            assert each.support in state.supports[belief]


@given(LINKS)
def test_the_alternatives_are_those_that_hold_without_the_belief(links: list[str]) -> None:
    state = ring(*links)
    for belief in state.supports:
        independent = well_founded(state.supports, state.supports, without=belief)
        percepts = set(percept_facts(state.percepts, state.lineages))
        expected = [
            support
            for support in state.supports[belief]
            if all(premise in independent or premise in percepts for premise in support.matched)
        ]
        found = explain(belief, state, alternatives=True)
        told = [found.support, *(each.support for each in found.alternatives)]
        assert [each for each in state.supports[belief] if each in told] == expected


def test_first_supports_that_lead_in_a_circle_are_not_followed() -> None:
    state = ring("ab", "ba")
    turned = {
        belief: tuple(reversed(supports)) if len(set(belief.args)) == 2 else supports
        for belief, supports in state.supports.items()
    }
    circular = replace(state, supports=turned)
    assert isinstance(turned[joined("ab")][0].matched[0], Belief)
    for belief in turned:
        assert all(len(set(path)) == len(path) for path in paths(explain(belief, circular)))


def test_alternatives_are_told_after_the_first() -> None:
    state = ring("ab", "bc", "ac")
    assert str(explain(joined("ac"), state, alternatives=True)) == (
        "(joined a c)  by its definition (line 3)\n"
        "  (link l2 ^from a ^to c)  is perceived\n"
        "  or else:\n"
        "    (joined a c)  by its definition (line 4)\n"
        "      (joined a b)  by its definition (line 3)\n"
        "        (link l0 ^from a ^to b)  is perceived\n"
        "      (joined b c)  by its definition (line 3)\n"
        "        (link l1 ^from b ^to c)  is perceived"
    )
    assert explain(joined("ac"), state).alternatives == ()


def test_a_proof_with_shared_parts_is_told_once() -> None:
    text = "(percepts (o)) (concepts ((p0 ?x) :elements ((o ?x)))" + "".join(
        f" ((p{n} ?x) :elements ((p{n - 1} ?x) (q{n} ?x))) ((q{n} ?x) :elements ((p{n - 1} ?x)))"
        for n in range(1, 40)
    )
    domain, _ = parse_domain(text + ")")
    state = InferenceEngine(domain).step(Memory(), [Percept("o", "a")]).state
    told = str(explain(Belief("p39", ("a",)), state)).splitlines()  # unshared: 2 ** 39 lines
    assert len(told) == 3 * 39 + 2
    assert sum(line.endswith("as told above") for line in told) == 39


def test_a_proof_may_be_deeper_than_python_can_recurse() -> None:
    domain, _ = parse_domain(
        "(percepts (o ^next)) (concepts ((leads-on ?x) :elements ((o ?x ^next end)))"
        " ((leads-on ?x) :elements ((o ?x ^next ?y) (leads-on ?y))))"
    )
    names = [f"o{n}" for n in range(1500)]
    percepts = [
        Percept("o", name, {"next": other})
        for name, other in zip(names, [*names[1:], "end"], strict=True)
    ]
    found = explain(
        Belief("leads-on", ("o0",)), InferenceEngine(domain).step(Memory(), percepts).state
    )
    assert len(str(found).splitlines()) == 3000


def test_the_action_and_the_cycle_that_asserted_it() -> None:
    found = explain(Belief("holding", ("h1", "o1")), state())
    assert found.action == Action("pick-up", ("h1", "o1"))
    assert found.support.cycle == 1
    assert explain(Belief("busy", ("h1",)), state()).action is None


def test_the_periods_in_which_it_was_believed() -> None:
    agent = Agent(DOMAIN)
    done = [Outcome(Action("pick-up", ("h1", "o1")))]
    for percepts, outcomes in [
        (PERCEPTS, done),
        (PERCEPTS[:2], []),
        (PERCEPTS, []),
        (PERCEPTS, done),
    ]:
        agent.cycle(percepts, outcomes)
    found = agent.why("(holding h1 o1)")
    assert found.periods == (Period(0, 0), Period(3, None))
    assert str(found).splitlines()[-1] == "  it has been believed in cycle 0, from cycle 3 on"


def test_an_asserted_belief_that_is_derived_as_well_has_both_reasons() -> None:
    domain, _ = parse_domain(
        "(percepts (o)) (skills ((tie ?a ?b) :elements ((o ?a) (o ?b)) :actions ((*tie ?a ?b))"
        " :effects ((attached ?a ?b)))) (concepts ((attached ?a ?b) :elements ((o ?a) (o ?b))"
        " :tests ((/= ?a ?b))))"
    )
    engine = InferenceEngine(domain)
    percepts = [Percept("o", "a"), Percept("o", "b")]
    memory = engine.step(Memory(), percepts, [Outcome(Action("tie", ("a", "b")))])
    found = explain(Belief("attached", ("a", "b")), memory.state, alternatives=True)
    assert [found.because, *(each.because for each in found.alternatives)] == [
        "because (tie a b) succeeded, reported in cycle 0",
        "by its definition (line 1)",
    ]


LIFE = [
    (PERCEPTS, [Outcome(Action("pick-up", ("h1", "o1")))]),
    (PERCEPTS[:2], []),
    (PERCEPTS, []),
    (PERCEPTS, [Outcome(Action("pick-up", ("h2", "o1")))]),
    (PERCEPTS, []),
]


def test_why_it_was_believed_in_an_earlier_cycle() -> None:
    agent, told = Agent(DOMAIN), []
    asked = [f"({p} {h})" for p in ("idle", "busy") for h in ("h1", "h2")] + ["(holding h2 o1)"]
    for percepts, outcomes in LIFE:
        agent.cycle(percepts, outcomes)
        told.append({each: [*agent.why(each).as_document()["nodes"]] for each in asked})
    for cycle, wanted in enumerate(told):
        for each in asked:
            found = agent.why(each, cycle=cycle)
            assert found.cycle == cycle
            assert found.as_document()["nodes"] == wanted[each]
    assert str(agent.why("(busy h1)", cycle=0)) == (
        "(busy h1)  by its definition (line 4)\n"
        "  (holding h1 o1)  because (pick-up h1 o1) succeeded, reported in cycle 0\n"
        "  (object o1)  is perceived"
    )
    assert str(agent.why("(busy h1)", cycle=1)) == "(busy h1)  is not believed in cycle 1"


def test_a_cycle_that_is_forgotten_is_said_to_be() -> None:
    agent = Agent(DOMAIN, budget=Budget(changes_kept=6))
    for percepts, outcomes in LIFE * 20:
        agent.cycle(percepts, outcomes)
    with pytest.raises(ForgottenError, match="cycle 3 is not on record, which begins with cycle "):
        agent.why("(busy h1)", cycle=3)
    with pytest.raises(ForgottenError, match="there is no cycle 100; the last one is 99"):
        agent.why("(busy h1)", cycle=100)
    assert agent.why("(holding h2 o1)", cycle=98).action == Action("pick-up", ("h2", "o1"))
    assert len(agent.why("(holding h2 o1)").periods) < 5


def test_an_attachment_of_the_past_has_the_action_of_then() -> None:
    domain, _ = parse_domain(
        "(percepts (o)) (skills ((tie ?a ?b) :elements ((o ?a) (o ?b)) :actions ((*tie ?a ?b))))"
        " (attachments ((tie ?a ?b) :child ?a :parent ?b))"
        " (concepts ((tied ?a) :elements ((attached ?a ?any))))"
    )
    percepts = [Percept("o", name) for name in "abc"]
    engine, memory, memories = InferenceEngine(domain), Memory(), []
    for args in (("a", "b"), ("a", "c"), ("b", "c")):
        memory = engine.step(memory, percepts, [Outcome(Action("tie", args))])
        memories.append(memory)
    for cycle, wanted in enumerate(memories):
        state = engine.look_back(cycle)
        assert state.hierarchy == wanted.state.hierarchy
        assert dict(state.asserted()) == dict(wanted.state.asserted())
        assert str(explain(Belief("tied", ("a",)), state)) == str(
            explain(Belief("tied", ("a",)), wanted.state)
        )


def test_a_step_from_another_memory_begins_a_run_of_its_own() -> None:
    engine, memories = InferenceEngine(DOMAIN), [Memory()]
    for percepts, outcomes in LIFE:
        memories.append(engine.step(memories[-1], percepts, outcomes))
    other = engine.step(memories[2], PERCEPTS, [Outcome(Action("pick-up", ("h2", "o1")))])
    assert str(engine.look_back(2).beliefs) == str(other.state.beliefs)
    with pytest.raises(ForgottenError, match="cycle 1 is not on record"):
        engine.look_back(1)
    with pytest.raises(ForgottenError, match="there is no cycle 4"):
        engine.look_back(4)
    engine.step(other, PERCEPTS)
    assert engine.look_back(2).beliefs == other.state.beliefs


def test_of_many_periods_the_last_are_told() -> None:
    agent = Agent(DOMAIN)
    for _ in range(9):
        agent.cycle(PERCEPTS)
        agent.cycle(PERCEPTS[1:])
    agent.cycle(PERCEPTS)
    found = agent.why("(idle h1)")
    assert len(found.periods) == 10
    assert str(found).splitlines()[-1] == (
        "  it has been believed 5 times before, and in cycle 10, in cycle 12, in cycle 14, "
        "in cycle 16, from cycle 18 on"
    )
