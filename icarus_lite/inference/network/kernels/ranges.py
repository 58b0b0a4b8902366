"""How large the parts of an expression can become: where float arithmetic may be trusted.

Numeric kernels compute in `float64`, the language in Python's numbers. On floats the two agree bit
for bit, on integers as long as no result exceeds 2**53. So a kernel has a *limit*: as long as all
attributes stay within it, every part of its tests is known to be computed alike. The few parts for
which that cannot be known beforehand, such as a quotient, are *guarded*: their results are looked
at, and a pair with one that is out of the ordinary is left to the exact test.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterable, Iterator

from icarus_lite.language.syntax import Call, Constant, Expression, Variable
from icarus_lite.records import dataclass

EXACT_INTEGERS = 2.0**53
"""Up to this magnitude every integer is a float."""

MOST = sys.float_info.max
_LEAST_LIMIT, _GREATEST_LIMIT = 10, 50  # as powers of two


@dataclass(frozen=True, slots=True)
class Range:
    """What is known of the value of an expression.

    Args:
        low: Its lower bound.
        high: Its upper bound.
        integral: Whether it may be an integer; a float otherwise.
        guarded: Whether the value, or one on the way to it in this very operation, may lie outside
            of what floats compute exactly, or may not exist.
    """

    low: float
    high: float
    integral: bool
    guarded: bool = False

    @property
    def magnitude(self) -> float:
        """The greatest magnitude it can have."""
        return max(abs(self.low), abs(self.high))


def range_of(expression: Expression, limit: float) -> Range:
    """Give the range of a numeric expression whose variables have at most this magnitude."""
    if isinstance(expression, Variable):
        return Range(-limit, limit, integral=True)
    if isinstance(expression, Constant):
        value = expression.value
        if isinstance(value, str) or abs(value) > EXACT_INTEGERS:
            return Range(-MOST, MOST, integral=True, guarded=True)
        return Range(value, value, integral=isinstance(value, int))
    parts = [range_of(each, limit) for each in expression.args]
    found = _result(expression, parts)
    most = EXACT_INTEGERS if found.integral else MOST / 4
    if found.guarded or found.magnitude <= most:
        return found
    low, high = max(found.low, -MOST), min(found.high, MOST)
    return Range(low, high, found.integral, guarded=True)


def is_guarded(expression: Expression, limit: float) -> bool:
    """Tell whether some part of an expression is guarded, tests included."""
    return any(_guards(expression, limit))


def choose_limit(tests: Iterable[Expression]) -> float:
    """Give the greatest limit at which no more parts are guarded than must be."""
    tests = tuple(tests)

    def guards(power: int) -> int:
        return sum(sum(_guards(test, 2.0**power)) for test in tests)

    unavoidable = guards(_LEAST_LIMIT)
    power = _LEAST_LIMIT
    while power < _GREATEST_LIMIT and guards(power + 1) == unavoidable:
        power += 1
    return 2.0**power


def is_nonnegative(expression: Expression) -> bool:
    """Tell whether an expression is never negative, whatever its variables are."""
    if isinstance(expression, Constant):
        return not isinstance(expression.value, str) and expression.value >= 0
    if isinstance(expression, Variable):
        return False
    name, args = expression.function, expression.args
    if name in ("abs", "sqrt", "distance"):
        return True
    if name == "*" and len(args) == 2 and args[0] == args[1]:
        return True
    if name == "max":
        return any(map(is_nonnegative, args))
    return (name in ("+", "*", "min", "/")) and all(map(is_nonnegative, args))


NUMERIC_FUNCTIONS = frozenset({"+", "-", "*", "/", "abs", "min", "max", "sqrt", "distance"})
"""The functions that give a number."""


def _guards(expression: Expression, limit: float) -> Iterator[bool]:
    """Say of each part whether it is guarded."""
    if isinstance(expression, Call):
        for each in expression.args:
            yield from _guards(each, limit)
        if expression.function in NUMERIC_FUNCTIONS:
            yield range_of(expression, limit).guarded
    elif isinstance(expression, Constant):
        yield range_of(expression, limit).guarded


def _result(call: Call, parts: list[Range]) -> Range:
    name = call.function
    if name in ("+", "-"):
        return _sum(parts if name == "+" else _subtrahends(parts), parts)
    if name == "*":
        return _product(call, parts)
    if name == "/":
        return _quotient(parts)
    if name in ("min", "max"):
        pick = min if name == "min" else max
        may_be = any(part.integral for part in parts)
        return Range(pick(p.low for p in parts), pick(p.high for p in parts), may_be)
    if name == "distance":
        reach = sum(part.magnitude for part in parts)
        return Range(0.0, reach, integral=False, guarded=reach > 2.0**500)
    return _unary(call, *parts)


def _unary(call: Call, part: Range) -> Range:
    """Give the range of an absolute value or a square root."""
    if call.function == "abs":
        return Range(max(part.low, -part.high, 0.0), part.magnitude, part.integral)
    safe = part.low >= 0 or is_nonnegative(call.args[0])
    return Range(0.0, math.sqrt(max(part.high, 0.0)), integral=False, guarded=not safe)


def _sum(signed: list[Range], parts: list[Range]) -> Range:
    whole = all(part.integral for part in parts)
    low, high = sum(part.low for part in signed), sum(part.high for part in signed)
    # Sums on the way there may be larger than the result.
    reach = sum(part.magnitude for part in parts)
    guarded = reach > (EXACT_INTEGERS if whole or _any_whole(parts) else MOST / 4)
    return Range(low, high, whole, guarded)


def _any_whole(parts: list[Range]) -> bool:
    """Tell whether integers may be added up before the first float is met."""
    return sum(part.integral for part in parts) >= 2


def _subtrahends(parts: list[Range]) -> list[Range]:
    if len(parts) == 1:
        return [Range(-parts[0].high, -parts[0].low, parts[0].integral)]
    return [parts[0], *(Range(-p.high, -p.low, p.integral) for p in parts[1:])]


def _product(call: Call, parts: list[Range]) -> Range:
    whole = all(part.integral for part in parts)
    size, reach = 1.0, 1.0
    for part in parts:
        size *= part.magnitude
        reach = max(reach, size)  # a small factor may come after large ones
    most = EXACT_INTEGERS if whole or _any_whole(parts) else MOST / 4
    low = 0.0 if is_nonnegative(call) else -size
    return Range(low, size, whole, guarded=not reach <= most)


def _quotient(parts: list[Range]) -> Range:
    size = parts[0].magnitude
    for part in parts[1:]:
        least = part.low if part.low > 0 else -part.high if part.high < 0 else 0.0
        size = size / least if least > 1e-100 else math.inf
    if size < MOST / 4:
        return Range(-size, size, integral=False)
    return Range(-MOST, MOST, integral=False, guarded=True)
