"""The measured behaviour of ICARUS, F1 to F9, where it is about inference: the network by steps.

The numbers are those of the Lisp implementation; what is added is that each situation is reached
by changes, and left again.
"""

from __future__ import annotations

from itertools import permutations
from pathlib import Path

import pytest

from icarus_lite import Belief, Percept, load_domain
from icarus_lite.inference.network import Delta, Network, compile_domain
from icarus_lite.language import parse_atom, parse_domain

BLOCKS = load_domain(Path(__file__).resolve().parents[2] / "domains" / "blocks.icr")
_COUNTED = ("on", "ontable", "clear", "holding", "hand-empty")


def network_of(text: str) -> Network:
    domain, problems = parse_domain(text)
    assert domain is not None, problems
    return compile_domain(domain).network()


def block(name: str, x: float, level: int) -> Percept:
    return Percept("block", name, {"x": x, "y": 0.05 * level, "height": 0.05})


def table_and_hand() -> tuple[Percept, ...]:
    return Percept("table", "t", {"y": 0}), Percept("hand", "h")


def believed(network: Network) -> list[str]:
    return [str(belief) for belief in network.beliefs()]


def test_f1_a_tower_of_n_blocks_makes_2n_plus_3_beliefs_as_it_grows_and_shrinks() -> None:
    network = compile_domain(BLOCKS).network()
    network.update(Delta(table_and_hand()))

    def counted(n: int) -> int:
        return sum(network.count(name) for name in _COUNTED) + n + 1  # blocks and table themselves

    for level in range(40):
        network.update(Delta((block(f"b{level}", 0.3, level),)))
        assert counted(level + 1) == 2 * (level + 1) + 3
    for level in reversed(range(1, 40)):
        network.update(Delta(gone=(("block", f"b{level}"),)))
        assert counted(level) == 2 * level + 3


def test_f5_above_is_transitive_and_follows_what_is_taken_away() -> None:
    network = compile_domain(BLOCKS).network()
    tower = [block("c", 0.3, 0), block("b", 0.3, 1), block("a", 0.3, 2)]
    network.update(Delta((*table_and_hand(), *tower)))
    above = [str(belief) for belief in network.facts("above")]
    assert sorted(above) == ["(above a b)", "(above a c)", "(above b c)"]
    changes = network.update(Delta((block("a", 0.5, 0),)))
    assert {"(above a b)", "(above a c)"} <= {str(belief) for belief in changes.removed}
    assert [str(belief) for belief in network.facts("above")] == ["(above b c)"]


def test_f6_a_variable_that_occurs_only_inside_not_reads_there_is_none() -> None:
    network = network_of("""
        (percepts (hand ^holds) (thing))
        (concepts
          ((holding ?h ?o) :elements ((hand ?h ^holds ?o) (thing ?o)))
          ((free ?h) :elements ((hand ?h) (not (holding ?h ?any))))
          ((not-held ?o) :elements ((thing ?o) (not (holding ?any ?o)))))""")

    def hand(name: str, holds: str) -> Percept:
        return Percept("hand", name, {"holds": holds})

    things = (Percept("thing", "o1"), Percept("thing", "o2"))
    network.update(Delta((hand("h1", "o1"), hand("h2", "nil"), *things)))
    assert believed(network) == ["(free h2)", "(holding h1 o1)", "(not-held o2)"]
    network.update(Delta((hand("h2", "o1"),)))
    assert believed(network) == ["(holding h1 o1)", "(holding h2 o1)", "(not-held o2)"]
    network.update(Delta((hand("h1", "nil"),)))
    assert believed(network) == ["(free h1)", "(holding h2 o1)", "(not-held o2)"]
    network.update(Delta(gone=(("thing", "o1"),)))
    assert believed(network) == ["(free h1)", "(free h2)", "(not-held o2)"]


@pytest.mark.parametrize("order", list(permutations(range(3))))
def test_f7_the_order_of_definitions_does_not_matter_to_not(order: tuple[int, ...]) -> None:
    clauses = (
        "((solid ?b) :elements ((block ?b)))",
        "((clear ?b) :elements ((solid ?b) (not (on ?any ?b))))",
        "((on ?a ?b) :elements ((block ?b ^under ?a) (block ?a)))",
    )
    text = " ".join(clauses[place] for place in order)
    network = network_of(f"(percepts (block ^under)) (concepts {text})")
    network.update(Delta((Percept("block", "b", {"under": "a"}),)))
    assert believed(network) == ["(clear b)", "(solid b)"]
    network.update(Delta((Percept("block", "a"),)))
    assert believed(network) == ["(clear a)", "(on a b)", "(solid a)", "(solid b)"]


@pytest.mark.parametrize(("goal", "found"), [("(on ?z a)", []), ("(on ?z b)", ["a"])])
def test_f8_goals_with_variables(goal: str, found: list[str]) -> None:
    network = compile_domain(BLOCKS).network()
    network.update(Delta((*table_and_hand(), block("b", 0.3, 0), block("a", 0.3, 1))))
    goal_atom = parse_atom(goal)
    assert [bound["?z"] for bound in network.matches(goal_atom, {})] == found
    assert bool(list(network.matches(goal_atom, {"?z": "a"}))) is bool(found)
    assert not list(network.matches(goal_atom, {"?z": "b"}))


def test_f9_attached_from_the_pick_up_until_the_place_down() -> None:
    network = network_of("""
        (percepts (object) (hand))
        (concepts ((carried ?o) :elements ((object ?o) (attached ?o ?h) (hand ?h))))
        (skills ((pick-up ?h ?o) :elements ((hand ?h) (object ?o)) :actions ((*grasp ?h ?o)))
                ((place-down ?h ?o) :elements ((attached ?o ?h)) :actions ((*open ?h))))
        (attachments ((pick-up ?h ?o) :until (place-down ?h ?o) :child ?o :parent ?h))""")
    attached = Belief("attached", ("o1", "hand1"))
    for cycle in range(12):
        seen = (Percept("object", "o1"), Percept("hand", "hand1")) if cycle == 0 else ()
        given, taken = (attached,) * (cycle == 0), (attached,) * (cycle == 9)
        network.update(Delta(seen, (), given, taken))
        assert network.holds(attached) is network.holds(Belief("carried", ("o1",))) is (cycle < 9)
    assert list(network.intervals(attached)) == [(0, 9)]
    assert list(network.intervals(Belief("carried", ("o1",)))) == [(0, 9)]
