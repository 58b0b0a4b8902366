"""What each way to update a relation costs: the one place for measured constants.

Microseconds of CPU time on one core of a server of 2020-2024 under CPython 3.11 and numpy 2;
`benchmarks/kernels.py` measures them again. Only their ratios matter, and those roughly: near a
crossover two ways cost about the same.
"""

from __future__ import annotations

from collections.abc import Sequence

from icarus_lite.language.syntax import Call, Expression
from icarus_lite.records import dataclass

LIST_ROW = 0.7
"""A row of a list comprehension: the call, the bytes, the comparison with the old row."""

LIST_OPERATION = 0.010
"""One operation on one pair in a list comprehension."""

LIST_PAIR = 0.025
"""What else one pair costs there."""

NEAR_ROW = 3.5
"""An object tested against those in its strip: finding them, comparing with its old partners."""

NEAR_OPERATION = 0.008
"""One operation on one candidate of a strip."""

BLOCK = 14.0
"""A block of rows by numpy: bringing arrays up to date, comparing with the old rows."""

BLOCK_OPERATION = 1.1
"""One numpy operation, however small."""

BLOCK_PAIR = 0.0011
"""One numpy operation on one pair of a block."""

SWEEP = 100.0
"""A sweep: the sort, the neighbours, the comparison with the old pairs."""

SWEEP_OPERATION = 2.0
"""One numpy operation on all candidates, apart from their number."""

SWEEP_OBJECT = 0.17
"""One object in a sweep in which it has about ten neighbours."""

ORDER_MOVE = 1.5
"""One object that moves in the sorted keys of an order."""

ORDER_ALL = 20.0
"""All keys of an order compared with all by numpy, before and after."""

ORDER_ALL_PAIR = 0.0025
"""One pair there."""

ORDER_SORT = 60.0
"""All keys of an order sorted and compared with the old ones by numpy."""

ORDER_SORT_OBJECT = 0.3
"""One object there."""


GROUP_MOVE = 4.0
"""An object that moves, its partners by all rules of a group found and compared."""

GROUP_PLACE = 0.025
"""One object looked at to see whether it is near, up to a hundred objects; then they are sorted."""

GROUP_PAIR = 0.0005
"""One numpy operation on one pair there; what rules have in common is computed once."""

GROUP_NEAR = 60.0
"""A grid of all objects for a group."""

GROUP_NEAR_OBJECT = 0.7
"""One object there, and all pairs of which it is the left one."""

FEW_MOVED = 400
"""More moved objects than that are never followed one by one together."""

FLAT = 6.0
"""All pairs of all rules of a group laid out, and compared with those of before."""

FLAT_OPERATION = 0.5
"""One operation there; those that are alike share a numpy call."""

FLAT_PAIR = 0.0008
"""One operation on one pair there."""

GROUP_CALL = 8.0
"""All pairs of all rules of a group, apart from the operations."""


@dataclass(frozen=True, slots=True)
class Costs:
    """Estimates for the tests of one rule, in microseconds.

    Args:
        operations: How many operations they take a pair.
    """

    operations: int

    @classmethod
    def of(cls, tests: Sequence[Expression], inputs: Sequence[Expression]) -> Costs:
        """Count the operations of tests, parts that occur twice and inputs only once."""
        parts = {part for test in tests for part in _inside(test, frozenset(inputs))}
        return cls(sum(max(1, len(part.args) - 1) for part in parts))

    def lists(self, rows: int, pairs: int) -> float:
        """Estimate list comprehensions over so many rows and columns with so many pairs in all."""
        return LIST_ROW * rows + (LIST_PAIR + LIST_OPERATION * self.operations) * pairs

    @property
    def few_pairs(self) -> int:
        """Up to so many pairs, list comprehensions are cheapest without looking further.

        Half of where blocks overtake them: in between, strips may be cheaper than both.
        """
        block = BLOCK + BLOCK_OPERATION * self.operations
        return int(0.5 * block / (LIST_PAIR + LIST_OPERATION * self.operations))

    def strips(self, rows: int, candidates: float) -> float:
        """Estimate so many objects each tested against so many candidates in its strip."""
        return rows * (NEAR_ROW + (LIST_PAIR + NEAR_OPERATION * self.operations) * candidates)

    def blocks(self, calls: int, pairs: int) -> float:
        """Estimate numpy blocks."""
        return calls * (BLOCK + BLOCK_OPERATION * self.operations) + (
            BLOCK_PAIR * self.operations * pairs
        )

    def sweep(self, objects: int) -> float:
        """Estimate a sweep over all objects."""
        return SWEEP + SWEEP_OPERATION * self.operations + SWEEP_OBJECT * objects

    def moves(self, moved: int) -> float:
        """Estimate keys of an order moved one after the other."""
        return ORDER_MOVE * moved

    def every_key(self, pairs: int) -> float:
        """Estimate all keys of an order compared with all."""
        return ORDER_ALL + ORDER_ALL_PAIR * pairs

    def sorted_keys(self, objects: int) -> float:
        """Estimate all keys of an order sorted."""
        return ORDER_SORT + ORDER_SORT_OBJECT * objects


