"""The names a domain defines: what can be perceived, derived, asserted and done."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from enum import StrEnum

from icarus_lite.language.percept_types import inherited_attributes
from icarus_lite.language.syntax import NOWHERE, Atom, Domain, Span
from icarus_lite.records import dataclass, replace
from icarus_lite.symbols import ATTACHED


class Origin(StrEnum):
    """Where beliefs with a predicate come from."""

    PERCEPT = "percept"
    CONCEPT = "concept"
    EFFECT = "effect"
    GIVEN = "given"
    ATTACHMENT = "attachment"


@dataclass(frozen=True, slots=True)
class Definition:
    """What a predicate or skill looks like where it is first defined.

    Args:
        name: The predicate, or the skill's name.
        origin: Where its beliefs come from; for a skill, `EFFECT`.
        arity: The number of positional arguments.
        attributes: The attributes it may be used with.
        span: Where it is defined.
    """

    name: str
    origin: Origin
    arity: int
    attributes: frozenset[str]
    span: Span


@dataclass(frozen=True, slots=True)
class Vocabulary:
    """All names a domain defines.

    Args:
        predicates: Each predicate with its definitions, at most one per origin.
        skills: Skills by name, from their first clause.
    """

    predicates: Mapping[str, tuple[Definition, ...]]
    skills: Mapping[str, Definition]


def vocabulary(domain: Domain) -> Vocabulary:
    """Collect the names a domain defines, each from where it is first defined."""
    table: dict[str, dict[Origin, Definition]] = {}
    for definition in _definitions(domain):
        known = table.setdefault(definition.name, {})
        first = known.setdefault(definition.origin, definition)
        if first is not definition and definition.origin is Origin.EFFECT:
            attributes = first.attributes | definition.attributes
            known[Origin.EFFECT] = replace(first, attributes=attributes)
    skills: dict[str, Definition] = {}
    for clause in domain.skills:
        definition = _definition(clause.head, Origin.EFFECT, frozenset())
        skills.setdefault(clause.head.predicate, definition)
    predicates = {name: tuple(known.values()) for name, known in table.items()}
    return Vocabulary(predicates, skills)


def _definitions(domain: Domain) -> Iterable[Definition]:
    attributes = inherited_attributes(domain.percepts)
    for percept in domain.percepts:
        names = frozenset(attributes[percept.name])
        yield Definition(percept.name, Origin.PERCEPT, 1, names, percept.span)
    for concept in domain.concepts:
        names = frozenset(name for name, _ in concept.head.attributes)
        yield _definition(concept.head, Origin.CONCEPT, names)
    for skill in domain.skills:
        for effect in skill.effects:
            if not effect.negated and effect.atom.predicate != ATTACHED:
                names = frozenset(name for name, _ in effect.atom.attributes)
                yield _definition(effect.atom, Origin.EFFECT, names)
    perceived = {percept.name for percept in domain.percepts}
    for task in domain.tasks:
        for fact in task.init:
            if fact.predicate not in perceived and fact.predicate != ATTACHED:
                names = frozenset(name for name, _ in fact.attributes)
                yield _definition(fact, Origin.GIVEN, names)
    yield Definition(ATTACHED, Origin.ATTACHMENT, 2, frozenset(), NOWHERE)


def _definition(atom: Atom, origin: Origin, attributes: frozenset[str]) -> Definition:
    return Definition(atom.predicate, origin, len(atom.args), attributes, atom.span)
