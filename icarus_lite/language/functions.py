"""The functions of `:tests` and `:binds`: a closed table, typed and without side effects.

Domains may use Python functions besides, given by name. What they return is checked as well.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from enum import StrEnum
from types import MappingProxyType

from icarus_lite.errors import InferenceError
from icarus_lite.language.syntax import Call, Constant, Expression, Span, Variable
from icarus_lite.records import dataclass
from icarus_lite.symbols import Value, format_value, is_number

PythonFunctions = Mapping[str, Callable[..., Value | bool]]
"""Functions of the host program, by the name a domain calls them."""

NO_FUNCTIONS: PythonFunctions = MappingProxyType({})


class Kind(StrEnum):
    """What a function takes or gives."""

    NUMBER = "number"
    BOOLEAN = "boolean"
    ANY = "any"


@dataclass(frozen=True, slots=True)
class Function:
    """A function that tests may call.

    Args:
        name: As written in a domain.
        least: The smallest number of arguments.
        most: The largest, or None for any number.
        takes: What each argument must be; `ANY` is a symbol, string or number.
        gives: What it returns; only Python functions give `ANY`, which may be a boolean.
        documentation: One sentence for the reference.
        implementation: The Python function, called with checked arguments.
        even: Whether the number of arguments must be even.
    """

    name: str
    least: int
    most: int | None
    takes: Kind
    gives: Kind
    documentation: str
    implementation: Callable[..., Value | bool]
    even: bool = False

    def accepts(self, count: int) -> bool:
        """Tell whether it can be called with this many arguments."""
        if self.even and count % 2:
            return False
        return self.least <= count and (self.most is None or count <= self.most)

    @property
    def arity(self) -> str:
        """Say in words how many arguments it takes."""
        if self.even:
            return f"an even number of arguments, at least {self.least}"
        if self.most is None:
            return f"at least {_arguments(self.least)}"
        if self.least == self.most:
            return _arguments(self.least)
        return f"{self.least} to {self.most} arguments"


def _arguments(count: int) -> str:
    return f"{count} argument" if count == 1 else f"{count} arguments"


def _subtract(first: float, *others: float) -> float:
    return first - sum(others) if others else -first


def _divide(first: float, *others: float) -> float:
    for other in others:
        first = first / other
    return first


def _distance(*coordinates: float) -> float:
    half = len(coordinates) // 2
    return math.dist(coordinates[:half], coordinates[half:])


def _chain(compare: Callable[[float, float], bool]) -> Callable[..., bool]:
    """Extend a comparison of two to any number: each must compare with the next."""

    def compare_all(*numbers: float) -> bool:
        return all(compare(numbers[i], numbers[i + 1]) for i in range(len(numbers) - 1))

    return compare_all


def _equal(*values: Value) -> bool:
    return all(value == values[0] for value in values[1:])


def _different(*values: Value) -> bool:
    return len(set(values)) == len(values)


def _number(
    name: str, least: int, most: int | None, text: str, function: Callable[..., float]
) -> Function:
    return Function(name, least, most, Kind.NUMBER, Kind.NUMBER, text, function)


def _compare(name: str, text: str, function: Callable[[float, float], bool]) -> Function:
    return Function(name, 2, None, Kind.NUMBER, Kind.BOOLEAN, text, _chain(function))


_TABLE = (
    _number("+", 1, None, "The sum of its arguments.", lambda *numbers: sum(numbers)),
    _number("-", 1, None, "The first less all others; of one number, its negative.", _subtract),
    _number("*", 1, None, "The product of its arguments.", lambda *numbers: math.prod(numbers)),
    _number("/", 2, None, "The first divided by each of the others.", _divide),
    Function("=", 2, None, Kind.ANY, Kind.BOOLEAN, "All are equal; 1 equals 1.0.", _equal),
    Function("/=", 2, None, Kind.ANY, Kind.BOOLEAN, "No two are equal.", _different),
    _compare("<", "Each is less than the next.", lambda a, b: a < b),
    _compare("<=", "Each is less than or equal to the next.", lambda a, b: a <= b),
    _compare(">", "Each is greater than the next.", lambda a, b: a > b),
    _compare(">=", "Each is greater than or equal to the next.", lambda a, b: a >= b),
    Function(
        "distance",
        2,
        None,
        Kind.NUMBER,
        Kind.NUMBER,
        "The Euclidean distance of two points: all coordinates of the first, then of the second.",
        _distance,
        even=True,
    ),
    _number("abs", 1, 1, "The absolute value.", abs),
    _number("min", 1, None, "The least of its arguments.", lambda *numbers: min(numbers)),
    _number("max", 1, None, "The greatest of its arguments.", lambda *numbers: max(numbers)),
    _number("sqrt", 1, 1, "The square root of a number that is not negative.", math.sqrt),
    Function("and", 1, None, Kind.BOOLEAN, Kind.BOOLEAN, "All hold; stops at the first that does "
             "not.", lambda *truths: all(truths)),
    Function("or", 1, None, Kind.BOOLEAN, Kind.BOOLEAN, "At least one holds; stops at the first "
             "that does.", lambda *truths: any(truths)),
    Function("not", 1, 1, Kind.BOOLEAN, Kind.BOOLEAN, "The argument does not hold.",
             lambda truth: not truth),
)  # fmt: skip

FUNCTIONS: Mapping[str, Function] = MappingProxyType({entry.name: entry for entry in _TABLE})
"""The functions of the language, by name."""


def function_table(functions: PythonFunctions | None = None) -> Mapping[str, Function]:
    """Give the language's functions together with those of the host program.

    Raises:
        InferenceError: A function of the language would be replaced.
    """
    if not functions:
        return FUNCTIONS
    table = dict(FUNCTIONS)
    for name, implementation in functions.items():
        if name in FUNCTIONS:
            raise InferenceError(
                f"`{name}` is a function of the language and cannot be replaced; "
                "register the Python function under another name"
            )
        table[name] = _python_function(name, implementation)
    return MappingProxyType(table)


def _python_function(name: str, implementation: Callable[..., Value | bool]) -> Function:
    import inspect  # noqa: PLC0415 - it takes long to import, and few domains use such functions

    least, most = _python_arity(implementation)
    text = (inspect.getdoc(implementation) or "A Python function.").partition("\n")[0]
    return Function(name, least, most, Kind.ANY, Kind.ANY, text, implementation)


def _python_arity(implementation: Callable[..., Value | bool]) -> tuple[int, int | None]:
    """Read off a Python function how many positional arguments it takes."""
    import inspect  # noqa: PLC0415 - as above

    try:
        parameters = inspect.signature(implementation).parameters.values()
    except (TypeError, ValueError):  # some built-in functions do not say
        return 0, None
    positional = [p for p in parameters if p.kind in (p.POSITIONAL_ONLY, p.POSITIONAL_OR_KEYWORD)]
    least = sum(p.default is p.empty for p in positional)
    variadic = any(p.kind is p.VAR_POSITIONAL for p in parameters)
    return least, None if variadic else len(positional)


def evaluate(
    expression: Expression,
    bindings: Mapping[str, Value],
    functions: PythonFunctions = NO_FUNCTIONS,
    *,
    path: str = "",
) -> Value | bool:
    """Compute the value of an expression.

    Args:
        expression: A variable, constant or call.
        bindings: Values by variable name, the question mark included.
        functions: Python functions the expression may call besides those of the language.
        path: The domain file, to name it in errors.

    Returns:
        A number, symbol or string, or a boolean for a test.

    Raises:
        InferenceError: A variable is unbound, a function unknown, an argument of the wrong kind,
            a divisor zero, or a result not finite. The message begins with the place.
    """
    if isinstance(expression, Variable):
        try:
            return bindings[expression.name]
        except KeyError:
            raise _failure(path, expression.span, f"{expression.name} is not bound") from None
    if isinstance(expression, Constant):
        return expression.value
    name = expression.function
    if name in ("and", "or"):
        return _junction(expression, bindings, functions, path)
    values = [evaluate(arg, bindings, functions, path=path) for arg in expression.args]
    function = FUNCTIONS.get(name)
    if function is None:
        return _call_python(expression, values, functions, path)
    _check_arguments(function, expression, values, path)
    try:
        result = function.implementation(*values)
    except ZeroDivisionError:
        raise _failure(
            path, expression.span, f"division by zero in {_shown(name, values)}"
        ) from None
    except (ValueError, OverflowError):
        raise _failure(path, expression.span, f"{_shown(name, values)} has no value") from None
    if not isinstance(result, bool):
        _check_finite(result, expression, values, path)
    return result


def as_truth(value: Value | bool, test: Expression, path: str = "") -> bool:  # noqa: FBT001 - it is what is checked
    """Give the answer of a test, which has to be true or false.

    Raises:
        InferenceError: It is a number or symbol, as only a Python function can give in a test.
    """
    if isinstance(value, bool):
        return value
    message = f"{test} came to {_name(value)}, but a test has to be true or false"
    raise _failure(path, test.span, message)


def as_value(value: Value | bool, expression: Expression, path: str = "") -> Value:  # noqa: FBT001 - it is what is checked
    """Give what a bind computes, which has to be a number or symbol.

    Raises:
        InferenceError: It is a truth value, as only a Python function can give in a bind.
    """
    if not isinstance(value, bool):
        return value
    message = f"{expression} came to {_name(value)}, but a bind has to be a number or symbol"
    raise _failure(path, expression.span, message)


def _junction(
    call: Call, bindings: Mapping[str, Value], functions: PythonFunctions, path: str
) -> bool:
    """Evaluate `and` and `or`, which look no further once the answer is known."""
    _check_count(FUNCTIONS[call.function], call, path)
    answer_when = call.function == "or"
    for argument in call.args:
        truth = evaluate(argument, bindings, functions, path=path)
        if not isinstance(truth, bool):
            raise _failure(
                path, argument.span, f"`{call.function}` takes tests, not {_name(truth)}"
            )
        if truth is answer_when:
            return answer_when
    return not answer_when


def _check_count(function: Function, call: Call, path: str) -> None:
    if not function.accepts(len(call.args)):
        message = f"`{function.name}` takes {function.arity}, not {len(call.args)}"
        raise _failure(path, call.span, message)


def _check_arguments(function: Function, call: Call, values: list[Value | bool], path: str) -> None:
    _check_count(function, call, path)
    for argument, value in zip(call.args, values, strict=True):
        if isinstance(value, bool):
            fits = function.takes is Kind.BOOLEAN
        else:
            fits = function.takes is Kind.ANY or (
                function.takes is Kind.NUMBER and is_number(value)
            )
        if not fits:
            wanted = {
                Kind.NUMBER: "numbers",
                Kind.BOOLEAN: "tests",
                Kind.ANY: "symbols and numbers",
            }[function.takes]
            message = f"`{function.name}` takes {wanted}, not {_name(value)}"
            if isinstance(argument, Variable):
                message = f"{argument.name} is {_name(value)}, but {message.partition(',')[0]}"
            raise _failure(path, argument.span, message)


def _call_python(
    call: Call, values: list[Value | bool], functions: PythonFunctions, path: str
) -> Value | bool:
    implementation = functions.get(call.function)
    if implementation is None:
        raise _failure(path, call.span, f"there is no function `{call.function}`")
    shown = _shown(call.function, values)
    try:
        result = implementation(*values)
    except Exception as error:
        # The host's function may raise anything; the user needs to know which clause called it.
        message = f"the Python function in {shown} failed: {type(error).__name__}: {error}"
        raise _failure(path, call.span, message) from error
    given: object = _plain(result)  # annotations of the host's function are no proof
    if not isinstance(given, str | int | float):
        message = f"{shown} returned {type(given).__name__}, not a number, symbol or truth value"
        raise _failure(path, call.span, message)
    if not isinstance(given, bool):
        _check_finite(given, call, values, path)
    return given


def _plain(result: object) -> object:
    """Give the Python value that a numpy scalar stands for; everything else as it is."""
    if isinstance(result, str | int | float) or getattr(result, "shape", None) != ():
        return result
    item = getattr(result, "item", None)
    return item() if callable(item) else result


def _check_finite(result: Value, call: Call, values: list[Value | bool], path: str) -> None:
    try:
        finite = isinstance(result, str) or math.isfinite(result)
    except OverflowError:  # an integer beyond every float
        finite = False
    if not finite:
        shown = _shown(call.function, values)
        raise _failure(path, call.span, f"{shown} is not a finite number")


def _name(value: object) -> str:
    """Name a value and its kind in an error."""
    if isinstance(value, bool):
        return f"the truth value {str(value).lower()}"
    if isinstance(value, str):
        return f"the symbol {format_value(value)}"
    return f"the number {value!r}"


def _shown(function: str, values: list[Value | bool]) -> str:
    words = [str(v).lower() if isinstance(v, bool) else format_value(v) for v in values]
    return f"({' '.join([function, *words])})"


def _failure(path: str, span: Span, message: str) -> InferenceError:
    place = f"{span.line}:{span.column}: " if span.line else ""
    path = span.path or path
    if path:
        place = f"{path}:{place}" if place else f"{path}: "
    return InferenceError(place + message)
