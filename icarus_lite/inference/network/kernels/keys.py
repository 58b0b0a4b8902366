"""Numbers by slot, and the slots in the order of their numbers, kept so one move at a time."""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right

import numpy as np

from icarus_lite.inference.network.kernels.columns import Numbers

_MANY = 64
"""From so many keys on numpy sorts faster."""


class Keys:
    """The keys of one side, and the slots in the order of their keys.

    Args:
        none: The key of a slot whose object takes no part: an infinity.

    Attributes:
        values: The key of each slot.
        ranked: The keys in ascending order.
        slots: Their slots in that order.
        is_ranked: Whether the two are up to date.
    """

    __slots__ = ("_array", "is_ranked", "none", "ranked", "slots", "values")

    def __init__(self, none: float) -> None:
        self.none = none
        self.values: list[float] = []
        self.ranked: list[float] = []
        self.slots: list[int] = []
        self.is_ranked = True
        self._array: Numbers | None = None

    def rank(self) -> None:
        """Put the keys in order, unless they are."""
        if self.is_ranked:
            return
        values = self.values
        if len(values) < _MANY:
            self.slots = sorted(range(len(values)), key=values.__getitem__)
        else:
            self.slots = np.argsort(self.array(), kind="stable").tolist()
        self.ranked = [values[slot] for slot in self.slots]
        self.is_ranked = True

    def array(self) -> Numbers:
        """Give the key of each slot as an array: (size,)."""
        if self._array is None:
            self._array = np.array(self.values, dtype=np.float64)
        return self._array

    def replace(self, values: Numbers) -> None:
        """Give every slot a new key: (size,)."""
        self._array = values
        self.values = values.tolist()
        self.is_ranked = False

    def grow(self, size: int) -> None:
        """Make room for more slots, none of which has a key yet."""
        more = size - len(self.values)
        if more > 0:
            self.values.extend([self.none] * more)
            self.is_ranked = False
            self._array = None

    def set(self, slot: int, key: float) -> None:
        """Give a slot a new key; the order must be up to date, and stays so."""
        ranked, slots = self.ranked, self.slots
        place = bisect_left(ranked, self.values[slot])
        if slots[place] != slot:
            place = slots.index(slot, place)
        self.values[slot] = key
        self._array = None
        before = ranked[place - 1] if place else -math.inf
        after = ranked[place + 1] if place + 1 < len(ranked) else math.inf
        if before <= key <= after:
            ranked[place] = key
            return
        del ranked[place], slots[place]
        place = bisect_right(ranked, key)
        ranked.insert(place, key)
        slots.insert(place, slot)

    def copy(self) -> Keys:
        """Give the same keys, to go on with apart from these."""
        made = Keys(self.none)
        made.values, made.ranked = list(self.values), list(self.ranked)
        made.slots, made.is_ranked = list(self.slots), self.is_ranked
        return made
