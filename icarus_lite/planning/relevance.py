"""Means-ends analysis on the text of a domain: which skills can serve a goal at all.

Skill chaining goes from a literal to the skills with such an effect and on to their conditions;
concept chaining goes from a concept to the literals of its definition. Both look at predicate and
sign only, so what they leave out can never help.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from itertools import chain

from icarus_lite.language.syntax import Condition, Domain, SkillClause
from icarus_lite.records import dataclass
from icarus_lite.symbols import ATTACHED

Sign = tuple[str, bool]
"""A predicate, and whether it is to become true or false."""


@dataclass(frozen=True, slots=True)
class Relevance:
    """What can serve a goal.

    Args:
        skills: The primitive skills that can serve it, in the order of the domain.
        signs: The literals they serve, directly or through others.
    """

    skills: tuple[SkillClause, ...]
    signs: frozenset[Sign]


def relevance(domain: Domain, goals: Iterable[Condition]) -> Relevance:
    """Chain backwards from goals to the primitive skills that can serve them."""
    primitives = [clause for clause in domain.skills if clause.is_primitive]
    valued = _valued(domain, goals := tuple(goals))
    effects = {id(c): frozenset(signs_of_effects(domain, c, valued)) for c in primitives}
    signs = {(goal.atom.predicate, not goal.negated) for goal in goals}
    chosen: set[int] = set()
    before = -1
    while before != len(signs) + len(chosen):
        before = len(signs) + len(chosen)
        for concept in domain.concepts:
            for wanted in (True, False):
                if (concept.head.predicate, wanted) in signs:
                    signs.update(
                        (c.atom.predicate, c.negated is not wanted) for c in concept.elements
                    )
        for clause in primitives:
            if id(clause) not in chosen and effects[id(clause)] & signs:
                chosen.add(id(clause))
                signs.update((c.atom.predicate, not c.negated) for c in clause.elements)
    return Relevance(tuple(c for c in primitives if id(c) in chosen), frozenset(signs))


def signs_of_effects(
    domain: Domain, clause: SkillClause, valued: Collection[str] = ()
) -> Iterator[Sign]:
    """Give what a skill can change: its effects, and the attachments it makes or dissolves.

    Args:
        domain: Its attachments count.
        clause: The skill.
        valued: The predicates of beliefs that somebody asks about with their attributes.
    """
    for effect in clause.effects:
        yield effect.atom.predicate, not effect.negated
        if not effect.negated and effect.atom.predicate in valued:
            yield effect.atom.predicate, False  # the new attributes replace the old ones
    for rule in domain.attachments:
        if rule.attach.predicate == clause.head.predicate:
            yield ATTACHED, True
            yield ATTACHED, False  # the new parent replaces the old one
        if rule.until is not None and rule.until.predicate == clause.head.predicate:
            yield ATTACHED, False


def _valued(domain: Domain, goals: Iterable[Condition]) -> frozenset[str]:
    """Give the predicates that conditions, or effects that end them, name attributes of."""
    elements = (each.elements for each in domain.concepts)
    starting = (each.elements for each in domain.skills)
    ending = (e for clause in domain.skills for e in clause.effects if e.negated)
    conditions = chain(goals, ending, *elements, *starting)
    return frozenset(c.atom.predicate for c in conditions if c.atom.attributes)


def can_change(domain: Domain, goal: Condition) -> bool:
    """Tell whether any skill can ever change a literal, directly or through its definition."""
    return bool(relevance(domain, [goal]).skills)
