"""What the tests of a pair rule are made of: which side each part is about, and what is bounded."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from enum import Enum
from itertools import pairwise

from icarus_lite.errors import InferenceError
from icarus_lite.inference.network.kernels.exact import PairSide, variables_of
from icarus_lite.inference.network.kernels.ranges import NUMERIC_FUNCTIONS, is_nonnegative
from icarus_lite.language.functions import FUNCTIONS, evaluate
from icarus_lite.language.syntax import Call, Constant, Expression, Variable
from icarus_lite.records import dataclass

_MIRRORED = {"<": ">", "<=": ">=", ">": "<", ">=": "<="}
COMPARISONS = frozenset(_MIRRORED)


class Reach(Enum):
    """Which objects of a pair an expression is about."""

    NEITHER = "neither"
    LEFT = "left"
    RIGHT = "right"
    BOTH = "both"


@dataclass(frozen=True, slots=True)
class Sides:
    """The two patterns of a rule."""

    left: PairSide
    right: PairSide

    def reach(self, expression: Expression) -> Reach:
        """Tell which objects an expression is about; a variable of both counts as the left's."""
        names = variables_of(expression)
        left = names & self.left.variables
        if names == left:
            return Reach.LEFT if names else Reach.NEITHER
        return Reach.BOTH if left else Reach.RIGHT


@dataclass(frozen=True, slots=True)
class Axis:
    """A bound on the distance of two objects along one axis: |left - right| <= reach(limit).

    Args:
        left: The left object's place on it.
        right: The right object's place on it.
        limit: What bounds the distance: a constant, or something of one of the objects.
        reach: Gives the greatest distance for a value of `limit`.
    """

    left: Expression
    right: Expression
    limit: Expression
    reach: Callable[[float], float]

    def __str__(self) -> str:
        if isinstance(self.limit, Constant) and not isinstance(self.limit.value, str):
            return f"|{self.left} - {self.right}| bounded by {self.reach(self.limit.value):g}"
        return f"|{self.left} - {self.right}| bounded by {self.limit}"


@dataclass(frozen=True, slots=True)
class Order:
    """A test that compares a key of the left object with a key of the right one.

    Args:
        left: The left object's key.
        right: The right object's key.
        comparison: `<`, `<=`, `>` or `>=`, the left key first.
    """

    left: Expression
    right: Expression
    comparison: str


def is_numeric(test: Expression, names: frozenset[str]) -> bool:
    """Tell whether a test is all about numbers, as far as its text shows.

    Args:
        test: The test.
        names: The variables that stand for the objects themselves; they are no numbers.
    """
    if isinstance(test, Variable):
        return test.name not in names
    if isinstance(test, Constant):
        return not isinstance(test.value, str)
    function = FUNCTIONS.get(test.function)
    if function is None or not function.accepts(len(test.args)):
        return False
    return all(is_numeric(each, names) and _fits(test, each) for each in test.args)


def _fits(call: Call, argument: Expression) -> bool:
    """Tell whether an argument is a test where tests are wanted, a number where numbers are."""
    wants_test = call.function in ("and", "or", "not")
    is_test = isinstance(argument, Call) and argument.function not in NUMERIC_FUNCTIONS
    return wants_test == is_test


def order_of(test: Call, sides: Sides) -> Order | None:
    """Recognise a comparison of a key of one object with a key of the other."""
    if test.function not in _MIRRORED or len(test.args) != 2:
        return None
    first, second = test.args
    reaches = sides.reach(first), sides.reach(second)
    if reaches == (Reach.LEFT, Reach.RIGHT):
        return Order(first, second, test.function)
    if reaches == (Reach.RIGHT, Reach.LEFT):
        return Order(second, first, _MIRRORED[test.function])
    return None


def axes_of(test: Call, sides: Sides) -> Iterator[Axis]:
    """Find the bounds on distances that a test implies."""
    if test.function == "and":
        for each in test.args:
            if isinstance(each, Call):
                yield from axes_of(each, sides)
    if test.function not in _MIRRORED:
        return
    args = test.args if test.function in ("<", "<=") else test.args[::-1]
    for small, large in pairwise(args):
        if sides.reach(large) is not Reach.BOTH:
            for left, right, reach in _bounded(small, sides, lambda limit: limit):
                yield Axis(left, right, large, reach)


_Found = tuple[Expression, Expression, Callable[[float], float]]


def _bounded(small: Expression, sides: Sides, reach: Callable[[float], float]) -> Iterator[_Found]:
    """Find what is bounded where an expression does not exceed a limit."""
    if not isinstance(small, Call) or not is_nonnegative(small):
        return
    name, args = small.function, small.args
    if name == "abs":
        yield from _difference(args[0], sides, reach)
    elif name == "distance":
        half = len(args) // 2
        for pair in zip(args[:half], args[half:], strict=True):
            yield from _difference(Call("-", pair), sides, reach)
    elif name == "*" and len(args) == 2:
        yield from _bounded_product(args, sides, reach)
    elif name == "sqrt":
        yield from _bounded(args[0], sides, lambda limit: reach(limit) * abs(reach(limit)))
    elif name in ("max", "+"):
        for each in args:
            # A sum is not below a term where no other term is negative; nor is the greatest.
            if name == "max" or all(map(is_nonnegative, args)):
                yield from _bounded(each, sides, reach)


