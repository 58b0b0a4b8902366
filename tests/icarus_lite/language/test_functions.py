from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from icarus_lite.errors import InferenceError
from icarus_lite.language import FUNCTIONS, evaluate, function_table, parse_domain
from icarus_lite.language.functions import Kind
from icarus_lite.language.syntax import Call, Constant, Variable


def expression(text):
    domain, diagnostics = parse_domain(f"(concepts ((p) :tests ({text})))", "d.icr")
    assert domain is not None, diagnostics
    return domain.concepts[0].tests[0]


def value(text, **bindings):
    return evaluate(expression(text), {f"?{name}": bound for name, bound in bindings.items()})


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("(+ 1 2 3)", 6),
        ("(+ 1)", 1),
        ("(- 5)", -5),
        ("(- 5 2 1)", 2),
        ("(* 2 3.5)", 7.0),
        ("(*)", None),
        ("(/ 7 2)", 3.5),
        ("(/ 8 2 2)", 2.0),
        ("(abs -3)", 3),
        ("(min 3 1 2)", 1),
        ("(max 3 1 2)", 3),
        ("(min 3)", 3),
        ("(max 3)", 3),
        ("(sqrt 9)", 3.0),
        ("(distance 0 3)", 3.0),
        ("(distance 0 0 3 4)", 5.0),
        ("(distance 1 2 3 1 2 5)", 2.0),
        ("(= 1 1.0)", True),
        ("(= plug plug plug)", True),
        ("(= plug input)", False),
        ('(= 1 "1")', False),
        ("(/= 1 2 1)", False),
        ("(/= 1 2 3)", True),
        ("(< 1 2 3)", True),
        ("(< 1 3 2)", False),
        ("(<= 1 1 2)", True),
        ("(> 3 2)", True),
        ("(>= 2 3)", False),
        ("(not (< 1 2))", False),
        ("(and (< 1 2) (< 2 3))", True),
        ("(and (< 1 2) (< 3 2))", False),
        ("(or (< 2 1) (< 1 2))", True),
        ("(or (< 2 1))", False),
    ],
)
def test_values(text, expected):
    if expected is None:
        with pytest.raises(InferenceError):
            value(text)
    else:
        assert value(text) == expected
        assert type(value(text)) is type(expected)


def test_and_and_or_look_no_further_than_they_must():
    assert value("(and (/= ?x 0) (< (/ 1 ?x) 3))", x=0) is False
    assert value("(or (= ?x 0) (< (/ 1 ?x) 3))", x=0) is True


@pytest.mark.parametrize(
    ("text", "bindings", "message"),
    [
        ("(< ?x 1)", {}, "d.icr:1:27: ?x is not bound"),
        ("(< ?x 1)", {"x": "plug"}, "d.icr:1:27: ?x is the symbol plug, but `<` takes numbers"),
        ("(< 1 plug)", {}, "d.icr:1:29: `<` takes numbers, not the symbol plug"),
        ("(+ 1 (< 1 2))", {}, "d.icr:1:29: `+` takes numbers, not the truth value true"),
        ("(and 1)", {}, "d.icr:1:29: `and` takes tests, not the number 1"),
        ("(not ?x)", {"x": 0}, "d.icr:1:29: ?x is the number 0, but `not` takes tests"),
        ("(/ ?x 0)", {"x": 1}, "d.icr:1:24: division by zero in (/ 1 0)"),
        ("(sqrt -1)", {}, "d.icr:1:24: (sqrt -1) has no value"),
        ("(* 1e200 1e200)", {}, "d.icr:1:24: (* 1e+200 1e+200) is not a finite number"),
        ("(< ?x 1)", {"x": math.nan}, "d.icr:1:27: ?x is the number nan, but `<` takes numbers"),
        ("(distance 1 2 3)", {}, "takes an even number of arguments, at least 2, not 3"),
        ("(sqrt 1 2)", {}, "d.icr:1:24: `sqrt` takes 1 argument, not 2"),
        ("(and)", {}, "d.icr:1:24: `and` takes at least 1 argument, not 0"),
        ("(foo 1)", {}, "d.icr:1:24: there is no function `foo`"),
        ("(= 1 (= 1 1))", {}, "`=` takes symbols and numbers, not the truth value true"),
    ],
)
def test_errors_say_where_and_what(text, bindings, message):
    bound = {f"?{name}": each for name, each in bindings.items()}
    with pytest.raises(InferenceError) as caught:
        evaluate(expression(text), bound, path="d.icr")
    assert message in str(caught.value)