@dataclass(frozen=True, slots=True)
class OneWay(Costs):
    """Costs by which one way always seems the cheapest: to measure it, or to test it, alone.

    Args:
        way: `list`, `strip`, `block` or `sweep`; of an order of keys, single moves are its lists,
            all keys against all its block, and sorting them its sweep.
    """

    way: str = "list"

    @property
    def few_pairs(self) -> int:
        """Leave nothing to the short cut."""
        return -1

    def lists(self, rows: int, pairs: int) -> float:
        """See `Costs`."""
        return self._price("list", rows + pairs)

    def strips(self, rows: int, candidates: float) -> float:
        """See `Costs`."""
        return self._price("strip", rows + candidates)

    def blocks(self, calls: int, pairs: int) -> float:
        """See `Costs`."""
        return self._price("block", calls + pairs)

    def sweep(self, objects: int) -> float:
        """See `Costs`."""
        return self._price("sweep", objects)

    def moves(self, moved: int) -> float:
        """See `Costs`."""
        return self._price("list", moved)

    def every_key(self, pairs: int) -> float:
        """See `Costs`."""
        return self._price("block", pairs)

    def sorted_keys(self, objects: int) -> float:
        """See `Costs`."""
        return self._price("sweep", objects)

    def _price(self, way: str, size: float) -> float:
        return 0.0 if way == self.way else 1.0 + size


@dataclass(frozen=True, slots=True)
class GroupCosts:
    """Estimates for the rules of a group together, in microseconds.

    Args:
        operations: How many operations they take a pair, all together.
        rules: How many of them are kept as a matrix.
        boxed: Whether bounds on distances spare them most pairs.
    """

    operations: int
    rules: int
    boxed: bool

    @classmethod
    def of(cls, costs: Sequence[Costs], *, boxed: bool) -> GroupCosts:
        """Sum up what the rules cost."""
        return cls(sum(each.operations for each in costs), len(costs), boxed)

    def choose(self, moved: int, size: int, *, arrays: bool) -> str:
        """Choose a way: `few`, `flat`, `whole` or `near`, or `alone`: each rule by itself.

        Args:
            moved: How many objects have moved.
            size: How many there are, on whichever side are more.
            arrays: Whether the rules can be tested by arrays.
        """
        places = min(size, 100) if self.boxed else size
        rate = GROUP_PLACE
        if not self.boxed:
            rate += LIST_OPERATION * self.operations
        ways = {"few": moved * (GROUP_MOVE + rate * places)}
        if arrays:
            call = GROUP_CALL + BLOCK_OPERATION * self.operations
            ways["flat"] = (
                FLAT + FLAT_OPERATION * self.operations + FLAT_PAIR * self.operations * size * size
            )
            ways["whole"] = call + GROUP_PAIR * self.operations * size * size
            if self.boxed:
                ways["near"] = GROUP_NEAR + call + GROUP_NEAR_OBJECT * size
        way = min(ways, key=ways.__getitem__)
        # With no bound and no arrays the rules do as well by themselves.
        return "alone" if way == "few" and moved > FEW_MOVED else way


@dataclass(frozen=True, slots=True)
class OneGroupWay(GroupCosts):
    """Costs by which one way always seems the cheapest: to measure it, or to test it, alone.

    Args:
        way: `few`, `flat`, `near`, `whole` or `alone`.
    """

    way: str = "few"

    def choose(self, moved: int, size: int, *, arrays: bool) -> str:  # noqa: ARG002 - see `GroupCosts`
        """See `GroupCosts`."""
        return self.way


def _inside(test: Expression, inputs: frozenset[Expression]) -> list[Call]:
    if test in inputs or not isinstance(test, Call):
        return []
    return [test, *(part for each in test.args for part in _inside(each, inputs))]
