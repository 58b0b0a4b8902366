"""Proofs: why a belief is held, found when somebody asks.

Nothing is kept for them. The body of each clause is joined again with its head bound, which is
cheap because little is left to look up. Who asks for one reason gets the first that is found; only
who asks for all of them pays for all.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from itertools import chain, islice

from icarus_lite.inference.network.design import Keeping
from icarus_lite.inference.network.history import Kind, key_of
from icarus_lite.inference.network.running import Running
from icarus_lite.inference.network.ways import Ways
from icarus_lite.inference.supports import Derivation
from icarus_lite.symbols import Belief

MANY = 64
"""Of a clause that derives a belief in more ways than these, the first reason is the least of the
first so many found; otherwise it is the least of all."""


class Prover:
    """Finds the derivations of beliefs in the present of a network.

    Args:
        running: The network at work.
    """

    __slots__ = ("_recursive", "_ways", "running")

    def __init__(self, running: Running) -> None:
        self.running = running
        self._recursive: dict[Kind, Mapping[Kind, Mapping[object, int]]] = {}
        self._ways: dict[Kind, tuple[Ways, ...]] = {}

    def first(self, belief: Belief) -> Derivation | None:
        """Give one derivation, found without looking for all; None for what is not derived.

        It is by the clause written first, and of its ways the one with the least values (see
        `MANY`). Where a concept is recursive, it is one that does not rest on the belief itself:
        each belief it rests on was proved before.
        """
        args = belief.args
        kind = belief.predicate, len(args)
        ways_of = self._ways.get(kind)
        if ways_of is None:
            if kind not in self.running.heads:
                return None
            ways_of = self._of(kind)
        if not self.running.holds(kind, key_of(args)):
            return None
        if kind in self._recursive:
            return self._first_founded(ways_of, belief)
        for ways in ways_of:
            rows = ways.rows(*args)
            row = next(rows, None)
            if row is None:
                continue
            other = next(rows, None)
            if other is not None:
                row = min((row, other, *islice(rows, MANY - 2)), key=ways.rank)
            return ways.derivation(row)
        return None

    def _first_founded(self, ways_of: tuple[Ways, ...], belief: Belief) -> Derivation | None:
        is_founded = self._founded(belief)
        for ways in ways_of:
            rows = ways.rows(*belief.args)
            few = list(islice(rows, MANY))
            if len(few) > 1:
                few.sort(key=ways.rank)
            for row in chain(few, rows):
                found = ways.derivation(row)
                if is_founded(found):
                    return found
        return None

    def derivations(self, belief: Belief) -> tuple[Derivation, ...]:
        """Give every derivation: that of `first`, the others by clause and by their values."""
        kind = belief.predicate, len(belief.args)
        if not self.running.holds(kind, key_of(belief.args)):
            return ()
        found: list[Derivation] = []
        ways_of = self._of(kind)
        is_first = kind not in self._recursive
        for ways in ways_of:
            rows = list(ways.rows(*belief.args))
            is_first &= len(rows) <= MANY
            if len(rows) > 1:
                rows.sort(key=ways.rank)
            found += map(ways.derivation, rows)
        if len(found) > 1 and not is_first:
            first = self.first(belief)
            if first is not None:
                found.insert(0, found.pop(found.index(first)))
        return tuple(found)

    def _of(self, kind: Kind) -> tuple[Ways, ...]:
        """Give the clauses of a concept, as written."""
        found = self._ways.get(kind)
        if found is None:
            head = self.running.heads[kind]
            bodies = sorted(head.bodies, key=lambda body: body.number)
            found = self._ways[kind] = tuple(Ways(head, body, self.running) for body in bodies)
            if head.keeping in (Keeping.RECURSIVE, Keeping.RECOMPUTED):
                self._recursive[kind] = {
                    other_kind: self.running.parts.rows[other.facts.name]
                    for other_kind, other in self.running.heads.items()
                    if other.component == head.component
                }
        return found

    def _founded(self, belief: Belief) -> Callable[[Derivation], bool]:
        """Give what tells whether a derivation rests on beliefs of lower stages only."""
        kind = belief.predicate, len(belief.args)
        own = self._recursive[kind]
        stage = own[kind][key_of(belief.args)]

        def is_founded(derivation: Derivation) -> bool:
            for premise in derivation.matched:
                stages = own.get((premise.predicate, len(premise.args)))
                if stages is not None and stages.get(key_of(premise.args), stage) >= stage:
                    return False
            return True

        return is_founded
