"""Beliefs with attributes: of all derivations of a belief, the one that decides on them.

Attributes are functional: a belief has one value of each. What is perceived or asserted decides
before any clause, of several clauses the one written first, within one clause the canonically
least values. So the attributes depend on what is true now, not on how it came to be.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, TypeAlias

from icarus_lite.inference.canonical import canonical
from icarus_lite.records import dataclass
from icarus_lite.symbols import Value

PERCEIVED = -2
"""The rank of attributes that were perceived."""

ASSERTED = -1
"""The rank of attributes that were asserted."""

Candidate: TypeAlias = tuple[int, tuple[Any, ...]]
"""A rank, below 0 for what is given and else the number of the clause, and the values.

Those of a clause are in the order of its head; what is given comes as pairs of name and value."""

Key: TypeAlias = Any
"""What a belief is kept by: its arguments, bare where it is only one."""


@dataclass(frozen=True, slots=True)
class Telling:
    """A relation that holds a concept's rows, and how it is told of changes.

    Args:
        cells: The attributes that are values of its rows; none for the beliefs as such.
        rows: The rows.
        show: Called with the key and the value of a row that has come to be.
        withdraw: Called with those of one that is no longer.
        insert: Puts a row in without telling anyone.
    """

    cells: tuple[str, ...]
    rows: dict[Key, Any]
    show: Callable[[Key, Any], None]
    withdraw: Callable[[Key, Any], None]
    insert: Callable[[Key, Any], None]

    def value(self, attributes: Mapping[str, Value]) -> Any:
        """Give the value of a row with these attributes, or None if it lacks one."""
        if not self.cells:
            return 1
        values = tuple(attributes.get(name) for name in self.cells)
        if None in values:
            return None
        return values[0] if len(values) == 1 else values

    def follow(
        self, key: Key, before: Mapping[str, Value] | None, now: Mapping[str, Value] | None
    ) -> None:
        """Tell of a belief that had some attributes and now has others; None for no belief."""
        old = None if before is None else self.value(before)
        new = None if now is None else self.value(now)
        if old == new:
            return
        if old is not None:
            self.withdraw(key, old)
        if new is not None:
            self.show(key, new)


class Attributes(Mapping[Key, Mapping[str, Value]]):
    """The attributes of each fact of a concept, decided by its derivations.

    Attributes:
        held: Each belief with its derivations, and how many there are of each.
        best: For each the one that decides.
        believed: The beliefs that are not merely percepts of the same name.

    Args:
        number: The number of the concept's head.
        names: For each clause, by its number, the names of its head's attributes.
        changes: How often each derivation has come or gone, by key and candidate; emptied here.
        fill: Gathers in `changes` all that follows from what is there.
        tellings: The relations that hold the concept's rows.
        record: Is told of the changes of each cycle.
    """

    __slots__ = (
        "_changes",
        "_fill",
        "_names",
        "_number",
        "_record",
        "_tellings",
        "believed",
        "best",
        "held",
    )

    def __init__(
        self,
        number: int,
        names: Mapping[int, tuple[str, ...]],
        changes: dict[tuple[Key, Candidate], int],
        fill: Callable[[], None],
        tellings: Sequence[Telling],
        record: Callable[[Any], None],
    ) -> None:
        self._number, self._names, self._changes, self._fill = number, names, changes, fill
        self._tellings, self._record = tellings, record
        self.held: dict[Key, dict[Candidate, int]] = {}
        self.best: dict[Key, Candidate] = {}
        self.believed: dict[Key, None] = {}

    def __getitem__(self, key: Key) -> Mapping[str, Value]:
        return self._read(self.best[key])

    def __iter__(self) -> Iterator[Key]:
        return iter(self.best)

    def __len__(self) -> int:
        return len(self.best)

    def settle(self) -> None:
        """Let the rules see what the gathered changes come to."""
        gained: list[Key] = []
        lost: list[Key] = []
        altered: list[tuple[Key, Any, Any]] = []
        for key in self._gather():
            before, now = self._decide(key)
            old = None if before is None else self._read(before)
            new = None if now is None else self._read(now)
            if old != new:
                for telling in self._tellings:
                    telling.follow(key, old, new)
            was = key in self.believed
            is_now = self._believe(key)
            if is_now and not was:
                gained.append(key)
                altered.append((key, None, new))
            elif was and not is_now:
                lost.append(key)
                altered.append((key, old, None))
            elif is_now and old != new:
                altered.append((key, old, new))
        if altered:
            self._record((self._number, gained, lost, altered))

    def load(self) -> None:
        """Take in all there is, telling no one."""
        self._fill()
        for key in self._gather():
            _, now = self._decide(key)
            if now is None:
                continue
            self._believe(key)
            attributes = self._read(now)
            for telling in self._tellings:
                value = telling.value(attributes)
                if value is not None:
                    telling.insert(key, value)

    def _believe(self, key: Key) -> bool:
        """Tell whether there is more to it than a percept, and note that."""
        if any(number != PERCEIVED for number, _ in self.held.get(key, ())):
            self.believed[key] = None
            return True
        self.believed.pop(key, None)
        return False

    def _gather(self) -> dict[Key, None]:
        """Count the changes; give the beliefs that they are about."""
        touched: dict[Key, None] = {}
        for (key, candidate), change in self._changes.items():
            if not change:
                continue
            held = self.held.setdefault(key, {})
            count = held.get(candidate, 0) + change
            if count:
                held[candidate] = count
            else:
                del held[candidate]
            touched[key] = None
        self._changes.clear()
        return touched

    def _decide(self, key: Key) -> tuple[Candidate | None, Candidate | None]:
        """Give the candidate that decided before, and the one that decides now."""
        held, before = self.held[key], self.best.get(key)
        if not held:
            del self.held[key]
            self.best.pop(key, None)
            return before, None
        now = self.best[key] = min(held, key=rank) if len(held) > 1 else next(iter(held))
        return before, now

    def _read(self, candidate: Candidate) -> dict[str, Value]:
        number, values = candidate
        if number < 0:
            return dict(values)
        return dict(zip(self._names[number], values, strict=True))


def rank(candidate: Candidate) -> tuple[Any, ...]:
    """Give what candidates are ordered by: the rank, then the values."""
    number, values = candidate
    return number, () if number < 0 else canonical(values)
