"""Names that nothing in the domain uses. They are told only on request.

A person, a trace or another file may well ask for a concept that the file itself does not use.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from icarus_lite.language.checking.report import Report
from icarus_lite.language.percept_types import lineages
from icarus_lite.language.syntax import Atom, Condition, Domain, DomainTest
from icarus_lite.symbols import ATTACHED

_HINT = "remove it, or leave it for those who ask: `; noqa: ICR040` silences this"


def check_usage(domain: Domain, report: Report) -> None:
    """Note the percept types, concepts and effects that nothing asks for."""
    used = {atom.predicate for atom in _asked(domain)}
    concepts = {concept.head.predicate for concept in domain.concepts}
    told: set[str] = set()
    chains = lineages(domain.percepts)
    used_types = {above for name in used for above in chains.get(name, ())}
    used_types |= {name for name, chain in chains.items() if used.intersection(chain)}
    for percept in domain.percepts:
        if percept.name not in used_types:
            message = f"nothing uses the percept type `{percept.name}`"
            report.note(percept.span, "ICR040", message, _HINT)
    for concept in domain.concepts:
        name = concept.head.predicate
        if name not in used and name not in told:
            told.add(name)
            message = f"nothing uses the concept `{name}`"
            report.note(report.name_of(concept.head), "ICR040", message, _HINT)
    for skill in domain.skills:
        for effect in skill.effects:
            name = effect.atom.predicate
            if name not in used and name not in concepts and name != ATTACHED and name not in told:
                told.add(name)
                message = f"nothing asks for `{name}`, which this effect speaks of"
                report.note(report.name_of(effect.atom), "ICR040", message, _HINT)


def _asked(domain: Domain) -> Iterator[Atom]:
    """Give every pattern that something asks for; a concept does not count for itself."""
    for concept in domain.concepts:
        for element in concept.elements:
            if element.atom.predicate != concept.head.predicate:
                yield element.atom
    for skill in domain.skills:
        yield from _atoms((*skill.elements, *skill.holds))
    yield from _atoms(c for clause in domain.contradictions for c in clause.elements)
    yield from _atoms(domain.goals)
    for task in domain.tasks:
        yield from _atoms(task.goals)
    for goal in domain.long_term_goals:
        yield from _atoms((*goal.goals, *goal.relevance))
    for stop in domain.breakpoints:
        yield stop.condition.atom
    for test in domain.tests:
        yield from _tested(test)


def _tested(test: DomainTest) -> Iterator[Atom]:
    yield from (*test.expect, *test.expect_not)
    yield from _atoms(test.goals)
    for later in test.then:
        yield from (*later.expect, *later.expect_not)


def _atoms(conditions: Iterable[Condition]) -> Iterator[Atom]:
    for condition in conditions:
        yield condition.atom
