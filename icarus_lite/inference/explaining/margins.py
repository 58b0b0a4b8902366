"""By how much a numeric test fails: what makes one failure nearer than another."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import TypeAlias

from icarus_lite.errors import InferenceError
from icarus_lite.inference.evaluator import Evaluator
from icarus_lite.inference.expressions import compile_expression
from icarus_lite.inference.views import Row
from icarus_lite.language.syntax import Call

Margin: TypeAlias = Callable[[Row], float]
"""How far the values of a row are from meeting a test; 0 or more, infinite where it cannot be
said."""

_FALLING = frozenset({"<", "<="})
_COMPARISONS = frozenset({"<", "<=", ">", ">=", "="})


def margin_of(test: Call, slots: Mapping[str, int], evaluator: Evaluator) -> Margin | None:
    """Give how far a comparison is from being met; None for a test of another kind.

    The margin of `(< a b c)` is the largest of what a exceeds b by and b exceeds c by.
    """
    if test.function not in _COMPARISONS or len(test.args) < 2:
        return None
    sides = [compile_expression(a, slots, evaluator.functions, evaluator.path) for a in test.args]
    sign = 1 if test.function in _FALLING else -1
    absolute = test.function == "="

    def margin(row: Row) -> float:
        widest = 0.0
        try:
            values = [side(row) for side in sides]
            for i in range(len(values) - 1):
                step = sign * (values[i] - values[i + 1])  # type: ignore[operator] # see below
                widest = max(widest, abs(step) if absolute else step)
        except (InferenceError, TypeError):  # a side is free, a symbol, or has no value
            return math.inf
        return widest

    return margin
