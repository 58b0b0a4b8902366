"""The log of changes: what it tells of the past, how it is taken back, and what it forgets."""

from __future__ import annotations

import random
import tracemalloc

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from icarus_lite import Belief, Percept
from icarus_lite.inference.network import (
    Budget,
    CompiledDomain,
    Delta,
    ForgottenError,
    Network,
    compile_domain,
)
from icarus_lite.inference.supports import Derivation
from icarus_lite.language import parse_domain

TEXT = """
(percepts (obj ^x) (lid :is obj))
(concepts
  ((near ?a ?b ^gap ?gap)
   :elements ((obj ?a ^x ?xa) (obj ?b ^x ?xb))
   :tests ((/= ?a ?b) (< (abs (- ?xa ?xb)) 3))
   :binds ((?gap (- ?xa ?xb))))
  ((reaches ?a ?b) :elements ((near ?a ?b)))
  ((reaches ?a ?c) :elements ((near ?a ?b) (reaches ?b ?c)))
  ((free ?a) :elements ((obj ?a) (not (held ?a)))))
"""
DOMAIN, PROBLEMS = parse_domain(TEXT)
assert DOMAIN is not None, PROBLEMS
COMPILED: CompiledDomain = compile_domain(DOMAIN)
HELD = Belief("held", ("o0",))

Scene = tuple[tuple[str, int], ...]
"""The type and the place of each object; a place below 0 is nowhere."""


def percepts(scene: Scene) -> list[Percept]:
    return [Percept(type_, f"o{i}", {"x": x}) for i, (type_, x) in enumerate(scene) if x >= 0]


def reasons(network: Network) -> dict[str, set[str]]:
    """Give each belief that is derived with the facts that each of its derivations rests on."""
    return {
        str(belief): {" ".join(map(str, each.matched)) for each in network.supports(belief)}
        for belief in network.beliefs()
    }


def values(network: Network) -> dict[str, dict[str, object]]:
    return {str(belief): dict(belief.attributes) for belief in network.beliefs()}


SCENES = st.lists(
    st.tuples(
        st.tuples(*[st.tuples(st.sampled_from(["obj", "lid"]), st.integers(-1, 6))] * 4),
        st.booleans(),
        st.booleans(),
    ),
    min_size=2,
    max_size=9,
)


@settings(max_examples=30)
@given(SCENES)
def test_a_cycle_recalled_is_what_a_fresh_run_to_it_gives(history) -> None:
    network = COMPILED.network()
    for scene, held, moved in history:
        there = percepts(scene)
        asserted = [HELD] if held else []
        known = {(each.type, each.name) for each in network.percepts()}
        if moved and known == {(each.type, each.name) for each in there}:
            for type_ in ("obj", "lid"):
                row = [each for each in there if each.type == type_]
                network.move(
                    type_,
                    [each.name for each in row],
                    {"x": [each.attributes["x"] for each in row]},
                    asserted,
                    () if held else [HELD],
                )
        else:
            network.update_snapshot(there, asserted)
    fresh = COMPILED.network()
    there_is = {cycle: network.held_at(cycle) for cycle in range(network.cycle + 1)}
    now, percepts_now = values(network), set(network.percepts())
    for cycle in range(network.cycle + 1):
        then = network.recall(cycle)
        fresh.update_snapshot(then.percepts(), then.asserted())
        assert then.cycle == cycle
        assert then.held_at(cycle) == there_is[cycle] == frozenset(fresh.beliefs())
        assert values(then) == values(fresh)
        assert reasons(then) == reasons(fresh)
    assert (values(network), set(network.percepts())) == (now, percepts_now)


def test_what_was_perceived_and_given_is_taken_back_with_its_attributes() -> None:
    network = COMPILED.network()
    network.update(Delta((Percept("obj", "o0", {"x": 1}), Percept("lid", "o1", {"x": 2}))))
    network.move("obj", ["o0"], {"x": [5]}, [HELD])
    network.update(Delta(gone=(("obj", "o0"),), withdrawn=(HELD,)))
    network.update(Delta((Percept("lid", "o0", {"x": 2, "y": 7}),)))
    told = [set(network.recall(cycle).percepts()) for cycle in range(4)]
    lid = Percept("lid", "o1", {"x": 2})
    assert [sorted(map(str, each)) for each in told] == [
        ["(lid o1 ^x 2)", "(obj o0 ^x 1)"],
        ["(lid o1 ^x 2)", "(obj o0 ^x 5)"],
        ["(lid o1 ^x 2)"],
        ["(lid o0 ^x 2 ^y 7)", "(lid o1 ^x 2)"],
    ]
    assert lid in told[0]
    assert [network.recall(cycle).holds(HELD) for cycle in range(4)] == [False, True, False, False]
    assert network.recall(1).percept("obj", "o1") == lid
    assert network.recall(2).percept("obj", "o0") is None


