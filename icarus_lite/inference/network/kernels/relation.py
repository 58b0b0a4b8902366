"""What the rest of the network sees of a pair rule: a relation between slots, kept up to date."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from icarus_lite.inference.network.kernels.columns import Columns
from icarus_lite.inference.network.kernels.exact import ExactTest
from icarus_lite.inference.network.kernels.side import Gate

Pair: TypeAlias = tuple[int, int]
"""A left and a right slot."""

Change: TypeAlias = tuple[list[Pair], list[Pair]]
"""The pairs that hold now and did not before, and those that did and do not now."""


Bound: TypeAlias = tuple[ExactTest, tuple[Gate | None, Gate | None]]
"""The exact test of a rule and its gates, over the columns of an instance."""

Bind: TypeAlias = Callable[[tuple[Columns, Columns]], Bound]
"""Gives the exact test and the gates over columns."""


_MANY_CODES = 50
"""From so many on codes are taken apart by numpy."""


def pairs_at(codes: NDArray[np.intp], gained: NDArray[np.bool_], width: int) -> Change:
    """Give the pairs that stand at some places of a matrix: those gained, and those lost.

    Args:
        codes: (n,) the places, row by row.
        gained: (n,) whether the pair there is gained.
        width: The length of a row.
    """
    added: list[Pair] = []
    removed: list[Pair] = []
    if len(codes) < _MANY_CODES:
        for code, kind in zip(codes.tolist(), gained.tolist(), strict=True):
            (added if kind else removed).append(divmod(code, width))
        return added, removed
    i, j = np.divmod(codes, width)
    lost = ~gained
    added += zip(i[gained].tolist(), j[gained].tolist(), strict=True)
    removed += zip(i[lost].tolist(), j[lost].tolist(), strict=True)
    return added, removed


class PairRelation(ABC):
    """The pairs of objects that meet the tests of a rule.

    The objects are those of two `Columns`, which may be the same. After they have changed, `update`
    is told the slots of all objects that are new, changed or gone; until then the relation is that
    of before. An update that raises InferenceError leaves the relation as it was: it may be tried
    again, with at least the same slots, once the columns have been put right.
    """

    __slots__ = ()

    @abstractmethod
    def update(self, changed_left: Sequence[int], changed_right: Sequence[int]) -> Change:
        """Follow the columns; give the net change, in no particular but always the same order.

        Args:
            changed_left: Slots of the left columns that are new, changed or gone, each once.
            changed_right: Likewise on the right; the same ones where the columns are the same.

        Raises:
            InferenceError: a test cannot be evaluated for a pair.
        """

    @abstractmethod
    def load(self) -> None:
        """Follow the columns from scratch, whatever has changed, without saying what it was.

        Raises:
            InferenceError: a test cannot be evaluated for a pair.
        """

    @abstractmethod
    def holds(self, left: int, right: int) -> bool:
        """Tell whether a pair of slots is in the relation; the slots must be known to it."""

    @abstractmethod
    def of_left(self, left: int) -> Iterable[int]:
        """Give the right slots that are paired with a left one, in ascending order."""

    @abstractmethod
    def of_right(self, right: int) -> Iterable[int]:
        """Give the left slots that are paired with a right one, in ascending order."""

    @abstractmethod
    def pairs(self) -> Iterable[Pair]:
        """Give all pairs, in ascending order."""

    @abstractmethod
    def copy(self, left: Columns, right: Columns) -> PairRelation:
        """Give a relation in the same state over copies of its columns."""

    @abstractmethod
    def __len__(self) -> int:
        """Give the number of pairs."""
