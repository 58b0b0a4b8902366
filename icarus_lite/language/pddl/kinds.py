"""What becomes of each predicate in PDDL.

Percepts cannot be predicted, so while planning they stay as they are: what rests on percepts
alone never changes, and can be evaluated once. What effects state changes, and so does every
concept that rests on it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from icarus_lite.language.syntax import Call, ConceptClause, Condition, Domain, SkillClause
from icarus_lite.records import dataclass
from icarus_lite.symbols import ATTACHED, Belief

EQUALITIES = ("=", "/=")
"""The functions of `:tests` that PDDL has as well."""


@dataclass(frozen=True, slots=True)
class Kinds:
    """The predicates of a domain, sorted by what they become.

    Args:
        types: Percept types that become PDDL types; the others become predicates.
        stated: What effects state, `attached` included where something can be attached.
        changing: The same, and every concept that depends on it.
        derived: Concepts that become derived predicates.
        evaluated: Concepts whose extension is written down, for it never changes and their
            definition cannot be said in PDDL.
        overruled: Derived, and stated by effects as well.
        definitions: The clauses of each concept.
    """

    types: frozenset[str]
    stated: frozenset[str]
    changing: frozenset[str]
    derived: frozenset[str]
    evaluated: frozenset[str]
    overruled: frozenset[str]
    definitions: dict[str, list[ConceptClause]]


def planned_skills(domain: Domain) -> tuple[SkillClause, ...]:
    """Give the clauses that a planner uses: those that the driver carries out."""
    return tuple(clause for clause in domain.skills if clause.is_primitive)


def kinds_of(domain: Domain, goals: Iterable[Condition], facts: Sequence[Belief]) -> Kinds:
    """Sort the predicates of a domain for a task that begins with these facts."""
    definitions: dict[str, list[ConceptClause]] = {}
    for clause in domain.concepts:
        definitions.setdefault(clause.head.predicate, []).append(clause)
    skills = planned_skills(domain)
    stated = {effect.atom.predicate for clause in skills for effect in clause.effects}
    names = {clause.head.predicate for clause in skills}
    if any(rule.attach.predicate in names for rule in domain.attachments):
        stated.add(ATTACHED)
    changing = set(stated)
    before = -1
    while before != len(changing):
        before = len(changing)
        changing |= {name for name, clauses in definitions.items() if _uses(clauses, changing)}
    overruled = {
        name for name, clauses in definitions.items() if name in stated and _uses(clauses, changing)
    }
    still = {name for name in definitions if name not in changing}
    evaluated = {name for name in still if not all(map(_is_expressible, definitions[name]))}
    derived = (changing - stated | overruled | still - evaluated) & definitions.keys()
    conditions = [c for clause in domain.concepts for c in clause.elements]
    conditions += [c for clause in skills for c in clause.elements] + list(goals)
    negated = {c.atom.predicate for c in conditions if c.negated and not c.atom.attributes}
    return Kinds(
        _types(domain, facts) - stated - definitions.keys() - negated,
        frozenset(stated),
        frozenset(changing),
        frozenset(derived),
        frozenset(evaluated),
        frozenset(overruled),
        definitions,
    )


def is_equality(call: Call) -> bool:
    """Tell whether a test only compares names, alone or under and, or, not."""
    if call.function in ("and", "or", "not"):
        return all(isinstance(part, Call) and is_equality(part) for part in call.args)
    return call.function in EQUALITIES and not any(isinstance(part, Call) for part in call.args)


def _uses(clauses: Iterable[ConceptClause], predicates: set[str]) -> bool:
    return any(c.atom.predicate in predicates for clause in clauses for c in clause.elements)


def _is_expressible(clause: ConceptClause) -> bool:
    plain = not clause.binds and not clause.head.attributes
    return (
        plain
        and not any(condition.atom.attributes for condition in clause.elements)
        and all(is_equality(test) for test in clause.tests)
    )


def _types(domain: Domain, facts: Sequence[Belief]) -> frozenset[str]:
    """Give the percept types of objects that have one type each, those above it included."""
    above = {percept.name: percept.supertype for percept in domain.percepts}
    perceived: dict[object, list[str]] = {}
    for fact in facts:
        if fact.predicate in above and len(fact.args) == 1:
            perceived.setdefault(fact.args[0], []).append(fact.predicate)
    unfit: set[str] = set()
    for types in perceived.values():
        lowest = [t for t in types if not any(above[other] == t for other in types)]
        if len(lowest) > 1:
            unfit.update(types)
    return frozenset(above.keys() - unfit)
