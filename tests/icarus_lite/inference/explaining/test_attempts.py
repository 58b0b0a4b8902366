"""The nearest attempt: as near as trying everything finds, whatever the order of the facts."""

from __future__ import annotations

from itertools import product

from hypothesis import given, settings
from hypothesis import strategies as st

from icarus_lite.inference import Evaluator, FactStore, Matcher, match, unify
from icarus_lite.inference.explaining import Standing, nearest_attempt
from icarus_lite.inference.explaining.conjunctions import in_order
from icarus_lite.language import parse_conditions
from icarus_lite.language.syntax import Atom, Call, Condition, Constant, Variable, variables_of
from icarus_lite.symbols import Belief

X, Y = Variable("?x"), Variable("?y")
NAMES = st.sampled_from(["a", "b", "c"])
TERMS = st.one_of(st.sampled_from([X, Y, Variable("?z")]), st.builds(Constant, NAMES))
ATOMS = st.one_of(
    st.builds(lambda a, b: Atom("p", (a, b)), TERMS, TERMS),
    st.builds(lambda a: Atom("q", (a,)), TERMS),
)
FACTS = st.lists(
    st.one_of(
        st.builds(lambda a, b: Belief("p", (a, b)), NAMES, NAMES),
        st.builds(lambda a: Belief("q", (a,)), NAMES),
    ),
    max_size=5,
    unique=True,
)
CONJUNCTIONS = st.lists(st.builds(Condition, ATOMS, st.booleans()), max_size=4)
TESTS = st.lists(st.sampled_from([Call("/=", (X, Y)), Call("=", (X, Constant("a")))]), max_size=2)


def attempt(conditions, tests, facts, bindings=None, **limits):
    return nearest_attempt(
        conditions, tests, FactStore(facts), bindings or {}, Evaluator(), **limits
    )


def block(name, size):
    return Belief("block", (name,), {"size": size})


def exhaustive(conditions, tests, facts, bindings):
    """Try every fact, and none, for every condition; give most met, and the latest failure."""
    order = in_order(conditions, tests, bindings)
    positive = [n for n, c in enumerate(order) if isinstance(c, Condition) and not c.negated]
    shared = {*bindings, *(name for n in positive for name in order[n].atom.variables)}
    best = (-1, -1)
    for choice in product((*facts, None), repeat=len(positive)):
        bound = dict(bindings)
        for place, fact in zip(positive, choice, strict=True):
            if fact is not None and bound is not None:
                bound = match(order[place].atom, fact, bound)
        if bound is None:
            continue
        met = set()
        for place, each in enumerate(order):
            if place in positive:
                held = choice[positive.index(place)] is not None
            elif isinstance(each, Call):
                names = set(variables_of(each))
                held = names <= set(bound) and Evaluator()(each, bound)
            else:
                names = set(each.atom.variables) & shared
                held = names <= set(bound) and all(
                    match(each.atom, fact, bound) is None for fact in facts
                )
            if held:
                met.add(place)
        first = min(set(range(len(order))) - met, default=len(order))
        best = max(best, (len(met), first))
    return best


@settings(max_examples=300, deadline=None)
@given(
    conditions=CONJUNCTIONS,
    tests=TESTS,
    facts=FACTS,
    bound=st.dictionaries(st.sampled_from(["?x", "?y"]), NAMES, max_size=1),
)
def test_no_other_attempt_meets_more_or_gets_further(conditions, tests, facts, bound):
    found = attempt(conditions, tests, facts, bound)
    first = next(
        (n for n, each in enumerate(found.checked) if each.standing is not Standing.MET),
        len(found.checked),
    )
    assert (found.met, first) == exhaustive(conditions, tests, facts, bound)
    assert found.complete


@settings(max_examples=150, deadline=None)
@given(
    conditions=CONJUNCTIONS,
    tests=TESTS,
    facts=FACTS.flatmap(lambda each: st.tuples(st.just(each), st.permutations(each))),
)
def test_the_order_of_the_facts_does_not_matter(conditions, tests, facts):
    one, other = (attempt(conditions, tests, each) for each in facts)
    if not one.holds:  # else any match will do
        assert one == other


@settings(max_examples=150, deadline=None)
@given(conditions=CONJUNCTIONS, facts=FACTS)
def test_it_holds_just_where_there_is_a_match(conditions, facts):
    matches = Matcher(conditions).matches(FactStore(facts))
    assert attempt(conditions, [], facts).holds == any(True for _ in matches)


def test_of_failed_numeric_tests_the_nearest_counts():
    conditions = parse_conditions("((block ?a ^size ?s))")
    test = Call(">", (Variable("?s"), Constant(10)))
    facts = [block("a", 1), block("b", 9), block("c", 4)]
    assert attempt(conditions, [test], facts).bindings == {"?a": "b", "?s": 9}


def test_equally_near_the_least_in_value_counts():
    conditions = parse_conditions("((block ?a ^size ?s))")
    test = Call(">", (Variable("?s"), Constant(10)))
    facts = [block("c", 9), block("a", 9), block("b", 9)]
    assert attempt(conditions, [test], facts).bindings["?a"] == "a"


def test_the_attributes_of_the_very_object_are_taken_although_it_does_not_match():
    conditions = parse_conditions("((block a ^color red ^size ?s))")
    test = Call(">", (Variable("?s"), Constant(10)))
    found = attempt(conditions, [test], [Belief("block", ("a",), {"color": "blue", "size": 12})])
    assert [each.standing for each in found.checked] == [Standing.FAILED, Standing.MET]
    assert found.failure.fact.attributes["color"] == "blue"


def test_what_nothing_binds_is_not_asked():
    conditions = parse_conditions("((block ?a ^size ?s) (not (on ?a ?any)))")
    test = Call(">", (Variable("?s"), Constant(10)))
    found = attempt(conditions, [test], [Belief("on", ("b", "c"))])
    assert [each.standing for each in found.checked] == [
        Standing.FAILED,
        Standing.OPEN,
        Standing.OPEN,
    ]


def test_a_test_without_a_value_counts_as_failed_and_says_why():
    conditions = parse_conditions("((block ?a ^kind toy) (block ?a ^size ?s))")
    test = Call(">", (Variable("?s"), Constant(10)))
    found = attempt(conditions, [test], [Belief("block", ("a",), {"kind": "note", "size": "big"})])
    assert found.checked[2].standing is Standing.FAILED
    assert "is the symbol big" in found.checked[2].error


def test_a_search_that_is_cut_off_says_so_and_still_answers():
    conditions = parse_conditions("((block ?a ^size ?s) (block ?b ^size ?t) (block ?c ^size ?u))")
    test = Call(">", (Call("+", (Variable("?s"), Variable("?t"), Variable("?u"))), Constant(99)))
    facts = [block(f"b{n}", n) for n in range(20)]
    found = attempt(conditions, [test], facts, limit=50)
    assert not found.complete
    assert found.met == 3
    assert attempt(conditions, [test], facts, limit=10_000).complete


def test_unify_is_what_a_pattern_binds():
    conditions = parse_conditions("((p ?x ?x))")
    facts = [Belief("p", ("a", "b")), Belief("p", ("b", "b"))]
    found = attempt(conditions, [], facts)
    assert found.bindings == unify([(X, "b")])
