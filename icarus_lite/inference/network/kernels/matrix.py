"""A pair relation as a matrix of bytes, brought up to date in the cheapest of four ways.

Objects that have
changed mean rows and columns to be computed anew and compared with what is stored, as a whole: by
list comprehensions where there are few pairs, by numpy in blocks of rows where there are many. With
a known bound on the distance, few objects are compared with those in their strip only, many by a
sweep over neighbours.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from icarus_lite.inference.network.kernels.blocks import blocks
from icarus_lite.inference.network.kernels.byte_matrix import ByteMatrix, ones
from icarus_lite.inference.network.kernels.columns import Columns
from icarus_lite.inference.network.kernels.neighbours import neighbours
from icarus_lite.inference.network.kernels.relation import (
    Bind,
    Change,
    Pair,
)
from icarus_lite.inference.network.kernels.strips import Strips
from icarus_lite.inference.network.kernels.tester import MatrixPlan, Slots

_SHORT = 48
"""Rows up to this length are compared byte by byte, longer ones by numpy."""


class MatrixRelation(ByteMatrix):
    """See the module.

    Args:
        plan: What is known of the rule.
        columns: Its objects.
        bind: Gives the exact test and the gates over columns.
    """

    __slots__ = ("_few_pairs", "_strips")

    def __init__(self, plan: MatrixPlan, columns: tuple[Columns, Columns], bind: Bind) -> None:
        super().__init__(plan, columns, bind)
        self._strips: Strips | None = None
        self._few_pairs = plan.costs.few_pairs

    def forget(self) -> None:
        """Rely no longer on where objects were: moves are followed elsewhere from now on."""
        super().forget()
        self._strips = None

    def copy(self, left: Columns, right: Columns) -> MatrixRelation:
        """Give a relation in the same state over copies of its columns."""
        made = MatrixRelation(self._plan, (left, right), self._bind)
        made._tester = self._tester.copy((left, right))
        made.stride = self.stride
        made._allocate(len(self.bits) // self.stride)
        made.bits[:] = self.bits
        made._count = self._count
        return made

    def load(self) -> None:
        """Follow the columns from scratch, whatever has changed, without saying what it was."""
        tester = self._tester
        self._strips = None
        tester.refresh(range(tester.left.columns.size), range(tester.right.columns.size))
        self._reserve()
        left, right = tester.left, tester.right
        codes = self._swept()
        if codes is not None:
            self._grid[:] = 0
            self._grid.reshape(-1)[codes] = 1
            self._count, self._codes = len(codes), codes
            return
        self._codes = None
        if self._plan.mask is None:
            rows = [tester.row(slot, on_left=True) for slot in range(left.size)]
            for slot, row in enumerate(rows):
                self.bits[slot * self.stride : slot * self.stride + right.size] = row
        else:
            found = list(blocks(tester, np.arange(left.size)))
            for slots, hold in found:
                self._grid[slots[0] : slots[-1] + 1, : right.size] = hold
        self._count = int(np.count_nonzero(self._grid))

    def update(self, changed_left: Sequence[int], changed_right: Sequence[int]) -> Change:
        """Follow the columns; give the net change: see `PairRelation`."""
        tester = self._tester
        tester.refresh(changed_left, changed_right)
        left, right = tester.left.size, tester.right.size
        if left * self.stride > len(self.bits) or right > self.stride:
            self._reserve()
        if tester.mirrored:
            changed_right = ()
        pairs = len(changed_left) * right + len(changed_right) * left
        if pairs <= self._few_pairs:
            self._strips = self._codes = None
            added, removed = self._by_list(changed_left, changed_right)
        else:
            added, removed = self._by_cheapest(changed_left, changed_right, pairs)
        if added or removed:
            self._write(added, removed)
        return added, removed

    def _by_cheapest(
        self, changed_left: Sequence[int], changed_right: Sequence[int], pairs: int
    ) -> Change:
        rows = len(changed_left) + len(changed_right)
        is_few = 4 * rows < self._tester.left.size + self._tester.right.size
        way = self._choose(rows, pairs, few=is_few)
        strips = self._strips
        if strips is not None:
            strips = self._strips = strips if is_few else None
        if strips is not None:
            strips.move(changed_left, changed_right)
        change = self._by_sweep() if way == "sweep" else None
        if change is not None:
            return change
        self._codes = None
        if way == "strip" and strips is not None:
            return self._by_strip(strips, changed_left, changed_right)
        if way == "list":
            return self._by_list(changed_left, changed_right)
        return self._by_block(changed_left, changed_right)

    def _choose(self, rows: int, pairs: int, *, few: bool) -> str:
        """Choose the way that costs least: `list`, `strip`, `block` or `sweep`."""
        plan, left, right = self._plan, self._tester.left.size, self._tester.right.size
        costs, every = plan.costs, left * right
        estimates = {"list": costs.lists(rows, pairs)}
        if plan.mask is not None:
            calls = 1 if self._tester.mirrored or pairs >= every else 2
            estimates["block"] = costs.blocks(calls, min(pairs, every))
            if plan.axes:
                estimates["sweep"] = costs.sweep(left + right)
        if plan.axes and few and costs.strips(rows, 0) < min(estimates.values()):
            if self._strips is None:
                self._strips = Strips(self._tester)
            estimates["strip"] = costs.strips(rows, self._strips.candidates)
        return min(estimates, key=estimates.__getitem__)

    # One row after the other.

    def _by_list(self, changed_left: Sequence[int], changed_right: Sequence[int]) -> Change:
        added: list[Pair] = []
        removed: list[Pair] = []
        bits, stride, size = self.bits, self.stride, self._tester.right.size
        mirrored = self._tester.mirrored
        for i, row in self._changed_rows(changed_left, on_left=True):
            old = bits[i * stride : i * stride + size]
            for j in _differences(old, row):
                change = added if row[j] else removed
                change.append((i, j))
                if mirrored and j not in changed_left:
                    change.append((j, i))
        size = self._tester.left.size
        for j, column in self._changed_rows(changed_right, on_left=False):
            for i in _differences(bits[j : j + size * stride : stride], column):
                if i not in changed_left:
                    (added if column[i] else removed).append((i, j))
        return added, removed

    def _changed_rows(
        self, slots: Sequence[int], *, on_left: bool
    ) -> list[tuple[int, bytes | bytearray]]:
        """Test objects against all of the other side; give those whose row has changed."""
        tester, plan, bits, stride = self._tester, self._plan, self.bits, self.stride
        if tester.is_regular:
            own, others, programs = tester.left, tester.right, plan.left.programs
            if not on_left:
                own, others, programs = others, own, plan.right.programs
            twins = tester.twins(slots, on_left=on_left) if plan.distinct else [-1] * len(slots)
            mine, theirs = own.ready_lists(), others.ready_lists()
            try:
                found = programs.rows(slots, twins, mine, theirs, bits, stride)
            except (ArithmeticError, ValueError):
                pass  # the exact test tells which pair it is, and what it means
            else:
                return [*found]
        changed: list[tuple[int, bytes | bytearray]] = []
        for slot in slots:
            row = tester.row(slot, on_left=on_left)
            old = bits[slot : slot + len(row) * stride : stride]
            if on_left:
                old = bits[slot * stride : slot * stride + len(row)]
            if row != old:
                changed.append((slot, row))
        return changed

    # Those in a strip.

    def _by_strip(
        self, strips: Strips, changed_left: Sequence[int], changed_right: Sequence[int]
    ) -> Change:
        added: list[Pair] = []
        removed: list[Pair] = []
        mirrored = self._tester.mirrored
        for i in changed_left:
            new, old = self._partners(strips, i, on_left=True), self.of_left(i)
            if new != old:
                for change, others in ((added, _less(new, old)), (removed, _less(old, new))):
                    change += [(i, j) for j in others]
                    if mirrored:
                        change += [(j, i) for j in others if j not in changed_left]
        for j in changed_right:
            new, old = self._partners(strips, j, on_left=False), self.of_right(j)
            if new != old:
                for change, others in ((added, _less(new, old)), (removed, _less(old, new))):
                    change += [(i, j) for i in others if i not in changed_left]
        return added, removed

    def _partners(self, strips: Strips, slot: int, *, on_left: bool) -> list[int]:
        """Give the objects with which one holds, in ascending order."""
        tester = self._tester
        own, others = (tester.left, tester.right) if on_left else (tester.right, tester.left)
        if not own.present[slot]:
            return []
        if slot in own.odd or others.odd:
            row = tester.row(slot, on_left=on_left)
            return ones(row, 0, len(row))
        programs = self._plan.left.programs if on_left else self._plan.right.programs
        among = strips.near(slot, on_left=on_left)
        try:
            found = programs.among(slot, own.ready_lists(), others.ready_lists(), among)
        except (ArithmeticError, ValueError):
            found = [other for other in among if tester.is_exactly(slot, other, on_left=on_left)]
        if self._plan.distinct:
            twin = tester.twin(slot, on_left=on_left)
            if twin in found:
                found.remove(twin)
        found.sort()
        return found

    # Blocks of rows.

    def _by_block(self, changed_left: Sequence[int], changed_right: Sequence[int]) -> Change:
        tester = self._tester
        left, right = tester.left.size, tester.right.size
        pairs = len(changed_left) * right + len(changed_right) * left
        added: list[Pair] = []
        removed: list[Pair] = []
        all_rows = pairs >= left * right
        moved = np.arange(left) if all_rows else np.array(changed_left, dtype=np.intp)
        for rows, hold in blocks(tester, moved):
            places, others = np.nonzero(hold != self._grid[rows, :right].view(np.bool_))
            kinds = hold[places, others].tolist()
            for i, j, kind in zip(rows[places].tolist(), others.tolist(), kinds, strict=True):
                (added if kind else removed).append((i, j))
        if all_rows:
            return added, removed
        known = set(changed_left)
        if tester.mirrored:
            for change in (added, removed):
                change += [(j, i) for i, j in change if j not in known]
        for columns, hold in blocks(tester, np.array(changed_right, dtype=np.intp), flip=True):
            places, others = np.nonzero(hold != self._grid[:left, columns].T.view(np.bool_))
            kinds = hold[places, others].tolist()
            for j, i, kind in zip(columns[places].tolist(), others.tolist(), kinds, strict=True):
                if i not in known:
                    (added if kind else removed).append((i, j))
        return added, removed

    # All neighbours.

    def _by_sweep(self) -> Change | None:
        codes = self._swept()
        return None if codes is None else self._replace(codes)

    def _swept(self) -> Slots | None:
        """Give all pairs as numbers left * stride + right; None where a sweep does not help."""
        if not self._plan.axes or self._plan.mask is None:
            return None
        found = neighbours(self._tester)
        return None if found is None else found[0] * self.stride + found[1]


def _differences(old: bytes | bytearray, new: bytes | bytearray) -> list[int]:
    """Give the places where two rows differ."""
    if len(old) <= _SHORT:
        return [n for n, (a, b) in enumerate(zip(old, new, strict=True)) if a != b]
    differ = np.frombuffer(old, dtype=np.uint8) != np.frombuffer(new, dtype=np.uint8)
    return [int(n) for n in np.flatnonzero(differ)]


def _less(some: list[int], others: list[int]) -> list[int]:
    """Give those of some that are not among the others."""
    known = set(others)
    return [each for each in some if each not in known]
