from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from icarus_lite.errors import InferenceError
from icarus_lite.inference.network.kernels.ranges import (
    EXACT_INTEGERS,
    choose_limit,
    is_guarded,
    is_nonnegative,
    range_of,
)
from icarus_lite.language.functions import evaluate
from icarus_lite.language.syntax import Call, Constant, Expression, Variable

_X, _Y = Variable("?x"), Variable("?y")
_LEAVES = st.one_of(
    st.sampled_from([_X, _Y]),
    st.builds(Constant, st.one_of(st.integers(-9, 9), st.floats(-9, 9), st.just(10**17))),
)


def _calls(inner: st.SearchStrategy[Expression]) -> st.SearchStrategy[Expression]:
    several = st.lists(inner, min_size=2, max_size=4).map(tuple)
    one = inner.map(lambda each: (each,))
    return st.one_of(
        st.builds(Call, st.sampled_from(["+", "-", "*", "/", "min", "max"]), several),
        st.builds(Call, st.sampled_from(["abs", "sqrt", "-"]), one),
        st.builds(Call, st.just("distance"), st.tuples(inner, inner)),
    )


NUMBERS = st.recursive(_LEAVES, _calls, max_leaves=8)


@settings(max_examples=300, deadline=None)
@given(NUMBERS, st.sampled_from([1.0, 64.0, 2.0**20]), st.floats(-1, 1), st.integers(-8, 8))
def test_a_value_lies_in_its_range_and_unguarded_integers_are_floats(
    expression: Expression, limit: float, x: float, eighths: int
) -> None:
    bindings = {"?x": x * limit, "?y": int(eighths * limit / 8)}
    known = range_of(expression, limit)
    try:
        value = evaluate(expression, bindings)
    except InferenceError:
        assert is_guarded(expression, limit)
        return
    assert isinstance(value, int | float)
    if is_guarded(expression, limit):
        return
    slack = 1e-9 * known.magnitude + 1e-300
    assert known.low - slack <= value <= known.high + slack
    if isinstance(value, int):
        assert known.integral
        assert abs(value) <= EXACT_INTEGERS
    if is_nonnegative(expression):
        assert value >= 0


@pytest.mark.parametrize(
    ("expression", "power"),
    [
        (Call("<", (_X, _Y)), 50),
        (Call("<", (Call("*", (_X, _Y)), Constant(1))), 26),
        (Call("<", (Call("*", (_X, _X, _X)), Constant(1))), 17),
        (Call("<", (Call("/", (_X, Constant(4))), _Y)), 50),
        (Call("<", (Call("/", (_X, _Y)), Constant(1))), 50),  # guarded whatever the limit
    ],
)
def test_the_limit_is_the_greatest_at_which_products_stay_exact(
    expression: Expression, power: int
) -> None:
    assert math.log2(choose_limit([expression])) == power


@pytest.mark.parametrize(
    "expression",
    [
        Call("/", (_X, _Y)),
        Call("sqrt", (_X,)),
        Constant(2**53 + 1),
        Call("+", (Constant(2**53), Constant(2**53), Constant(-(2**53)), Constant(0.5))),
        Call("/", (_X, Constant(1e-200))),
    ],
)
def test_what_may_go_wrong_is_guarded(expression: Expression) -> None:
    assert is_guarded(expression, 1.0)


@pytest.mark.parametrize(
    "expression",
    [
        Call("sqrt", (Call("+", (Call("*", (_X, _X)), Call("abs", (_Y,)))),)),
        Call("/", (_X, Constant(0.25), Constant(-3))),
        Call("/", (_X, Call("+", (Constant(1), Call("abs", (_Y,)))))),
        Call("distance", (_X, _Y)),
    ],
)
def test_what_cannot_go_wrong_is_not(expression: Expression) -> None:
    assert not is_guarded(expression, 1024.0)
