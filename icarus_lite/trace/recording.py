"""A recorded run, ready to be asked about at any of its cycles.

A trace is read once from end to end, which takes a fraction of a second for ten thousand cycles.
What is kept of it is small: where each line stands, and what changed. To go to a cycle, the
effects that persisted then are put together from the changes, and the engine derives the rest
from them and the percepts of that line, as it did in the run.
"""

from __future__ import annotations

import json
from bisect import bisect_right
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from pathlib import Path

from icarus_lite.errors import TraceError
from icarus_lite.inference import (
    Assertion,
    BeliefState,
    Chronicle,
    Context,
    Doubt,
    Explanation,
    Functions,
    Hierarchy,
    InferenceEngine,
    Judgement,
    Link,
    Memory,
    WhyNot,
    Withdrawal,
    explain,
    why_not,
)
from icarus_lite.language import DomainError, diagnose_text
from icarus_lite.language.syntax import Domain
from icarus_lite.outcomes import Outcome
from icarus_lite.records import dataclass, field
from icarus_lite.symbols import ATTACHED, Action, Belief, Percept, Value
from icarus_lite.trace.as_of import ChronicleAsOf
from icarus_lite.trace.ground_text import parse_action, parse_belief
from icarus_lite.trace.lines import TraceLines, outcome_of
from icarus_lite.trace.schema import ChangeLine

_STRIDE = 64
"""Cycles between two of the states that are kept whole."""


@dataclass(frozen=True, slots=True)
class _Delta:
    """What one cycle changed."""

    added: tuple[Belief, ...]
    removed: tuple[Belief, ...]
    asserted: tuple[tuple[Belief, Assertion], ...]
    outcomes: tuple[Outcome, ...]
    present: tuple[str, ...]
    withdrawn: tuple[Withdrawal, ...] = ()


@dataclass(frozen=True, slots=True)
class _Kept:
    """The effects that persist after a cycle, and the names of all objects perceived so far."""

    asserted: Mapping[Belief, Assertion] = field(default_factory=dict)
    links: Mapping[Value, Link] = field(default_factory=dict)
    known: frozenset[str] = frozenset()

    def after(self, deltas: Sequence[_Delta]) -> _Kept:
        # What is asserted anew equals the old, but may come with other attributes.
        asserted = {belief: (belief, cause) for belief, cause in self.asserted.items()}
        links, known = dict(self.links), set(self.known)
        for delta in deltas:
            for belief in delta.removed:
                asserted.pop(belief, None)
                if belief.predicate == ATTACHED and len(belief.args) == 2:
                    child, parent = belief.args
                    if child in links and links[child].parent == parent:
                        del links[child]
            for belief, cause in delta.asserted:
                if belief.predicate == ATTACHED and len(belief.args) == 2:
                    child, parent = belief.args
                    links.pop(child, None)
                    links[child] = Link(parent, cause.action, cause.cycle)
                else:
                    asserted[belief] = belief, cause
            known.update(delta.present)
        return _Kept(dict(asserted.values()), links, frozenset(known))


@dataclass(frozen=True)
class Instant:
    """One cycle of a recorded run.

    Args:
        record: Its line of the trace.
        memory: What was believed, and what persisted.
        context: What questions about it are asked against.
    """

    record: Mapping[str, object]
    memory: Memory
    context: Context

    @property
    def state(self) -> BeliefState:
        """What was believed."""
        return self.memory.state

    @property
    def cycle(self) -> int:
        """Its number."""
        return self.state.cycle

    def why(self, belief: Belief, *, alternatives: bool = False) -> Explanation:
        """Explain why a belief was held, down to percepts and actions: see `Agent.why`."""
        chronicle = self.context.chronicle
        return explain(belief, self.state, alternatives=alternatives, chronicle=chronicle)

    def why_not(self, asked: str | Belief) -> WhyNot:
        """Say why a belief was not held, or why a skill could not start: see `Agent.why_not`."""
        return why_not(asked, self.context)


