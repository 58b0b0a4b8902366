"""Conjunctions as they are asked, and what became of each condition in an attempt."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from enum import StrEnum

from icarus_lite.inference.facts import Bindings
from icarus_lite.inference.supports import Literal
from icarus_lite.language.syntax import Call, Condition, variables_of
from icarus_lite.records import dataclass
from icarus_lite.symbols import Belief, Value


class Standing(StrEnum):
    """What became of a condition in an attempt."""

    MET = "met"
    FAILED = "failed"
    OPEN = "open"  # it could not be asked: a variable in it was bound by nothing


@dataclass(frozen=True, slots=True)
class Checked:
    """A condition or test of a conjunction as an attempt left it.

    Args:
        condition: As the domain states it.
        bound: With the values of the attempt filled in.
        standing: What became of it.
        fact: What met it; for a `not` that failed, what is in its way; for a pattern that failed,
            the fact with the same arguments and other attributes, if there is one.
        error: Why a test has no value, if it has none.
    """

    condition: Literal
    bound: Literal
    standing: Standing
    fact: Belief | None = None
    error: str = ""


@dataclass(frozen=True, slots=True)
class Attempt:
    """The way to meet a conjunction that comes closest.

    Args:
        checked: All conditions and tests, in the order in which inference asks them.
        bindings: The values of the variables that are bound.
        complete: Whether every way was considered; False where the search was cut off.
    """

    checked: tuple[Checked, ...]
    bindings: Mapping[str, Value]
    complete: bool

    @property
    def holds(self) -> bool:
        """Whether all of it is met."""
        return self.failure is None

    @property
    def failure(self) -> Checked | None:
        """The first condition that is not met."""
        return next((each for each in self.checked if each.standing is not Standing.MET), None)

    @property
    def met(self) -> int:
        """How many conditions and tests are met."""
        return sum(each.standing is Standing.MET for each in self.checked)


def in_order(
    conditions: Sequence[Condition], tests: Sequence[Call], given: Bindings
) -> tuple[Literal, ...]:
    """Put conditions and tests into the order in which inference asks them.

    The positive conditions as written, each test as soon as its variables are bound, then the
    negated conditions.
    """
    order: list[Literal] = []
    known, waiting = set(given), list(tests)
    for condition in (None, *(c for c in conditions if not c.negated)):
        if condition is not None:
            order.append(condition)
            known.update(condition.atom.variables)
        ready = [test for test in waiting if known.issuperset(variables_of(test))]
        order += ready
        waiting = [test for test in waiting if test not in ready]
    return (*order, *waiting, *(c for c in conditions if c.negated))


def is_positive(literal: Literal) -> bool:
    """Tell whether it is a condition that something has to match."""
    return isinstance(literal, Condition) and not literal.negated


def variables_in(literal: Literal) -> Sequence[str]:
    """Give the names of its variables, repeats included."""
    return tuple(variables_of(literal)) if isinstance(literal, Call) else literal.atom.variables
