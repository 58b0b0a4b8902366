from __future__ import annotations

import math
from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from icarus_lite import InferenceError
from icarus_lite.inference.expressions import Compiled, compile_expression, conjoin
from icarus_lite.language.functions import FUNCTIONS, evaluate
from icarus_lite.language.syntax import Call, Constant, Expression, Span, Variable

_SLOTS = {"?x": 0, "?y": 1, "?z": 2}
_PLACES = st.integers(1, 9).map(lambda column: Span(1, column, 1, column + 1))
_VALUES = st.one_of(
    st.integers(-3, 3),
    st.floats(-3, 3),
    st.sampled_from(["a", "b", 1e308, -1e308, -0.0, math.inf]),
)


def twice(value: float) -> float:
    return 2 * value


_FUNCTIONS = {"twice": twice}
_LEAVES = st.one_of(
    st.builds(Variable, st.sampled_from([*_SLOTS, "?unbound"]), _PLACES),
    st.builds(Constant, _VALUES, _PLACES),
)
_EXPRESSIONS = st.recursive(
    _LEAVES,
    lambda inner: st.builds(
        Call,
        st.sampled_from([*FUNCTIONS, "twice", "unknown"]),
        st.lists(inner, min_size=1, max_size=4).map(tuple),
        _PLACES,
    ),
    max_leaves=8,
)


@given(_EXPRESSIONS, st.tuples(_VALUES, _VALUES, _VALUES))
def test_a_compiled_expression_gives_what_evaluate_gives(
    expression: Expression, row: tuple
) -> None:
    bindings = dict(zip(_SLOTS, row, strict=True))
    compiled = compile_expression(expression, _SLOTS, _FUNCTIONS, "d.icr")
    assert answer(lambda: compiled(row)) == answer(
        lambda: evaluate(expression, bindings, _FUNCTIONS, path="d.icr")
    )


def answer(ask: Callable[[], object]) -> str:
    try:
        return repr(ask())
    except InferenceError as error:
        return f"error: {error}"


@pytest.mark.parametrize("operator", ["+", "-", "*"])
def test_a_negative_zero_comes_out_as_from_evaluate(operator: str) -> None:
    call = Call(operator, (Variable("?x"), Variable("?y")))
    for row in [(-0.0, -0.0), (-0.0, 0), (0.0, -0.0), (-0.0, 0.0)]:
        compiled = compile_expression(call, _SLOTS, {}, "")
        wanted = evaluate(call, dict(zip(_SLOTS, row, strict=False)))
        assert repr(compiled((*row, 0))) == repr(wanted)


def test_a_python_function_is_called_once() -> None:
    calls = []

    def refuse(value: float) -> float:
        calls.append(value)
        raise ValueError

    compiled = compile_expression(
        Call("<", (Call("refuse", (Variable("?x"),)), Constant(1))), _SLOTS, {"refuse": refuse}, ""
    )
    with pytest.raises(InferenceError, match="the Python function in"):
        compiled((1, 2, 3))
    assert calls == [1]


def test_tests_are_asked_in_turn_until_one_fails() -> None:
    asked: list[int] = []

    def ask(number: int) -> Compiled:
        return lambda _: asked.append(number) or number != 2

    together = conjoin([ask(1), ask(2), ask(3)])
    assert not together(())
    assert asked == [1, 2]
    assert conjoin([]) is None
