"""What every plan must cost, at least: by what none of them can do without.

A landmark is an atom that must hold at some time on the way to the goal, whatever the plan: a goal
itself, or what all operators need that make another landmark true. One that does not hold yet
must be made true by a step. Landmarks with no such step in common need a step each, and cost what
the cheapest of their steps does, at least.

Source: Hoffmann, Porteous and Sebastia, Ordered landmarks in planning, 2004.
"""

from __future__ import annotations

from collections.abc import Sequence

from icarus_lite.planning.ground_task import GroundTask


def at_least(task: GroundTask, prices: Sequence[int] | None = None) -> int:
    """Give a cost that no plan can go below.

    Args:
        task: The problem.
        prices: What each of its operators costs; 1 each if left out, so that steps are counted.
    """
    makers: list[list[int]] = [[] for _ in task.atoms]
    conditions = [operator.conditions for operator in task.operators]
    for number, operator in enumerate(task.operators):
        possible = operator.possible & ~task.initial
        while possible:
            bit = possible & -possible
            possible ^= bit
            makers[bit.bit_length() - 1].append(number)
    first_rule = len(conditions)
    for number, rule in enumerate(task.rules, first_rule):
        conditions.append(rule.conditions)
        makers[rule.atom].append(number)
    landmarks, pending = set(task.goal), list(task.goal)
    made_by_steps = []
    while pending:
        atom = pending.pop()
        if task.initial >> atom & 1:
            continue
        ways = makers[atom]
        if ways and ways[-1] < first_rule:
            made_by_steps.append(ways)
        for needed in _common([conditions[way] for way in ways]):
            if needed not in landmarks:
                landmarks.add(needed)
                pending.append(needed)
    return _apart(made_by_steps, prices)


def _common(ways: Sequence[tuple[int, ...]]) -> list[int]:
    """Give what all ways need."""
    if not ways:
        return []
    others = [frozenset(way) for way in ways[1:]]
    return [atom for atom in ways[0] if all(atom in other for other in others)]


def _apart(made_by: Sequence[Sequence[int]], prices: Sequence[int] | None) -> int:
    """Add up landmarks that no step can serve two of, taking those with the fewest steps first."""
    taken: set[int] = set()
    total = 0
    for ways in sorted(made_by, key=len):
        if taken.isdisjoint(ways):
            taken.update(ways)
            total += 1 if prices is None else min(prices[way] for way in ways)
    return total
