"""Whether a pair of objects meets the tests of a rule, asked the way the language defines it.

This is the one account of what a pair rule means. The fast kernels answer the ordinary case and
hand whatever is out of the ordinary to it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeAlias

from icarus_lite.inference.expressions import compile_expression, conjoin
from icarus_lite.inference.network.kernels.columns import Columns
from icarus_lite.language.functions import NO_FUNCTIONS
from icarus_lite.language.syntax import Call, Expression, Variable
from icarus_lite.records import dataclass

ExactTest: TypeAlias = Callable[[int, int], bool]
"""Tells whether the objects in a left and a right slot meet the tests; raises InferenceError."""


@dataclass(frozen=True, slots=True)
class PairSide:
    """One of the two percept patterns of a pair rule.

    Args:
        name: The variable that stands for the object itself, or None.
        attributes: Each variable that stands for the value of an attribute, with that attribute.
            An object that lacks one of these attributes is absent for the rule.
    """

    name: str | None
    attributes: tuple[tuple[str, str], ...]

    @property
    def variables(self) -> frozenset[str]:
        """The variables that this side binds."""
        names = {variable for variable, _ in self.attributes}
        return frozenset(names if self.name is None else names | {self.name})


def variables_of(expression: Expression) -> frozenset[str]:
    """Give the names of the variables in an expression."""
    if isinstance(expression, Variable):
        return frozenset((expression.name,))
    if isinstance(expression, Call):
        return frozenset().union(*(variables_of(each) for each in expression.args))
    return frozenset()


def in_turn(left: PairSide, tests: Sequence[Call]) -> tuple[Call, ...]:
    """Give the tests in the order in which a join asks them.

    What the left object alone answers is asked before the right one is looked for; the rest
    follows as written.
    """
    known = left.variables
    first = [test for test in tests if variables_of(test) <= known]
    return (*first, *(test for test in tests if not variables_of(test) <= known))


def exact_test(
    sides: tuple[PairSide, PairSide],
    columns: tuple[Columns, Columns],
    tests: Sequence[Call],
    path: str,
) -> ExactTest:
    """Compile the tests over two sets of columns.

    Args:
        sides: The left and the right pattern.
        columns: Where their objects are.
        tests: The tests, in the order in which they are asked.
        path: The domain file, to name it in errors.
    """
    slots: dict[str, int] = {}
    for side in sides:
        for variable in (side.name, *(name for name, _ in side.attributes)):
            if variable is not None:
                slots.setdefault(variable, len(slots))
    readers = [
        (place, on_left, source)
        for side, table, on_left in ((sides[1], columns[1], False), (sides[0], columns[0], True))
        for place, source in _sources(side, table, slots)
    ]
    width = len(slots)
    test = conjoin([compile_expression(each, slots, NO_FUNCTIONS, path) for each in tests])

    def holds(left: int, right: int) -> bool:
        if test is None:
            return True
        row: list[object] = [None] * width
        for place, on_left, source in readers:
            row[place] = source[left if on_left else right]
        return bool(test(tuple(row)))  # type: ignore[arg-type] # no None is left where one is read

    return holds


def _sources(
    side: PairSide, columns: Columns, slots: dict[str, int]
) -> list[tuple[int, Sequence[object]]]:
    found: list[tuple[int, Sequence[object]]] = []
    if side.name is not None:
        found.append((slots[side.name], columns.names))
    found += [(slots[variable], columns.column(name)) for variable, name in side.attributes]
    return found
