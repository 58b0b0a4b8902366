from __future__ import annotations

import importlib.util
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from icarus_lite import Belief, InferenceError
from icarus_lite.inference import Closure, Derivation, FactStore, Matcher, ground
from icarus_lite.language.checking.stratification import NotStratifiedError, strata
from icarus_lite.language.reading.reader import parse_domain
from icarus_lite.language.syntax import Atom, ConceptClause, Condition, Constant, Variable

_REFERENCE = Path(__file__).parents[2] / "reference" / "naive_inference.py"
_spec = importlib.util.spec_from_file_location("naive_inference", _REFERENCE)
naive_inference = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(naive_inference)


def concepts(text: str) -> tuple[ConceptClause, ...]:
    domain, problems = parse_domain(f"(concepts {text})")
    assert domain is not None, problems
    return domain.concepts


def derive(text: str, *facts: Belief) -> set[str]:
    return {str(b) for b in Closure(concepts(text)).derive(FactStore(facts))}


def fact(predicate: str, *args: str | int, **attributes: str | float) -> Belief:
    return Belief(predicate, args, attributes)


def test_recursion_reaches_everything_above() -> None:  # fixture F5
    text = """((above ?a ?b) :elements ((on ?a ?b)))
              ((above ?a ?c) :elements ((on ?a ?b) (above ?b ?c)))"""
    assert derive(text, fact("on", "a", "b"), fact("on", "b", "c")) == {
        "(above a b)",
        "(above b c)",
        "(above a c)",
    }


def test_a_negation_is_asked_only_once_its_answer_is_final() -> None:  # fixture F7
    text = """((clear ?b) :elements ((block ?b) (not (on ?other ?b))))
              ((on ?a ?b) :elements ((touching ?a ?b)))"""
    blocks = [fact("block", "a"), fact("block", "b")]
    assert derive(text, *blocks, fact("touching", "a", "b")) == {"(on a b)", "(clear a)"}


def test_a_variable_inside_not_only_reads_there_is_none() -> None:  # fixture F6
    text = """((free ?h) :elements ((hand ?h) (not (holding ?h ?any))))
              ((not-held ?o) :elements ((obj ?o) (not (holding ?any ?o))))"""
    facts = [fact("hand", "h1"), fact("hand", "h2"), fact("obj", "o1"), fact("obj", "o2")]
    assert derive(text, *facts, fact("holding", "h1", "o1")) == {"(free h2)", "(not-held o2)"}


def test_two_variables_may_be_the_same_object_unless_a_test_says_otherwise() -> None:
    objects = [fact("obj", "a"), fact("obj", "b")]
    pairs = "((pair ?x ?y) :elements ((obj ?x) (obj ?y)))"
    assert "(pair a a)" in derive(pairs, *objects)
    others = "((pair ?x ?y) :elements ((obj ?x) (obj ?y)) :tests ((/= ?x ?y)))"
    assert derive(others, *objects) == {"(pair a b)", "(pair b a)"}


def test_a_repeated_variable_in_one_literal_must_be_equal() -> None:
    assert derive(
        "((loop ?x) :elements ((edge ?x ?x)))", fact("edge", 1, 2), fact("edge", 3, 3)
    ) == {"(loop 3)"}


def test_attributes_match_by_name_in_any_order_and_a_missing_one_does_not() -> None:
    text = "((sized ?o) :elements ((object ?o ^w ?w ^type box)) :tests ((> ?w 1)))"
    big = fact("object", "a", type="box", w=2, x=0)
    assert derive(
        text, big, fact("object", "b", type="box"), fact("object", "c", type="rod", w=5)
    ) == {"(sized a)"}


def test_binds_compute_the_attributes_of_a_head() -> None:
    text = """((gap ?a ?b ^size ?s) :elements ((object ?a ^x ?xa) (object ?b ^x ?xb))
               :tests ((< ?xa ?xb)) :binds ((?s (- ?xb ?xa))))
              ((wide ?a ?b) :elements ((gap ?a ?b ^size ?s)) :tests ((> ?s 1)))"""
    found = Closure(concepts(text)).derive(
        FactStore([fact("object", "a", x=0), fact("object", "b", x=3)])
    )
    gap = next(b for b in found if b.predicate == "gap")
    assert gap.attributes["size"] == 3
    assert fact("wide", "a", "b") in found


