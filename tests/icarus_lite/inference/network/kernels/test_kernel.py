"""A pair relation holds exactly the pairs of which `evaluate` says so, however it is updated."""

from __future__ import annotations

from collections.abc import Sequence

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from icarus_lite.errors import InferenceError
from icarus_lite.inference.network.kernels import (
    Columns,
    PairRelation,
    PairSide,
    compile_pair,
)
from icarus_lite.inference.network.kernels.exact import in_turn
from icarus_lite.language.functions import evaluate
from icarus_lite.language.syntax import Call, Constant, Expression, Variable
from icarus_lite.symbols import Value

LEFT = PairSide("?a", (("?xa", "x"), ("?ya", "y"), ("?wa", "w")))
RIGHT = PairSide("?b", (("?xb", "x"), ("?yb", "y"), ("?wb", "w")))
ATTRIBUTES = ("w", "x", "y")
APART = Call("/=", (Variable("?a"), Variable("?b")))
WAYS = ("list", "strip", "block", "sweep", "chosen")


def expected(
    columns: tuple[Columns, Columns], tests: Sequence[Call], *, distinct: bool
) -> set[tuple[int, int]] | str:
    """Ask `evaluate` about every pair; an error where a join would meet one."""
    found = set()
    ordered = in_turn(LEFT, tests)
    alone = [t for t in ordered if in_turn(LEFT, [t, APART])[0] is t and _is_alone(t)]
    try:
        for i, mine in enumerate(rows(columns[0], LEFT)):
            if mine is None or not all(evaluate(t, mine) for t in alone):
                continue
            for j, theirs in enumerate(rows(columns[1], RIGHT)):
                if theirs is None or (distinct and mine["?a"] == theirs["?b"]):
                    continue
                if all(evaluate(test, {**mine, **theirs}) for test in ordered):
                    found.add((i, j))
    except InferenceError:
        return "error"
    return found


def _is_alone(test: Expression) -> bool:
    if isinstance(test, Variable):
        return test.name in LEFT.variables
    return not isinstance(test, Call) or all(map(_is_alone, test.args))


def rows(columns: Columns, side: PairSide) -> list[dict[str, Value] | None]:
    found: list[dict[str, Value] | None] = []
    for slot in range(columns.size):
        row: dict[str, Value | None] = {side.name or "": columns.names[slot]}
        row |= {variable: columns.column(name)[slot] for variable, name in side.attributes}
        complete = columns.alive[slot] and None not in row.values()
        found.append(row if complete else None)  # type: ignore[arg-type]
    return found


def follow(
    relation: PairRelation, changed: tuple[Sequence[int], Sequence[int]], before: set
) -> set | str:
    """Update a relation; give its pairs as the changes say, checked against what it says itself."""
    try:
        added, removed = relation.update(*changed)
    except InferenceError:
        return "error"
    assert len(set(added)) == len(added)
    assert len(set(removed)) == len(removed)
    assert before.isdisjoint(added)
    assert before.issuperset(removed)
    return (before - set(removed)) | set(added)


def agree(relation: PairRelation, pairs: set, columns: tuple[Columns, Columns]) -> None:
    assert len(relation) == len(pairs)
    assert list(relation.pairs()) == sorted(pairs)
    for i in range(columns[0].size):
        assert list(relation.of_left(i)) == sorted(b for a, b in pairs if a == i)
        for j in range(columns[1].size):
            assert relation.holds(i, j) is ((i, j) in pairs)
    for j in range(columns[1].size):
        assert list(relation.of_right(j)) == sorted(a for a, b in pairs if b == j)


# Random tests over random histories.