def test_a_proof_of_the_past_is_the_one_given_then() -> None:
    network, told = COMPILED.network(), []
    for x in (4, 9, 4, 2):
        network.update_snapshot(percepts((("obj", 0), ("obj", 2), ("obj", x))), [])
        told.append({b: network.support(b) for b in network.beliefs()})
    for cycle, wanted in enumerate(told):
        then = network.recall(cycle)
        assert {b: then.support(b) for b in then.beliefs()} == wanted


def test_a_recalled_network_goes_its_own_way() -> None:
    network = COMPILED.network()
    for x in (2, 9):
        network.update_snapshot(percepts((("obj", 0), ("obj", x))), [])
    near, then = Belief("near", ("o0", "o1")), network.recall(0)
    then.move("obj", ["o1"], {"x": [1]})
    assert then.intervals(near) == [(0, None)]
    assert network.intervals(near) == [(0, 1)]
    assert then.recall(0).percepts() == network.recall(0).percepts()
    with pytest.raises(ForgottenError, match="cycle 0 is not on record, which begins with cycle 1"):
        network.copy().recall(0)  # what the copy has taken over is the log of another


def flickering(changes_kept: int | None, cycles: int) -> tuple[Network, list[frozenset[Belief]]]:
    network = COMPILED.network(Budget(changes_kept=changes_kept))
    draw, told = random.Random(1), []
    for _ in range(cycles):
        scene = tuple(("obj", draw.randrange(8)) for _ in range(3))
        network.update_snapshot(percepts((("obj", 0), ("obj", 1), *scene)), [])
        told.append(frozenset(network.beliefs()))
    return network, told


@pytest.mark.parametrize("changes_kept", [1, 30, 200, 3000])
def test_old_cycles_are_forgotten_and_the_rest_stays_right(changes_kept: int) -> None:
    cycles = 80
    network, told = flickering(changes_kept, cycles)
    first = network.first_cycle
    assert (first > 0) == (changes_kept < 3000)
    assert first <= network.cycle
    for cycle in range(first, cycles):
        assert network.held_at(cycle) == told[cycle]
        assert frozenset(network.recall(cycle).beliefs()) == told[cycle]
    for belief in frozenset().union(*told):
        held = [cycle for cycle in range(cycles) if belief in told[cycle]]
        starts = [cycle for cycle in held if cycle - 1 not in held]
        ends = [cycle + 1 for cycle in held if cycle + 1 not in held]
        known = [(s, e if e < cycles else None) for s, e in zip(starts, ends, strict=True)]
        assert network.intervals(belief) == [each for each in known if (each[1] or cycles) >= first]
    if first:
        with pytest.raises(ForgottenError, match=f"cycle {first - 1} is not on record, which begi"):
            network.held_at(first - 1)
        with pytest.raises(ForgottenError, match="a budget with more `changes_kept` keeps more"):
            network.recall(0)


def test_what_has_lasted_from_before_the_record_has_its_true_beginning() -> None:
    network = COMPILED.network(Budget(changes_kept=20))
    for x in (9, 9, 2, *[2, 3] * 50):
        network.update_snapshot(percepts((("obj", 0), ("obj", 1), ("obj", x))), [])
    assert network.first_cycle > 50
    assert network.intervals(Belief("near", ("o0", "o1"))) == [(0, None)]
    assert network.intervals(Belief("near", ("o1", "o2"))) == [(2, None)]
    assert network.intervals(Belief("near", ("o0", "o2")))[-1] == (101, 102)


def test_a_budget_without_a_limit_keeps_all() -> None:
    network, told = flickering(None, 300)
    assert network.first_cycle == 0
    assert network.held_at(1) == told[1]


def test_a_long_run_needs_no_more_memory_than_a_short_one() -> None:
    network = COMPILED.network(Budget(changes_kept=1_000))
    draw = random.Random(2)

    def run(cycles: int) -> int:
        for _ in range(cycles):
            network.move("obj", ["o0", "o1"], {"x": [draw.randrange(9), draw.randrange(9)]})
        return tracemalloc.get_traced_memory()[0]

    network.update_snapshot(percepts((("obj", 0), ("obj", 1), ("obj", 2))), [])
    tracemalloc.start()
    try:
        after = [run(500) for _ in range(4)]
    finally:
        tracemalloc.stop()
    assert network.cycle == 2_000
    assert max(after) < 1.5 * after[0], after


@pytest.mark.parametrize(
    ("cycle", "said"),
    [(-1, "there is no cycle -1; the first one is 0"), (9, "there is no cycle 9; the last one is")],
)
def test_a_cycle_that_never_was(cycle: int, said: str) -> None:
    network, _ = flickering(None, 4)
    for ask in (network.held_at, network.recall):
        with pytest.raises(ForgottenError, match=said):
            ask(cycle)
    with pytest.raises(ForgottenError, match="there is no cycle 0: there has been none yet"):
        COMPILED.network().recall(0)


def test_no_derivation_is_lost_on_the_way_back() -> None:
    network, _ = flickering(None, 30)
    then = network.recall(12)
    for belief in then.beliefs():
        every = then.supports(belief)
        assert every[0] == then.support(belief)
        assert all(isinstance(each, Derivation) for each in every)
