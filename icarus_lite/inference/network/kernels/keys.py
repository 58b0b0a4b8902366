"""Numbers by slot, and the slots in the order of their numbers, kept so one move at a time."""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from collections.abc import Callable, Mapping, Sequence
from typing import TypeAlias

import numpy as np

from icarus_lite.inference.network.kernels.columns import Numbers

Cut: TypeAlias = Callable[[list[float], float], int]
"""Gives the place of a key in ascending keys: `bisect_left` or `bisect_right`."""

Passed: TypeAlias = list[tuple[int, list[int]]]
"""Slots, each with those that it has passed."""

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

    def move(
        self,
        slots: Sequence[int],
        fresh: Mapping[int, float] | Sequence[float],
        others: Keys,
        cut: Cut,
    ) -> tuple[Passed, Passed]:
        """Give some slots new keys; give whom each has passed, upwards and downwards.

        Args:
            slots: The slots, each once.
            fresh: Their keys, by slot.
            others: The keys that they may pass; both orders must be up to date.
            cut: Says where in the order of the others a key stands.
        """
        up: Passed = []
        down: Passed = []
        values, ranked, own, known = self.values, self.ranked, self.slots, others.ranked
        last = len(ranked) - 1
        for slot in slots:
            key, before = fresh[slot], values[slot]
            if key == before:
                continue
            old, new = cut(known, before), cut(known, key)
            if new > old:
                up.append((slot, others.slots[old:new]))
            elif new < old:
                down.append((slot, others.slots[new:old]))
            place = bisect_left(ranked, before)
            if (
                own[place] == slot
                and (not place or ranked[place - 1] <= key)
                and (place == last or key <= ranked[place + 1])
            ):
                values[slot] = ranked[place] = key  # as `set` would: mostly it passes none
            else:
                self.set(slot, key)
        self._array = None
        return up, down

    def copy(self) -> Keys:
        """Give the same keys, to go on with apart from these."""
        made = Keys(self.none)
        made.values, made.ranked = list(self.values), list(self.ranked)
        made.slots, made.is_ranked = list(self.slots), self.is_ranked
        return made
