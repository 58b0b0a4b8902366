"""The objects of one percept type as columns: one list, and when asked one array, an attribute.

An object has a *slot*, a small integer that is its own as long as it is there. Numeric kernels
speak of slots only. The lists hold the values as they were given and are always up to date; the
arrays hold them as `float64` and are brought up to date when a kernel asks.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from struct import Struct
from typing import TYPE_CHECKING, TypeAlias

from icarus_lite.symbols import Value

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

Numbers: TypeAlias = "NDArray[np.float64]"
"""One number a slot, or one number a pair of slots."""

PLAIN = 2.0**20
"""Up to this magnitude a number is *plain*: the usual expressions of degree two in plain integers
stay below 2**53, so that `float64` computes them as exactly as Python does."""

_EXACT = 2.0**53  # an integer beyond it may be no float
_LONG_RUN = 5
"""So many slots in a row are written at once."""

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
        "_packed",
        "_stale",
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
        # None until a kernel asks: a domain without kernels never needs numpy.
        self._arrays: list[Numbers | None] = [None] * len(attributes)
        self._packed = 0, Struct("0d")
        # For each attribute the slots in which its array is out of date; None if all of it is.
        self._stale: list[list[int] | None] = [[] for _ in attributes]

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
        for stale in self._stale:
            if stale is not None:
                stale.append(slot)
        if self._stale and self._stale[0] is not None and len(self._stale[0]) > self.size:
            self._stale = [None] * len(self._stale)
        return slot

    def assign(
        self,
        slots: Sequence[int],
        moved: Sequence[tuple[int, Sequence[Value]]],
        first: int | None,
        *,
        plain: bool,
    ) -> None:
        """Set some attributes of some objects; `judge` them afterwards unless all values are plain.

        Args:
            slots: The objects, at least one.
            moved: For each attribute that changes its place among them, and one value an object.
            first: The first slot, if the slots follow one another without a gap; else None.
            plain: Whether all values are plain numbers.
        """
        count, size = len(slots), self.size
        lists, arrays, every = self.lists, self._arrays, self._stale
        if first is not None and self._packed[0] != count:
            self._packed = count, Struct(f"{count}d")
        for place, values in moved:
            column, stale = lists[place], every[place]
            if first is None:
                for slot, value in zip(slots, values):  # noqa: B905 # strict costs a tenth of it
                    column[slot] = value
            else:
                column[first : first + count] = values
                array = arrays[place]
                fits = plain and (count == size or stale == [])
                if fits and array is not None and len(array) >= size:
                    # Into its memory: a third of what it costs to assign them.
                    self._packed[1].pack_into(array.data, 8 * first, *values)
                    if stale != []:
                        every[place] = []
                    continue
            if stale is None:
                continue
            if 4 * (len(stale) + count) > size:
                every[place] = None
            else:
                stale.extend(slots)

    def judge(self, slots: Sequence[int]) -> None:
        """Find out which of some objects are unusual."""
        for slot in slots:
            self._judge(slot)

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
        made._stale = [None] * len(self.attributes)
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
        place = self.places[attribute]
        array, stale = self._arrays[place], self._stale[place]
        if array is None or stale or stale is None or self.size > len(array):
            array = self._refreshed(place)
        return array[: self.size]

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

    def _refreshed(self, place: int) -> Numbers:
        """Bring an attribute's array up to date; give it, spare room included."""
        array, stale, column = self._arrays[place], self._stale[place], self.lists[place]
        if array is None or self.size > len(array):
            import numpy as np  # noqa: PLC0415 - as above

            array = self._arrays[place] = np.zeros(max(16, 2 * self.size))
            stale = None
        if stale is not None:
            for slot in stale:
                value = column[slot]
                array[slot] = value if is_plain(value, _EXACT) else 0.0
        elif self.unusual:
            array[: self.size] = [v if is_plain(v, _EXACT) else 0.0 for v in column]
        else:
            array[: self.size] = column
        self._stale[place] = []
        return array


def first_of_run(slots: Sequence[int]) -> int | None:
    """Give the first of several slots that follow one another without a gap; else None."""
    if len(slots) < _LONG_RUN or slots[-1] - slots[0] != len(slots) - 1:
        return None
    return slots[0] if [*range(slots[0], slots[-1] + 1)] == slots else None
