from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from icarus_lite.language import NotStratifiedError, strata
from icarus_lite.language.checking.stratification import negation_cycles, recursive_concepts
from icarus_lite.language.syntax import Atom, ConceptClause, Condition


def clause(head, *uses):
    """Make a clause; a use that begins with `-` is negated."""
    elements = tuple(
        Condition(Atom(use.removeprefix("-")), negated=use.startswith("-")) for use in uses
    )
    return ConceptClause(Atom(head), elements)


def test_dependencies_come_first():
    clauses = [clause("clear", "block", "-on"), clause("on", "block"), clause("tower", "clear")]
    assert strata(clauses) == (("on",), ("clear",), ("tower",))


def test_mutual_recursion_is_one_group_in_order_of_definition():
    clauses = [clause("odd", "even"), clause("even", "odd"), clause("even", "zero")]
    assert strata(clauses) == (("odd", "even"),)
    assert recursive_concepts(clauses) == {"odd", "even"}


def test_recursion_through_itself():
    clauses = [clause("above", "on"), clause("above", "on", "above"), clause("high", "above")]
    assert strata(clauses) == (("above",), ("high",))
    assert recursive_concepts(clauses) == {"above"}


def test_no_clauses_make_no_strata():
    assert strata([]) == ()


@pytest.mark.parametrize(
    ("clauses", "path"),
    [
        ([clause("p", "-p")], "p -> not p"),
        ([clause("p", "-q"), clause("q", "p")], "p -> not q -> p"),
        ([clause("p", "q"), clause("q", "r"), clause("r", "-p")], "r -> not p -> q -> r"),
    ],
)
def test_the_error_names_the_cycle(clauses, path):
    with pytest.raises(NotStratifiedError) as caught:
        strata(clauses)
    assert str(caught.value.cycle) == path
    assert path in str(caught.value)


def test_every_offending_literal_is_found():
    clauses = [clause("p", "-q", "-q", "-r"), clause("q", "p"), clause("r")]
    assert [str(cycle) for cycle in negation_cycles(clauses)] == ["p -> not q -> p"] * 2


def test_a_long_chain_does_not_exhaust_the_call_stack():
    clauses = [clause(f"c{i}", f"c{i + 1}") for i in range(5000)]
    order = strata(clauses)
    assert order[0] == ("c4999",)
    assert order[-1] == ("c0",)


names = st.sampled_from("abcdef")
uses = st.lists(st.tuples(st.booleans(), names), max_size=3)
programs = st.lists(
    st.tuples(names, uses).map(
        lambda made: clause(
            made[0], *(("-" if negated else "") + name for negated, name in made[1])
        )
    ),
    max_size=10,
)


@given(programs)
def test_strata_respect_every_dependency_or_a_cycle_is_named(clauses):
    heads = {each.head.predicate for each in clauses}
    cycles = negation_cycles(clauses)
    if cycles:
        direct = {(c.head.predicate, e.atom.predicate) for c in clauses for e in c.elements}
        for cycle in cycles:
            chain = [cycle.clause.head.predicate, *cycle.path]
            assert chain[0] == chain[-1]
            assert all(step in direct for step in pairwise(chain))
        return
    level = {name: i for i, group in enumerate(strata(clauses)) for name in group}
    assert set(level) == heads
    for each in clauses:
        for element in each.elements:
            used = element.atom.predicate
            if used in heads and element.negated:
                assert level[used] < level[each.head.predicate]
            elif used in heads:
                assert level[used] <= level[each.head.predicate]
