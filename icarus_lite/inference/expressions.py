"""Expressions compiled to closures over a row of values.

The language's `evaluate` looks every variable up by name and checks every argument, so that it can
say what is wrong and where. A compiled expression takes the straight way: each variable is a place
in the row, each number is checked once where it is read and each result where it arises. Whatever
is out of the ordinary is handed to `evaluate`, which gives the value or the error: there is only
one account of what an expression means.
"""

from __future__ import annotations

import operator
import sys
from collections.abc import Callable, Mapping, Sequence
from operator import itemgetter

from icarus_lite.inference.views import Row
from icarus_lite.language.functions import (
    FUNCTIONS,
    Function,
    Kind,
    PythonFunctions,
    as_truth,
    as_value,
    evaluate,
)
from icarus_lite.language.syntax import Call, Constant, Expression, Variable
from icarus_lite.symbols import Value, is_number

Compiled = Callable[[Row], Value | bool]
"""Gives the value of an expression for a row."""

_Number = Callable[[Row], float]
_Slots = Mapping[str, int]

_MOST = sys.float_info.max
_BINARY: Mapping[str, Callable[[float, float], float]] = {
    # A sum begins with 0, which turns -0.0 into 0.0; so do these.
    "+": lambda a, b: 0 + a + b,
    "-": lambda a, b: a - (0 + b),
    "*": operator.mul,
}
_COMPARISONS: Mapping[str, Callable[[float, float], bool]] = {
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}


class _UnusualError(Exception):
    """A value that only `evaluate` knows how to treat."""


def compile_expression(
    expression: Expression, slots: Mapping[str, int], functions: PythonFunctions, path: str
) -> Compiled:
    """Give a function of a row with the value of an expression.

    Args:
        expression: A variable, constant or call.
        slots: Where in the row each bound variable stands.
        functions: Python functions the expression may call besides those of the language.
        path: The domain file, to name it in errors.

    Returns:
        A function that gives exactly what `evaluate` gives, and raises the same InferenceError.
    """

    def as_evaluated(row: Row) -> Value | bool:
        bindings = {name: row[slot] for name, slot in slots.items()}
        return evaluate(expression, bindings, functions, path=path)

    straight = _straight(expression, slots)
    if straight is None:
        return as_evaluated

    def compiled(row: Row) -> Value | bool:
        try:
            return straight(row)
        except (_UnusualError, ArithmeticError, ValueError, TypeError):
            return as_evaluated(row)

    return compiled


def compile_test(
    test: Expression, slots: Mapping[str, int], functions: PythonFunctions, path: str
) -> Compiled:
    """Give a function of a row with the answer of a test: true or false, nothing else.

    Only a Python function can come to something else, which is then an InferenceError.
    """
    compiled = compile_expression(test, slots, functions, path)
    if isinstance(test, Call) and test.function in FUNCTIONS:
        return compiled
    return lambda row: as_truth(compiled(row), test, path)


def compile_bind(
    expression: Expression, slots: Mapping[str, int], functions: PythonFunctions, path: str
) -> Callable[[Row], Value]:
    """Give a function of a row with what a bind computes: a number or symbol, nothing else.

    Only a Python function can come to something else, which is then an InferenceError.
    """
    compiled = compile_expression(expression, slots, functions, path)
    return lambda row: as_value(compiled(row), expression, path)


def conjoin(tests: Sequence[Compiled]) -> Compiled | None:
    """Give one function that asks all tests in turn; None if there are none."""
    if not tests:
        return None
    first, rest = tests[0], conjoin(tests[1:])
    return first if rest is None else _both(first, rest)


def _both(first: Compiled, second: Compiled) -> Compiled:
    return lambda row: first(row) and second(row)