def test_every_derivation_is_kept() -> None:
    text = """((near ?a) :elements ((left ?a)))
              ((near ?a) :elements ((right ?a)))"""
    found = Closure(concepts(text)).derive(FactStore([fact("left", "o"), fact("right", "o")]))
    supports = found[fact("near", "o")]
    assert [s.matched for s in supports if isinstance(s, Derivation)] == [
        (fact("left", "o"),),
        (fact("right", "o"),),
    ]


def test_a_support_names_what_was_absent() -> None:
    text = "((free ?h) :elements ((hand ?h) (not (holding ?h ?any))))"
    (support,) = Closure(concepts(text)).derive(FactStore([fact("hand", "h1")]))[fact("free", "h1")]
    assert isinstance(support, Derivation)
    assert [str(atom) for atom in support.absent] == ["(holding h1 ?any)"]


def test_a_denied_belief_is_not_derived_nor_what_rests_on_it() -> None:
    text = "((q ?x) :elements ((p ?x))) ((r ?x) :elements ((q ?x)))"
    closure = Closure(concepts(text))
    assert closure.derive(FactStore([fact("p", "a")]), frozenset({fact("q", "a")})) == {}


def test_negation_through_recursion_is_refused() -> None:
    with pytest.raises(NotStratifiedError):
        Closure(concepts("((p ?x) :elements ((d ?x) (not (q ?x)))) ((q ?x) :elements ((p ?x)))"))


def test_comparing_a_symbol_with_a_number_is_an_error_with_its_place() -> None:
    text = "((big ?o) :elements ((object ?o ^w ?w)) :tests ((> ?w 1)))"
    with pytest.raises(InferenceError, match="1:"):
        derive(text, fact("object", "a", w="wide"))


_VARIABLES = ("?x", "?y", "?z")
_CONSTANTS = (1, 2, 3)
_GIVEN = {"e": 2, "f": 1}
_DERIVED = {"p": 1, "q": 2, "r": 1, "s": 0}


@st.composite
def programs(draw: st.DrawFn) -> list[ConceptClause]:
    """Draw stratified clauses: a head may negate only what comes before it in the alphabet."""
    clauses = []
    names = list(_DERIVED)
    for _ in range(draw(st.integers(1, 6))):
        head = draw(st.sampled_from(names))
        below = [n for n in names if n < head]
        usable = {**_GIVEN, **{n: _DERIVED[n] for n in names if n <= head}}
        positive = [
            _atom(draw, name, usable[name])
            for name in draw(st.lists(st.sampled_from(sorted(usable)), min_size=1, max_size=3))
        ]
        lower = sorted([*_GIVEN, *below])
        negative = [
            _atom(draw, name, {**_GIVEN, **_DERIVED}[name])
            for name in draw(st.lists(st.sampled_from(lower), max_size=2))
        ]
        bound = sorted({v for atom in positive for v in atom.variables})
        head_args = tuple(
            Variable(draw(st.sampled_from(bound))) if bound else Constant(1)
            for _ in range(_DERIVED[head])
        )
        elements = [Condition(a) for a in positive] + [Condition(a, negated=True) for a in negative]
        clauses.append(ConceptClause(Atom(head, head_args), tuple(elements)))
    return clauses


def _atom(draw: st.DrawFn, name: str, arity: int) -> Atom:
    term = st.one_of(
        st.sampled_from(_VARIABLES).map(Variable), st.sampled_from(_CONSTANTS).map(Constant)
    )
    return Atom(name, tuple(draw(term) for _ in range(arity)))


_FACTS = st.sets(
    st.one_of(
        st.tuples(st.just("e"), st.sampled_from(_CONSTANTS), st.sampled_from(_CONSTANTS)),
        st.tuples(st.just("f"), st.sampled_from(_CONSTANTS)),
    ),
    max_size=8,
)


@given(programs(), _FACTS)
def test_equals_the_naive_reference(clauses: list[ConceptClause], facts: set[tuple]) -> None:
    store = FactStore(Belief(f[0], f[1:]) for f in facts)
    Closure(clauses).derive(store)
    assert {(b.predicate, *b.args) for b in store} == naive_inference.model(clauses, facts)


