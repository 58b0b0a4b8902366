"""Tables: the objects of one percept type, as columns that generated code and kernels read."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from icarus_lite.inference.network.kernels.columns import Columns, first_of_run
from icarus_lite.symbols import Value


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

    __slots__ = ("_last_first", "_last_names", "_last_slots", "_others", "lists", "objects")

    def __init__(self, numeric: Sequence[str], others: Sequence[str]) -> None:
        self.objects = Objects(Columns(tuple(numeric)))
        own: dict[str, list[Value | None]] = {name: [] for name in others}
        self._others = own
        self.lists: dict[str, list[Value | None]] = dict(own)
        for name in numeric:
            self.lists[name] = self.objects.columns.column(name)
        # Which objects have moved last, their slots, and the first of them if they are a run.
        self._last_names: list[Value] = []
        self._last_slots: list[int] = []
        self._last_first: int | None = None

    def put(self, name: Value, attributes: Mapping[str, Value]) -> int:
        """Set an object, new or not; give its slot."""
        self._last_names = []
        columns = self.objects.columns
        slot = self.objects.put(name, [attributes.get(each) for each in columns.attributes])
        for attribute, column in self._others.items():
            if slot == len(column):
                column.append(attributes.get(attribute))
            else:
                column[slot] = attributes.get(attribute)
        return slot

    def move(
        self, names: Sequence[Value], moved: Mapping[str, tuple[Value, ...]], *, plain: bool
    ) -> list[int]:
        """Set some attributes of objects that are there; give their slots.

        Args:
            names: The objects.
            moved: For each attribute one value an object.
            plain: Whether all values are plain numbers.
        """
        if names != self._last_names:  # mostly the same objects move again
            known = self.objects.places
            self._last_names = [*names]
            slots = self._last_slots = [known[name] for name in names]
            self._last_first = first_of_run(slots)
        slots, columns = self._last_slots, self.objects.columns
        places = columns.places
        try:  # mostly all of them are numeric
            numeric = [(places[attribute], values) for attribute, values in moved.items()]
        except KeyError:
            numeric = [(places[each], values) for each, values in moved.items() if each in places]
            for attribute in moved.keys() & self._others.keys():
                column = self._others[attribute]
                for slot, value in zip(slots, moved[attribute], strict=True):
                    column[slot] = value
        columns.assign(slots, numeric, self._last_first, plain=plain)
        if not plain or columns.unusual:
            columns.judge(slots)
        return [*slots]

    def drop(self, name: Value) -> int:
        """Take an object away; give the slot it had, which is its own until `settle`."""
        self._last_names = []
        return self.objects.drop(name)
