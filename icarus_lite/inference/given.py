"""What a task gives at its start: percepts, attachments, and beliefs that no camera reports."""

from __future__ import annotations

from collections.abc import Iterable

from icarus_lite.inference.attachment import Hierarchy
from icarus_lite.inference.effects import Change
from icarus_lite.inference.facts import ground
from icarus_lite.language.syntax import Atom, Domain
from icarus_lite.records import dataclass
from icarus_lite.symbols import ATTACHED, Action, Belief, Percept

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


@dataclass(frozen=True, slots=True)
class GivenBeliefs:
    """What a task gives besides percepts.

    Args:
        asserted: What persists as effects do, in the order given.
        hierarchy: The attachments.
        refused: A sentence for each attachment that was refused.
    """

    asserted: tuple[Belief, ...]
    hierarchy: Hierarchy
    refused: tuple[str, ...] = ()


def given_beliefs(domain: Domain, facts: Iterable[Atom]) -> GivenBeliefs:
    """Pick out of the facts of `:init` what no camera reports.

    Args:
        domain: Says which predicates are percept types.
        facts: Ground facts.
    """
    types = {percept.name for percept in domain.percepts}
    found = [ground(fact, {}) for fact in facts if fact.predicate not in types]
    beliefs = [belief for belief in found if belief is not None]
    attached = [each for each in beliefs if _is_attachment(each)]
    asserted = dict.fromkeys(each for each in beliefs if not _is_attachment(each))
    hierarchy, refused = Hierarchy(), tuple[str, ...]()
    if attached:
        hierarchy, refused = hierarchy.with_change(Change(tuple(attached)), GIVEN, 0)
    return GivenBeliefs(tuple(asserted), hierarchy, refused)


def _is_attachment(belief: Belief) -> bool:
    return belief.predicate == ATTACHED and len(belief.args) == 2
