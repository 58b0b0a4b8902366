"""A pair relation stored as a matrix of bytes, and taking over what others have found.

One byte a pair, so that a single question costs one look into a `bytearray`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from icarus_lite.inference.network.kernels.blocks import own_pairs
from icarus_lite.inference.network.kernels.columns import Columns
from icarus_lite.inference.network.kernels.relation import (
    Bind,
    Change,
    Pair,
    PairRelation,
    pairs_at,
)
from icarus_lite.inference.network.kernels.side import Side
from icarus_lite.inference.network.kernels.tester import MatrixPlan, Slots, Tester, Truths


class ByteMatrix(PairRelation):
    """See the module. How it follows its columns is `MatrixRelation`'s business.

    Args:
        plan: What is known of the rule.
        columns: Its objects.
        bind: Gives the exact test and the gates over columns.

    Attributes:
        bits: One byte a pair, 1 where it holds: `bits[left * stride + right]`. Growth replaces it.
        stride: The length of a row.
    """

    __slots__ = (
        "_bind", "_codes", "_count", "_grid", "_held", "_plan", "_tester", "_window", "bits",
        "stride",
    )  # fmt: skip

    def __init__(self, plan: MatrixPlan, columns: tuple[Columns, Columns], bind: Bind) -> None:
        self._plan = plan
        self._bind = bind
        self._tester = Tester(plan, columns, bind)
        self._codes: Slots | None = None  # where the ones are, as long as that is known
        self._count = 0
        self._window: Truths | None = None  # the part of the matrix that has objects
        self._held: bytes | None = None  # what it was when it was last compared
        self.stride = 16
        self._allocate(16)

    def __len__(self) -> int:
        return self._count

    def holds(self, left: int, right: int) -> bool:
        """Tell whether a pair of slots is in the relation; the slots must be known to it."""
        return self.bits[left * self.stride + right] == 1

    def of_left(self, left: int) -> list[int]:
        """Give the right slots that are paired with a left one, in ascending order."""
        begin = left * self.stride
        return ones(self.bits, begin, begin + self._tester.right.size)

    def of_right(self, right: int) -> list[int]:
        """Give the left slots that are paired with a right one, in ascending order."""
        tester = self._tester
        if tester.mirrored:
            return self.of_left(right)
        column = self.bits[right : right + tester.left.size * self.stride : self.stride]
        return ones(column, 0, len(column))

    def pairs(self) -> Iterator[Pair]:
        """Give all pairs, in ascending order."""
        return ((i, j) for i in range(self._tester.left.size) for j in self.of_left(i))

    # What others have found.

    @property
    def sides(self) -> tuple[Side, Side]:
        """What the tests read of the left and of the right objects."""
        return self._tester.left, self._tester.right

    def is_ordinary(self, columns: Columns) -> bool:
        """Whether nothing is unusual that keeps others from following moves of these objects."""
        return all(side.is_ordinary(moving=side.columns is columns) for side in self.sides)

    def forget(self) -> None:
        """Rely no longer on where objects were: moves are followed elsewhere from now on."""
        self._codes = self._window = self._held = None

    def truths(self, left: Slots, right: Slots) -> Truths:
        """Tell of some pairs whether each is in the relation: (n,) from (n,) left and right."""
        return self._grid[left, right].view(np.bool_)

    def is_exactly(self, left: int, right: int) -> bool:
        """Ask the exact test about a pair.

        Raises:
            InferenceError: it cannot be evaluated.
        """
        return self._tester.is_exactly(left, right, on_left=True)

    def compare(self, hold: Truths, doubt: Truths | None) -> Change | None:
        """Give the net change to what holds now of all pairs; None if there is none.

        It has to be taken over with `apply`. In between, and until `forget`, nothing else may
        change the relation.

        Args:
            hold: (left, right) whether each pair meets the tests; it is written to.
            doubt: Likewise of which pairs that is not known; None if of none.

        Raises:
            InferenceError: a test cannot be evaluated for one in doubt.
        """
        tester, plan = self._tester, self._plan
        left, right = tester.left.size, tester.right.size
        if plan.distinct:
            if tester.same:
                hold.reshape(-1)[:: right + 1] = False
                if doubt is not None and plan.distinct_first:
                    doubt.reshape(-1)[:: right + 1] = False
            else:
                own = own_pairs(tester, np.arange(left), on_left=True)
                hold[own] = False
                if doubt is not None and plan.distinct_first:
                    doubt[own] = False
        if doubt is not None and doubt.any():
            for i, j in zip(*(each.tolist() for each in np.nonzero(doubt)), strict=True):
                hold[i, j] = tester.is_exactly(i, j, on_left=True)
        held = hold.tobytes()
        if held == self._held:
            return None
        self._held = held
        if self._window is None:
            self._window = self._grid[:left, :right].view(np.bool_)
        codes = (hold != self._window).ravel().nonzero()[0]
        if not len(codes):
            return None
        return pairs_at(codes, hold.ravel()[codes], right)

    def among(self, left: Slots, right: Slots, hold: Truths, doubt: Truths | None) -> Slots:
        """Give where in the matrix those of some pairs stand that hold: see `replace`.

        Args:
            left: (n,) their left slots.
            right: (n,) their right slots; each pair once.
            hold: (n,) whether each meets the tests; it is written to.
            doubt: (n,) of which that is not known; None if of none.

        Raises:
            InferenceError: a test cannot be evaluated for one in doubt.
        """
        tester, plan = self._tester, self._plan
        if plan.distinct:
            apart = left != right
            hold &= apart
            if doubt is not None and plan.distinct_first:
                doubt &= apart
        if doubt is not None:
            for place in np.flatnonzero(doubt).tolist():
                pair = int(left[place]), int(right[place])
                hold[place] = tester.is_exactly(*pair, on_left=True)
        return left[hold] * self.stride + right[hold]

    def replace(self, codes: Slots) -> Change:
        """Hold the pairs at these places of the matrix from now on, and no others; give the change.

        Args:
            codes: (n,) left slot * stride + right slot of each.
        """
        change = self._replace(codes)
        self._count += len(change[0]) - len(change[1])
        return change

    def _replace(self, codes: Slots) -> Change:
        self._held = None
        flat, stride, old = self._grid.reshape(-1), self.stride, self._codes
        if old is None:
            old = np.flatnonzero(flat.view(np.bool_))  # much faster than of bytes
        added = codes[flat[codes] == 0]
        flat[codes] = 2
        removed = old[flat[old] == 1]
        flat[removed] = 0
        flat[codes] = 1
        self._codes = codes
        return _as_pairs(added, stride), _as_pairs(removed, stride)

    def apply(self, added: Sequence[Pair], removed: Sequence[Pair]) -> None:
        """Take over a net change that was found elsewhere."""
        self._codes = None
        self._write(added, removed)

    # What is stored.

    def _reserve(self) -> None:
        """Make room for all objects."""
        left, right = self._tester.left.size, self._tester.right.size
        old = self._grid
        if left > old.shape[0] or right > self.stride:
            rows = max(old.shape[0], _roomy(left))
            self.stride = max(self.stride, _roomy(right))
            self._codes = None
            self._allocate(rows)
            self._grid[: old.shape[0], : old.shape[1]] = old

    def _allocate(self, rows: int) -> None:
        self._window = self._held = None
        self.bits = bytearray(rows * self.stride)
        self._grid = np.frombuffer(self.bits, dtype=np.uint8).reshape(rows, self.stride)

    def _write(self, added: Sequence[Pair], removed: Sequence[Pair]) -> None:
        self._count += len(added) - len(removed)
        bits, stride = self.bits, self.stride
        for i, j in added:
            bits[i * stride + j] = 1
        for i, j in removed:
            bits[i * stride + j] = 0


def _roomy(size: int) -> int:
    """Give a capacity with room to grow: a quarter more while it is small; whole cache lines."""
    return (size + size // 4 + 15) // 16 * 16 if size < 512 else (size + 63) // 64 * 64


def ones(row: bytes | bytearray, begin: int, end: int) -> list[int]:
    """Give the places of the ones in a stretch, found at the speed of memchr."""
    found = []
    place = row.find(1, begin, end)
    while place >= 0:
        found.append(place - begin)
        place = row.find(1, place + 1, end)
    return found


def _as_pairs(codes: Slots, stride: int) -> list[Pair]:
    codes.sort()
    i, j = np.divmod(codes, stride)
    return list(zip(i.tolist(), j.tolist(), strict=True))
