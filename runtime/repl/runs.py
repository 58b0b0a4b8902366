"""Runs that can go on: where the next cycle of a live session comes from."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from icarus_lite import Action, Agent, DecisionKind, Outcome, Percept, Status
from icarus_lite.trace import Frame, cycle_record, read_frames

if TYPE_CHECKING:
    from runtime.cycle_report import CycleReport
    from runtime.run_record import LoopResult


class LiveRun(Protocol):
    """An agent with a body, one cycle at a time."""

    words: str
    """What it is, in a sentence for the person."""

    agent: Agent

    waits: bool
    """Whether further cycles would be like the last one until the person says something."""

    def advance(self) -> Mapping[str, object] | None:
        """Run one cycle and give its line of the trace; None if the run has come to its end."""

    def close(self) -> None:
        """Let go of whatever it holds."""


class TypedRun:
    """A run without a body: the person says what is perceived, and what became of actions.

    What has been typed stays perceived until it is taken back. An action that the agent starts
    succeeds in the next cycle, unless the person has said otherwise.

    Args:
        agent: The agent.
        percepts: What is perceived at first.
    """

    words = "percepts as you type or load them; actions succeed unless you say otherwise"

    def __init__(self, agent: Agent, percepts: Sequence[Percept] = ()) -> None:
        self.agent = agent
        self.percepts = {(each.type, each.name): each for each in percepts}
        self.outcomes: list[Outcome] = []
        self.waits = False
        self._frames: Iterator[Frame] | None = None
        self._started: Action | None = None

    def load(self, path: Path) -> None:
        """Take percepts and outcomes from a file of frames, one each cycle, until it ends."""
        next(read_frames(path), None)  # what cannot be read is told at once
        self._frames = read_frames(path)

    def advance(self) -> Mapping[str, object] | None:
        """Run one cycle."""
        frame = None if self._frames is None else next(self._frames, None)
        if frame is not None:
            self.percepts = {(each.type, each.name): each for each in frame.percepts}
            self.outcomes += frame.outcomes
        elif self._frames is not None:
            self._frames = None
            return None
        outcomes = tuple(self.outcomes)
        if frame is None and self._started is not None and not self._is_told(self._started):
            outcomes += (Outcome(self._started, Status.SUCCEEDED),)
        percepts = tuple(self.percepts.values())
        decision = self.agent.cycle(percepts, outcomes)
        self.outcomes = []
        going = decision.kind in (DecisionKind.ACT, DecisionKind.CONTINUE)
        self._started = decision.action if going else None
        changed = decision.added or decision.removed or outcomes
        self.waits = not (changed or going or self._frames)
        return cycle_record(decision, percepts, outcomes)

    def close(self) -> None:
        """There is nothing to let go of."""

    @property
    def started(self) -> Action | None:
        """The action under way."""
        return self._started

    def _is_told(self, action: Action) -> bool:
        return any(outcome.action == action for outcome in self.outcomes)


class _Stepping(Protocol):
    """A loop that is run cycle by cycle: see `runtime.loop.Loop`."""

    def step(self) -> LoopResult | None:
        """Run one cycle; give the result once the run has ended."""


class CellRun:
    """A run in a cell, of which each cycle is run when it is asked for.

    Between two cycles the arm goes on with what it was told to do.

    Args:
        agent: The agent.
        words: What cell and arm this is.
        make: Gives the loop, from the observer that is to be called after each cycle.
        let_go: Takes the cell apart.
    """

    def __init__(
        self,
        agent: Agent,
        words: str,
        make: Callable[[Callable[[CycleReport], None]], _Stepping],
        let_go: Callable[[], None],
    ) -> None:
        self.agent = agent
        self.words = words
        self.waits = False
        self._reports: list[CycleReport] = []
        self._loop = make(self._reports.append)
        self._let_go = let_go

    def advance(self) -> Mapping[str, object] | None:
        """Run one cycle."""
        result = self._loop.step()
        if not self._reports:
            return None
        record = self._reports[-1].record()
        self._reports.clear()
        if result is not None:
            outcome = "achieved" if result.achieved else "failed"
            self.words = f"the run has ended: {outcome}, {result.reason}"
        return record

    def close(self) -> None:
        """Stop the arm and take the cell apart."""
        self._let_go()
