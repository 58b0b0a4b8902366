"""What is known in one cycle, as execution asks for it."""

from __future__ import annotations

from collections.abc import Hashable, Sequence

from icarus_lite.inference import FactStore, InferenceEngine, Memory, with_values
from icarus_lite.language.syntax import Condition
from icarus_lite.planning import Imagination, PlanStep, holds
from icarus_lite.symbols import Belief, Value


class Moment:
    """The beliefs of a cycle, and what follows from them for what could be done.

    Args:
        engine: The inference engine, for its domain and semantics.
        memory: What is believed, the last outcomes taken into account.
        time_s: The time in s, for `:timeout`; None where nobody tells it.
    """

    __slots__ = ("_engine", "_imagination", "_lost", "_memory", "_scene", "facts", "time_s")

    def __init__(
        self, engine: InferenceEngine, memory: Memory, time_s: float | None = None
    ) -> None:
        self._engine = engine
        self._memory = memory
        self._imagination: Imagination | None = None
        self._lost: frozenset[Value] | None = None
        self._scene: Hashable = None
        self.facts: FactStore = memory.state.facts()
        self.time_s = time_s

    @property
    def cycle(self) -> int:
        """The number of the cycle."""
        return self._memory.state.cycle

    @property
    def scene(self) -> Hashable:
        """What makes two moments the same to the agent: all that it perceives and believes.

        Beliefs follow from percepts, persisting effects and attachments, so these will do.
        """
        if self._scene is None:
            state, asserted = self._memory.state, self._memory.asserted
            pairs = frozenset(state.hierarchy.pairs())
            self._scene = frozenset(state.percepts), with_values(asserted), pairs
        return self._scene

    @property
    def lost(self) -> frozenset[Value]:
        """The objects that were perceived once and are not any longer."""
        if self._lost is None:
            present = (percept.name for percept in self._memory.state.percepts)
            self._lost = frozenset(self._memory.known.difference(present))
        return self._lost

    @property
    def beliefs(self) -> frozenset[Belief]:
        """All that is believed; percepts are left out."""
        return frozenset(self._memory.state.supports)

    @property
    def imagination(self) -> Imagination:
        """What situations are expanded with from here."""
        if self._imagination is None:
            engine = self._engine
            self._imagination = Imagination(
                engine.domain, self._memory, engine.closure, engine.evaluator
            )
        return self._imagination

    def believes(
        self, conditions: Sequence[Condition], bindings: dict[str, Value] | None = None
    ) -> bool:
        """Tell whether a conjunction is believed, for some value of its free variables."""
        return holds(conditions, self.facts, bindings, self._engine.evaluator)

    def undone_by(self, step: PlanStep, goals: Sequence[Condition]) -> Condition | None:
        """Give the first of these goals that would no longer hold after a step; None if all do."""
        imagined = self.imagination.after(self.imagination.start, step)
        facts = self.imagination.facts(imagined)
        return next((g for g in goals if not self.imagination.holds([g], facts)), None)

    def is_over(self, limit_s: float | None, since_s: float | None) -> bool:
        """Tell whether a time limit has passed; it cannot where nobody tells the time."""
        if limit_s is None or since_s is None or self.time_s is None:
            return False
        return self.time_s - since_s > limit_s
