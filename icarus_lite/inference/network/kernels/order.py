"""A pair relation that is an order of keys: never stored, only the keys are.

A test such as `left_of`, `(<= (+ (* 2 ?xa) ?wa) (- (* 2 ?xb) ?wb))`, compares a key of the left
object with a key of the right one. Half a million of a million pairs may hold, and none of them
needs to be written down: whether a pair holds is a comparison of two numbers, and what a move
changes are the partners whose keys lie between the old key and the new one. Sorted keys show these
at once, so that the cost follows the changes.
"""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from icarus_lite.inference.network.kernels.columns import Columns, Numbers
from icarus_lite.inference.network.kernels.costs import Costs
from icarus_lite.inference.network.kernels.crossing import crossed, is_below, net
from icarus_lite.inference.network.kernels.exact import ExactTest
from icarus_lite.inference.network.kernels.keys import Cut, Keys, Passed
from icarus_lite.inference.network.kernels.relation import (
    Bind,
    Change,
    Pair,
    PairRelation,
    pairs_at,
)
from icarus_lite.inference.network.kernels.side import Side, SidePlan
from icarus_lite.inference.network.kernels.tester import Slots, Truths
from icarus_lite.records import dataclass


@dataclass(frozen=True, slots=True)
class OrderPlan:
    """What is known of a relation once a domain is compiled.

    Args:
        left: The left side; its one input is the key.
        right: The right side, likewise.
        ascending: Whether the left key is the smaller one.
        strict: Whether equal keys do not do.
        distinct: Whether an object is never paired with itself.
        distinct_first: Whether that is asked before anything else of a pair.
        costs: What the ways to update it cost.
    """

    left: SidePlan
    right: SidePlan
    ascending: bool
    strict: bool
    distinct: bool
    distinct_first: bool
    costs: Costs


