"""Beliefs as the from-scratch `Closure` has them: the second opinion nearest to the engine."""

from __future__ import annotations

from collections.abc import Mapping

from engine_trials.histories import World
from icarus_lite import Belief
from icarus_lite.inference import Closure, Derivation, FactStore, percept_facts
from icarus_lite.inference.facts import Lineages
from icarus_lite.language.percept_types import lineages
from icarus_lite.language.syntax import Domain
from icarus_lite.symbols import Value

Row = tuple[str, tuple[Value, ...], tuple[tuple[str, Value], ...]]
"""A belief with its attributes, sorted by name."""


def row(belief: Belief) -> Row:
    """Give a belief in the form in which beliefs are compared here."""
    return belief.predicate, belief.args, tuple(sorted(belief.attributes.items()))


class Scratch:
    """Infers a world's beliefs without regard to any other cycle."""

    def __init__(self, domain: Domain) -> None:
        self._closure = Closure(domain.concepts)
        self._lineages: Lineages = lineages(domain.percepts)

    def facts(self, world: World) -> tuple[FactStore, Mapping[Belief, tuple[Derivation, ...]]]:
        """Give everything that holds, percepts included, and all derivations."""
        store = FactStore(percept_facts(world.percepts, self._lineages))
        for belief in world.asserted:
            store.add(belief)
        return store, self._closure.derive(store)  # type: ignore[return-value]

    def beliefs(self, world: World) -> frozenset[Row]:
        """Give all derived and asserted beliefs."""
        store, found = self.facts(world)
        held = {*found, *world.asserted}
        return frozenset(row(fact) for fact in store if fact in held)