_ORDINARY = st.one_of(
    st.integers(-6, 6), st.floats(-4, 4, width=32), st.sampled_from([0, 0.5, 1, 1.0, -0.0, 2])
)
_EXTREME = st.sampled_from(
    [2**53, 2**53 + 1, -(2**53) - 1, 2**63, 2**70, 10**30, 1e308, -1e308, 5e-324, 1e-200, 1e16,
     2.0**53, 2**26 + 1, 2**20 + 1, 0.1, 0.3, 1e-160, "peg", True, None]
)  # fmt: skip
_CONSTANTS = st.one_of(
    st.integers(-3, 5), st.sampled_from([0.5, 0.25, 1.5, 0.1, 9, 2**54 + 1, 1e300, 1e-170])
)
_LEAVES = st.one_of(
    st.sampled_from([Variable(f"?{n}{s}") for n in "xyw" for s in "ab"]),
    st.sampled_from([Variable(f"?{n}{s}") for n in "xy" for s in "ab"]),
    st.builds(Constant, _CONSTANTS),
)


def _calls(inner: st.SearchStrategy[Expression]) -> st.SearchStrategy[Expression]:
    def several(least: int, most: int) -> st.SearchStrategy[tuple[Expression, ...]]:
        return st.lists(inner, min_size=least, max_size=most).map(tuple)

    return st.one_of(
        st.builds(Call, st.sampled_from(["+", "-", "*"]), several(2, 2)),
        st.builds(Call, st.sampled_from(["+", "-", "*", "min", "max"]), several(1, 4)),
        st.builds(Call, st.just("/"), several(2, 3)),
        st.builds(Call, st.sampled_from(["abs", "sqrt"]), several(1, 1)),
        st.builds(Call, st.just("distance"), st.one_of(several(2, 2), several(4, 4))),
    )


NUMBERS = st.recursive(_LEAVES, _calls, max_leaves=7)
_COMPARED = st.builds(
    Call,
    st.sampled_from(["<", "<=", ">", ">=", "=", "/="]),
    st.one_of(st.tuples(NUMBERS, NUMBERS), st.lists(NUMBERS, min_size=2, max_size=4).map(tuple)),
)
_ANY_TESTS = st.recursive(
    _COMPARED,
    lambda inner: st.one_of(
        st.builds(
            Call,
            st.sampled_from(["and", "or"]),
            st.lists(inner, min_size=1, max_size=3).map(tuple),
        ),
        st.builds(Call, st.just("not"), inner.map(lambda test: (test,))),
    ),
    max_leaves=3,
)


def _apart_along(name: str) -> Expression:
    return Call("-", (Variable(f"?{name}a"), Variable(f"?{name}b")))


def _square(inner: Expression) -> Expression:
    return Call("*", (inner, inner))


_X, _Y = _apart_along("x"), _apart_along("y")
_LIMITS = st.one_of(
    st.builds(Constant, st.sampled_from([1, 2, 0.5, 1.5, 0, -1, 4, 9.0])),
    st.sampled_from([Variable("?wa"), Variable("?wb")]),
)
_NEAR = st.one_of(
    st.builds(lambda c: Call("<", (Call("abs", (_X,)), c)), _LIMITS),
    st.builds(lambda c: Call("<=", (Call("*", (Constant(2), Call("abs", (_Y,)))), c)), _LIMITS),
    st.builds(lambda c: Call("<", (Call("+", (_square(_X), _square(_Y))), c)), _LIMITS),
    st.builds(
        lambda c: Call(">", (c, Call("+", (_square(_X), _square(_Y), _square(_X))))), _LIMITS
    ),
    st.builds(
        lambda c: Call(
            "<=", (Call("distance", tuple(map(Variable, ("?xa", "?ya", "?xb", "?yb")))), c)
        ),
        _LIMITS,
    ),
)
_ORDERS = st.builds(
    lambda f, op, g: Call(op, (Call("+", (Variable("?xa"), f)), Call("-", (Variable("?xb"), g)))),
    st.sampled_from([Constant(0), Variable("?wa"), Constant(0.5)]),
    st.sampled_from(["<", "<=", ">", ">="]),
    st.sampled_from([Constant(0), Variable("?wb"), Constant(0.5)]),
)
_TESTS = st.one_of(_NEAR, _ORDERS, _ANY_TESTS)
_VALUES = st.one_of(_ORDINARY, _ORDINARY, _ORDINARY, _ORDINARY, _EXTREME)
_ROWS = st.one_of(st.tuples(_ORDINARY, _ORDINARY, _ORDINARY), st.tuples(_VALUES, _VALUES, _VALUES))
_NAMES = st.sampled_from([f"o{n}" for n in range(8)])
_STEPS = st.lists(st.tuples(_NAMES, st.one_of(_ROWS, st.none())), min_size=1, max_size=8)


