"""Are the functions of `:tests` and `:binds` known, and called with the right arguments?"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence

from icarus_lite.language.checking.report import Report
from icarus_lite.language.functions import Function, Kind
from icarus_lite.language.syntax import Bind, Call, Constant, Expression, Span, Variable

_OTHER_NAMES = {
    "==": "=",
    "eq": "=",
    "eql": "=",
    "equal": "=",
    "!=": "/=",
    "<>": "/=",
    "neq": "/=",
    "=<": "<=",
    "=>": ">=",
}
_NUMBER_WITH_UNIT = re.compile(r"([+-]?(?:[0-9]+(?:\.[0-9]+)?|\.[0-9]+))([a-zA-Z°%]{0,4})")
_WANTED = {Kind.NUMBER: "numbers", Kind.BOOLEAN: "tests", Kind.ANY: "symbols, strings or numbers"}


def variables_in(expression: Expression) -> Iterator[Variable]:
    """Give the variables of an expression in the order of the text, repeats included."""
    if isinstance(expression, Variable):
        yield expression
    elif isinstance(expression, Call):
        for argument in expression.args:
            yield from variables_in(argument)


def check_expressions(
    tests: Sequence[Call],
    binds: Sequence[Bind],
    functions: Mapping[str, Function],
    report: Report,
    predicates: Collection[str] = (),
) -> None:
    """Check the calls of one clause: each test must give a boolean, each bind a value.

    Args:
        tests: The clause's `:tests`.
        binds: Its `:binds`.
        functions: All functions there are.
        report: Where findings go.
        predicates: What is perceived or believed, to tell where a pattern belongs.
    """
    for test in tests:
        gives = _check_call(test, functions, report, predicates)
        if gives is Kind.NUMBER:
            message = f"`{test.function}` gives a number, so this is not a test"
            report.error(test.span, "ICR017", message, "compare it: (< (distance …) 0.05)")
    for bind in binds:
        if not isinstance(bind.expression, Call):
            continue
        gives = _check_call(bind.expression, functions, report, predicates)
        if gives is Kind.BOOLEAN:
            name = bind.variable.name
            message = f"{name} would be true or false, but variables hold numbers and symbols"
            report.error(bind.expression.span, "ICR017", message, "move the test to :tests")


def _check_call(
    call: Call, functions: Mapping[str, Function], report: Report, predicates: Collection[str]
) -> Kind | None:
    """Check a call and its arguments; give the kind of its result, or None if it is unknown."""
    kinds = [
        _check_call(argument, functions, report, predicates) if isinstance(argument, Call) else None
        for argument in call.args
    ]
    function = functions.get(call.function)
    if function is None:
        meant = _OTHER_NAMES.get(call.function) or report.closest(call.function, functions)
        hint = "a predicate belongs in :elements; a Python function must be given when loading"
        if call.function in predicates:
            hint = "it is perceived or believed: a pattern over it belongs in :elements"
        elif call.args and str(call.args[0]) in functions:
            hint = f"the function comes first: ({call.args[0]} {call.function} …)"
        elif meant:
            hint = f"did you mean `{meant}`? {hint}"
        report.error(_name_span(call), "ICR016", f"there is no function `{call.function}`", hint)
        return None
    if not function.accepts(len(call.args)):
        message = f"`{function.name}` takes {function.arity}, not {len(call.args)}"
        report.error(call.span, "ICR017", message, function.documentation)
        return None
    for argument, kind in zip(call.args, kinds, strict=True):
        _check_argument(function, argument, kind, report)
    return function.gives


def _check_argument(
    function: Function, argument: Expression, kind: Kind | None, report: Report
) -> None:
    if isinstance(argument, Call):
        if kind in (None, Kind.ANY, function.takes):
            return
        if function.takes is Kind.ANY and kind is Kind.NUMBER:
            return
        given = f"`{argument.function}` gives a {kind}"
    elif isinstance(argument, Constant) and isinstance(argument.value, str):
        if function.takes is Kind.ANY:
            return
        given = f"{argument} is a symbol"
    else:
        if function.takes is not Kind.BOOLEAN:
            return
        given = f"{argument} is a value"
    message = f"`{function.name}` takes {_WANTED[function.takes]}, but {given}"
    hint = function.documentation
    if function.takes is Kind.NUMBER and isinstance(argument, Constant):
        hint = _as_number(str(argument.value)) or hint
    report.error(argument.span, "ICR017", message, hint)


def _as_number(text: str) -> str:
    """Say how a number is written that was written in another way, or nothing."""
    plain = text.replace(",", ".").replace("\N{EN DASH}", "-").replace("\N{MINUS SIGN}", "-")
    match = _NUMBER_WITH_UNIT.fullmatch(plain)
    if match is None:
        return ""
    if match[2]:
        return "a number has no unit: write it in the unit of what it is compared with"
    return f"the number is written {match[1]}"


def _name_span(call: Call) -> Span:
    """Give the place of the function's name, which follows the parenthesis."""
    span = call.span
    if not span.line:
        return span
    return Span(span.line, span.column + 1, span.line, span.column + 1 + len(call.function))
