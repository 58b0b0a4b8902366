"""All pairs that hold, where only near ones can: candidates from a grid, then tested."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from icarus_lite.inference.network.kernels.columns import Numbers
from icarus_lite.inference.network.kernels.relation import Pair
from icarus_lite.inference.network.kernels.sweep import Stretch, candidates
from icarus_lite.inference.network.kernels.tester import AxisPlan, Slots, Tester, Truths

FEW_STRIPS = 4
"""A sweep is of use if the objects spread over at least so many strips."""


def neighbours(tester: Tester) -> tuple[Slots, Slots] | None:
    """Give the left and the right slots of all pairs that hold, each pair once.

    Args:
        tester: The pairs; along some axis their distance is bounded.

    Returns:
        None where the objects are too close together for this to help.

    Raises:
        InferenceError: a test cannot be evaluated for one of the pairs.
    """
    left, right = tester.left, tester.right
    mine = left.ready_arrays()
    theirs = mine if tester.mirrored else right.ready_arrays()
    # One half says it all only where both sides lie in the same cells; a rule that compares the
    # height of one with the length of the other, and the other way round, is symmetric as well.
    halved = tester.mirrored and all(axis.left == axis.right for axis in tester.plan.axes)
    own = others = None
    if not tester.is_regular:
        own, others = np.flatnonzero(left.regular()), np.flatnonzero(right.regular())
        mine = [each[own] for each in mine]
        theirs = mine if tester.mirrored else [each[others] for each in theirs]
    i = j = np.zeros(0, dtype=np.intp)
    if len(mine[0]) and len(theirs[0]):
        axes = [_stretch(axis, mine, theirs) for axis in tester.plan.axes]
        found = candidates(axes, FEW_STRIPS, mirrored=halved)
        if found is None:
            return None
        i, j = found
        given = [*(each.take(i) for each in mine), *(each.take(j) for each in theirs)]
        if own is not None and others is not None:
            i, j = own[i], others[j]
        i, j = _tested(tester, i, j, given, halved=halved)
    odd = _odd_pairs(tester)
    if odd:
        i = np.concatenate([i, np.array([a for a, _ in odd], dtype=np.intp)])
        j = np.concatenate([j, np.array([b for _, b in odd], dtype=np.intp)])
    return i, j


def _stretch(axis: AxisPlan, mine: Sequence[Numbers], theirs: Sequence[Numbers]) -> Stretch:
    limit = axis.limit
    if isinstance(limit, tuple):
        side, number = limit
        limit = float((theirs if side else mine)[number].max())
    return Stretch(mine[axis.left], theirs[axis.right], max(axis.reach(limit), 0.0))


def _tested(
    tester: Tester, i: Slots, j: Slots, given: Sequence[Numbers], *, halved: bool
) -> tuple[Slots, Slots]:
    """Give those of the candidates that hold, and their mirror images if these were left out."""
    hold, doubt = tester.mask(given)
    plan = tester.plan
    if plan.distinct:
        apart = _apart(tester, i, j)
        hold &= apart
        if doubt is not None and plan.distinct_first:
            doubt &= apart
    if doubt is not None:
        for place in np.flatnonzero(doubt).tolist():
            hold[place] = tester.is_exactly(int(i[place]), int(j[place]), on_left=True)
    i, j = i[hold], j[hold]
    if halved:
        off = i != j
        i, j = np.concatenate([i, j[off]]), np.concatenate([j, i[off]])
    return i, j


def _apart(tester: Tester, i: Slots, j: Slots) -> Truths:
    """Tell which pairs are of two different objects."""
    if tester.same:
        apart: Truths = i != j
        return apart
    of_left = np.array(tester.twins(range(tester.left.size), on_left=True), dtype=np.intp)
    different: Truths = of_left[i] != j
    return different


def _odd_pairs(tester: Tester) -> list[Pair]:
    """Ask the exact test about each pair with an odd object."""
    left, right = tester.left, tester.right
    found = [
        (i, j)
        for i in sorted(left.odd)
        for j in range(right.size)
        if tester.is_exactly(i, j, on_left=True)
    ]
    found += [
        (i, j)
        for j in sorted(right.odd)
        for i in range(left.size)
        if i not in left.odd and tester.is_exactly(i, j, on_left=True)
    ]
    return found