class OrderRelation(PairRelation):
    """See the module.

    The keys are turned round where the left one is to be the greater, so that a pair always holds
    when the left key is less than the right one (or equal). An object that takes no part has the
    key infinity, which compares with none. Pairs with an odd object, of which only the exact test
    can tell, are kept as they are.

    Args:
        plan: What is known of the rule.
        columns: Its objects.
        bind: Gives the exact test and the gates over columns.
    """

    __slots__ = (
        "_bind", "_count", "_distinct", "_every", "_exact", "_held", "_left", "_left_keys", "_odd",
        "_plan", "_right", "_right_keys", "_same", "_strict",
    )  # fmt: skip

    def __init__(self, plan: OrderPlan, columns: tuple[Columns, Columns], bind: Bind) -> None:
        exact, gates = bind(columns)
        self._plan = plan
        self._bind = bind
        self._exact: ExactTest = exact
        self._same = columns[0] is columns[1]
        self._strict = plan.strict
        self._distinct = plan.distinct
        self._left = Side(plan.left, columns[0], gates[0])
        self._right = Side(plan.right, columns[1], gates[1])
        self._left_keys = Keys(math.inf)
        self._right_keys = Keys(-math.inf)
        self._odd: frozenset[Pair] = frozenset()
        self._count = 0
        self._held: bytes | None = None  # what held when all keys were last compared with all
        self._every: tuple[tuple[int, int], bool] | None = None

    def __len__(self) -> int:
        return self._count + len(self._odd)

    def holds(self, left: int, right: int) -> bool:
        """Tell whether a pair of slots is in the relation; the slots must be known to it."""
        f, g = self._left_keys.values[left], self._right_keys.values[right]
        if f < g or (f == g and not self._strict):
            return not self._distinct or (
                left != right if self._same else not self._is_one(left, right)
            )
        return bool(self._odd) and (left, right) in self._odd

    def of_left(self, left: int) -> Iterable[int]:
        """Give the right slots that are paired with a left one, in ascending order."""
        f, keys = self._left_keys.values[left], self._right_keys.values
        if self._strict:
            found = [j for j, g in enumerate(keys) if f < g]
        else:
            found = [j for j, g in enumerate(keys) if f <= g]
        if self._distinct:
            found = [j for j in found if not self._is_one(left, j)]
        if self._odd:
            found = sorted([*found, *(j for i, j in self._odd if i == left)])
        return found

    def of_right(self, right: int) -> Iterable[int]:
        """Give the left slots that are paired with a right one, in ascending order."""
        g, keys = self._right_keys.values[right], self._left_keys.values
        if self._strict:
            found = [i for i, f in enumerate(keys) if f < g]
        else:
            found = [i for i, f in enumerate(keys) if f <= g]
        if self._distinct:
            found = [i for i in found if not self._is_one(i, right)]
        if self._odd:
            found = sorted([*found, *(i for i, j in self._odd if j == right)])
        return found

    def pairs(self) -> Iterator[Pair]:
        """Give all pairs, in ascending order."""
        return ((i, j) for i in range(self._left.size) for j in self.of_left(i))

    def copy(self, left: Columns, right: Columns) -> OrderRelation:
        """Give a relation in the same state over copies of its columns."""
        made = OrderRelation(self._plan, (left, right), self._bind)
        made._left = self._left.copy(left, made._left.gate)
        made._right = self._right.copy(right, made._right.gate)
        made._left_keys, made._right_keys = self._left_keys.copy(), self._right_keys.copy()
        made._odd, made._count = self._odd, self._count
        return made

    def load(self) -> None:
        """Follow the columns from scratch, whatever has changed, without saying what it was."""
        self._refresh(range(self._left.columns.size), range(self._right.columns.size))
        self._odd = self._odd_pairs()
        f, g = self._fresh_keys(self._left, left=True), self._fresh_keys(self._right, left=False)
        self._held = None
        ranked = np.sort(g)
        below = np.searchsorted(ranked, f, side="right" if self._strict else "left")
        self._count = int((len(ranked) - below).sum())
        for keys, values in ((self._left_keys, f), (self._right_keys, g)):
            keys.replace(values)
        if self._distinct:
            self._count -= self._own_pairs()

    def update(self, changed_left: Sequence[int], changed_right: Sequence[int]) -> Change:
        """Follow the columns; give the net change: see `PairRelation`."""
        self._refresh(changed_left, changed_right)
        odd = self._odd
        if odd or self._left.odd or self._right.odd:
            odd = self._odd_pairs()
        self._left_keys.grow(self._left.size)
        self._right_keys.grow(self._right.size)
        costs, size = self._plan.costs, self._left.size + self._right.size
        by_move = costs.moves(len(changed_left) + len(changed_right))
        by_every = costs.every_key(self._left.size * self._right.size)
        by_sort = costs.sorted_keys(size)
        if by_move <= min(by_every, by_sort):
            added, removed = self._by_move(changed_left, changed_right)
        else:
            f = self._fresh_keys(self._left, left=True)
            g = self._fresh_keys(self._right, left=False)
            added, removed = self._by_matrix(f, g) if by_every < by_sort else self._by_sort(f, g)
        self._count += len(added) - len(removed)
        if odd or self._odd:
            gained, lost = {*added, *(odd - self._odd)}, {*removed, *(self._odd - odd)}
            added, removed = sorted(gained - lost), sorted(lost - gained)
            self._odd = odd
        return added, removed

    # Followed by others.

    @property
    def sides(self) -> tuple[Side, Side]:
        """What the tests read of the left and of the right objects."""
        return self._left, self._right

    def is_ordinary(self, columns: Columns) -> bool:
        """Whether nothing is unusual that keeps others from following moves of these objects."""
        return not self._odd and all(
            side.is_ordinary(moving=side.columns is columns) for side in self.sides
        )

    def moved(self, left: Sequence[int], right: Sequence[int]) -> Change:
        """Follow a few ordinary objects whose keys are in the lists of the sides already."""
        added, removed = self._by_move(left, right)
        self._count += len(added) - len(removed)
        return added, removed

    def replaced(self, f: Numbers, g: Numbers) -> Change:
        """Follow all objects, each of them ordinary.

        Args:
            f: (left,) what is compared of each left object.
            g: (right,) likewise of each right one.
        """
        f, g = self._own_keys(f, g)
        size = len(f), len(g)
        if self._every is None or self._every[0] != size:
            costs = self._plan.costs
            every = costs.every_key(size[0] * size[1]) < costs.sorted_keys(size[0] + size[1])
            self._every = size, every
        added, removed = self._by_matrix(f, g) if self._every[1] else self._by_sort(f, g)
        self._count += len(added) - len(removed)
        return added, removed

    def taken(self, f: Numbers, g: Numbers, change: Change) -> Change:
        """Take over new keys of all objects, see `replaced`, and the change that they make."""
        f, g = self._own_keys(f, g)
        self._held = None
        self._left_keys.replace(f)
        self._right_keys.replace(g)
        self._count += len(change[0]) - len(change[1])
        return change

    def truths(self, left: Slots, right: Slots) -> Truths:
        """Tell of some pairs of different objects whether each is in the relation.

        Args:
            left: (n,) the left slots.
            right: (n,) the right slots.
        """
        f, g = self._left_keys.array().take(left), self._right_keys.array().take(right)
        return is_below(f, g, strict=self._strict)

    def _own_keys(self, f: Numbers, g: Numbers) -> tuple[Numbers, Numbers]:
        if not self._plan.ascending:
            return -f, -g
        if f.base is not None or g.base is not None:  # they belong to columns that will change
            return f.copy(), g.copy()
        return f, g

    def _refresh(self, changed_left: Sequence[int], changed_right: Sequence[int]) -> None:
        self._left.refresh(changed_left)
        self._right.refresh(changed_right)

    def _is_one(self, left: int, right: int) -> bool:
        if self._same:
            return left == right
        return self._left.columns.names[left] == self._right.columns.names[right]

    def _key(self, side: Side, values: list[float], slot: int, none: float) -> float:
        if not side.present[slot] or slot in side.odd:
            return none
        return values[slot] if self._plan.ascending else -values[slot]

    # One object after the other.

    def _by_move(self, changed_left: Sequence[int], changed_right: Sequence[int]) -> Change:
        """Find the partners between the old and the new key, left objects first."""
        self._held = None
        f, g, strict = self._left_keys, self._right_keys, self._strict
        if not (f.is_ranked and g.is_ranked):
            f.rank()
            g.rank()
        cut = bisect_right if strict else bisect_left
        up, down = self._passed(self._left, changed_left, f, g, cut)
        cut = bisect_left if strict else bisect_right
        right_up, right_down = self._passed(self._right, changed_right, g, f, cut)
        if not (up or down or right_up or right_down):  # as in most cycles
            return [], []
        removed: list[Pair] = [(i, j) for i, others in up for j in others]
        added: list[Pair] = [(i, j) for i, others in down for j in others]
        added += [(i, j) for j, others in right_up for i in others]
        removed += [(i, j) for j, others in right_down for i in others]
        if (up and right_up) or (down and right_down):
            added, removed = net(added, removed)
        return self._apart(added), self._apart(removed)

    def _passed(
        self, side: Side, changed: Sequence[int], keys: Keys, others: Keys, cut: Cut
    ) -> tuple[Passed, Passed]:
        """Give changed objects their new keys; give whom each has passed, upwards and downwards."""
        fresh = side.ready_lists()[0]
        if self._plan.ascending and side.is_regular:
            return keys.move(changed, fresh, others, cut)
        turned = {slot: self._key(side, fresh, slot, keys.none) for slot in changed}
        return keys.move(changed, turned, others, cut)

    def _apart(self, pairs: list[Pair]) -> list[Pair]:
        if not self._distinct or not pairs:
            return pairs
        if self._same:
            return [pair for pair in pairs if pair[0] != pair[1]]
        return [pair for pair in pairs if not self._is_one(*pair)]

    # All at once.

    def _by_matrix(self, f: Numbers, g: Numbers) -> Change:
        """Compare all keys with all, and what holds now with what held before."""
        new = is_below(f[:, None], g, strict=self._strict)
        now, before = new.tobytes(), self._held
        if before is None or len(before) != len(now):
            old = is_below(
                self._left_keys.array()[:, None], self._right_keys.array(), strict=self._strict
            )
            before = old.tobytes()
        self._left_keys.replace(f)
        self._right_keys.replace(g)
        self._held = now
        if now == before:
            return [], []
        flat = new.ravel()
        codes = (flat != np.frombuffer(before, dtype=np.bool_)).nonzero()[0]
        added, removed = pairs_at(codes, flat[codes], len(g))
        return self._apart(added), self._apart(removed)

    def _by_sort(self, f: Numbers, g: Numbers) -> Change:
        """Sort the keys, and find out which old and new ones have changed places."""
        f_old, g_old = self._left_keys.array(), self._right_keys.array()
        i, j = crossed((f_old, g_old), (f, g), strict=self._strict)
        gained = is_below(f[i], g[j], strict=self._strict)
        if self._same and self._distinct:
            apart = i != j
            i, j, gained = i[apart], j[apart], gained[apart]
        self._held = None
        self._left_keys.replace(f)
        self._right_keys.replace(g)
        lost = ~gained
        added = list(zip(i[gained].tolist(), j[gained].tolist(), strict=True))
        removed = list(zip(i[lost].tolist(), j[lost].tolist(), strict=True))
        if self._same:
            return added, removed
        return self._apart(added), self._apart(removed)

    def _fresh_keys(self, side: Side, *, left: bool) -> Numbers:
        """Give the new key of each slot."""
        none = math.inf if left else -math.inf
        keys = side.ready_arrays()[0] if side.size else np.zeros(0)
        keys = keys.copy() if self._plan.ascending else -keys
        if not side.is_regular:
            keys[~side.regular()] = none
        return keys

    def _own_pairs(self) -> int:
        """Count the pairs of one object that the keys alone would allow."""
        f, g = self._left_keys.values, self._right_keys.values
        if self._same:
            own: Iterable[Pair] = ((slot, slot) for slot in range(len(f)))
        else:
            names, twins = self._left.columns.names, self._right.columns.slots
            own = ((i, twins[name]) for i, name in enumerate(names) if name in twins)
        return sum(f[i] < g[j] or (f[i] == g[j] and not self._strict) for i, j in own)

    def _odd_pairs(self) -> frozenset[Pair]:
        """Ask the exact test about each pair with an odd object.

        Raises:
            InferenceError: it cannot be evaluated, as is mostly why an object is odd.
        """
        left, right = self._left, self._right
        pairs = [
            (i, j)
            for i in range(left.size)
            if left.present[i]
            for j in (range(right.size) if i in left.odd else sorted(right.odd))
            if right.present[j]
        ]
        return frozenset(pair for pair in pairs if self.is_exactly(*pair))

    def is_exactly(self, left: int, right: int) -> bool:
        """Ask the exact test about a pair.

        Raises:
            InferenceError: it cannot be evaluated.
        """
        is_one = self._distinct and self._is_one(left, right)
        if is_one and self._plan.distinct_first:
            return False
        return self._exact(left, right) and not is_one
