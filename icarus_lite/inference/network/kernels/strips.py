"""The few objects near one that has moved, found in sorted places along one axis."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Sequence

from icarus_lite.inference.network.kernels.keys import Keys
from icarus_lite.inference.network.kernels.side import Side
from icarus_lite.inference.network.kernels.tester import AxisPlan, Tester

_WIDER = 1 + 1e-6
_SLACK = 1e-150  # where the square of a difference underflows, the difference is not yet zero
_ROUNDING = 2.0**-50  # of place + reach, relative to the place

_NOWHERE = float("inf")


class Strips:
    """The places of all objects along the axis on which the bound on their distance tells most.

    An absent or odd object is nowhere. It has to be told of every change, or made anew.

    Args:
        tester: The pairs; along some axis their distance is bounded.

    Attributes:
        candidates: About how many objects are within reach of one.
    """

    __slots__ = ("_axis", "_left", "_most", "_right", "_tester", "candidates")

    def __init__(self, tester: Tester) -> None:
        self._tester = tester
        self.candidates = _NOWHERE
        for axis in tester.plan.axes:
            left = _places(tester.left, axis.left)
            right = left
            if not (tester.mirrored and axis.left == axis.right):
                right = _places(tester.right, axis.right)
            most = _most(axis, tester)
            spread = _spread(left, right)
            share = min(1.0, 2 * axis.reach(most) / spread) if spread > 0 else 1.0
            if share * tester.right.size < self.candidates:
                self.candidates = share * tester.right.size
                self._axis, self._most, self._left, self._right = axis, most, left, right

    def move(self, changed_left: Sequence[int], changed_right: Sequence[int]) -> None:
        """Follow objects that have moved, come or gone."""
        tester, axis = self._tester, self._axis
        _move(self._left, tester.left, axis.left, changed_left)
        if self._right is not self._left:
            _move(self._right, tester.right, axis.right, changed_right)
        if isinstance(axis.limit, tuple):
            side, number = axis.limit
            own, changed = (tester.right, changed_right) if side else (tester.left, changed_left)
            limits = own.ready_lists()[number]
            for slot in changed:
                if limits[slot] > self._most and own.present[slot]:
                    self._most = limits[slot]

    def near(self, slot: int, *, on_left: bool) -> list[int]:
        """Give the objects of the other side that may be within reach of one."""
        axis, most = self._axis, self._most
        own, others, side = (self._left, self._right, self._tester.left)
        if not on_left:
            own, others, side = self._right, self._left, self._tester.right
        if isinstance(axis.limit, tuple) and axis.limit[0] == (not on_left):
            most = side.ready_lists()[axis.limit[1]][slot]
        place = own.values[slot]
        reach = max(axis.reach(most), 0.0) * _WIDER + _SLACK + abs(place) * _ROUNDING
        ranked = others.ranked
        low, high = bisect_left(ranked, place - reach), bisect_right(ranked, place + reach)
        return others.slots[low:high]


def _places(side: Side, number: int) -> Keys:
    keys = Keys(_NOWHERE)
    values = side.ready_arrays()[number].copy()
    if not side.is_regular:
        values[~side.regular()] = _NOWHERE
    keys.replace(values)
    keys.rank()
    return keys


def _move(keys: Keys, side: Side, number: int, changed: Sequence[int]) -> None:
    if side.size > len(keys.values):
        keys.grow(side.size)
        keys.rank()
    values, present, odd = side.ready_lists()[number], side.present, side.odd
    for slot in changed:
        place = values[slot] if present[slot] and slot not in odd else _NOWHERE
        if place != keys.values[slot]:
            keys.set(slot, place)


def _most(axis: AxisPlan, tester: Tester) -> float:
    if not isinstance(axis.limit, tuple):
        return axis.limit
    side = tester.right if axis.limit[0] else tester.left
    return float(max(side.ready_lists()[axis.limit[1]], default=0.0))


def _spread(left: Keys, right: Keys) -> float:
    """Give how far apart the outermost objects are."""
    found = [key for keys in (left, right) for key in keys.ranked if key != _NOWHERE]
    return max(found) - min(found) if found else 0.0
