"""The network against a naive evaluator, on random programs and random histories."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import ModuleType

from hypothesis import given, settings
from hypothesis import strategies as st

from icarus_lite import Belief, Percept
from icarus_lite.inference.network import Delta, Network, compile_domain
from icarus_lite.language.syntax import Atom, ConceptClause, Condition, Constant, Domain, Variable


def _reference() -> ModuleType:
    path = Path(__file__).parents[3] / "reference" / "naive_inference.py"
    spec = importlib.util.spec_from_file_location("naive_inference", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


model = _reference().model

GIVEN = {"e": 2, "o": 1}
LAYERS = ({"p": 2, "q": 1}, {"r": 2, "s": 1})
ARITY = {**GIVEN, **LAYERS[0], **LAYERS[1]}
VALUES = ("a", "b", "c")


@st.composite
def clauses(draw: st.DrawFn) -> ConceptClause:
    height = draw(st.sampled_from([0, 0, 1]))
    head = draw(st.sampled_from(sorted(LAYERS[height])))
    below = [*GIVEN, *(name for layer in LAYERS[:height] for name in layer)]
    names = st.sampled_from(["?x", "?y", "?z"])

    def atom(predicates: list[str], terms: st.SearchStrategy) -> Atom:
        name = draw(st.sampled_from(predicates))
        return Atom(name, tuple(draw(terms) for _ in range(ARITY[name])))

    anything = st.one_of(names.map(Variable), names.map(Variable), st.just(Constant("a")))
    usable = [*below, *LAYERS[height]]
    positive = [atom(usable, anything) for _ in range(draw(st.integers(1, 3)))]
    bound = sorted({v for each in positive for v in each.variables})
    negative = [atom(below, anything) for _ in range(draw(st.integers(0, 2)))]
    if bound:
        args = tuple(Variable(draw(st.sampled_from(bound))) for _ in range(ARITY[head]))
    else:
        args = tuple(Constant(draw(st.sampled_from(VALUES))) for _ in range(ARITY[head]))
    elements = [Condition(each) for each in positive]
    elements += [Condition(each, negated=True) for each in negative]
    return ConceptClause(Atom(head, args), tuple(draw(st.permutations(elements))))


FACTS = st.one_of(
    st.tuples(st.just("e"), st.sampled_from(VALUES), st.sampled_from(VALUES)),
    st.tuples(st.just("o"), st.sampled_from(VALUES)),
)
WORLDS = st.lists(st.frozensets(FACTS, max_size=7), min_size=1, max_size=6)
PROGRAMS = st.lists(clauses(), min_size=1, max_size=6)


def tell(net: Network, world: frozenset) -> None:
    """Tell a world: `o` is perceived, `e` is asserted."""
    percepts = [Percept("o", fact[1]) for fact in sorted(world) if fact[0] == "o"]
    net.update_snapshot(
        percepts, [Belief("e", fact[1:]) for fact in sorted(world) if len(fact) > 2]
    )


def held(net: Network) -> set[tuple]:
    return {(b.predicate, *b.args) for b in net.beliefs() if b.predicate != "e"}


def wanted(program: list[ConceptClause], world: frozenset) -> set[tuple]:
    return {fact for fact in model(program, set(world)) if fact[0] not in GIVEN}


@settings(max_examples=60, deadline=None)
@given(PROGRAMS, WORLDS)
def test_after_every_update_it_believes_what_follows(
    program: list[ConceptClause], worlds: list[frozenset]
) -> None:
    net = compile_domain(Domain("random", concepts=tuple(program))).network()
    before: set[Belief] = set()
    for cycle, world in enumerate(worlds):
        tell(net, world)
        assert held(net) == wanted(program, world)
        changes = net._changes(cycle)
        now = set(net.beliefs())
        assert set(changes[0]) == now - before
        assert set(changes[1]) == before - now
        before = now


@settings(max_examples=30, deadline=None)
@given(PROGRAMS, WORLDS, st.frozensets(FACTS, max_size=7))
def test_the_log_and_a_copy_tell_the_truth(
    program: list[ConceptClause], worlds: list[frozenset], imagined: frozenset
) -> None:
    net = compile_domain(Domain("random", concepts=tuple(program))).network()
    history = []
    for world in worlds:
        tell(net, world)
        history.append(frozenset(net.beliefs()))
    other = net.copy()
    tell(other, imagined)
    assert held(other) == wanted(program, imagined)
    assert [net.held_at(cycle) for cycle in range(len(worlds))] == history
    for belief in {belief for state in history for belief in state}:
        spans = net.intervals(belief)
        covered = {
            cycle
            for start, end in spans
            for cycle in range(start, len(history) if end is None else end)
        }
        assert covered == {cycle for cycle, state in enumerate(history) if belief in state}


@settings(max_examples=30, deadline=None)
@given(PROGRAMS, WORLDS)
def test_first_derivations_lead_to_what_is_given(
    program: list[ConceptClause], worlds: list[frozenset]
) -> None:
    net = compile_domain(Domain("random", concepts=tuple(program))).network()
    for world in worlds:
        tell(net, world)
    for belief in net.beliefs():
        open_ones: set[Belief] = set()

        def ground(each: Belief, under: set[Belief]) -> None:
            assert each not in under, f"the proof of {each} rests on itself"
            if each.predicate not in GIVEN:
                for premise in net.supports(each)[0].matched:
                    ground(premise, under | {each})

        ground(belief, open_ones)


def test_the_same_history_gives_the_same_order() -> None:
    program = (
        ConceptClause(Atom("p", (Variable("?x"), Variable("?y"))),
                      (Condition(Atom("e", (Variable("?x"), Variable("?y")))),)),
    )  # fmt: skip
    found = []
    for _ in range(2):
        net = compile_domain(Domain("random", concepts=program)).network()
        net.update(Delta(asserted=tuple(Belief("e", (a, b)) for a in VALUES for b in VALUES)))
        net.update(Delta(withdrawn=(Belief("e", ("b", "b")),)))
        found.append([str(belief) for belief in net.facts("p")])
    assert found[0] == found[1]
