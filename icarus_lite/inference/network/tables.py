"""Tables: the objects of one percept type, as columns that generated code and kernels read."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from icarus_lite.inference.network.kernels import Columns
from icarus_lite.symbols import Value

_MANY = 40
"""From so many moved objects on, columns are written by numpy."""


class Objects:
    """The objects that kernels see, and where each stands until all kernels have seen it go.

    Attributes:
        columns: What the kernels read.
        places: The slot of each object, of those that were dropped as well until `settle`.
    """

    __slots__ = ("_leaving", "columns", "places")

    def __init__(self, columns: Columns) -> None:
        self.columns = columns
        self.places: dict[Value, int] = {}
        self._leaving: list[Value] = []

    def put(self, name: Value, values: Sequence[Value | None]) -> int:
        """Set the values of an object, new or not; give its slot."""
        slot = self.places[name] = self.columns.put(name, values)
        return slot

    def drop(self, name: Value) -> int:
        """Take an object away; give the slot it had."""
        self._leaving.append(name)
        return self.columns.drop(name)

    def settle(self) -> None:
        """Let the slots of dropped objects be used again."""
        if self._leaving:
            for name in self._leaving:
                if name not in self.columns.slots:
                    del self.places[name]
            self._leaving.clear()
            self.columns.settle()


class Table:
    """The objects of one percept type, those of its subtypes included.

    Each object has a slot. Attributes that kernels read are kept in their columns, the others in
    lists beside them; attributes that nothing in the domain looks at are not kept.

    Args:
        numeric: The attributes that kernels read.
        others: The other attributes that patterns look at.

    Attributes:
        objects: The objects as kernels see them; their columns give out the slots.
        lists: For each attribute its values by slot, None where an object lacks it.
    """

    __slots__ = ("_others", "lists", "objects")

    def __init__(self, numeric: Sequence[str], others: Sequence[str]) -> None:
        self.objects = Objects(Columns(tuple(numeric)))
        own: dict[str, list[Value | None]] = {name: [] for name in others}
        self._others = own
        self.lists: dict[str, list[Value | None]] = dict(own)
        for name in numeric:
            self.lists[name] = self.objects.columns.column(name)

    def put(self, name: Value, attributes: Mapping[str, Value]) -> int:
        """Set an object, new or not; give its slot."""
        columns = self.objects.columns
        slot = self.objects.put(name, [attributes.get(each) for each in columns.attributes])
        for attribute, column in self._others.items():
            if slot == len(column):
                column.append(attributes.get(attribute))
            else:
                column[slot] = attributes.get(attribute)
        return slot

    def move(self, names: Sequence[Value], moved: Mapping[str, Sequence[Value]]) -> list[int]:
        """Set some attributes of objects that are there; give their slots.

        Args:
            names: The objects.
            moved: For each attribute one value an object.
        """
        known, columns = self.objects.places, self.objects.columns
        slots = [known[name] for name in names]
        numeric: list[tuple[int, Sequence[Value]]] = []
        for attribute, values in moved.items():
            place = columns.places.get(attribute)
            if place is not None:
                numeric.append((place, values))
                continue
            column = self._others.get(attribute)
            if column is not None:
                for slot, value in zip(slots, values, strict=True):
                    column[slot] = value
        if not numeric:
            return slots
        if len(slots) >= _MANY:
            arrays = {columns.attributes[place]: np.asarray(values) for place, values in numeric}
            if all(array.dtype.kind in "if" for array in arrays.values()):
                columns.move(slots, arrays)
                return slots
        columns.assign(slots, numeric)
        return slots

    def drop(self, name: Value) -> int:
        """Take an object away; give the slot it had, which is its own until `settle`."""
        return self.objects.drop(name)
