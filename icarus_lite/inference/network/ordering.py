"""Join orders: what of a body to look up first, given what is bound already.

The order is chosen once, at compile time, by an estimate: a scene of fifty objects, a constant met
by one object in four, a comparison by one pair in two, a bounded distance by one in twenty. Only
the proportions matter. A condition with all of its key bound comes first, as it can only lose
rows; then the one that is expected to give the fewest. Negations are asked as soon as their
variables are bound, tests as soon as they may be.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from enum import StrEnum
from typing import TypeAlias

from icarus_lite.inference.network.bodies import Body, Literal, Negation, Test
from icarus_lite.inference.network.relations import Facts, Pairs, Relation, View
from icarus_lite.language.syntax import Call, Constant, Expression, Term, variables_of
from icarus_lite.records import dataclass

_OBJECTS = 50.0
_GIVEN = 20.0
_CONSTANT = 0.25
_COMPARISON = 0.5
_BOUNDED = 0.05
_KERNEL = 10.0


class Access(StrEnum):
    """How the rows of a relation are found."""

    MEMBER = "member"  # every cell is known and the key is all there is: is it there?
    GET = "get"  # the key is known: at most one row
    INDEX = "index"  # some cells are known: a hash index on them
    SCAN = "scan"  # nothing is known: all rows


@dataclass(frozen=True, slots=True)
class Find:
    """Look rows up.

    Args:
        literal: The condition.
        access: How.
        bound: The cells whose values are known beforehand, and looked up by.
        estimate: How many rows are expected for each that comes in.
    """

    literal: Literal
    access: Access
    bound: tuple[int, ...]
    estimate: float


@dataclass(frozen=True, slots=True)
class Ask:
    """Ask a test."""

    test: Test


@dataclass(frozen=True, slots=True)
class Absent:
    """See that there is no such row.

    Args:
        negation: The condition.
        access: How it is looked up.
        bound: The cells whose values are known.
    """

    negation: Negation
    access: Access
    bound: tuple[int, ...]


Step: TypeAlias = Find | Ask | Absent


def arrange(
    body: Body,
    sizes: Mapping[Relation, float],
    bound: Iterable[str] = (),
    leading: Literal | None = None,
    without: Negation | None = None,
) -> tuple[Step, ...]:
    """Give the steps that join a body.

    Args:
        body: The clause taken apart.
        sizes: How many rows each relation is expected to have.
        bound: The variables whose values are known beforehand.
        leading: A literal whose row is known already.
        without: A negation that is not to be asked.
    """
    known = set(bound)
    waiting = [each for each in body.literals if each is not leading]
    tests = list(body.tests)
    negations = [each for each in body.negations if each is not without]
    positive = {v for each in body.literals for t in each.terms for v in variables_of(t)}
    done: set[int] = set(leading.places) if leading is not None else set()
    steps: list[Step] = []

    def settle() -> None:
        for test in [t for t in tests if t.needs <= known and t.after <= done]:
            tests.remove(test)
            steps.append(Ask(test))
        for negation in list(negations):
            outer = {v for t in negation.terms for v in variables_of(t)} & positive
            if outer <= known:
                negations.remove(negation)
                steps.append(_absent(negation, known))

    settle()
    while waiting:
        finds = [_find(each, known, sizes) for each in waiting]
        best = min(range(len(finds)), key=lambda i: (_rank(finds[i]), i))
        literal = waiting.pop(best)
        steps.append(finds[best])
        known.update(v for term in literal.terms for v in variables_of(term))
        done |= literal.places
        settle()
    steps.extend(Ask(test) for test in tests)
    return tuple(steps)


def _rank(find: Find) -> tuple[int, float]:
    """Rank what can only lose rows first, by what it costs to lose one; then by the rows expected.

    To ask a kernel for one pair costs some ten times as much as to look into a dictionary.
    """
    if find.access not in (Access.MEMBER, Access.GET):
        return 1, find.estimate
    cost = _KERNEL if isinstance(find.literal.relation, Pairs) else 1.0
    return 0, cost / max(1.0 - find.estimate, 0.01)


def _find(literal: Literal, known: set[str], sizes: Mapping[Relation, float]) -> Find:
    bound = bound_cells(literal.terms, known)
    access = access_to(literal.relation, bound)
    return Find(literal, access, bound, _rows(literal.relation, bound, sizes))


def _absent(negation: Negation, known: set[str]) -> Absent:
    bound = bound_cells(negation.terms, known)
    return Absent(negation, access_to(negation.relation, bound), bound)


def bound_cells(terms: Sequence[Term], known: Iterable[str]) -> tuple[int, ...]:
    """Give the cells whose values are known: constants, and variables bound before."""
    names = frozenset(known)
    return tuple(
        cell for cell, term in enumerate(terms) if isinstance(term, Constant) or term.name in names
    )


def access_to(relation: Relation, bound: tuple[int, ...]) -> Access:
    """Say how rows of a relation are found by these cells."""
    if set(range(relation.keys)) <= set(bound):
        return Access.GET if relation.values else Access.MEMBER
    return Access.INDEX if bound else Access.SCAN


def _rows(relation: Relation, bound: tuple[int, ...], sizes: Mapping[Relation, float]) -> float:
    size = sizes.get(relation, _GIVEN)
    if set(range(relation.keys)) <= set(bound):
        return min(1.0, size / _OBJECTS**relation.keys)
    return size / min(size, _OBJECTS) ** len(bound)


def expected_sizes(bodies: Iterable[Body]) -> dict[Relation, float]:
    """Estimate how many rows each relation has; bodies come bottom first."""
    sizes: dict[Relation, float] = {}
    totals: dict[tuple[str, int], float] = {}
    of_kind: dict[tuple[str, int], list[Relation]] = {}
    for body in bodies:
        for relation in body.relations:
            if relation in sizes:
                continue
            if isinstance(relation, Facts):
                kind = relation.predicate, relation.arity
                sizes[relation] = totals.get(kind, _GIVEN)
                of_kind.setdefault(kind, []).append(relation)
            else:
                sizes[relation] = _base_size(relation)
        head = body.clause.head
        kind = head.predicate, len(head.args)
        rows = 1.0
        for step in arrange(body, sizes):
            if isinstance(step, Find):
                rows *= step.estimate
            elif isinstance(step, Ask):
                rows *= selectivity(step.test.call)
            else:
                rows *= _COMPARISON
        most = max(_OBJECTS ** len(head.args), 1.0)
        totals[kind] = min(totals.get(kind, 0.0) + max(rows, 1.0), most)
        for relation in of_kind.get(kind, ()):
            sizes[relation] = totals[kind]
    return sizes


def _base_size(relation: View | Pairs) -> float:
    if isinstance(relation, View):
        size = _OBJECTS * _CONSTANT ** len(relation.constants)
        for test in relation.tests:
            size *= selectivity(test)
        return size
    size = _base_size(relation.left) * _base_size(relation.right)
    for test in relation.tests:
        size *= selectivity(test)
    return size


def selectivity(call: Call) -> float:
    """Estimate which share of rows a test lets through."""
    if call.function == "=":
        return _CONSTANT
    if call.function in ("<", "<=") and _measures(call.args[0]):
        return _BOUNDED
    if call.function in (">", ">=") and _measures(call.args[-1]):
        return _BOUNDED
    if call.function == "and":
        share = 1.0
        for argument in call.args:
            share *= selectivity(argument) if isinstance(argument, Call) else _COMPARISON
        return share
    return 1.0 if call.function == "/=" else _COMPARISON


def _measures(expression: Expression) -> bool:
    """Tell whether an expression looks like a distance: something that is small only near by."""
    if not isinstance(expression, Call):
        return False
    if expression.function in ("distance", "abs"):
        return True
    if expression.function == "*" and len(expression.args) == 2:
        one, other = expression.args
        return (isinstance(one, Call) and one == other) or _measures(one) or _measures(other)
    return expression.function in ("+", "max", "sqrt") and any(map(_measures, expression.args))
