"""From an attempt to reasons: what is behind each condition that is not met."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from typing import Final

from icarus_lite.errors import InferenceError
from icarus_lite.inference.evaluator import Evaluator
from icarus_lite.inference.explaining.conjunctions import Checked, Standing
from icarus_lite.inference.explaining.context import Context
from icarus_lite.inference.explaining.lookup import Facts, matching
from icarus_lite.inference.explaining.reasons import (
    Blocked,
    Blocker,
    Difference,
    FailedTest,
    Missing,
    Reason,
    Unasked,
)
from icarus_lite.inference.facts import Bindings
from icarus_lite.language.syntax import Atom, Call, Constant, Term, Variable
from icarus_lite.symbols import Belief, Value

NEAREST: Final = 3
"""How many beliefs are shown beside one that is missing, and of those that block a `not`."""

MOST_COMPARED: Final = 500
"""How many facts of a predicate are looked at to find the nearest."""


def diagnose(checked: Checked, bindings: Bindings, context: Context) -> Reason:
    """Give the reason for which a condition of an attempt is not met.

    Args:
        checked: The condition; it is not met.
        bindings: The values of the attempt.
        context: What the attempt was made in.
    """
    condition, bound = checked.condition, checked.bound
    if checked.standing is Standing.OPEN:
        return Unasked(bound)
    if isinstance(condition, Call):
        return _failed_test(checked, bindings, context.evaluator)
    assert not isinstance(bound, Call)
    if condition.negated:
        return blocked(bound.atom, context)
    return _missing(bound.atom, checked.fact, context)


def _missing(pattern: Atom, namesake: Belief | None, context: Context) -> Missing:
    if namesake is not None:
        return Missing(pattern, namesake, tuple(_differences(pattern, namesake)))
    remark = context.remark(pattern)
    nearest = () if remark else nearest_beliefs(pattern, context.facts)
    return Missing(pattern, nearest=nearest, remark=remark)


def _differences(pattern: Atom, fact: Belief) -> Iterator[Difference]:
    for name, term in pattern.attributes:
        wanted = term.value if isinstance(term, Constant) else None
        found = fact.attributes.get(name)
        if found is None or (wanted is not None and wanted != found):
            yield Difference(name, wanted, found)


def _failed_test(checked: Checked, bindings: Bindings, evaluator: Evaluator) -> FailedTest:
    test, bound = checked.condition, checked.bound
    assert isinstance(test, Call)
    assert isinstance(bound, Call)
    if checked.error:
        return FailedTest(bound, bound, error=checked.error)
    while test.function == "and":
        place = next(n for n, part in enumerate(test.args) if not evaluator(part, bindings))
        part, part_bound = test.args[place], bound.args[place]
        if not isinstance(part, Call) or not isinstance(part_bound, Call):
            break
        test, bound = part, part_bound
    sides = _values(test, bindings, evaluator)
    assert isinstance(checked.bound, Call)
    return FailedTest(checked.bound, bound, sides)


def _values(test: Call, bindings: Bindings, evaluator: Evaluator) -> tuple[Value | bool, ...]:
    """Give what the arguments of a test come to; nothing if one that was not needed has none."""
    try:
        return tuple(evaluator(each, bindings) for each in test.args)
    except InferenceError:  # behind the part of an `or` that nobody asks
        return ()


def blocked(pattern: Atom, context: Context) -> Blocked:
    """Collect what stands in the way of a `not`, each with its first support."""
    found = sorted(matching(pattern, context.facts), key=str)
    shown = tuple(Blocker(fact, context.support(fact)) for fact in found[:NEAREST])
    return Blocked(pattern, shown, len(found) - len(shown))


def nearest_beliefs(asked: Atom, facts: Facts, most: int = NEAREST) -> tuple[Belief, ...]:
    """Give the facts of the same predicate that agree with a pattern in most places.

    If enough share an argument with it, only those are compared. Of a predicate with very many
    facts only the first 500 of them are.
    """
    same = _sharing(asked, facts)
    if len(same) < most:
        rows = islice(facts.rows(asked.predicate).values(), MOST_COMPARED)
        same = [fact for ((_, fact, _),) in rows]
    return tuple(sorted(same, key=lambda fact: (-_agreement(asked, fact), str(fact)))[:most])


def _sharing(asked: Atom, facts: Facts) -> list[Belief]:
    """Give the facts that have one of a pattern's constants in the same place."""
    found: dict[Belief, None] = {}
    for place, term in enumerate(asked.args):
        if isinstance(term, Constant):
            args: list[Term] = [Variable(f"?{n}") for n in range(len(asked.args))]
            args[place] = term
            found |= dict.fromkeys(matching(Atom(asked.predicate, tuple(args)), facts))
    return list(found)


def _agreement(asked: Atom, fact: Belief) -> int:
    pairs = [*zip(asked.args, fact.args, strict=False)]
    pairs += [(term, fact.attributes.get(name, "")) for name, term in asked.attributes]
    return sum(isinstance(term, Constant) and term.value == value for term, value in pairs)
