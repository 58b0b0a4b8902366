"""The ways in which one clause derives a belief, and what a row of its join says of one of them.

A row holds the values of the variables in the arguments of the conditions; all else follows from
it. What is the same for every row is worked out once, when the clause is first asked.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import partial
from typing import Any, TypeAlias

from icarus_lite.inference.canonical import canonical
from icarus_lite.inference.network.bodies import Body
from icarus_lite.inference.network.design import Head, Keeping
from icarus_lite.inference.network.running import Running
from icarus_lite.inference.supports import Derivation
from icarus_lite.inference.views import Row, row_getter
from icarus_lite.language.functions import as_value
from icarus_lite.language.syntax import Atom, ConceptClause, Constant, Term, Variable
from icarus_lite.records import dataclass
from icarus_lite.symbols import Belief, Value

_Fetch: TypeAlias = Callable[[Row], Belief | None]
"""Gives the fact with these arguments."""

_Absence: TypeAlias = tuple[Atom, tuple[str | None, ...], tuple[str | None, ...]]
"""A negated pattern; for each argument and attribute the variable that is bound there, if any."""


@dataclass(frozen=True, slots=True)
class _Premise:
    """A positive condition: how the fact that met it is found again, and what it binds.

    Args:
        args: Picks the fact's arguments out of a row and the constants behind it.
        fetch: Gives the fact.
        bound: The variables that occur first among its arguments, with their places in a row.
        attributes: The variables that occur first among its attributes, with their names there.
    """

    args: Callable[[Row], Row]
    fetch: _Fetch
    bound: tuple[tuple[str, int], ...]
    attributes: tuple[tuple[str, str], ...]


class Ways:
    """One clause of a network at work.

    Args:
        head: Its concept.
        body: The clause, taken apart.
        running: The network.

    Attributes:
        rows: Gives a row for each way to derive a belief with these arguments.
    """

    __slots__ = ("_absences", "_clause", "_constants", "_order", "_premises", "_running", "rows")

    def __init__(self, head: Head, body: Body, running: Running) -> None:
        variables = running.compiled.module.wiring.proofs[body.number]
        self.rows: Callable[..., Iterator[Row]] = running.functions[
            f"prove_{head.facts.name}_{body.number + 1}"
        ]
        self._running, self._clause = running, body.clause
        self._premises, self._constants = _premises(body.clause, variables, running)
        order = tuple(place for premise in self._premises for _, place in premise.bound)
        self._order = row_getter(order)
        bound = {name for p in self._premises for name, _ in (*p.bound, *p.attributes)}
        bound |= {bind.variable.name for bind in body.clause.binds}
        self._absences = tuple(
            _absence(condition.atom, bound)
            for condition in body.clause.elements
            if condition.negated
        )

    def rank(self, row: Row) -> tuple[tuple[Any, ...], ...]:
        """Give what rows are ordered by: their values as the conditions name them."""
        return canonical(self._order(row))

    def derivation(self, row: Row) -> Derivation:
        """Give the derivation that a row stands for."""
        cells = row + self._constants
        bindings: dict[str, Value] = {}
        matched = []
        for premise in self._premises:
            fact = premise.fetch(premise.args(cells))
            assert fact is not None  # the row was just joined
            matched.append(fact)
            for name, place in premise.bound:
                bindings[name] = row[place]
            for name, attribute in premise.attributes:
                bindings[name] = fact.attributes[attribute]
        if self._clause.binds:
            _compute(self._clause, bindings, self._running)
        absent = tuple([_bound(each, bindings) for each in self._absences])
        return Derivation(self._clause, bindings, tuple(matched), absent)


def _premises(
    clause: ConceptClause, variables: tuple[str, ...], running: Running
) -> tuple[tuple[_Premise, ...], Row]:
    """Give the positive conditions of a clause, and the constants among their arguments."""
    places = {name: place for place, name in enumerate(variables)}
    constants: list[Value] = []
    found = []
    seen: set[str] = set()
    for atom in (condition.atom for condition in clause.elements if not condition.negated):
        picked, bound, attributes = [], [], []
        for term in atom.args:
            if isinstance(term, Constant):
                picked.append(len(variables) + len(constants))
                constants.append(term.value)
                continue
            picked.append(places[term.name])
            if term.name not in seen:
                seen.add(term.name)
                bound.append((term.name, places[term.name]))
        for name, term in atom.attributes:
            if isinstance(term, Variable) and term.name not in seen:
                seen.add(term.name)
                attributes.append((term.name, name))
        fetch = _fetching(atom.predicate, len(atom.args), running)
        found.append(_Premise(row_getter(tuple(picked)), fetch, tuple(bound), tuple(attributes)))
    return tuple(found), tuple(constants)


def _fetching(predicate: str, arity: int, running: Running) -> _Fetch:
    """Give what gives the facts of a kind, in the quickest way that is right for all of them."""
    head = running.heads.get((predicate, arity))
    if head is not None and head.keeping not in (Keeping.ATTRIBUTED, Keeping.RECOMPUTED):
        return partial(_plain, predicate)
    any_fact = partial(running.fact, predicate)
    if head is not None or arity != 1:
        return any_fact
    objects = running.objects

    def seen(args: Row) -> Belief | None:
        attributes = objects.get(predicate, _NOBODY).get(args[0])
        return any_fact(args) if attributes is None else Belief(predicate, args, dict(attributes))

    return seen


def _plain(predicate: str, args: Row) -> Belief:
    return Belief(predicate, args, _NO_ATTRIBUTES)


_NOBODY: Mapping[Value, Mapping[str, Value]] = {}
_NO_ATTRIBUTES: Mapping[str, Value] = {}


def _compute(clause: ConceptClause, bindings: dict[str, Value], running: Running) -> None:
    evaluator = running.compiled.design.vocabulary.evaluator
    for bind in clause.binds:
        bindings[bind.variable.name] = as_value(
            evaluator(bind.expression, bindings), bind.expression, evaluator.path
        )


def _absence(atom: Atom, bound: set[str]) -> _Absence:
    def name(term: Term) -> str | None:
        return term.name if isinstance(term, Variable) and term.name in bound else None

    return atom, tuple(map(name, atom.args)), tuple(name(term) for _, term in atom.attributes)


def _bound(absence: _Absence, bindings: dict[str, Value]) -> Atom:
    """Give a negated pattern with its bound variables replaced; the others mean "any"."""
    atom, args, attributes = absence
    return Atom(
        atom.predicate,
        tuple(
            [
                term if name is None else Constant(bindings[name], term.span)
                for term, name in zip(atom.args, args, strict=True)
            ]
        ),
        tuple(
            [
                (key, term if name is None else Constant(bindings[name], term.span))
                for (key, term), name in zip(atom.attributes, attributes, strict=True)
            ]
        ),
        atom.span,
    )
