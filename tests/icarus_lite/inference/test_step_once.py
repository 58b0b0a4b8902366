"""One state inferred without a network: the same beliefs with the same supports."""

from __future__ import annotations

from pathlib import Path

import pytest

from icarus_lite.errors import FrameError
from icarus_lite.inference import InferenceEngine, Memory, given_memory, given_percepts
from icarus_lite.language import load_domain
from icarus_lite.language.syntax import Atom, Domain
from icarus_lite.symbols import Percept

DOMAINS = [load_domain(p) for p in sorted(Path(__file__).parents[3].glob("domains/*.icr"))]
STATES = [
    (domain, facts, name)
    for domain in DOMAINS
    for facts, name in (
        *((task.init, f"task {task.name}") for task in domain.tasks if task.init),
        *((test.percepts, test.name) for test in domain.tests),
    )
]


@pytest.mark.parametrize(
    ("domain", "facts", "name"), STATES, ids=[f"{d.name}: {name}" for d, _, name in STATES]
)
def test_beliefs_supports_and_plans_of_the_next_cycle_are_the_same(
    domain: Domain, facts: tuple[Atom, ...], name: str
) -> None:
    assert name
    given, percepts = given_memory(domain, facts), given_percepts(domain, facts)
    by_network = InferenceEngine(domain).step(given, percepts)
    engine = InferenceEngine(domain)
    at_once = engine.step_once(given, percepts)
    assert at_once.state.beliefs == by_network.state.beliefs
    assert at_once.asserted == by_network.asserted
    assert at_once.known == by_network.known
    assert at_once.state.cycle == by_network.state.cycle
    assert at_once.state.percepts == by_network.state.percepts
    for belief in at_once.state.beliefs:
        ours, theirs = at_once.state.supports[belief], by_network.state.supports[belief]
        assert len(ours) == len(theirs)
        assert all(each in theirs for each in ours)
    # A cycle may follow all the same.
    after = engine.step(at_once, percepts)
    assert after.state.beliefs == at_once.state.beliefs
    assert after.state.cycle == at_once.state.cycle + 1


def test_percepts_are_checked() -> None:
    domain = DOMAINS[0]
    kind = domain.percepts[0].name
    with pytest.raises(FrameError, match="2 percepts of type"):
        InferenceEngine(domain).step_once(Memory(), [Percept(kind, "a"), Percept(kind, "a")])


def test_an_engine_that_is_under_way_goes_on_by_its_network() -> None:
    test = next(test for domain in DOMAINS for test in domain.tests if test.percepts)
    domain = next(domain for domain in DOMAINS if test in domain.tests)
    percepts = given_percepts(domain, test.percepts)
    engine = InferenceEngine(domain)
    first = engine.step(Memory(), percepts)
    second = engine.step_once(first, percepts)
    assert second.state.cycle == 1
    assert engine.look_back(0).beliefs == second.state.beliefs
