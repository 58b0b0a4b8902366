"""All pairs of a few objects, tested at once and laid out one after the other.

The arrays that change are copied into one (*the cells*), from which the operands of all tests are
taken by one index made beforehand. What does not change was laid out once.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from icarus_lite.inference.network.kernels.columns import Columns, Numbers
from icarus_lite.inference.network.kernels.group_flat_source import FlatSource, Plane
from icarus_lite.inference.network.kernels.matrix import MatrixRelation
from icarus_lite.inference.network.kernels.order import OrderRelation
from icarus_lite.inference.network.kernels.relation import Change, Pair
from icarus_lite.inference.network.kernels.tester import Slots, Truths
from icarus_lite.records import dataclass

if TYPE_CHECKING:
    from numpy.typing import NDArray

Row: TypeAlias = "NDArray[np.float64] | NDArray[np.bool_]"
"""(n,) numbers or truth values, one a pair, of one plane or of several after one another."""

Test: TypeAlias = Callable[[], Sequence[tuple[Truths, Truths | None]]]
"""Gives for each member which pairs meet the tests, and of which that is not known."""


@dataclass(frozen=True, slots=True)
class _Pairs:
    """The pairs of a plane: (n,) their left and their right slots, and both of each."""

    left: Slots
    right: Slots
    each: list[Pair]

    @classmethod
    def of(cls, plane: Plane, left: int, right: int) -> _Pairs:
        """Give all pairs of so many left with so many right objects."""
        i, j = np.divmod(np.arange(left * right), max(right, 1))
        if plane.apart:
            i, j = i[i != j], j[i != j]
        return cls(i, j, list(zip(i.tolist(), j.tolist(), strict=True)))


class FlatPairs:
    """The relations of a group, followed by testing all of their pairs.

    Args:
        source: What was generated.
        space: The generated functions.
        columns: For each array that these read its columns and attribute.
        types: The columns of each type that a plane names.
        relations: The relation of each member.

    Attributes:
        is_armed: Whether it is ready to follow.
    """

    __slots__ = (
        "_buffer", "_cells", "_changed", "_changing", "_columns", "_derive", "_flat", "_flat_over",
        "_given", "_held", "_index", "_moving", "_moving_given", "_pairs", "_places", "_relations",
        "_sizes", "_source", "_types", "is_armed",
    )  # fmt: skip

    def __init__(
        self,
        source: FlatSource,
        space: Mapping[str, Any],
        columns: Mapping[str, tuple[Columns, str]],
        types: Mapping[str, Columns],
        relations: Sequence[MatrixRelation | OrderRelation],
    ) -> None:
        self._source = source
        self._derive: Callable[..., list[Numbers]] = space["derive"]
        self._flat_over: Callable[[Sequence[Row]], Test] = space["flat_over"]
        self._flat: Test = tuple
        self._columns, self._types, self._relations = columns, types, relations
        self.is_armed = False
        self._sizes: list[tuple[int, int]] = []
        self._pairs: list[_Pairs] = []
        self._moving: list[tuple[Columns, str]] = []
        self._given: list[Numbers] = []
        self._moving_given: list[tuple[int, int]] = []
        self._changing: list[Numbers] = []  # those of moving columns, then what is derived
        self._places: dict[str, int] = {}  # of each of these by name
        # The cells, first those that change; whence and where to operands are taken of them.
        self._cells, self._changed = np.zeros(0), np.zeros(0)
        self._index, self._buffer = np.arange(0), np.zeros(0)
        # Of each member what held when it was last tested, as an array and as bytes.
        self._held: list[tuple[Truths, bytes] | None] = [None] * len(relations)

    def forget(self) -> None:
        """Rely no longer on what held last: relations have followed otherwise since."""
        self._held = [None] * len(self._relations)

    def disarm(self) -> None:
        """Be ready no longer. All pairs are many: they are laid out only if it is asked again."""
        self.is_armed = False

    def arm(self, moved: Columns, attributes: Sequence[str]) -> None:
        """Be ready to follow moves of some objects, of which only these attributes change."""
        self.forget()
        self.is_armed = True
        source = self._source
        names = [
            name
            for name, (columns, attribute) in self._columns.items()
            if columns is moved and attribute in attributes
        ]
        self._moving = [self._columns[name] for name in names]
        self._given = [self._array(name) for name in source.given]
        self._moving_given = [
            (place, names.index(name)) for place, name in enumerate(source.given) if name in names
        ]
        self._changing = [*map(self._array, names), *self._derive(*self._given)]
        self._places = {name: n for n, name in enumerate([*names, *source.derived])}
        self._lay()

    def _array(self, name: str) -> Numbers:
        columns, attribute = self._columns[name]
        return columns.array(attribute)

    def _lay(self) -> None:
        """Make room for all rows, and lay out those that do not change."""
        source = self._source
        self._pair()
        changes = [
            any(source.operands[text][0] in self._places for text in store.inputs)
            for store in source.stacked.stores
        ]
        index = self._fill(changes)
        self._index = np.concatenate(index)
        self._buffer = np.zeros(len(self._index))
        found, taken = [], 0
        for store, is_changing in zip(source.stacked.stores, changes, strict=True):
            bounds = np.cumsum([0, *(len(self._pairs[n].each) for n in store.planes)]).tolist()
            if is_changing:
                memory: Row = self._buffer[taken : taken + bounds[-1]]
                taken += bounds[-1]
            elif store.inputs:
                memory = np.concatenate([self._laid(text) for text in store.inputs])
            else:
                memory = np.zeros(bounds[-1], dtype=np.bool_ if store.truths else np.float64)
            found.append((memory, bounds))
        rows = [
            found[store][0][found[store][1][begin] : found[store][1][end]]
            for store, begin, end in source.stacked.rows
        ]
        self._flat = self._flat_over(rows)

    def _pair(self) -> None:
        """Pair all objects, unless there are as many as last time."""
        source = self._source
        sizes = [(self._types[p.left].size, self._types[p.right].size) for p in source.planes]
        if sizes != self._sizes:
            self._sizes = sizes
            self._pairs = [
                _Pairs.of(plane, *size) for plane, size in zip(source.planes, sizes, strict=True)
            ]

    def _fill(self, changes: Sequence[bool]) -> list[Slots]:
        """Make the cells, and the index of what is taken of them for stores that change."""
        source = self._source
        texts = [
            text
            for store, is_changing in zip(source.stacked.stores, changes, strict=True)
            if is_changing
            for text in store.inputs
        ]
        names = [*dict.fromkeys([*self._places, *(source.operands[text][0] for text in texts)])]
        count = len(self._places)
        arrays = [*self._changing, *map(self._array, names[count:])]
        ends = np.cumsum([0, *map(len, arrays)]).tolist()
        self._cells = np.concatenate([np.zeros(0), *arrays])
        self._changed = self._cells[: ends[count]]
        begins = dict(zip(names, ends, strict=False))
        return [
            np.arange(0),
            *(begins[source.operands[text][0]] + self._slots(text) for text in texts),
        ]

    def _slots(self, text: str) -> Slots:
        """Give the slots at which an operand reads its array: (n,)."""
        _, plane, word = self._source.operands[text]
        return self._pairs[plane].left if word == "left" else self._pairs[plane].right

    def _laid(self, text: str) -> Numbers:
        """Lay out an operand that does not change."""
        return self._array(self._source.operands[text][0]).take(self._slots(text))

    def follow(self) -> dict[int, Change]:
        """Find out which pairs of each relation are gained and lost; they are left as they were.

        Raises:
            InferenceError: a test cannot be evaluated.
        """
        if not self._changing:
            return {}
        moving, given = [columns.array(name) for columns, name in self._moving], self._given
        for place, which in self._moving_given:
            given[place] = moving[which]
        self._changing = changing = moving + self._derive(*given)
        np.concatenate(changing, out=self._changed)
        self._cells.take(self._index, None, self._buffer, "clip")
        found, every = {}, self._held
        for number, (hold, doubt) in enumerate(self._flat()):
            if doubt is not None:
                self._settle(number, hold, doubt)
            now, held = hold.tobytes(), every[number]
            if held is None:
                held = self._recalled(number)
            if now != held[1]:
                added: list[Pair] = []
                removed: list[Pair] = []
                pairs = self._pairs[self._source.plane_of[number]].each
                for place in (hold != held[0]).nonzero()[0].tolist():
                    (added if now[place] else removed).append(pairs[place])
                found[number] = added, removed
                every[number] = hold, now
            elif every[number] is None:
                every[number] = held
        return found

    def keys(self, number: int) -> tuple[Numbers, Numbers]:
        """Give what a relation that is an order of keys compares now, of left and right objects."""
        left, right = (
            self._changing[self._places[name]] if name in self._places else self._array(name)
            for name in self._source.keys[number]
        )
        return left, right

    def _settle(self, number: int, hold: Truths, doubt: Truths) -> None:
        """Let the exact test decide where there is doubt."""
        relation, pairs = self._relations[number], self._pairs[self._source.plane_of[number]]
        for place in doubt.nonzero()[0].tolist():
            hold[place] = relation.is_exactly(*pairs.each[place])

    def _recalled(self, number: int) -> tuple[Truths, bytes]:
        """Give which pairs a relation holds."""
        pairs = self._pairs[self._source.plane_of[number]]
        hold = self._relations[number].truths(pairs.left, pairs.right)
        return hold, hold.tobytes()
