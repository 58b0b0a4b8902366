"""Ours without the network: all beliefs inferred from scratch in each frame."""

from __future__ import annotations

from collections.abc import Callable

from icarus_lite import Belief, Percept, load_domain
from icarus_lite.inference import Closure, FactStore, percept_fact
from tabletop.engines.network_engine import RULES
from tabletop.oracle import PREDICATES, Facts
from tabletop.scene import Frame, State


class ScratchEngine:
    """Is handed the whole state as facts, ready-made.

    Args:
        base: Where the arm stands.
    """

    def __init__(self, base: tuple[int, int, int]) -> None:
        self._closure = Closure(load_domain(RULES).concepts)
        self._base = Percept("base", "arm", dict(zip(("x", "y", "reach2"), base, strict=True)))
        self._store = FactStore()

    def begin(self, state: State) -> None:
        """Infer everything."""
        self.prepare(Frame((), ()), state)()

    def prepare(self, frame: Frame, state: State) -> Callable[[], None]:  # noqa: ARG002 - as `Engine`
        """Give what infers everything from a state."""
        facts = [percept_fact(self._base)]
        for each in state.things:
            given = {name: getattr(each, name) for name in ("type", "x", "y", "z", "w", "d", "h")}
            facts.append(Belief("obj", (each.name,), given))
        facts += [Belief("holding", (each,)) for each in sorted(state.holding)]
        facts += [Belief("fixed", pair) for pair in sorted(state.fixed)]

        def step() -> None:
            self._store = FactStore(facts)
            self._closure.derive(self._store)

        return step

    def facts(self) -> Facts:
        """Give all derived facts."""
        wanted = frozenset(PREDICATES)
        return frozenset(
            (fact.predicate, *fact.args) for fact in self._store if fact.predicate in wanted
        )