def _bounded_product(
    factors: tuple[Expression, ...], sides: Sides, reach: Callable[[float], float]
) -> Iterator[_Found]:
    if factors[0] == factors[1]:
        yield from _difference(factors[0], sides, lambda limit: math.sqrt(max(reach(limit), 0.0)))
    for factor, other in (factors, factors[::-1]):
        if isinstance(factor, Constant):
            yield from _bounded(other, sides, _scaled(reach, factor))


def _scaled(reach: Callable[[float], float], factor: Constant) -> Callable[[float], float]:
    value = factor.value
    if isinstance(value, str) or value <= 0:
        return lambda _: math.inf
    return lambda limit: reach(limit) / value


def _difference(
    difference: Expression, sides: Sides, reach: Callable[[float], float]
) -> Iterator[_Found]:
    if not isinstance(difference, Call) or difference.function != "-":
        return
    if len(difference.args) != 2:
        return
    first, second = difference.args
    reaches = sides.reach(first), sides.reach(second)
    if reaches == (Reach.LEFT, Reach.RIGHT):
        yield first, second, reach
    elif reaches == (Reach.RIGHT, Reach.LEFT):
        yield second, first, reach


def terms_of(tests: Sequence[Expression], sides: Sides, reach: Reach) -> tuple[Expression, ...]:
    """Give the largest numeric parts that are about one side only, each once."""
    found: dict[Expression, None] = {}

    def visit(expression: Expression) -> None:
        about = sides.reach(expression)
        is_test = isinstance(expression, Call) and expression.function not in NUMERIC_FUNCTIONS
        if about is reach and not is_test:
            found.setdefault(expression)
        elif about in (reach, Reach.BOTH) and isinstance(expression, Call):
            for each in expression.args:
                visit(each)

    for test in tests:
        visit(test)
    return tuple(found)


def is_symmetric(tests: Sequence[Call], sides: Sides) -> bool:
    """Tell whether the tests hold of (b, a) exactly when they hold of (a, b).

    Only what is plainly so is recognised: absolute or squared differences, distances, and what
    commutes. Float addition and multiplication of two numbers commute exactly.
    """
    of_left = {attribute: variable for variable, attribute in sides.left.attributes}
    of_right = {attribute: variable for variable, attribute in sides.right.attributes}
    if of_left.keys() != of_right.keys() or len(of_left) != len(sides.left.attributes):
        return False
    if len(of_right) != len(sides.right.attributes):
        return False
    swapped = {of_left[name]: of_right[name] for name in of_left}
    swapped |= {of_right[name]: of_left[name] for name in of_left}
    same = {name: name for name in swapped}
    return {_shape(t, same) for t in tests} == {_shape(t, swapped) for t in tests}


def _shape(expression: Expression, names: dict[str, str]) -> str:
    """Write an expression so that two that always give the same number are written alike."""
    if isinstance(expression, Variable):
        return names.get(expression.name, expression.name)
    if isinstance(expression, Constant):
        return repr(expression.value)
    name, args = expression.function, list(expression.args)
    if name in (">", ">="):
        name, args = _MIRRORED[name], args[::-1]
    if name == "distance":
        half = len(args) // 2
        points = zip(args[:half], args[half:], strict=True)
        words = ["".join(sorted(_shape(each, names) for each in pair)) for pair in points]
        return f"(distance {' '.join(words)})"
    squares = name == "*" and len(args) == 2 and args[0] == args[1]
    if (name == "abs" or squares) and _is_difference(args[0]):
        assert isinstance(args[0], Call)
        words = sorted(_shape(each, names) for each in args[0].args)
        return f"({name} difference {' '.join(words)})"
    words = [_shape(each, names) for each in args]
    if name in ("=", "/=", "and", "or") or (name in ("+", "*") and len(words) == 2):
        words.sort()
    return f"({name} {' '.join(words)})"


def _is_difference(expression: Expression) -> bool:
    return isinstance(expression, Call) and expression.function == "-" and len(expression.args) == 2


def swapped(expression: Expression, sides: Sides) -> Expression:
    """Give an expression with the left object in place of the right one, and the other way."""
    of_left = {attribute: variable for variable, attribute in sides.left.attributes}
    of_right = {attribute: variable for variable, attribute in sides.right.attributes}
    names = {of_left[name]: of_right[name] for name in of_left}
    names |= {of_right[name]: of_left[name] for name in of_left}

    def swap(part: Expression) -> Expression:
        if isinstance(part, Variable):
            return Variable(names.get(part.name, part.name), part.span)
        if isinstance(part, Call):
            return Call(part.function, tuple(map(swap, part.args)), part.span)
        return part

    return swap(expression)


def fold(test: Call) -> Call:
    """Put the value in place of each part without variables that has one."""
    return Call(test.function, tuple(map(_fold, test.args)), test.span)


def _fold(expression: Expression) -> Expression:
    if not isinstance(expression, Call):
        return expression
    if not variables_of(expression) and expression.function in NUMERIC_FUNCTIONS:
        try:
            value = evaluate(expression, {})
        except InferenceError:  # it is told when the test is asked
            return expression
        assert not isinstance(value, bool), "the function gives a number"
        return Constant(value, expression.span)
    return Call(expression.function, tuple(map(_fold, expression.args)), expression.span)
