"""The tests of a pair rule as Python source for one row of pairs."""

from __future__ import annotations

import builtins
import keyword
import re
import sys
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence

from icarus_lite.inference.network.kernels.ranges import (
    NUMERIC_FUNCTIONS,
    is_nonnegative,
    range_of,
)
from icarus_lite.language.syntax import Call, Constant, Expression, Variable

COMPENSATED_SUMS = sys.version_info >= (3, 12)
"""From Python 3.12 on, `sum` corrects itself on three floats and more."""

HELPERS = {
    "<": "all_less",
    "<=": "none_greater",
    ">": "all_greater",
    ">=": "none_less",
    "=": "all_equal",
    "/=": "all_different",
}
"""The names under which generated code finds the comparisons of the language."""

_OPERATORS = {"=": "==", "/=": "!="}


def parts_of(expression: Expression) -> Iterator[Expression]:
    """Give an expression and all its parts, the outer ones first."""
    yield expression
    if isinstance(expression, Call):
        for each in expression.args:
            yield from parts_of(each)


class PythonWriter:
    """Writes tests as one Python condition.

    It computes exactly what `evaluate` does, in the same order, on numbers within the limit. Where
    a result may be out of the ordinary it is wrapped in `checked`, which raises an ArithmeticError.

    Args:
        names: The identifier of each part that is given as a value.
        limit: The greatest magnitude of a variable.
    """

    def __init__(self, names: Mapping[Expression, str], limit: float) -> None:
        self._names = names
        self._limit = limit
        self._shared: set[Expression] = set()
        self._known: dict[Expression, str] = {}

    def condition(self, tests: Sequence[Call]) -> str:
        """Write that all tests hold."""
        counted = Counter(
            part for test in tests for part in parts_of(test) if part not in self._names
        )
        self._shared = {
            part
            for part, count in counted.items()
            if count > 1 and isinstance(part, Call) and part.function in NUMERIC_FUNCTIONS
        }
        self._known = {}
        return " and ".join(self._test(test) for test in tests)

    def number(self, expression: Expression) -> str:
        """Write a numeric expression."""
        name = self._names.get(expression) or self._known.get(expression)
        if name is not None:
            return name
        if isinstance(expression, Constant):
            text = repr(expression.value)
            return f"({text})" if text.startswith("-") else text
        assert isinstance(expression, Call), "every variable has a name"
        text = self._operation(expression)
        if range_of(expression, self._limit).guarded:
            text = f"checked({text})"
        if expression in self._shared:
            name = f"part_{len(self._known) + 1}"
            self._known[expression] = name
            return f"({name} := {text})"
        return text

    def _test(self, test: Expression) -> str:
        assert isinstance(test, Call), "a test is a call"
        if test.function in ("and", "or"):
            texts, before = [], dict(self._known)
            for number, each in enumerate(test.args):
                texts.append(self._test(each))
                if number == 0:
                    before = dict(self._known)
            # What comes after it can rely on no more than the first having been asked.
            self._known = before
            return f"({f' {test.function} '.join(texts)})"
        if test.function == "not":
            return f"(not {self._test(test.args[0])})"
        if len(test.args) == 2 and test.function in ("<", "<="):
            short = self._within(test) or self._early(test)
            if short is not None:
                return short
        words = [self.number(each) for each in test.args]
        if len(words) == 2:
            return f"{words[0]} {_OPERATORS.get(test.function, test.function)} {words[1]}"
        return f"{HELPERS[test.function]}({', '.join(words)})"

    def _within(self, test: Call) -> str | None:
        """Write |x| < c, c being a constant, without a call."""
        small, large = test.args
        if not isinstance(small, Call) or small.function != "abs" or small in self._shared:
            return None
        if not isinstance(large, Constant) or range_of(small, self._limit).guarded:
            return None
        limit, inner = self.number(large), self.number(small.args[0])
        return f"-{limit} {test.function} {inner} {test.function} {limit}"

    def _early(self, test: Call) -> str | None:
        """Write that a sum of what is never negative is small: no term may be larger alone.

        Float addition is monotone, so this is as exact as it is; and mostly the first term tells.
        """
        small, large = test.args
        if COMPENSATED_SUMS or not isinstance(small, Call) or small.function != "+":
            return None
        if len(small.args) < 2 or small in self._names or small in self._shared:
            return None
        if isinstance(large, Call) and large not in self._names:
            return None
        parts = [small, *small.args]
        if not all(map(is_nonnegative, small.args)):
            return None
        if any(range_of(part, self._limit).guarded for each in parts for part in parts_of(each)):
            return None
        limit = self.number(large)
        words = [self.number(small.args[0])]
        known = dict(self._known)
        words += [self.number(each) for each in small.args[1:]]
        # What the later terms bind is bound only where the first one is small enough.
        self._known = known
        first = "term_1"
        return (
            f"(({first} := {words[0]}) {test.function} {limit}"
            f" and {' + '.join([first, *words[1:]])} {test.function} {limit})"
        )

    def _operation(self, call: Call) -> str:
        words, name = [self.number(each) for each in call.args], call.function
        if name == "+":
            return _sum(words)
        if name == "-":
            return f"(-{words[0]})" if len(words) == 1 else f"({words[0]} - {_sum(words[1:])})"
        if name in ("*", "/"):
            return f"({f' {name} '.join(words)})" if len(words) > 1 else words[0]
        if name in ("min", "max"):
            return f"{name}({', '.join(words)})" if len(words) > 1 else words[0]
        if name == "distance":
            half = len(words) // 2
            first, second = (", ".join(part) + "," for part in (words[:half], words[half:]))
            return f"dist(({first}), ({second}))"
        return f"{name}({words[0]})"


def _sum(words: list[str]) -> str:
    if len(words) == 1:
        return words[0]
    if len(words) > 2 and COMPENSATED_SUMS:
        return f"sum(({', '.join(words)}))"
    return f"({' + '.join(words)})"


def identifiers(expressions: Sequence[Expression], side: str, taken: set[str]) -> list[str]:
    """Give each input of a kernel an identifier: that of its variable, or one that says the side.

    Args:
        expressions: The inputs of one side.
        side: `left` or `right`.
        taken: The identifiers in use; the new ones are added.
    """
    found = []
    for number, expression in enumerate(expressions, 1):
        word = f"{side}{number}"
        if isinstance(expression, Variable):
            word = "".join(c if c.isalnum() and c.isascii() else "_" for c in expression.name[1:])
        while not word.isidentifier() or _is_reserved(word) or word in taken:
            word = f"v{word}" if not word or word[0].isdigit() else f"{word}_"
        taken.add(word)
        found.append(word)
    return found


def _is_reserved(word: str) -> bool:
    """Tell whether generated code uses a name, or names its own parts so: `part_3`."""
    named_so = _NUMBERED.fullmatch(word) is not None
    return named_so or keyword.iskeyword(word) or hasattr(builtins, word) or word in _RESERVED


_NUMBERED = re.compile(r"[a-z]+_\d+")
_RESERVED = frozenset(
    [
        *("np", "dist", "sqrt", "checked", *HELPERS.values()),
        *("slot", "slots", "twin", "twins", "own", "others", "other", "among", "bits", "stride"),
        *("found", "row", "attributes", "derived"),
    ]
)
