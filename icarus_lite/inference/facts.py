"""A store of ground facts, looked up by predicate and arguments."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from icarus_lite.language.syntax import Atom, Term, Variable
from icarus_lite.symbols import Belief, Percept, Value

Bindings = Mapping[str, Value]
"""What each variable, `?` included, is bound to."""


def percept_fact(percept: Percept) -> Belief:
    """Give a percept as a fact: its type is the predicate, its name the one argument."""
    return Belief(percept.type, (percept.name,), percept.attributes)


class FactStore:
    """Ground facts by predicate, in the order in which they came to be believed."""

    __slots__ = ("_facts",)

    def __init__(self, facts: Iterable[Belief] = ()) -> None:
        self._facts: dict[str, dict[tuple[Value, ...], Belief]] = {}
        for fact in facts:
            self.add(fact)

    def add(self, fact: Belief) -> bool:
        """Add a fact; tell whether it is new. A fact already there keeps its attributes."""
        rows = self._facts.setdefault(fact.predicate, {})
        if fact.args in rows:
            return False
        rows[fact.args] = fact
        return True

    def __contains__(self, fact: Belief) -> bool:
        return fact.args in self._facts.get(fact.predicate, ())

    def __iter__(self) -> Iterator[Belief]:
        for rows in self._facts.values():
            yield from rows.values()

    def candidates(self, atom: Atom, bindings: Bindings) -> Iterable[Belief]:
        """Give the facts that may match a pattern: one if its arguments are known, else all."""
        rows = self._facts.get(atom.predicate)
        if rows is None:
            return ()
        args = tuple(resolve(term, bindings) for term in atom.args)
        if all(value is not None for value in args):
            fact = rows.get(args)  # type: ignore[arg-type] # no None is left in args
            return () if fact is None else (fact,)
        return tuple(rows.values())

    def matches(self, atom: Atom, bindings: Bindings) -> Iterator[tuple[dict[str, Value], Belief]]:
        """Give each fact that matches a pattern, with the bindings extended by the match."""
        for fact in self.candidates(atom, bindings):
            extended = match(atom, fact, bindings)
            if extended is not None:
                yield extended, fact


def resolve(term: Term, bindings: Bindings) -> Value | None:
    """Give a term's value, or None for a variable that is still free."""
    return bindings.get(term.name) if isinstance(term, Variable) else term.value


def match(atom: Atom, fact: Belief, bindings: Bindings) -> dict[str, Value] | None:
    """Match a pattern with a fact; give the extended bindings, or None.

    A pattern names any subset of the fact's attributes, in any order; an attribute that the fact
    lacks does not match.
    """
    if atom.predicate != fact.predicate or len(atom.args) != len(fact.args):
        return None
    pairs: list[tuple[Term, Value]] = list(zip(atom.args, fact.args, strict=True))
    for name, term in atom.attributes:
        if name not in fact.attributes:
            return None
        pairs.append((term, fact.attributes[name]))
    return unify(pairs, bindings)


def unify(
    pairs: Iterable[tuple[Term, Value]], bindings: Bindings | None = None
) -> dict[str, Value] | None:
    """Bind terms to values; give the extended bindings, or None where one disagrees."""
    extended = dict(bindings or {})
    for term, value in pairs:
        if isinstance(term, Variable):
            if extended.setdefault(term.name, value) != value:
                return None
        elif term.value != value:
            return None
    return extended


def ground(atom: Atom, bindings: Bindings) -> Belief | None:
    """Give a pattern as a fact under bindings, or None if a variable of it is still free."""
    args = tuple(resolve(term, bindings) for term in atom.args)
    attributes = {name: resolve(term, bindings) for name, term in atom.attributes}
    if any(value is None for value in (*args, *attributes.values())):
        return None
    return Belief(atom.predicate, args, attributes)  # type: ignore[arg-type] # checked above
