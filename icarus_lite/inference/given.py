"""What a task gives at its start: percepts, attachments, and beliefs that no camera reports."""

from __future__ import annotations

from collections.abc import Iterable

from icarus_lite.inference.attachment import ATTACHED, Hierarchy
from icarus_lite.inference.effects import Change
from icarus_lite.inference.engine import BeliefState, Memory
from icarus_lite.inference.facts import ground
from icarus_lite.inference.supports import Assertion
from icarus_lite.language.syntax import Atom, Domain
from icarus_lite.symbols import Action, Belief, Percept

GIVEN = Action("given")
"""Stands for the action behind a belief that was given at the start and that no skill asserted."""


def given_percepts(domain: Domain, facts: Iterable[Atom]) -> tuple[Percept, ...]:
    """Pick the percepts out of the facts of `:init`.

    Args:
        domain: Says which predicates are percept types.
        facts: Ground facts.
    """
    types = {percept.name for percept in domain.percepts}
    found = [ground(fact, {}) for fact in facts if fact.predicate in types]
    return tuple(
        Percept(belief.predicate, str(belief.args[0]), belief.attributes)
        for belief in found
        if belief is not None and len(belief.args) == 1
    )


def given_memory(domain: Domain, facts: Iterable[Atom]) -> Memory:
    """Give the memory of an engine or agent that begins with the facts of `:init`.

    Attachments go into the hierarchy, everything else that is no percept is asserted and
    persists, as an effect does. Percepts are left out: they are for the first cycle.

    Args:
        domain: Says which predicates are percept types.
        facts: Ground facts.
    """
    types = {percept.name for percept in domain.percepts}
    beliefs = [ground(fact, {}) for fact in facts if fact.predicate not in types]
    asserted: dict[Belief, Assertion] = {}
    attached: list[Belief] = []
    for belief in beliefs:
        if belief is not None and belief.predicate == ATTACHED and len(belief.args) == 2:
            attached.append(belief)
        elif belief is not None:
            asserted[belief] = Assertion(GIVEN, 0)
    hierarchy, refused = Hierarchy().with_change(Change(tuple(attached)), GIVEN, 0)
    return Memory(BeliefState(hierarchy=hierarchy, notes=refused), asserted)
