"""The syntax tree of PDDL: typed STRIPS with negative preconditions and derived predicates.

Spans never take part in comparison. Variables are written with their question mark, names in
lower case; the type `object` is above all others.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from icarus_lite.language.syntax import NOWHERE, Span
from icarus_lite.records import dataclass, field

OBJECT = "object"
"""The type of everything."""


@dataclass(frozen=True, slots=True)
class Typed:
    """A variable, object or type with its (super)type."""

    name: str
    type: str = OBJECT
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Fact:
    """A predicate with terms: an atomic formula, or with objects only, a fact."""

    predicate: str
    args: tuple[str, ...] = ()
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Equal:
    """Two terms name the same object."""

    left: str
    right: str
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Not:
    """The negation of a formula."""

    part: Formula
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class And:
    """All parts hold; with no part it is true."""

    parts: tuple[Formula, ...] = ()
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Or:
    """A part holds; with no part it is false."""

    parts: tuple[Formula, ...] = ()
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Exists:
    """The part holds for some objects."""

    variables: tuple[Typed, ...]
    part: Formula
    span: Span = field(default=NOWHERE, compare=False)


Formula = Fact | Equal | Not | And | Or | Exists


@dataclass(frozen=True, slots=True)
class Effect:
    """A literal that an action makes true, or false.

    Args:
        fact: The literal's atom.
        negated: Whether it becomes false.
        every: Variables over which a negated one ranges: `(forall (?z) (not (p ?x ?z)))`.
    """

    fact: Fact
    negated: bool = False
    every: tuple[Typed, ...] = ()


@dataclass(frozen=True, slots=True)
class Predicate:
    """A declared predicate."""

    name: str
    parameters: tuple[Typed, ...] = ()
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Rule:
    """One way for a derived predicate to hold."""

    predicate: str
    parameters: tuple[Typed, ...]
    body: Formula
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class PddlAction:
    """An action schema; `comment` stands above it in a file that we write."""

    name: str
    parameters: tuple[Typed, ...] = ()
    precondition: Formula = And()
    effects: tuple[Effect, ...] = ()
    comment: str = field(default="", compare=False)
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class PddlDomain:
    """A PDDL domain. `types` leaves `object` out."""

    name: str
    types: tuple[Typed, ...] = ()
    constants: tuple[Typed, ...] = ()
    predicates: tuple[Predicate, ...] = ()
    rules: tuple[Rule, ...] = ()
    actions: tuple[PddlAction, ...] = ()

    @property
    def derived(self) -> frozenset[str]:
        """The predicates that rules define."""
        return frozenset(rule.predicate for rule in self.rules)


@dataclass(frozen=True, slots=True)
class PddlProblem:
    """A PDDL problem: objects, initial facts and goal."""

    name: str
    domain: str
    objects: tuple[Typed, ...] = ()
    init: tuple[Fact, ...] = ()
    goal: Formula = And()


def parents(types: Iterable[Typed]) -> Mapping[str, str]:
    """Map each type to the type above it."""
    return {each.name: each.type for each in types}


def ancestors(types: Mapping[str, str], name: str) -> Iterator[str]:
    """Give a type and all types above it, itself first, `object` last.

    Args:
        types: Maps each type to the one above it, without a circle.
        name: Where to begin.
    """
    while name != OBJECT:
        yield name
        name = types.get(name, OBJECT)
    yield OBJECT


def is_a(types: Mapping[str, str], name: str, other: str) -> bool:
    """Tell whether every object of a type is also of the other type."""
    return other in ancestors(types, name)


def conjunction(parts: Sequence[Formula]) -> Formula:
    """Give a formula that holds when all parts do; a single part as it is."""
    return parts[0] if len(parts) == 1 else And(tuple(parts))


def variables_of(formula: Formula) -> Iterator[str]:
    """Give the free variables of a formula in the order of occurrence, repeats included."""
    match formula:
        case Fact(_, args):
            yield from (term for term in args if term.startswith("?"))
        case Equal(left, right):
            yield from (term for term in (left, right) if term.startswith("?"))
        case Not(part):
            yield from variables_of(part)
        case Exists(bound, part):
            names = {variable.name for variable in bound}
            yield from (name for name in variables_of(part) if name not in names)
        case And(parts) | Or(parts):
            for part in parts:
                yield from variables_of(part)
