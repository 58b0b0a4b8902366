"""A store of ground facts, looked up by predicate and arguments."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Iterator, Mapping, Sequence
from types import MappingProxyType

from icarus_lite.errors import FrameError
from icarus_lite.inference.views import Entry, Index, Key, View
from icarus_lite.language.syntax import Atom, Term, Variable
from icarus_lite.symbols import Action, Belief, Percept, Value, is_number

Bindings = Mapping[str, Value]
"""What each variable, `?` included, is bound to."""


Lineages = Mapping[str, Sequence[str]]
"""Each percept type with all types that its percepts belong to, its own first."""

_NO_ROWS: Mapping[Key, Sequence[Entry]] = MappingProxyType({})


def percept_fact(percept: Percept) -> Belief:
    """Give a percept as a fact: its type is the predicate, its name the one argument."""
    return Belief(percept.type, (percept.name,), percept.attributes)


def percept_facts(percepts: Iterable[Percept], lineages: Lineages) -> Iterator[Belief]:
    """Give percepts as facts, each once for every type that it belongs to.

    A percept of a subtype, `(part :is object)`, is a percept of its supertypes as well, with the
    same name and attributes.
    """
    for percept in percepts:
        yield percept_fact(percept)
        for supertype in lineages.get(percept.type, ())[1:]:
            yield Belief(supertype, (percept.name,), percept.attributes)


def check_values(percept: Percept) -> None:
    """See that every attribute of a percept is a symbol or a finite number.

    Raises:
        FrameError: one is not; the message names it.
    """
    for attribute, value in percept.attributes.items():
        if not isinstance(value, str) and not is_number(value):
            raise FrameError(f"attribute {attribute} of {percept.name} is {_fault(value)}")


def check_arguments(action: Action) -> None:
    """See that every argument of an action is a symbol or a finite number.

    Raises:
        FrameError: one is not; the message names it.
    """
    for place, value in enumerate(action.args, 1):
        if not isinstance(value, str) and not is_number(value):
            raise FrameError(f"argument {place} of {action.name} is {_fault(value)}")


def _fault(value: object) -> str:
    number = isinstance(value, int | float) and not isinstance(value, bool)
    return f"{value!r}, {'not finite' if number else 'neither a number nor a symbol'}"


def with_values(facts: Iterable[Belief]) -> frozenset[Hashable]:
    """Give what is the same for two collections only if they agree in attributes as well.

    Beliefs themselves are the same by predicate and arguments.
    """
    return frozenset(
        (fact, frozenset(fact.attributes.items())) if fact.attributes else fact for fact in facts
    )


class FactStore:
    """Ground facts by predicate, in the order in which they came to be believed.

    Each fact has a number, counting up over the whole store, so that "new since then" is a
    question of numbers. Hash indexes are built when a view is first asked for, and kept up to date
    from then on.
    """

    __slots__ = ("_facts", "_indexes", "_indexes_of", "count")

    def __init__(self, facts: Iterable[Belief] = ()) -> None:
        self.count = 0
        self._facts: dict[str, dict[Key, Sequence[Entry]]] = {}
        self._indexes: dict[View, Index] = {}
        self._indexes_of: dict[str, list[tuple[View, Index]]] = {}
        for fact in facts:
            self.add(fact)

    def add(self, fact: Belief) -> bool:
        """Add a fact; tell whether it is new. A fact already there keeps its attributes."""
        rows = self._facts.get(fact.predicate)
        if rows is None:
            rows = self._facts[fact.predicate] = {}
        elif fact.args in rows:
            return False
        rows[fact.args] = (((), fact, self.count),)
        for view, index in self._indexes_of.get(fact.predicate, ()):
            view.insert(index, fact, self.count)
        self.count += 1
        return True

    def __contains__(self, fact: Belief) -> bool:
        return fact.args in self._facts.get(fact.predicate, ())

    def __iter__(self) -> Iterator[Belief]:
        for rows in self._facts.values():
            for ((_, fact, _),) in rows.values():
                yield fact

    def rows(self, predicate: str) -> Mapping[Key, Sequence[Entry]]:
        """Give the facts of a predicate by all their arguments, as entries that bind nothing."""
        return self._facts.get(predicate, _NO_ROWS)

    def index(self, view: View) -> Mapping[Key, Sequence[Entry]]:
        """Give the hash index of a view, built now unless it was asked for before."""
        index = self._indexes.get(view)
        if index is None:
            index = self._indexes[view] = {}
            for ((_, fact, number),) in self.rows(view.predicate).values():
                view.insert(index, fact, number)
            self._indexes_of.setdefault(view.predicate, []).append((view, index))
        return index

    def candidates(self, atom: Atom, bindings: Bindings) -> Iterable[Belief]:
        """Give the facts that may match a pattern: one if its arguments are known, else all."""
        rows = self.rows(atom.predicate)
        args = tuple(resolve(term, bindings) for term in atom.args)
        if all(value is not None for value in args):
            found = rows.get(args, ())  # type: ignore[arg-type] # no None is left in args
            return tuple(fact for _, fact, _ in found)
        return tuple(fact for ((_, fact, _),) in rows.values())

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
