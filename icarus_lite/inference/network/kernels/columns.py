"""The objects of one percept type as columns: one list, and when asked one array, an attribute.

An object has a *slot*, a small integer that is its own as long as it is there. Numeric kernels
speak of slots only. The lists hold the values as they were given and are always up to date; the
arrays hold them as `float64` and are brought up to date when a kernel asks.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from icarus_lite.symbols import Value

Numbers: TypeAlias = NDArray[np.float64]
"""One number a slot, or one number a pair of slots."""

PLAIN = 2.0**20
"""Up to this magnitude a number is *plain*: the usual expressions of degree two in plain integers
stay below 2**53, so that `float64` computes them as exactly as Python does."""

_EXACT = 2.0**53  # an integer beyond it may be no float
_LONG_LOG = 1 << 14
_NUMERIC = (int, float)
_TYPES = frozenset(_NUMERIC)


def is_plain(value: object, limit: float = PLAIN) -> bool:
    """Tell whether a value is a Python number, no boolean, of at most this magnitude."""
    return type(value) in _NUMERIC and -limit <= value <= limit  # type: ignore[operator] # a number


class Columns:
    """Slots for the objects of one percept type (or of one pattern on it).

    An object that was dropped keeps its slot until `settle`, so that what is withdrawn with it can
    still be named; put again before that, it is back where it was.

    Args:
        attributes: The attributes that have a column.

    Attributes:
        names: The name of the object in each slot; that of the last one where the slot is empty.
        slots: The slot of each object that is there.
        lists: For each attribute the value in each slot, None where the object lacks it.
        alive: For each slot 1 if an object is there, else 0.
        size: How many slots there are, empty ones included.
        unusual: The slots with a value that is missing, no number, or not plain.
    """

    __slots__ = (
        "_arrays",
        "_free",
        "_leaving",
        "_log",
        "_synced",
        "alive",
        "attributes",
        "lists",
        "names",
        "places",
        "size",
        "slots",
        "unusual",
    )

    def __init__(self, attributes: tuple[str, ...]) -> None:
        self.attributes = attributes
        self.places: Mapping[str, int] = {name: n for n, name in enumerate(attributes)}
        self.names: list[Value] = []
        self.slots: dict[Value, int] = {}
        self.lists: tuple[list[Value | None], ...] = tuple([] for _ in attributes)
        self.alive = bytearray()
        self.size = 0
        self.unusual: set[int] = set()
        self._free: list[int] = []
        self._leaving: dict[Value, int] = {}
        self._arrays: list[Numbers] = [np.zeros(16) for _ in attributes]
        self._log: list[int] = []
        self._synced = [0] * len(attributes)

    def __len__(self) -> int:
        return len(self.slots)

    @property
    def has_holes(self) -> bool:
        """Whether some slot is empty."""
        return len(self.slots) != self.size

    def slot(self, name: Value) -> int:
        """Give the slot of an object that is there.

        Raises:
            KeyError: no such object is there.
        """
        return self.slots[name]

    def put(self, name: Value, values: Sequence[Value | None]) -> int:
        """Set the values of an object, new or not, in the order of the attributes.

        Args:
            name: The object.
            values: One value an attribute; None where the object lacks it.

        Returns:
            Its slot.
        """
        slot = self.slots.get(name)
        if slot is None:
            slot = self._take(name)
        for column, value in zip(self.lists, values):  # noqa: B905 # strict costs a tenth of it
            column[slot] = value
        # One sum judges all: it is large, or no number, wherever one of them is.
        if not (_TYPES.issuperset(map(type, values)) and sum(map(abs, values)) <= PLAIN):  # type: ignore[arg-type] # numbers
            self._judge(slot)
        elif self.unusual:
            self.unusual.discard(slot)
        self._log.append(slot)
        if len(self._log) > _LONG_LOG:
            self._forget_log()
        return slot

    def assign(self, slots: Sequence[int], moved: Sequence[tuple[int, Sequence[Value]]]) -> None:
        """Set some attributes of a few objects.

        Args:
            slots: The objects, by slot.
            moved: For each attribute that changes its place among them, and one value a slot.
        """
        ordinary = not self.unusual
        for place, values in moved:
            column = self.lists[place]
            for slot, value in zip(slots, values):  # noqa: B905 # strict costs a tenth of it
                column[slot] = value
                if not (
                    (type(value) is float or type(value) is int)
                    and -1048576.0 <= value <= 1048576.0
                ):
                    ordinary = False
        if not ordinary:
            for slot in slots:
                self._judge(slot)
        self._log.extend(slots)
        if len(self._log) > _LONG_LOG:
            self._forget_log()

    def move(self, slots: Sequence[int], moved: Mapping[str, NDArray[np.generic]]) -> None:
        """Set some attributes of many objects at once.

        Args:
            slots: The objects, by slot.
            moved: For each attribute that changes the new values, one a slot, integers or floats.
        """
        where = np.asarray(slots, dtype=np.intp)
        ordinary = True
        for attribute, values in moved.items():
            place = self.places[attribute]
            array, column = self._whole_array(place), self.lists[place]
            given = values.tolist()
            if _is_run(where, self.size):
                column[int(where[0]) : int(where[0]) + len(where)] = given
            else:
                for slot, value in zip(slots, given, strict=True):
                    column[slot] = value
            if values.dtype.kind in "if" and _all_plain(values):
                array[where] = values
            else:
                ordinary = False
        if not ordinary or self.unusual:
            for slot in slots:
                self._judge(slot)
        if not ordinary:
            self._log.extend(slots)

    def drop(self, name: Value) -> int:
        """Take an object away; give the slot it had.

        Raises:
            KeyError: no such object is there.
        """
        slot = self.slots.pop(name)
        self.alive[slot] = 0
        self._leaving[name] = slot
        return slot

    def copy(self) -> Columns:
        """Give columns with the same objects in the same slots."""
        made = Columns(self.attributes)
        made.names, made.slots = list(self.names), dict(self.slots)
        made.lists = tuple(list(column) for column in self.lists)
        made.alive, made.size = bytearray(self.alive), self.size
        made.unusual = set(self.unusual)
        made._free, made._leaving = list(self._free), dict(self._leaving)
        made._synced = [-1] * len(self.attributes)
        return made

    def settle(self) -> None:
        """Let the slots of dropped objects be used again; all relations must be up to date."""
        if self._leaving:
            self._free.extend(sorted(self._leaving.values(), reverse=True))
            self._leaving.clear()

    def column(self, attribute: str) -> list[Value | None]:
        """Give the values of an attribute by slot, as they were given."""
        return self.lists[self.places[attribute]]

    def array(self, attribute: str) -> Numbers:
        """Give the values of an attribute by slot as floats: (size,); 0 where one is no number."""
        return self._whole_array(self.places[attribute])[: self.size]

    def _take(self, name: Value) -> int:
        slot = self._leaving.pop(name, None)
        if slot is None and self._free:
            slot = self._free.pop()
            self.names[slot] = name
        elif slot is None:
            slot = self.size
            self.size += 1
            self.names.append(name)
            self.alive.append(0)
            for column in self.lists:
                column.append(None)
        self.alive[slot] = 1
        self.slots[name] = slot
        return slot

    def _judge(self, slot: int) -> None:
        if all(is_plain(column[slot]) for column in self.lists):
            self.unusual.discard(slot)
        else:
            self.unusual.add(slot)

    def _whole_array(self, place: int) -> Numbers:
        """Give an attribute's array, spare room included, brought up to date."""
        array, log, synced = self._arrays[place], self._log, self._synced[place]
        if self.size > len(array):
            array = self._arrays[place] = np.zeros(2 * self.size)
            synced = -1
        elif synced == len(log):
            return array
        column = self.lists[place]
        if synced < 0 or 4 * (len(log) - synced) > self.size:
            if self.unusual:
                array[: self.size] = [v if is_plain(v, _EXACT) else 0.0 for v in column]
            else:
                array[: self.size] = column
        else:
            for slot in log[synced:]:
                value = column[slot]
                array[slot] = value if is_plain(value, _EXACT) else 0.0
        self._synced[place] = len(self._log)
        return array

    def _forget_log(self) -> None:
        """Start the log again, as it has grown long; all arrays will be made anew."""
        self._log.clear()
        self._synced = [-1] * len(self._synced)


def _is_run(where: NDArray[np.intp], size: int) -> bool:
    """Tell whether slots follow one another without a gap."""
    return 0 < len(where) <= size and bool((np.diff(where) == 1).all())


def _all_plain(values: NDArray[np.generic]) -> bool:
    return values.size == 0 or bool(values.min() >= -PLAIN and values.max() <= PLAIN)