class Recording:
    """A recorded run; one that is still going on may be added to.

    Args:
        source: The trace file, or the header of a run that is kept in memory.
        functions: The Python functions that the run's domain was given.

    Raises:
        TraceError: the file is not a trace, or is damaged anywhere but in its last line.
    """

    def __init__(
        self, source: str | Path | Mapping[str, object], functions: Functions | None = None
    ) -> None:
        if isinstance(source, Mapping):
            self._lines = TraceLines(json.dumps(source).encode() + b"\n", "<this run>")
        else:
            self._lines = TraceLines.read(source)
        self._functions = functions
        self.path = self._lines.path
        self.header = self._lines.header
        self._beliefs: dict[str, Belief] = {}
        self._actions: dict[str, Action] = {}
        self._cycles: list[int] = []
        self._deltas: list[_Delta] = []
        self._kept: list[_Kept] = [_Kept()]
        for place, line in enumerate(self._lines.changes()):
            self._take_in(place, line)
        self.warning = self._lines.warning
        self._chronicle, self._recorded = Chronicle(), 0

    def __len__(self) -> int:
        return len(self._cycles)

    def append(self, record: Mapping[str, object]) -> None:
        """Add a cycle, as `cycle_record` gives it; the file that was read stays as it is."""
        self._lines.append(record)
        place = len(self._lines) - 1
        self._take_in(place, self._lines.change(place))

    @property
    def cycles(self) -> Sequence[int]:
        """The numbers of its cycles, in order."""
        return self._cycles

    @property
    def goals(self) -> tuple[str, ...]:
        """The goals of the run, as text."""
        found = self.header.get("goals")
        return tuple(map(str, found)) if isinstance(found, list) else ()

    @cached_property
    def domain(self) -> Domain:
        """The domain that ran, as the header has it.

        Raises:
            TraceError: it cannot be read any more.
        """
        told = self.header.get("domain")
        text = told.get("text") if isinstance(told, dict) else None
        if not isinstance(told, dict) or not isinstance(text, str):
            raise TraceError('has no domain: key "domain" of its header', path=self.path, line=1)
        name = str(told.get("path") or "domain.icr")
        rows = told.get("included")
        included = {
            str(Path(str(row["path"])).resolve()): str(row["text"])
            for row in (rows if isinstance(rows, list) else ())
        }
        domain, source, diagnostics = diagnose_text(text, name, unsaved=included)
        if domain is None:
            words = DomainError(diagnostics, source)
            message = f"has a domain that this icarus cannot read: {words}"
            raise TraceError(message, path=self.path, line=1)
        return domain

    @cached_property
    def engine(self) -> InferenceEngine:
        """Derives the beliefs of a cycle anew."""
        return InferenceEngine(self.domain, self._functions)

    def use(self, domain: Domain) -> None:
        """Look at the run by the rules of another domain from now on; the record stays as it is.

        What was added and removed, and when, is still told as it was recorded.
        """
        self.__dict__["domain"] = domain
        self.__dict__.pop("engine", None)

    def place(self, cycle: int) -> int:
        """Give the place of a cycle in `cycles`.

        Raises:
            TraceError: the run has no such cycle.
        """
        place = bisect_right(self._cycles, cycle) - 1
        if place < 0 or self._cycles[place] != cycle:
            if not self._cycles:
                raise TraceError("has no cycles", path=self.path)
            first, last = self._cycles[0], self._cycles[-1]
            message = f"has no cycle {cycle}: its cycles are {first} to {last}"
            raise TraceError(message, path=self.path)
        return place

    def record(self, cycle: int) -> Mapping[str, object]:
        """Give the line of a cycle. Raises TraceError if there is no such cycle."""
        return self._lines.record(self.place(cycle))

    def at(self, cycle: int) -> Instant:
        """Go to a cycle.

        Raises:
            TraceError: the run has no such cycle, or what was recorded of it cannot be read.
        """
        place = self.place(cycle)
        record = self._lines.record(place)
        percepts, _, line = self._lines.inputs(place)
        whole = place // _STRIDE
        kept = self._kept[whole].after(self._deltas[whole * _STRIDE : place + 1])
        engine, hierarchy = self.engine, Hierarchy(kept.links)
        doubts = (Doubt(d.rule, self._belief(d.belief), d.cycles, d.limit) for d in line.doubts)
        judgement = Judgement(tuple(doubts), self._deltas[place].withdrawn)
        memory = engine.recall(
            cycle, percepts, kept.asserted, hierarchy, kept.known, line.notes, judgement
        )
        chronicle = ChronicleAsOf(
            self.chronicle(), cycle, lambda name: self._last_perceived(place, name)
        )
        context = Context(self.domain, memory.state, engine.evaluator, chronicle, memory.known)
        return Instant(record, memory, context)

    def chronicle(self) -> Chronicle:
        """Give the record of what was believed when, over the whole run."""
        for place in range(self._recorded, len(self._cycles)):
            self._record(self._chronicle, place)
        self._recorded = len(self._cycles)
        return self._chronicle

    def chronicle_until(self, cycle: int) -> Chronicle:
        """Give a record of its own, to be gone on with, of what was believed up to a cycle.

        Raises:
            TraceError: the run has no such cycle.
        """
        chronicle = Chronicle()
        for place in range(self.place(cycle) + 1):
            self._record(chronicle, place)
        return chronicle

    def changes(self, cycle: int) -> tuple[tuple[Belief, ...], tuple[Belief, ...]]:
        """Give the beliefs that a cycle added and removed. Raises TraceError if there is none."""
        delta = self._deltas[self.place(cycle)]
        return delta.added, delta.removed

    def withdrawn(self, cycle: int) -> tuple[Withdrawal, ...]:
        """Give what was withdrawn in a cycle, and why. Raises TraceError if there is none."""
        return self._deltas[self.place(cycle)].withdrawn

    def percepts(self) -> Iterator[tuple[int, tuple[Percept, ...]]]:
        """Give what was perceived, cycle by cycle."""
        for place, cycle in enumerate(self._cycles):
            yield cycle, self._lines.inputs(place)[0]

    def reports(self, first: int, last: int) -> Iterator[tuple[int, Outcome]]:
        """Give what was reported of actions in a stretch of cycles, both ends included."""
        for cycle, delta in zip(self._cycles, self._deltas, strict=True):
            if first <= cycle <= last:
                yield from ((cycle, outcome) for outcome in delta.outcomes)

    def _record(self, chronicle: Chronicle, place: int) -> None:
        delta = self._deltas[place]
        chronicle.record(
            self._cycles[place],
            delta.added,
            delta.removed,
            delta.outcomes,
            delta.present,
            delta.withdrawn,
        )

    def _last_perceived(self, place: int, name: str) -> int | None:
        """Give the last cycle before one in which an object was perceived; None if it is then."""
        if name in self._deltas[place].present:
            return None
        for at in range(place - 1, -1, -1):
            if name in self._deltas[at].present:
                return self._cycles[at]
        return None

    def _take_in(self, place: int, line: ChangeLine) -> None:
        """Note what a cycle has changed."""
        if self._cycles and line.cycle <= self._cycles[-1]:
            after = self._cycles[-1]
            message = f'key "cycle": {line.cycle} comes after {after}; cycles must increase'
            raise self._lines.damaged(place, message)
        try:
            delta = self._delta(line)
        except TraceError as error:
            raise self._lines.damaged(place, error.message) from None
        self._cycles.append(line.cycle)
        self._deltas.append(delta)
        if len(self._cycles) % _STRIDE == 0:
            self._kept.append(self._kept[-1].after(self._deltas[-_STRIDE:]))

    def _delta(self, line: ChangeLine) -> _Delta:
        asserted = tuple(
            (
                Belief(*self._parts(row.belief), row.attributes),
                Assertion(self._action(row.action), line.cycle),
            )
            for row in line.asserted
        )
        present = tuple(row.name for row in line.percepts)
        if self._deltas and self._deltas[-1].present == present:
            present = self._deltas[-1].present  # one tuple for all cycles that see the same
        return _Delta(
            tuple(self._belief(row.belief) for row in line.added),
            tuple(map(self._belief, line.removed)),
            asserted,
            tuple(map(outcome_of, line.outcomes)),
            present,
            tuple(
                Withdrawal(self._belief(row.belief), row.because, row.cycles)
                for row in line.withdrawn
            ),
        )

    def _belief(self, text: str) -> Belief:
        found = self._beliefs.get(text)
        if found is None:
            found = self._beliefs[text] = parse_belief(text)
        return found

    def _parts(self, text: str) -> tuple[str, tuple[Value, ...]]:
        belief = self._belief(text)
        return belief.predicate, belief.args

    def _action(self, text: str) -> Action:
        found = self._actions.get(text)
        if found is None:
            found = self._actions[text] = parse_action(text)
        return found
