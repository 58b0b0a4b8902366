"""The log of net changes, cycle by cycle: when a belief was held, and what was believed then.

Each cycle leaves what it changed in the beliefs, and what was there before in the percepts and
assertions that it wrote over. From the present both lead back to any cycle on record. The log
keeps as many changes as its budget says, and forgets its oldest cycles for the sake of new ones; of
a belief that was held where the record begins it still knows since when.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, TypeAlias

from icarus_lite.errors import IcarusError
from icarus_lite.symbols import Belief, Value

Kind: TypeAlias = tuple[str, int]
"""A predicate and its number of arguments."""

Event: TypeAlias = tuple[Kind, Sequence[Any], Sequence[Any], Sequence[Any]]
"""What became of the beliefs of a kind in one cycle: the keys gained, lost, and altered.

An entry of what was altered is a key with its attributes before and after, None for no belief."""

Writes: TypeAlias = Sequence[Any]
"""What a cycle has written over in the percepts and assertions, as `Base` notes it."""

_LOOKS_AFTER = 1024
"""The log looks at its size after so many cycles at most, sooner where cycles change much."""


class ForgottenError(IcarusError, ValueError):
    """A cycle is asked about that the log has never known, or no longer knows.

    Args:
        cycle: The cycle.
        first: The first one on record.
        last: The last one; before `first` if there is none.
    """

    def __init__(self, cycle: int, first: int, last: int) -> None:
        self.cycle, self.first, self.last = cycle, first, last
        if last < first:
            text = f"there is no cycle {cycle}: there has been none yet"
        elif cycle > last:
            text = f"there is no cycle {cycle}; the last one is {last}"
        elif cycle < 0 or first == 0:
            text = f"there is no cycle {cycle}; the first one is 0"
        else:
            text = (
                f"cycle {cycle} is not on record, which begins with cycle {first}; "
                "a budget with more `changes_kept` keeps more of it"
            )
        super().__init__(text)


def belief_of(kind: Kind, key: Any, attributes: Mapping[str, Value] | None = None) -> Belief:
    """Give the belief that is kept by a key."""
    predicate, arity = kind
    return Belief(predicate, (key,) if arity == 1 else key, attributes or {})


def key_of(args: tuple[Value, ...]) -> Any:
    """Give the key that a belief with these arguments is kept by."""
    return args[0] if len(args) == 1 else args


class History:
    """What changed in each cycle. Of cycle 0 nothing is, as the present leads back to it.

    Args:
        changes_kept: How many changes to keep, of beliefs, percepts and assertions together; the
            last cycle is kept whatever it has changed. None keeps all.

    Attributes:
        first: The first cycle on record.
    """

    __slots__ = (
        "_cycles", "_held_since", "_look_at", "_most", "_read", "_size", "_sizes", "_taken_over",
        "_turns", "first",
    )  # fmt: skip

    def __init__(self, changes_kept: int | None) -> None:
        self.first = 0
        self._taken_over = 0
        self._most = changes_kept
        self._cycles: list[tuple[Sequence[Event], Writes]] = []
        self._sizes: list[int] = []
        self._size = 0
        self._look_at: float = 1 if changes_kept is not None else float("inf")
        self._held_since: dict[Kind, dict[Any, int]] = {}
        self._turns: dict[Kind, dict[Any, list[int]]] = {}
        self._read = 0

    @property
    def last(self) -> int:
        """The last cycle on record; before `first` if there is none."""
        return self.first + len(self._cycles) - 1

    def add(self, events: Sequence[Event], writes: Writes) -> None:
        """Put a cycle on record, and forget old ones if there is too much of them.

        Args:
            events: What became of the beliefs.
            writes: What was written over in the percepts and assertions.
        """
        self._cycles.append((events, writes))
        if len(self._cycles) >= self._look_at:
            self._look()

    def until(self, cycle: int) -> History:
        """Give a history of its own that ends with a cycle on record.

        It tells of the beliefs of all its cycles. What these have written over is not its own, so
        that percepts and assertions can be taken back to its last cycle only.
        """
        other = History(self._most)
        other.first, other._taken_over = self.first, cycle
        count = cycle + 1 - self.first
        other._cycles = self._cycles[:count]
        other._sizes = self._sizes[:count]
        other._size = sum(other._sizes)
        other._held_since = {kind: dict(held) for kind, held in self._held_since.items()}
        return other

    def check(self, cycle: int) -> None:
        """See that a cycle is on record.

        Raises:
            ForgottenError: it is not.
        """
        if not self.first <= cycle <= self.last:
            raise ForgottenError(cycle, self.first, self.last)

    def intervals(self, belief: Belief, *, held: bool) -> list[tuple[int, int | None]]:
        """Give each stretch of cycles in which a belief was held, unless it is long over.

        Args:
            belief: The belief.
            held: Whether it is held now.

        Returns:
            The first cycle of each, and the first one after it; None for one that goes on. A
            stretch that reaches into the record is given whole; what ended before is forgotten.
        """
        self._catch_up()
        kind, key = (belief.predicate, len(belief.args)), key_of(belief.args)
        turns = self._turns.get(kind, {}).get(key, [])
        edges: list[int | None] = list(turns)
        if held != bool(len(turns) % 2):  # it was held before the first turn on record
            edges.insert(0, self._held_since.get(kind, {}).get(key, 0))
        if len(edges) % 2:
            edges.append(None)
        starts, ends = edges[::2], edges[1::2]
        return [(s, e) for s, e in zip(starts, ends, strict=True) if s is not None]

    def changes(self, cycle: int) -> tuple[list[Belief], list[Belief], list[Belief]]:
        """Give the beliefs that a cycle, other than cycle 0, added, removed, and altered.

        Raises:
            ForgottenError: it is not on record.
        """
        self.check(cycle)
        added: list[Belief] = []
        removed: list[Belief] = []
        altered: list[Belief] = []
        for kind, gained, lost, other in self._cycles[cycle - self.first][0]:
            before = {key: old for key, old, _ in other}
            after = {key: new for key, _, new in other}
            added += [belief_of(kind, key, after.get(key)) for key in gained]
            removed += [belief_of(kind, key, before.get(key)) for key in lost]
            altered += [
                belief_of(kind, key, new)
                for key, old, new in other
                if old is not None and new is not None
            ]
        return added, removed, altered

    def writes_after(self, cycle: int) -> list[Writes]:
        """Give what later cycles have written over, the first of them first.

        Raises:
            ForgottenError: the cycle is not on record, or the record of before it is another's.
        """
        self.check(cycle)
        if cycle < self._taken_over:
            raise ForgottenError(cycle, self._taken_over, self.last)
        return [writes for _, writes in self._cycles[cycle + 1 - self.first :]]

    def roll_back(self, held: dict[Belief, Belief], cycle: int) -> None:
        """Take back, in what is held now, all that came after a cycle.

        Args:
            held: The beliefs of now, each with itself and so with its attributes.
            cycle: The cycle to go back to.

        Raises:
            ForgottenError: it is not on record.
        """
        self.check(cycle)
        for events, _ in reversed(self._cycles[cycle + 1 - self.first :]):
            for kind, gained, lost, altered in events:
                for key in gained:
                    del held[belief_of(kind, key)]
                for key in lost:
                    belief = belief_of(kind, key)
                    held[belief] = belief
                for key, old, _ in altered:
                    if old is not None:
                        belief = belief_of(kind, key, old)
                        held.pop(belief, None)
                        held[belief] = belief

    def _catch_up(self) -> None:
        """Read the cycles that have come since the last question."""
        for cycle in range(max(self._read, self.first), self.last + 1):
            for kind, gained, lost, _ in self._cycles[cycle - self.first][0]:
                turns = self._turns.setdefault(kind, {})
                for key in (*gained, *lost):
                    turns.setdefault(key, []).append(cycle)
        self._read = self.last + 1

    def _look(self) -> None:
        """Measure the cycles that are new, forget old ones if need be, and say when to look again.

        A quarter more than needed is forgotten, so that it is seldom.
        """
        assert self._most is not None  # only a log with a limit looks
        new = [_size(*cycle) for cycle in self._cycles[len(self._sizes) :]]
        self._sizes += new
        self._size += sum(new)
        if self._size > self._most:
            count = 0
            while self._size > self._most * 3 // 4 and count < len(self._cycles) - 1:
                self._size -= self._sizes[count]
                count += 1
            self._forget(count)
        room = (self._most - self._size) // max(new)
        self._look_at = len(self._cycles) + max(1, min(room, _LOOKS_AFTER))

    def _forget(self, count: int) -> None:
        """Forget the oldest cycles, but for since when what they left has been held."""
        for number, (events, _) in enumerate(self._cycles[:count], self.first):
            for kind, gained, lost, _ in events:
                held = self._held_since.setdefault(kind, {})
                held.update(dict.fromkeys(gained, number))
                for key in lost:
                    held.pop(key, None)
        del self._cycles[:count], self._sizes[:count]
        self.first += count
        self._turns, self._read = {}, self.first


def _size(events: Sequence[Event], writes: Writes) -> int:
    """Count the changes of a cycle, itself included."""
    changed = sum(len(gained) + len(lost) + len(altered) for _, gained, lost, altered in events)
    written: int = sum(each.size for each in writes)
    return 1 + changed + written