def _straight(expression: Expression, slots: _Slots) -> Compiled | None:
    """Compile an expression of any kind; None where it is left to `evaluate`."""
    if isinstance(expression, Constant):
        value = expression.value
        return lambda _: value
    if isinstance(expression, Variable):
        slot = slots.get(expression.name)
        return None if slot is None else itemgetter(slot)
    function = FUNCTIONS.get(expression.function)
    if function is None or not function.accepts(len(expression.args)):
        return None
    if function.gives is Kind.NUMBER:
        return _number_of(expression, function, slots)
    compiler = {Kind.NUMBER: _comparison, Kind.BOOLEAN: _logical, Kind.ANY: _equality}
    return compiler[function.takes](expression, slots)


def _number(expression: Expression, slots: _Slots) -> _Number | None:
    """Compile an expression that must give a finite number."""
    if isinstance(expression, Constant):
        number = expression.value
        if isinstance(number, str) or not is_number(number):
            return None
        return lambda _: number
    if isinstance(expression, Variable):
        slot = slots.get(expression.name)
        return None if slot is None else _read(slot)
    function = FUNCTIONS.get(expression.function)
    if function is None or function.gives is not Kind.NUMBER:
        return None
    return _number_of(expression, function, slots)


def _number_of(call: Call, function: Function, slots: _Slots) -> _Number | None:
    parts = _numbers(call, slots)
    if parts is None or not function.accepts(len(parts)):
        return None
    if len(parts) == 2 and call.function in _BINARY:
        return _finite_pair(_BINARY[call.function], *parts)
    return _finite(function.implementation, parts)


def _numbers(call: Call, slots: _Slots) -> list[_Number] | None:
    parts = [_number(each, slots) for each in call.args]
    known = [part for part in parts if part is not None]
    return known if len(known) == len(parts) else None


def _read(slot: int) -> _Number:
    def read(row: Row) -> float:
        value = row[slot]
        if (type(value) is float or type(value) is int) and -_MOST <= value <= _MOST:
            return value
        raise _UnusualError

    return read


def _finite_pair(
    function: Callable[[float, float], float], left: _Number, right: _Number
) -> _Number:
    def pair(row: Row) -> float:
        result = function(left(row), right(row))
        if -_MOST <= result <= _MOST:
            return result
        raise _UnusualError

    return pair


def _finite(function: Callable[..., Value | bool], parts: list[_Number]) -> _Number:
    def several(row: Row) -> float:
        result = function(*[part(row) for part in parts])
        if not isinstance(result, str) and -_MOST <= result <= _MOST:
            return result
        raise _UnusualError

    return several


def _comparison(call: Call, slots: _Slots) -> Compiled | None:
    parts = _numbers(call, slots)
    if parts is None:
        return None
    if len(parts) == 2 and call.function in _COMPARISONS:
        compare = _COMPARISONS[call.function]
        left, right = parts
        return lambda row: compare(left(row), right(row))
    compare_all = FUNCTIONS[call.function].implementation
    return lambda row: compare_all(*[part(row) for part in parts])


def _equality(call: Call, slots: _Slots) -> Compiled | None:
    parts = []
    for argument in call.args:
        if isinstance(argument, Call):
            part: Compiled | None = _number(argument, slots)
        else:
            part = _straight(argument, slots)
        if part is None:
            return None
        parts.append(part)
    if len(parts) == 2:
        left, right = parts
        if call.function == "=":
            return lambda row: left(row) == right(row)
        return lambda row: left(row) != right(row)
    agree = FUNCTIONS[call.function].implementation
    return lambda row: agree(*[part(row) for part in parts])


def _logical(call: Call, slots: _Slots) -> Compiled | None:
    parts = []
    for argument in call.args:
        function = FUNCTIONS.get(argument.function) if isinstance(argument, Call) else None
        part = _straight(argument, slots)
        if part is None or function is None or function.gives is not Kind.BOOLEAN:
            return None
        parts.append(part)
    if call.function == "and":
        return lambda row: all(part(row) for part in parts)
    if call.function == "or":
        return lambda row: any(part(row) for part in parts)
    (only,) = parts
    return lambda row: not only(row)