@given(programs(), _FACTS)
def test_first_supports_never_run_in_a_circle(
    clauses: list[ConceptClause], facts: set[tuple]
) -> None:
    store = FactStore(Belief(f[0], f[1:]) for f in facts)
    given_facts = set(store)
    found = Closure(clauses).derive(store)

    def height(belief: Belief, below: frozenset[Belief]) -> int:
        assert belief not in below
        if belief in given_facts:
            return 0
        first = found[belief][0]
        assert isinstance(first, Derivation)
        return 1 + max((height(m, below | {belief}) for m in first.matched), default=0)

    for belief in found:
        height(belief, frozenset())


def by_naive_passes(
    clauses: list[ConceptClause], store: FactStore
) -> dict[Belief, list[tuple[int, tuple[Belief, ...]]]]:
    """Ask every clause of a stratum over all facts, in turn, until nothing new comes out."""
    found: dict[Belief, list[tuple[int, tuple[Belief, ...]]]] = {}
    for layer in strata(clauses):
        fresh = True
        while fresh:
            fresh = False
            for number, clause in enumerate(clauses):
                if clause.head.predicate not in layer:
                    continue
                for match in tuple(Matcher(clause.elements).matches(store)):
                    belief = ground(clause.head, match.bindings)
                    support = (number, match.matched)
                    if support not in found.setdefault(belief, []):
                        found[belief].append(support)
                    fresh |= store.add(belief)
    return found


def assert_as_by_naive_passes(clauses: list[ConceptClause], given_facts: list[Belief]) -> None:
    store, naive_store = FactStore(given_facts), FactStore(given_facts)
    numbers = {id(clause): number for number, clause in enumerate(clauses)}
    found = [
        (belief, [(numbers[id(s.clause)], s.matched) for s in supports])
        for belief, supports in Closure(clauses).derive(store).items()
    ]
    assert found == list(by_naive_passes(clauses, naive_store).items())
    assert list(store) == list(naive_store)


@given(programs(), _FACTS)
def test_beliefs_and_derivations_come_in_the_order_of_naive_passes(
    clauses: list[ConceptClause], facts: set[tuple]
) -> None:
    assert_as_by_naive_passes(clauses, [Belief(f[0], f[1:]) for f in sorted(facts, key=str)])


@given(st.lists(st.tuples(st.integers(1, 5), st.integers(1, 5)), unique=True, max_size=12))
def test_the_same_where_a_clause_joins_its_own_concept_with_itself(
    edges: list[tuple[int, int]],
) -> None:
    text = """((odd ?x ?y) :elements ((edge ?x ?y)))
              ((even ?x ?z) :elements ((odd ?x ?y) (odd ?y ?z)))
              ((odd ?x ?w) :elements ((odd ?x ?y) (even ?y ?z) (odd ?z ?w)))"""
    assert_as_by_naive_passes(list(concepts(text)), [fact("edge", *pair) for pair in edges])


def test_a_value_is_written_as_in_the_first_condition_that_binds_it() -> None:
    text = """((p ?x) :elements ((e ?x) (p ?x))) ((p ?x) :elements ((start ?x)))"""
    found = Closure(concepts(text)).derive(FactStore([fact("e", 2), fact("start", 2.0)]))
    recursive = found[fact("p", 2)][1]
    assert isinstance(recursive, Derivation)
    assert repr(recursive.bindings["?x"]) == "2"


def test_a_test_is_not_asked_about_what_an_earlier_condition_rules_out() -> None:
    text = """((reached ?x) :elements ((start ?x)))
              ((reached ?y) :elements ((numbered ?x) (reached ?x) (next ?x ?y))
                            :tests ((> ?x 0)))"""
    facts = [fact("start", "a"), fact("start", 1), fact("numbered", 1)]
    facts += [fact("next", 1, 2), fact("next", "a", 3)]
    assert derive(text, *facts) == {"(reached a)", "(reached 1)", "(reached 2)"}


def test_attributes_do_not_depend_on_the_order_of_the_facts() -> None:
    domain, problems = parse_domain(
        "(percepts (a ^v)) (concepts ((size ^v ?v) :elements ((a ?x ^v ?v))))"
    )
    assert domain is not None, problems
    facts = [Belief("a", (f"a{v}",), {"v": v}) for v in (3, "big", 1, 2)]
    for ordered in (facts, facts[::-1]):
        (size,) = Closure(domain.concepts).derive(FactStore(ordered))
        assert size.attributes == {"v": 1}