def apply(columns: Columns, step: Sequence[tuple[str, tuple | None]]) -> list[int]:
    changed: dict[int, None] = {}
    for name, row in step:
        if row is not None:
            changed[columns.put(name, row)] = None
        elif name in columns.slots:
            changed[columns.drop(name)] = None
    return list(changed)


@pytest.mark.parametrize("way", WAYS)
@settings(max_examples=60, deadline=None)
@given(data=st.data())
def test_a_relation_over_one_type_is_what_evaluate_says(way: str, data: st.DataObject) -> None:
    tests = tuple(data.draw(st.lists(_TESTS, min_size=1, max_size=3)))
    distinct = data.draw(st.booleans())
    if data.draw(st.booleans()):
        place = data.draw(st.integers(0, len(tests)))
        tests = (*tests[:place], APART, *tests[place:])
    kernel = compile_pair(LEFT, RIGHT, tests, distinct)
    assume(kernel is not None)
    assert kernel is not None
    columns = Columns(ATTRIBUTES)
    kernel = kernel if way == "chosen" else kernel.only_by(way)
    relation = kernel.instance(columns, columns)
    history = data.draw(st.lists(_STEPS, min_size=1, max_size=6))
    _walk(relation, (columns, columns), tests, history, distinct=distinct)


def _walk(
    relation: PairRelation,
    columns: tuple[Columns, Columns],
    tests: tuple[Call, ...],
    history: Sequence[Sequence[tuple[str, tuple | None]]],
    *,
    distinct: bool,
) -> None:
    held: set = set()
    same = columns[0] is columns[1]
    waiting: tuple[dict[int, None], dict[int, None]] = ({}, {})
    for number, step in enumerate(history):
        if same:
            changed = apply(columns[0], step)
            waiting[0].update(dict.fromkeys(changed))
            waiting[1].update(dict.fromkeys(changed))
        else:
            waiting[0].update(dict.fromkeys(apply(columns[0], step[: len(step) // 2])))
            waiting[1].update(dict.fromkeys(apply(columns[1], step[len(step) // 2 :])))
        wanted = expected(columns, tests, distinct=distinct)
        if number == len(history) // 2 and not isinstance(wanted, str):
            # In the middle the relation is loaded anew; what it says must not depend on that.
            relation.load()
            found: set | str = set(relation.pairs())
        else:
            found = follow(relation, (list(waiting[0]), list(waiting[1])), held)
        assert found == wanted
        if not isinstance(found, str):
            held = found
            waiting[0].clear()
            waiting[1].clear()
            for each in columns:
                each.settle()
            agree(relation, held, columns)


@pytest.mark.parametrize("way", WAYS)
@settings(max_examples=30, deadline=None)
@given(data=st.data())
def test_a_relation_over_two_types_is_what_evaluate_says(way: str, data: st.DataObject) -> None:
    tests = tuple(data.draw(st.lists(_TESTS, min_size=1, max_size=2)))
    distinct = data.draw(st.booleans())
    kernel = compile_pair(LEFT, RIGHT, tests, distinct)
    assume(kernel is not None)
    assert kernel is not None
    columns = Columns(ATTRIBUTES), Columns(ATTRIBUTES)
    kernel = kernel if way == "chosen" else kernel.only_by(way)
    relation = kernel.instance(*columns)
    history = data.draw(st.lists(_STEPS, min_size=1, max_size=5))
    _walk(relation, columns, tests, history, distinct=distinct)
