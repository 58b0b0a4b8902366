"""Pairs tested by numpy, block by block of rows: all partners of some objects."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from icarus_lite.inference.network.kernels.tester import Slots, Tester, Truths

_BLOCK = 1 << 15
"""How many pairs numpy tests at a time: 256 kB an operand, which stays in the cache."""


def blocks(tester: Tester, slots: Slots, *, flip: bool = False) -> Iterator[tuple[Slots, Truths]]:
    """Test objects of one side against all of the other.

    Args:
        tester: The pairs.
        slots: (k,) objects of the left side; of the right one if `flip`.
        flip: Whether rows are right objects.

    Yields:
        Some of the slots, (r,), and for each of them and each of the n on the other side whether
        the pair holds, (r, n).

    Raises:
        InferenceError: a test cannot be evaluated for one of the pairs.
    """
    own, others = (tester.right, tester.left) if flip else (tester.left, tester.right)
    mine, theirs = own.ready_arrays(), others.ready_arrays()
    if not len(slots) or not others.size:
        return
    step = max(1, _BLOCK // others.size)
    for begin in range(0, len(slots), step):
        rows = slots[begin : begin + step]
        block = [each[rows, None] for each in mine]
        hold, doubt = tester.mask([*theirs, *block] if flip else [*block, *theirs])
        _settle(tester, rows, hold, doubt, flip=flip)
        yield rows, hold


def _settle(tester: Tester, rows: Slots, hold: Truths, doubt: Truths | None, *, flip: bool) -> None:
    """Settle what arrays cannot: absent and odd objects, pairs of one object, doubts."""
    own, others = (tester.right, tester.left) if flip else (tester.left, tester.right)
    if not tester.is_regular:
        regular = own.regular()[rows, None] & others.regular()
        hold &= regular
        if doubt is not None:
            doubt &= regular
    if tester.plan.distinct:
        where = own_pairs(tester, rows, on_left=not flip)
        hold[where] = False
        if doubt is not None and tester.plan.distinct_first:
            doubt[where] = False
    if doubt is not None and doubt.any():
        for n, other in zip(*(each.tolist() for each in np.nonzero(doubt)), strict=True):
            hold[n, other] = tester.is_exactly(int(rows[n]), other, on_left=not flip)
    if own.odd or others.odd:
        for n, slot in enumerate(rows.tolist()):
            odd = range(others.size) if slot in own.odd else sorted(others.odd)
            for other in odd:
                hold[n, other] = tester.is_exactly(slot, other, on_left=not flip)


def own_pairs(tester: Tester, rows: Slots, *, on_left: bool) -> tuple[Slots, Slots]:
    """Give where in a block an object meets itself."""
    if tester.same:
        return np.arange(len(rows)), rows
    found = np.array(tester.twins(rows.tolist(), on_left=on_left), dtype=np.intp)
    places = np.flatnonzero(found >= 0)
    return places, found[places]
