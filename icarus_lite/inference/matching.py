"""Conditions against facts: the join behind concepts, skills and goals."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

from icarus_lite.inference.facts import Bindings, FactStore
from icarus_lite.language.functions import evaluate
from icarus_lite.language.syntax import Atom, Call, Condition, Expression, Variable
from icarus_lite.symbols import Belief, Value

Functions: TypeAlias = Mapping[str, Callable[..., Value | bool]]
"""Python predicates registered by name, beside the built-in functions of `:tests`."""


@dataclass(frozen=True, slots=True)
class Evaluator:
    """Evaluates the expressions of one domain.

    Args:
        functions: Python predicates registered by name. They must be pure.
        path: The domain file, to name it in errors.
    """

    functions: Functions = field(default_factory=dict)
    path: str = ""

    def __call__(self, expression: Expression, bindings: Bindings) -> Value | bool:
        """Give an expression's value. Raises InferenceError, with the place, if it has none."""
        return evaluate(expression, bindings, self.functions, path=self.path)


@dataclass(frozen=True, slots=True)
class Match:
    """One way in which conditions hold.

    Args:
        bindings: What the variables are bound to.
        matched: The facts that met the positive conditions, in their order.
        absent: The patterns that nothing matches, as written.
    """

    bindings: Mapping[str, Value]
    matched: tuple[Belief, ...]
    absent: tuple[Atom, ...]


class Matcher:
    """Finds every way in which a conjunction holds.

    Positive conditions are joined in the order written, each test is tried as soon as its
    variables are bound, and negated conditions come last: a variable that is still free then
    occurs only inside its `not` and reads "there is none".
    """

    __slots__ = ("_evaluator", "_negative", "_positive", "_tests_at")

    def __init__(
        self,
        conditions: Sequence[Condition],
        tests: Sequence[Call] = (),
        bound: Sequence[str] = (),
        evaluator: Evaluator | None = None,
    ) -> None:
        self._evaluator = evaluator or Evaluator()
        self._positive = tuple(c.atom for c in conditions if not c.negated)
        self._negative = tuple(c.atom for c in conditions if c.negated)
        known = set(bound)
        waiting = list(tests)
        self._tests_at: list[tuple[Call, ...]] = []
        for atom in (None, *self._positive):
            if atom is not None:
                known.update(atom.variables)
            ready = [test for test in waiting if known.issuperset(variables_of(test))]
            self._tests_at.append(tuple(ready))
            waiting = [test for test in waiting if test not in ready]
        self._tests_at[-1] += tuple(waiting)  # an unbound variable: evaluation says so, with place

    def matches(self, facts: FactStore, bindings: Bindings | None = None) -> Iterator[Match]:
        """Give each match, in a fixed order: that of the facts, the first condition slowest.

        Raises:
            InferenceError: a test compares what cannot be compared.
        """
        yield from self._join(0, facts, dict(bindings or {}), ())

    def _join(
        self, depth: int, facts: FactStore, bindings: dict[str, Value], matched: tuple[Belief, ...]
    ) -> Iterator[Match]:
        for test in self._tests_at[depth]:
            if not self._evaluator(test, bindings):
                return
        if depth < len(self._positive):
            for extended, fact in facts.matches(self._positive[depth], bindings):
                yield from self._join(depth + 1, facts, extended, (*matched, fact))
            return
        for atom in self._negative:
            if any(True for _ in facts.matches(atom, bindings)):
                return
        yield Match(bindings, matched, self._negative)


def variables_of(expression: Expression) -> Iterator[str]:
    """Give the names of the variables of an expression, repeats included."""
    if isinstance(expression, Variable):
        yield expression.name
    elif isinstance(expression, Call):
        for argument in expression.args:
            yield from variables_of(argument)
