"""The log of net changes, cycle by cycle: when a belief was held, and what was believed then."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, TypeAlias

from icarus_lite.symbols import Belief, Value

Kind: TypeAlias = tuple[str, int]
"""A predicate and its number of arguments."""

Event: TypeAlias = tuple[Kind, Sequence[Any], Sequence[Any], Sequence[Any]]
"""What became of the beliefs of a kind in one cycle: the keys gained, lost, and altered.

An entry of what was altered is a key with its attributes before and after, None for no belief."""


def belief_of(kind: Kind, key: Any, attributes: Mapping[str, Value] | None = None) -> Belief:
    """Give the belief that is kept by a key."""
    predicate, arity = kind
    return Belief(predicate, (key,) if arity == 1 else key, attributes or {})


def key_of(args: tuple[Value, ...]) -> Any:
    """Give the key that a belief with these arguments is kept by."""
    return args[0] if len(args) == 1 else args


class History:
    """What changed in each cycle; the first is not written down, as the present leads back to it.

    Attributes:
        cycles: The events of each cycle.
    """

    __slots__ = ("_read", "_turns", "cycles")

    def __init__(self) -> None:
        self.cycles: list[Sequence[Event]] = []
        self._read = 0
        self._turns: dict[Kind, dict[Any, list[int]]] = {}

    def copy(self) -> History:
        """Give a history of its own that begins with the same cycles."""
        other = History()
        other.cycles = list(self.cycles)
        return other

    def intervals(self, belief: Belief, *, held: bool) -> list[tuple[int, int | None]]:
        """Give each stretch of cycles in which a belief was held.

        Args:
            belief: The belief.
            held: Whether it is held now.

        Returns:
            The first cycle of each, and the first one after it; None for one that goes on.
        """
        self._catch_up()
        kind = belief.predicate, len(belief.args)
        turns = self._turns.get(kind, {}).get(key_of(belief.args), [])
        from_the_start = held != bool(len(turns) % 2)
        edges: list[int | None] = [0, *turns] if from_the_start else list(turns)
        if len(edges) % 2:
            edges.append(None)
        starts, ends = edges[::2], edges[1::2]
        return [(s, e) for s, e in zip(starts, ends, strict=True) if s is not None]

    def changes(self, cycle: int) -> tuple[list[Belief], list[Belief], list[Belief]]:
        """Give the beliefs that a cycle, other than the first, added, removed, and altered."""
        added: list[Belief] = []
        removed: list[Belief] = []
        altered: list[Belief] = []
        for kind, gained, lost, other in self.cycles[cycle]:
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

    def roll_back(self, held: dict[Belief, Belief], cycle: int) -> None:
        """Take back, in what is held now, all that came after a cycle.

        Args:
            held: The beliefs of now, each with itself and so with its attributes.
            cycle: The cycle to go back to.
        """
        for number in range(len(self.cycles) - 1, cycle, -1):
            for kind, gained, lost, altered in self.cycles[number]:
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
        for cycle in range(self._read, len(self.cycles)):
            for kind, gained, lost, _ in self.cycles[cycle]:
                turns = self._turns.setdefault(kind, {})
                for key in (*gained, *lost):
                    turns.setdefault(key, []).append(cycle)
        self._read = len(self.cycles)
