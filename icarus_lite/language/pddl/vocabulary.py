"""The names, types and predicates of an exported problem, as its parts come to need them."""

from __future__ import annotations

from collections.abc import Iterable

from icarus_lite.language.pddl.kinds import Kinds
from icarus_lite.language.pddl.names import Names, pddl_word
from icarus_lite.language.pddl.syntax import OBJECT, Fact, Predicate, Typed, ancestors
from icarus_lite.language.pddl.values import PossibleValues
from icarus_lite.language.syntax import Constant, Domain, Term
from icarus_lite.records import dataclass, field
from icarus_lite.symbols import Belief, Value

_RESERVED = (
    "and",
    "either",
    "exists",
    "forall",
    "imply",
    "not",
    "number",
    "object",
    "or",
    "problem",
    "total-cost",
    "when",
)


@dataclass(slots=True)
class PddlVocabulary:
    """Names and types that the translation has asked for so far.

    All things share one set of names, for some planners insist on it.

    Args:
        kinds: What becomes of each predicate.
        values: Which values arguments can take.
        above: The type above each PDDL type.
        type_of: The PDDL type of each object.
        objects: The objects spoken of, in the order in which they came up.
        constants: Those that the domain itself speaks of.
        rows: For each predicate made for the export, the tuples it is true of.
    """

    kinds: Kinds
    values: PossibleValues
    above: dict[str, str] = field(default_factory=dict)
    type_of: dict[Value, str] = field(default_factory=dict)
    objects: dict[Value, None] = field(default_factory=dict)
    constants: dict[Value, None] = field(default_factory=dict)
    rows: dict[str, tuple[tuple[Value, ...], ...]] = field(default_factory=dict)
    _names: Names = field(default_factory=lambda: Names(_RESERVED))
    _used: dict[str, list[list[str]]] = field(default_factory=dict)
    _sources: dict[str, str] = field(default_factory=dict)

    def declare_types(self, domain: Domain, facts: Iterable[Belief]) -> None:
        """Take in the percept types that become types, and the objects perceived as such."""
        above = {each.name: each.supertype for each in domain.percepts}
        for name in above:
            if name in self.kinds.types:
                self._type_name(name)
        for name, parent in above.items():
            if name in self.kinds.types:
                known = parent is not None and parent in self.kinds.types
                self.above[self._type_name(name)] = (
                    self._type_name(parent) if known and parent else OBJECT
                )
        for fact in facts:
            if fact.predicate in self.kinds.types and len(fact.args) == 1:
                ours, known_type = self._type_name(fact.predicate), self.type_of.get(fact.args[0])
                if known_type is None or known_type in ancestors(self.above, ours):
                    self.type_of[fact.args[0]] = ours

    def _type_name(self, name: str) -> str:
        return self._names.of(("type", name), pddl_word("thing" if name == OBJECT else name, "t"))

    def types(self) -> tuple[Typed, ...]:
        """Give the types that have objects here, and those above them."""
        needed = {
            t for each in self.objects for t in ancestors(self.above, self.type_of_value(each))
        }
        for columns in self._used.values():
            needed.update(
                t for column in columns for name in column for t in ancestors(self.above, name)
            )
        return tuple(Typed(name, above) for name, above in self.above.items() if name in needed)

    def type_of_value(self, value: Value) -> str:
        """Give an object's PDDL type."""
        return self.type_of.get(value, OBJECT)

    def type_of_values(self, values: Iterable[Value]) -> str:
        """Give the narrowest type that all these objects are of."""
        return self.common_type([self.type_of_value(value) for value in values])

    def common_type(self, names: Iterable[str]) -> str:
        """Give the narrowest type above all of these; `object` if there are none."""
        shared: list[str] | None = None
        for name in dict.fromkeys(names):
            chain = list(ancestors(self.above, name))
            shared = chain if shared is None else [each for each in shared if each in chain]
        return shared[0] if shared else OBJECT

    def object(self, value: Value, *, constant: bool = False) -> str:
        """Give the PDDL name of an object, symbol or number, which the problem then has."""
        self.objects[value] = None
        if constant:
            self.constants[value] = None
        return self._names.of(("object", value), pddl_word(str(value)))

    def term(self, term: Term) -> str:
        """Give a term: variables keep their names as far as PDDL allows."""
        if isinstance(term, Constant):
            return self.object(term.value, constant=True)
        return variable_name(term.name)

    def predicate(self, name: str) -> str:
        """Give the PDDL name of a predicate."""
        chosen = self._names.of(("predicate", name), pddl_word(name, "p"))
        self._sources[chosen] = name
        return chosen

    def fresh_predicate(self, key: str, wish: str) -> str:
        """Give the name of a predicate that is made for the export; one for each key."""
        return self._names.of(("made", key), pddl_word(wish, "p"))

    def action(self, skill: str, number: int) -> str:
        """Give the name of the action for a clause of a skill."""
        wish = pddl_word(skill, "a") + (f"-{number}" if number > 1 else "")
        return self._names.of(("action", skill, number), wish)

    def fact(self, name: str, terms: Iterable[str], types: Iterable[str]) -> Fact:
        """Make an atom of a PDDL predicate, and remember the types of its arguments."""
        columns = self._used.setdefault(name, [])
        for place, kind in enumerate(types):
            if place == len(columns):
                columns.append([])
            columns[place].append(kind)
        return Fact(name, tuple(terms))

    def predicates(self) -> tuple[Predicate, ...]:
        """Declare what is used, with the narrowest types that fit all uses."""
        return tuple(
            Predicate(
                name,
                tuple(
                    Typed(f"?{letter}", self.common_type(column))
                    for letter, column in zip(_letters(len(columns)), columns, strict=True)
                ),
            )
            for name, columns in self._used.items()
        )

    def source_of(self, name: str) -> str | None:
        """Give the domain's predicate behind a PDDL predicate; None if it was made here."""
        return self._sources.get(name)

    @property
    def used(self) -> tuple[str, ...]:
        """The PDDL predicates used, in the order in which they came up."""
        return tuple(self._used)


def variable_name(name: str) -> str:
    """Make a legal PDDL variable of one of ours."""
    return f"?{pddl_word(name[1:], 'v')}"


def _letters(count: int) -> list[str]:
    if count <= 3:
        return list("abc"[:count])
    return [f"a{number}" for number in range(1, count + 1)]
