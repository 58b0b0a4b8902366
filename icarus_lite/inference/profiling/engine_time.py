"""What the network itself spends on each clause, cycle by cycle.

Two networks follow the same cycles. The one runs undisturbed but for a clock around each numeric
kernel: it gives the time of a cycle and of the kernels in it. The other runs under Python's
profiler, which slows it down: it gives in what proportions the generated code of the clauses
shares the rest. Times are those of the processor, so that whatever else the machine does meanwhile
does not count. In both of them pair rules that are otherwise followed together follow each by
itself, so that it shows what each costs. What is left over is nobody's: finding out what changed,
keeping stores and indexes, the log.
"""

from __future__ import annotations

import cProfile
from collections.abc import Sequence
from time import thread_time
from types import CodeType
from typing import Any, TypeAlias

from icarus_lite.inference.network import CompiledDomain, Network
from icarus_lite.inference.network.pair_stores import PairStore
from icarus_lite.inference.network.relations import Pairs
from icarus_lite.inference.network.running import Running
from icarus_lite.inference.profiling.source import clause_lines
from icarus_lite.records import dataclass
from icarus_lite.symbols import Belief, Percept

Cycle: TypeAlias = tuple[Sequence[Percept], Sequence[Belief]]
"""Everything that is perceived in a cycle, and all beliefs that are given in it."""

_UPDATE = Network.update_snapshot.__code__
_KERNEL = PairStore.update.__code__


@dataclass(frozen=True, slots=True)
class EngineTime:
    """What the network spent, the first cycle aside.

    Args:
        cycles: How many cycles there were after the first.
        seconds: How long they took together.
        first: How long the first cycle took, in which everything is new.
        clauses: Of the seconds, those spent on each clause, by its number.
    """

    cycles: int
    seconds: float
    first: float
    clauses: tuple[float, ...]


def engine_time(compiled: CompiledDomain, cycles: Sequence[Cycle]) -> EngineTime:
    """Measure what a network of a domain spends on cycles.

    Raises:
        InferenceError: a test cannot be evaluated, or the budget is spent.
    """
    if not cycles:
        return EngineTime(0, 0.0, 0.0, (0.0,) * len(compiled.domain.concepts))
    first, seconds, kernels = _clocked(compiled, cycles)
    shares = _shares(compiled, cycles)
    rest = max(seconds - sum(kernels), 0.0)
    clauses = tuple(k + rest * share for k, share in zip(kernels, shares, strict=True))
    return EngineTime(len(cycles) - 1, seconds, first, clauses)


def _clocked(compiled: CompiledDomain, cycles: Sequence[Cycle]) -> tuple[float, float, list[float]]:
    """Give the seconds of the first cycle, of the others, and of the kernels of each clause."""
    network = compiled.network()
    kernels: dict[str, _Timed] = {}
    first, seconds = 0.0, 0.0
    for number, (percepts, given) in enumerate(cycles):
        begun = thread_time()
        network.update_snapshot(percepts, given)
        took = thread_time() - begun
        if number:
            seconds += took
        else:
            first = took
        _watch(network, kernels)
    by_clause = [0.0] * len(compiled.domain.concepts)
    for name, clause in _kernel_clauses(_running(network)).items():
        if name in kernels:
            by_clause[clause] += kernels[name].seconds
    return first, seconds, by_clause


def _watch(network: Network, kernels: dict[str, _Timed]) -> None:
    """Put a clock before each kernel that has none; a network may begin again with new ones."""
    _running(network).follow_alone()
    for name, store in _running(network).parts.pairs.items():
        if not isinstance(store.relation, _Timed):
            spent = kernels[name].seconds if name in kernels else 0.0
            kernels[name] = _Timed(store.relation, spent)
            store.relation = kernels[name]  # type: ignore[assignment] # stands in for it


def _shares(compiled: CompiledDomain, cycles: Sequence[Cycle]) -> list[float]:
    """Give the share of each clause's generated code in the time outside of kernels."""
    network = compiled.network()
    profile = cProfile.Profile(thread_time)
    for number, (percepts, given) in enumerate(cycles):
        if number:
            profile.enable()
        try:
            network.update_snapshot(percepts, given)
        finally:
            profile.disable()
        _running(network).follow_alone()
    module = _running(network).compiled.module
    blocks = clause_lines(module.source, compiled.domain)
    path = module.path
    by_clause = [0.0] * len(compiled.domain.concepts)
    whole = 0.0
    for entry in profile.getstats():
        code = entry.code
        if code is _UPDATE:
            whole += entry.totaltime
        elif code is _KERNEL:
            whole -= entry.totaltime
        elif isinstance(code, CodeType) and code.co_filename == path:
            for number, (begin, end) in blocks.items():
                if begin <= code.co_firstlineno <= end:
                    by_clause[number] += entry.inlinetime
    return [each / whole if whole > 0 else 0.0 for each in by_clause]


def _running(network: Network) -> Running:
    return network._running  # noqa: SLF001 - a profiler looks inside


def _kernel_clauses(running: Running) -> dict[str, int]:
    """Give the clause that each kernel belongs to: where it stands for two conditions."""
    return {
        literal.relation.name: body.number
        for body in running.compiled.design.bodies
        for literal in body.literals
        if isinstance(literal.relation, Pairs) and len(literal.places) == 2
    }


class _Timed:
    """A numeric kernel's relation with a clock before its updates."""

    def __init__(self, relation: Any, seconds: float) -> None:
        self._relation = relation
        self.seconds = seconds

    def update(self, left: Sequence[int], right: Sequence[int]) -> Any:
        """Let the relation follow, and add to its time."""
        begun = thread_time()
        try:
            return self._relation.update(left, right)
        finally:
            self.seconds += thread_time() - begun

    def __getattr__(self, name: str) -> Any:
        return getattr(self._relation, name)

    def __len__(self) -> int:
        return len(self._relation)
