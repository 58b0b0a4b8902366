"""The memory of an engine or agent that begins with the facts of a task."""

from __future__ import annotations

from collections.abc import Iterable

from icarus_lite.inference.engine import BeliefState, Memory
from icarus_lite.inference.given import GIVEN, given_beliefs
from icarus_lite.inference.supports import Assertion
from icarus_lite.language.syntax import Atom, Domain


def given_memory(domain: Domain, facts: Iterable[Atom]) -> Memory:
    """Give the memory of an engine or agent that begins with the facts of `:init`.

    Attachments go into the hierarchy, everything else that is no percept is asserted and
    persists, as an effect does. Percepts are left out: they are for the first cycle.

    Args:
        domain: Says which predicates are percept types.
        facts: Ground facts.
    """
    given = given_beliefs(domain, facts)
    state = BeliefState(hierarchy=given.hierarchy, notes=given.refused)
    return Memory(state, {belief: Assertion(GIVEN, 0) for belief in given.asserted})
