"""Which variables of a skill stand for what it is about, and which for what it measures."""

from __future__ import annotations

from collections.abc import Iterator

from icarus_lite.language.syntax import Atom, ConceptClause, SkillClause, Variable


def objects_of(clause: SkillClause | ConceptClause) -> frozenset[str]:
    """Give the variables that stand for objects: all that are an argument of something.

    The others are only ever values of attributes, such as a position, and may change their value
    while the instance stays the same.
    """
    return frozenset(_arguments(clause))


def _arguments(clause: SkillClause | ConceptClause) -> Iterator[str]:
    atoms: list[Atom] = [clause.head, *(condition.atom for condition in clause.elements)]
    if isinstance(clause, SkillClause):
        atoms += [*clause.subskills, *(effect.atom for effect in clause.effects)]
    for atom in atoms:
        for term in atom.args:
            if isinstance(term, Variable):
                yield term.name
