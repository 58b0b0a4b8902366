"""The tests of a pair rule as numpy source, for any number of pairs at once.

Each operation is the same IEEE 754 operation in the same order as in Python, so that both find
the same pairs. Two things are computed otherwise: a distance (Python's `math.dist` rounds once
where the sum of squares rounds often) and, from Python 3.12 on, sums of three terms and more.
These are compared with a margin, and a pair within the margin is left in doubt.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from itertools import pairwise

from icarus_lite.inference.network.kernels.analysis import COMPARISONS
from icarus_lite.inference.network.kernels.python_source import COMPENSATED_SUMS, parts_of
from icarus_lite.inference.network.kernels.ranges import (
    EXACT_INTEGERS,
    NUMERIC_FUNCTIONS,
    is_nonnegative,
    range_of,
)
from icarus_lite.language.syntax import Call, Constant, Expression

MARGIN = 1e-14
"""Relative: far above the rounding of a sum of up to 30 squares (32 * 2**-53 = 4e-15)."""

_TINY = 1e-150
"""Absolute: where a square underflows, a relative margin says nothing."""

_SAFE = (1e-140, 1e140)
"""A constant in this range can be squared without under- or overflow."""

_FLIPPED = {"<": ">", "<=": ">=", ">": "<", ">=": "<=", "=": "=", "/=": "/="}
_OPERATORS = {"=": "==", "/=": "!="}


class NotVectorizableError(Exception):
    """The tests cannot be computed with arrays and give what Python gives."""


class ArrayWriter:
    """Writes tests as statements that compute `hold` and `doubt`, arrays of truth values.

    `hold` says which pairs meet the tests; where `doubt` is true it says nothing.

    Args:
        names: The identifier of each part that is given as an array (or as one number).
        limit: The greatest magnitude of a variable.
        constants: Where to note the constants that the tests name, each with its identifier: as
            arrays made beforehand they cost half of what numbers do. None writes numbers.
    """

    def __init__(
        self,
        names: Mapping[Expression, str],
        limit: float,
        constants: dict[str, str] | None = None,
    ) -> None:
        self._names = dict(names)
        self._limit = limit
        self._constants = constants
        self._lines: list[str] = []
        self._shared: set[Expression] = set()
        self._doubts: dict[Expression, list[str]] = {}
        self._count = 0

    def statements(self, tests: Sequence[Call]) -> list[str]:
        """Write that all tests hold.

        Raises:
            NotVectorizableError: they must be computed in Python.
        """
        self.share(tests)
        hold, doubt = self.conjunction(tests)
        self._lines.append(f"return {hold}, {doubt or None}")
        return self._lines

    @property
    def lines(self) -> list[str]:
        """The statements written so far."""
        return self._lines

    def share(self, tests: Sequence[Expression]) -> None:
        """See to it that what these tests have in common is computed once."""
        counted = Counter(part for test in tests for part in parts_of(test))
        self._shared = {part for part, count in counted.items() if count > 1}

    def conjunction(self, tests: Sequence[Call]) -> tuple[str, str]:
        """Write that all tests hold; give what says so, and what says where that is in doubt.

        Raises:
            NotVectorizableError: they must be computed in Python.
        """
        hold, doubt = "", ""
        for number, test in enumerate(tests):
            found, doubts = self._test(test), self._doubts_of(test)
            if doubts:
                reached = [f"{hold} & ({' | '.join(doubts)})"] if hold else [" | ".join(doubts)]
                doubt = self._assign("doubt", " | ".join([doubt, *reached] if doubt else reached))
            last = number == len(tests) - 1
            joined = f"{hold} & ({found})" if hold else found
            hold = joined if last and not doubt else self._assign("hold", joined)
        return hold, doubt

    def numbers(self, expressions: Sequence[Expression]) -> list[str]:
        """Write the values of numeric expressions.

        Raises:
            NotVectorizableError: they must be computed in Python.
        """
        self.share(expressions)
        words = [self.number(each) for each in expressions]
        doubts = dict.fromkeys(name for each in expressions for name in self._doubts_of(each))
        doubt = " | ".join(doubts) if doubts else "None"
        self._lines.append(f"return ({', '.join(words)},), {doubt}")
        return self._lines

    def number(self, expression: Expression) -> str:
        """Write a numeric expression; statements it needs are added first."""
        name = self._names.get(expression)
        if name is not None:
            return name
        if isinstance(expression, Constant):
            if range_of(expression, self._limit).guarded:
                raise NotVectorizableError
            text = repr(float(expression.value))
            if self._constants is not None:
                return self._constants.setdefault(text, f"number_{len(self._constants) + 1}")
            return f"({text})" if text.startswith("-") else text
        assert isinstance(expression, Call), "every variable has a name"
        if self._is_approximate(expression):
            raise NotVectorizableError
        if range_of(expression, self._limit).guarded:
            return self._guarded(expression)
        text = self._operation(expression, [self.number(each) for each in expression.args])
        if expression in self._shared:
            text = self._names[expression] = self._assign("part", text)
        return text

    def _assign(self, word: str, text: str) -> str:
        self._count += 1
        name = f"{word}_{self._count}"
        self._lines.append(f"{name} = {text}")
        return name

    def _doubts_of(self, test: Expression) -> list[str]:
        found: dict[str, None] = {}
        for part in parts_of(test):
            found.update(dict.fromkeys(self._doubts.get(part, ())))
        return list(found)

    def _guarded(self, call: Call) -> str:
        """Compute step by step, looking at each result on the way."""
        words = [self.number(each) for each in call.args]
        parts = [range_of(each, self._limit) for each in call.args]
        whole = sum(part.integral for part in parts) >= min(2, len(parts)) and call.function != "/"
        most = repr(EXACT_INTEGERS if whole else 1.7976931348623157e308)
        doubts = self._doubts[call] = []

        def watched(text: str) -> str:
            name = self._assign("part", text)
            doubts.append(self._assign("doubt", f"~(np.abs({name}) <= {most})"))
            return name

        if call.function in ("+", "*", "/") and len(words) > 1:
            name = words[0]
            for word in words[1:]:
                name = watched(f"{name} {call.function} {word}")
        elif call.function == "-" and len(words) > 2:
            name = words[1]
            for word in words[2:]:
                name = watched(f"{name} + {word}")
            name = watched(f"{words[0]} - {name}")
        else:
            name = watched(self._operation(call, words))
        self._names[call] = name
        return name

    def _operation(self, call: Call, words: list[str]) -> str:
        name = call.function
        if name in ("+", "*", "/"):
            return f"({f' {name} '.join(words)})"
        if name == "-":
            if len(words) == 1:
                return f"(-{words[0]})"
            return f"({words[0]} - ({' + '.join(words[1:])}))"
        if name in ("min", "max"):
            text = words[0]
            for word in words[1:]:
                text = f"np.{name}imum({text}, {word})"
            return text
        return f"np.{name}({words[0]})"  # abs and sqrt are called so there, too

    def _test(self, test: Expression) -> str:
        assert isinstance(test, Call), "a test is a call"
        if test.function in ("and", "or"):
            sign = " & " if test.function == "and" else " | "
            return f"({sign.join(f'({self._test(each)})' for each in test.args)})"
        if test.function == "not":
            return f"~({self._test(test.args[0])})"
        if any(self._is_approximate(each) for each in test.args):
            return self._about(test)
        words = [self.number(each) for each in test.args]
        operator = _OPERATORS.get(test.function, test.function)
        if test.function in COMPARISONS:
            pairs = list(pairwise(words))
        elif test.function == "=":
            pairs = [(words[0], word) for word in words[1:]]
        else:
            pairs = [(a, b) for place, a in enumerate(words) for b in words[place + 1 :]]
        if len(pairs) == 1:
            return f"{pairs[0][0]} {operator} {pairs[0][1]}"
        return " & ".join(f"({a} {operator} {b})" for a, b in pairs)

    def _is_approximate(self, expression: Expression) -> bool:
        return expression not in self._names and is_approximate(expression)

    def _about(self, test: Call) -> str:
        """Compare something computed otherwise than in Python, and doubt what is too close."""
        if len(test.args) != 2:
            raise NotVectorizableError
        first, second = test.args
        comparison = test.function
        if not self._is_approximate(first):
            first, second, comparison = second, first, _FLIPPED[comparison]
        assert isinstance(first, Call), "only a call is approximate"
        operator = _OPERATORS.get(comparison, comparison)
        limit, squared = self.number(second), self._squared(first)
        if squared is None:
            found = self._assign("about", self._sum(first))
        elif isinstance(second, Constant) and _is_safe(second):
            square = float(second.value) ** 2
            found = self._assign("squared", squared)
            low, high = square * (1 - 4 * MARGIN), square * (1 + 4 * MARGIN)
            doubt = f"({found} >= {low!r}) & ({found} <= {high!r})"
            self._doubts[test] = [self._assign("doubt", doubt)]
            return f"{found} {operator} {square!r}"
        else:
            found = self._assign("about", f"np.sqrt({squared})")
        margin = f"{MARGIN!r} * np.abs({limit}) + {_TINY!r}"
        self._doubts[test] = [self._assign("doubt", f"np.abs({found} - {limit}) <= {margin}")]
        return f"{found} {operator} {limit}"

    def _squared(self, call: Call) -> str | None:
        """Write the square of a distance; None if the call is a sum."""
        if call.function != "distance":
            return None
        half = len(call.args) // 2
        if half > 30 or range_of(call, self._limit).guarded:
            raise NotVectorizableError
        squares = []
        for pair in zip(call.args[:half], call.args[half:], strict=True):
            first, second = map(self.number, pair)
            name = self._assign("along", f"{first} - {second}")
            squares.append(f"{name} * {name}")
        return " + ".join(squares)

    def _sum(self, call: Call) -> str:
        plainly = call.function == "+" and len(call.args) <= 30 and is_nonnegative(call)
        if not plainly or range_of(call, self._limit).guarded:
            raise NotVectorizableError
        return " + ".join(map(self.number, call.args))


def is_approximate(expression: Expression) -> bool:
    """Tell whether arrays compute an expression otherwise than Python does."""
    if not isinstance(expression, Call) or expression.function not in NUMERIC_FUNCTIONS:
        return False
    if expression.function == "distance":
        return True
    terms = len(expression.args) - (expression.function == "-")
    return COMPENSATED_SUMS and expression.function in ("+", "-") and terms > 2


def _is_safe(constant: Constant) -> bool:
    value = constant.value
    return not isinstance(value, str) and _SAFE[0] <= value <= _SAFE[1]