def test_integers_beyond_every_float_are_refused():
    with pytest.raises(InferenceError, match="not a finite number"):
        value("(* ?x ?x)", x=10**300)


def test_an_error_without_a_path_or_place_is_still_a_sentence():
    with pytest.raises(InferenceError, match=r"^\?x is not bound$"):
        evaluate(Variable("?x"), {})
    with pytest.raises(InferenceError, match=r"^d.icr: \?x is not bound$"):
        evaluate(Variable("?x"), {}, path="d.icr")


def test_python_functions_may_be_called():
    functions = {"twice": lambda x: 2 * x, "even": lambda x: x % 2 == 0}
    assert evaluate(expression("(< (twice ?x) 7)"), {"?x": 3}, functions) is True
    assert evaluate(expression("(even ?x)"), {"?x": 3}, functions) is False


@pytest.mark.parametrize(
    ("function", "message"),
    [
        (lambda: 1 / 0, "1:24: the Python function in (f) failed: ZeroDivisionError: division"),
        (lambda: None, "1:24: (f) returned NoneType, not a number, symbol or truth value"),
        (lambda: math.inf, "1:24: (f) is not a finite number"),
    ],
)
def test_what_python_functions_do_is_watched(function, message):
    with pytest.raises(InferenceError) as caught:
        evaluate(expression("(f)"), {}, {"f": function})
    assert str(caught.value).startswith(message)


def test_the_table_holds_the_functions_of_the_language():
    arithmetic = {"+", "-", "*", "/", "distance", "abs", "min", "max", "sqrt"}
    assert set(FUNCTIONS) == arithmetic | {"=", "/=", "<", "<=", ">", ">=", "and", "or", "not"}
    assert all(entry.documentation.endswith(".") for entry in FUNCTIONS.values())


def test_python_functions_join_the_table_with_their_arity():
    def gap(a, b, c=0):
        """Say how far apart they are.

        More text.
        """
        return a - b - c

    table = function_table({"gap": gap, "any-of": lambda *xs: any(xs), "longest": max})
    assert (table["gap"].least, table["gap"].most) == (2, 3)
    assert table["gap"].arity == "2 to 3 arguments"
    assert table["gap"].documentation == "Say how far apart they are."
    assert table["gap"].gives is Kind.ANY
    assert table["any-of"].accepts(9)
    assert table["longest"].accepts(3)
    assert function_table(None) is FUNCTIONS


def test_a_function_of_the_language_cannot_be_replaced():
    with pytest.raises(InferenceError, match="`distance` is a function of the language"):
        function_table({"distance": lambda: 0})


numbers = st.one_of(st.integers(-(10**6), 10**6), st.floats(-1e6, 1e6))


@given(st.lists(numbers, min_size=1, max_size=3), st.data())
def test_distance_is_a_metric(first, data):
    second = data.draw(st.lists(numbers, min_size=len(first), max_size=len(first)))
    there = Call("distance", tuple(map(Constant, [*first, *second])))
    back = Call("distance", tuple(map(Constant, [*second, *first])))
    assert evaluate(there, {}) == evaluate(back, {})
    assert evaluate(Call("distance", tuple(map(Constant, [*first, *first]))), {}) == 0


values = st.one_of(numbers, st.sampled_from(["plug", "input", "1", ""]))
expressions = st.recursive(
    st.one_of(st.builds(Constant, values), st.sampled_from([Variable("?x"), Variable("?free")])),
    lambda inner: st.builds(
        Call, st.sampled_from([*FUNCTIONS, "unknown"]), st.lists(inner, max_size=4).map(tuple)
    ),
    max_leaves=8,
)


def evaluated(tree, bindings):
    """Give the value, or None if the expression has none."""
    try:
        return evaluate(tree, bindings)
    except InferenceError:
        return None


@given(expressions, values)
def test_an_expression_has_a_finite_value_or_an_inference_error(tree, bound):
    result = evaluated(tree, {"?x": bound})
    assert result is None or isinstance(result, bool | str) or math.isfinite(result)
