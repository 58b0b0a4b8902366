"""A whole domain profiled: every clause, over the cycles of a recording."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from icarus_lite.inference.engine import InferenceEngine, Memory
from icarus_lite.inference.network import CompiledDomain
from icarus_lite.inference.profiling.engine_time import Cycle, EngineTime, engine_time
from icarus_lite.inference.profiling.plans import RulePlan, rule_plans
from icarus_lite.inference.profiling.rows import ClauseProfile, Profiler
from icarus_lite.outcomes import Outcome
from icarus_lite.records import dataclass
from icarus_lite.symbols import Percept


@dataclass(frozen=True, slots=True)
class DomainProfile:
    """What all clauses of a domain did in some cycles.

    Args:
        clauses: The clauses, as written, evaluated from scratch in each cycle.
        cycles: How many cycles there were.
        engine: What the network spent on each of them.
    """

    clauses: tuple[ClauseProfile, ...]
    cycles: int
    engine: EngineTime

    @property
    def slowest(self) -> ClauseProfile | None:
        """The clause that the network spent most time on; None if it spent none.

        Of a single cycle, in which everything is new, it is the one that took longest from
        scratch.
        """
        spent = self.engine.clauses
        if not any(spent):
            spent = tuple(each.seconds for each in self.clauses)
        slowest = max(self.clauses, key=lambda each: spent[each.plan.number], default=None)
        return slowest if slowest is not None and spent[slowest.plan.number] > 0 else None

    def of(self, plan: RulePlan) -> ClauseProfile:
        """Give the profile of one clause."""
        return next(each for each in self.clauses if each.plan.number == plan.number)


class DomainProfiler:
    """Runs a domain through recorded cycles and looks at what each clause does in them.

    Args:
        compiled: The domain, compiled.
    """

    def __init__(self, compiled: CompiledDomain) -> None:
        self._engine = InferenceEngine(compiled.domain, compiled.evaluator.functions)
        self._memory = Memory()
        self.plans = rule_plans(compiled)
        self._rows = Profiler(self.plans, self._engine.evaluator)
        self._compiled = compiled
        self._cycles: list[Cycle] = []

    def cycle(self, percepts: Iterable[Percept], outcomes: Sequence[Outcome] = ()) -> None:
        """Infer a cycle, then evaluate every clause over what is believed in it.

        Raises:
            FrameError: a percept is malformed.
            InferenceError: a test cannot be evaluated.
        """
        self._memory = self._engine.step(self._memory, percepts, outcomes)
        state, asserted = self._memory.state, self._memory.asserted
        given = (*asserted, *(belief for belief, _ in state.hierarchy.beliefs()))
        self._cycles.append((state.percepts, given))
        self._rows.observe(state.facts())

    def result(self) -> DomainProfile:
        """Give what has been seen so far; the engine's time is measured now.

        Raises:
            InferenceError: the budget of a cycle is spent.
        """
        engine = engine_time(self._compiled, self._cycles)
        return DomainProfile(self._rows.profiles(), len(self._cycles), engine)
