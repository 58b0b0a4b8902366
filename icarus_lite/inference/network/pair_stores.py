"""A kernel's pairs by the names of the objects, as the joins of generated code read them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from icarus_lite.inference.network import kernels
from icarus_lite.inference.network.tables import Objects
from icarus_lite.symbols import Value

NamedPair = tuple[Value, Value]
"""The names of a left and of a right object."""


_NONE: tuple[list[NamedPair], list[NamedPair]] = ([], [])


class PairStore:
    """The pairs of objects that meet a numeric pair rule.

    Until it is updated it is the relation of before, objects that have gone meanwhile included.

    Args:
        kernel: The compiled rule.
        left: The objects that may stand on the left.
        right: Likewise on the right; the same ones where the patterns are the same.

    Attributes:
        holds: Tells whether two objects, by name, are a pair.
    """

    __slots__ = ("_known_left", "_known_right", "holds", "left", "relation", "right")

    def __init__(self, kernel: kernels.PairKernel, left: Objects, right: Objects) -> None:
        self.left, self.right = left, right
        self.relation = kernel.instance(left.columns, right.columns)
        self._known_left = self._known_right = 0
        self.holds: Callable[[Value, Value], bool] = self._holds_if_known

    def expect_strangers(self) -> None:
        """Be ready to be asked about objects that the kernel has not seen yet."""
        self.holds = self._holds_if_known

    def expect_no_strangers(self) -> None:
        """Go back to the fast way: the kernel knows all objects there are."""
        left_places, right_places = self.left.places, self.right.places
        relation = self.relation
        is_pair = relation.holds
        if isinstance(relation, kernels.MatrixRelation):
            # What `relation.holds` would say, without the call: joins ask it all the time.
            def holds_in_matrix(one: Value, other: Value) -> bool:
                left, right = left_places.get(one), right_places.get(other)
                if left is None or right is None:
                    return False
                return relation.bits[left * relation.stride + right] == 1

            self.holds = holds_in_matrix
            return

        def holds(one: Value, other: Value) -> bool:
            left = left_places.get(one)
            if left is None:
                return False
            right = right_places.get(other)
            return right is not None and is_pair(left, right)

        self.holds = holds

    def _holds_if_known(self, one: Value, other: Value) -> bool:
        left, right = self.left.places.get(one), self.right.places.get(other)
        return (
            left is not None
            and right is not None
            and left < self._known_left
            and right < self._known_right
            and self.relation.holds(left, right)
        )

    def of_left(self, one: Value) -> list[Value]:
        """Give the objects that are paired with one on the left."""
        slot, names = self.left.places.get(one), self.right.columns.names
        if slot is None or slot >= self._known_left:
            return []
        return [names[i] for i in self.relation.of_left(slot)]

    def of_right(self, other: Value) -> list[Value]:
        """Give the objects that are paired with one on the right."""
        slot, names = self.right.places.get(other), self.left.columns.names
        if slot is None or slot >= self._known_right:
            return []
        return [names[i] for i in self.relation.of_right(slot)]

    def pairs(self) -> Iterator[NamedPair]:
        """Give all pairs."""
        left, right = self.left.columns.names, self.right.columns.names
        return ((left[i], right[j]) for i, j in self.relation.pairs())

    def __iter__(self) -> Iterator[NamedPair]:
        return self.pairs()

    def __contains__(self, pair: object) -> bool:
        return isinstance(pair, tuple) and len(pair) == 2 and self.holds(*pair)

    def __len__(self) -> int:
        return len(self.relation)

    def update(
        self, changed_left: Sequence[int], changed_right: Sequence[int]
    ) -> tuple[list[NamedPair], list[NamedPair]]:
        """Follow the columns; give the pairs that are new and those that are no more.

        Args:
            changed_left: The slots on the left that are new, changed or gone.
            changed_right: Likewise on the right.

        Raises:
            InferenceError: a test cannot be evaluated.
        """
        change = self.relation.update(changed_left, changed_right)
        self._known_left, self._known_right = self.left.columns.size, self.right.columns.size
        return self.named(change)

    def named(self, change: kernels.Change) -> tuple[list[NamedPair], list[NamedPair]]:
        """Give a change of the relation with the names of the objects."""
        added, removed = change
        if not added and not removed:
            return _NONE
        left, right = self.left.columns.names, self.right.columns.names
        return (
            [(left[i], right[j]) for i, j in added],
            [(left[i], right[j]) for i, j in removed],
        )

    def load(self) -> None:
        """Follow the columns from scratch.

        Raises:
            InferenceError: a test cannot be evaluated.
        """
        self.relation.load()
        self.expect_no_strangers()
        self._known_left = self.left.columns.size
        self._known_right = self.right.columns.size
