"""The pairs of two sides, tested one by one or many at a time."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from icarus_lite.inference.network.kernels.columns import Columns, Numbers
from icarus_lite.inference.network.kernels.costs import Costs
from icarus_lite.inference.network.kernels.exact import ExactTest
from icarus_lite.inference.network.kernels.program import MaskFunction
from icarus_lite.inference.network.kernels.relation import Bind
from icarus_lite.inference.network.kernels.side import Side, SidePlan
from icarus_lite.records import dataclass

Truths = NDArray[np.bool_]
Slots = NDArray[np.intp]


@dataclass(frozen=True, slots=True)
class AxisPlan:
    """A bounded axis: which inputs are the places, and what bounds them.

    Args:
        left: The number of the left input.
        right: The number of the right input.
        limit: A constant, or a side (0 left, 1 right) and the number of its input.
        reach: Gives the greatest distance for the greatest limit.
    """

    left: int
    right: int
    limit: float | tuple[int, int]
    reach: Callable[[float], float]


@dataclass(frozen=True, slots=True)
class MatrixPlan:
    """What is known of a relation once a domain is compiled.

    Args:
        left: The left side.
        right: The right side.
        mask: Tests many pairs at once; None if only Python can.
        axes: The axes along which the distance is bounded.
        symmetric: Whether (b, a) holds whenever (a, b) does, both sides being the same objects.
        distinct: Whether an object is never paired with itself.
        distinct_first: Whether that is asked before anything else of a pair.
        costs: What the ways to update it cost.
    """

    left: SidePlan
    right: SidePlan
    mask: MaskFunction | None
    axes: tuple[AxisPlan, ...]
    symmetric: bool
    distinct: bool
    distinct_first: bool
    costs: Costs


class Tester:
    """The two sides of a rule over some columns.

    Args:
        plan: What is known of the rule.
        columns: Its objects.
        bind: Gives the exact test and the gates over columns.

    Attributes:
        left: The left side.
        right: The right side; the left one itself where the rule is symmetric.
        same: Whether both columns are the same.
        mirrored: Whether both sides are.
    """

    __slots__ = ("_bind", "_exact", "left", "mirrored", "plan", "right", "same")

    def __init__(self, plan: MatrixPlan, columns: tuple[Columns, Columns], bind: Bind) -> None:
        exact, gates = bind(columns)
        self.plan = plan
        self._bind = bind
        self._exact: ExactTest = exact
        self.same = columns[0] is columns[1]
        self.mirrored = self.same and plan.symmetric
        self.left = Side(plan.left, columns[0], gates[0])
        self.right = self.left
        if not self.mirrored:
            self.right = Side(plan.right, columns[1], gates[1])

    def copy(self, columns: tuple[Columns, Columns]) -> Tester:
        """Give the same over copies of the columns."""
        made = Tester(self.plan, columns, self._bind)
        made.left = self.left.copy(columns[0], made.left.gate)
        made.right = made.left
        if not self.mirrored:
            made.right = self.right.copy(columns[1], made.right.gate)
        return made

    def refresh(self, changed_left: Sequence[int], changed_right: Sequence[int]) -> None:
        """Follow the columns.

        Raises:
            InferenceError: a test about one object alone cannot be evaluated.
        """
        self.left.refresh(changed_left)
        if not self.mirrored:
            self.right.refresh(changed_right)

    @property
    def is_regular(self) -> bool:
        """Whether all pairs may be left to the kernels, but for those of one object."""
        left, right = self.left, self.right
        return not (left.absent or left.odd or right.absent or right.odd)

    def is_one(self, left: int, right: int) -> bool:
        """Tell whether both are the same object."""
        if self.same:
            return left == right
        return self.left.columns.names[left] == self.right.columns.names[right]

    def twin(self, slot: int, *, on_left: bool) -> int | None:
        """Give the slot of the same object on the other side."""
        if self.same:
            return slot
        own, others = (self.left, self.right) if on_left else (self.right, self.left)
        return others.columns.slots.get(own.columns.names[slot])

    def twins(self, slots: Sequence[int], *, on_left: bool) -> Sequence[int]:
        """Give the slots of the same objects on the other side, -1 where there is none."""
        if self.same:
            return slots
        own, others = (self.left, self.right) if on_left else (self.right, self.left)
        names, places = own.columns.names, others.columns.slots
        return [places.get(names[slot], -1) for slot in slots]

    def is_exactly(self, slot: int, other: int, *, on_left: bool) -> bool:
        """Ask the exact test; a pair with an absent object does not hold.

        Raises:
            InferenceError: it cannot be evaluated.
        """
        left, right = (slot, other) if on_left else (other, slot)
        if not (self.left.present[left] and self.right.present[right]):
            return False
        is_one = self.plan.distinct and self.is_one(left, right)
        if is_one and self.plan.distinct_first:
            return False
        return self._exact(left, right) and not is_one

    def mask(self, given: Sequence[Numbers]) -> tuple[Truths, Truths | None]:
        """Test pairs given as arrays: which hold, and of which that is in doubt."""
        mask = self.plan.mask
        assert mask is not None, "arrays are chosen only where they will do"
        with np.errstate(all="ignore"):
            hold, doubt = mask(*given)
        return hold, doubt

    def row(self, slot: int, *, on_left: bool) -> bytes | bytearray:
        """Test one object against all of the other side: a byte each.

        Raises:
            InferenceError: a test cannot be evaluated for one of the pairs.
        """
        own, others = (self.left, self.right) if on_left else (self.right, self.left)
        if not own.present[slot]:
            return bytes(others.size)
        if slot in own.odd:
            return self._exact_row(slot, others, on_left=on_left)
        programs = self.plan.left.programs if on_left else self.plan.right.programs
        try:
            row: bytes | bytearray = programs.row(slot, own.ready_lists(), others.ready_lists())
        except (ArithmeticError, ValueError):
            return self._exact_row(slot, others, on_left=on_left)
        if not others.is_regular:
            row = bytearray(map(int.__and__, row, others.present))
            for other in sorted(others.odd):
                row[other] = self.is_exactly(slot, other, on_left=on_left)
        if self.plan.distinct:
            twin = self.twin(slot, on_left=on_left)
            if twin is not None and row[twin]:
                row = bytearray(row)
                row[twin] = 0
        return row

    def _exact_row(self, slot: int, others: Side, *, on_left: bool) -> bytes:
        asked = (self.is_exactly(slot, other, on_left=on_left) for other in range(others.size))
        return bytes(asked)
