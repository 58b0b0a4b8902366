"""Beliefs that effects speak of although concepts define them.

An effect that adds such a belief is taken at its word where no clause derives it; one that ends
it holds although a clause still derives it, until an effect adds it again. Where concepts never
derive a belief, or do so whatever is done, it holds exactly as effects say, and is a fact like any
other. All others are *asserted*, *derived*, or both, and may have been *denied*.
"""

from __future__ import annotations

from collections.abc import Collection

from icarus_lite.planning.grounding.instances import Literals
from icarus_lite.planning.grounding.views import Cells
from icarus_lite.records import dataclass, field, replace

UNDENIED = "undenied "
"""Begins the name of the fact that no effect has ended a belief which concepts still derive."""

PASSED_ON = (-1, ())
"""The rank of what is believed because it is asserted: above that of all clauses."""

HELD_BY_HIERARCHY = (-1, (0,))
"""The rank of an attachment that is believed because the hierarchy has it."""


@dataclass(slots=True)
class Merged:
    """How such beliefs are represented.

    Args:
        stands_for: For the fact that a belief is asserted: the belief, if it is just that.
        always: The beliefs among these that concepts derive whatever is done.
        never: Those that they never derive.
        undenied: For the other beliefs that effects end: the fact that none has.
    """

    stands_for: dict[int, int] = field(default_factory=dict)
    always: set[int] = field(default_factory=set)
    never: set[int] = field(default_factory=set)
    undenied: dict[tuple[str, Cells], int] = field(default_factory=dict)


def merge(problem: Literals, ended: Collection[int], permanent: Collection[int]) -> Merged:
    """Sort out the beliefs that effects speak of although concepts define them.

    Args:
        problem: The derivations of these beliefs are in it, what is asserted passed on first; those
            that are facts like any other are taken out, the others get what may deny them.
        ended: The beliefs that some effect ends.
        permanent: What is perceived: no effect ends it.
    """
    merged = Merged()
    asserted = {
        belief: ways[0].conditions[0]
        for belief, ways in problem.derivations.items()
        if ways[0].rank == PASSED_ON
    }
    for belief in sorted({*asserted, *ended}):
        if belief in permanent:
            continue
        ways = [w for w in problem.derivations.get(belief, ()) if w.rank != PASSED_ON]
        always = any(problem.constant.issuperset(way.conditions) for way in ways)
        held = any(way.rank == HELD_BY_HIERARCHY for way in ways)
        if (always or not ways) and not held and belief not in problem.variants:
            number = asserted.get(belief)
            if number is not None:
                merged.stands_for[number] = belief
            (merged.always if always else merged.never).add(belief)
            if always or number in problem.initial:
                problem.initial.add(belief)
                if belief not in ended:
                    problem.constant.add(belief)
            problem.derivations.pop(belief, None)
        elif belief in ended and ways:
            _let_be_denied(problem, belief, merged)
    return merged


def _let_be_denied(problem: Literals, belief: int, merged: Merged) -> None:
    """Let what concepts derive be ended nevertheless."""
    predicate, args, _ = problem.atoms[belief]
    undenied = merged.undenied.get((predicate, args))
    if undenied is None:
        undenied = merged.undenied[predicate, args] = len(problem.atoms)
        problem.initial.add(undenied)
        problem.atoms.append((UNDENIED + predicate, args, ()))
    always_counts = (PASSED_ON, HELD_BY_HIERARCHY)
    problem.derivations[belief] = [
        way if way.rank in always_counts else replace(way, conditions=(*way.conditions, undenied))
        for way in problem.derivations[belief]
    ]
