"""A recorded run gone through again: does the agent come to the same?"""

from __future__ import annotations

import json
from typing import Final

from icarus_lite.inference import Functions
from icarus_lite.records import dataclass
from icarus_lite.trace.reader import inputs_of
from icarus_lite.trace.record import cycle_record
from icarus_lite.trace.recording import Recording
from icarus_lite.trace.resuming import RESUMED, agent_of, resumed_agent, tell_goals

LOST: Final = "lost"
"""The key of a line that says why the arm was lost: what was decided then was not carried out."""

_DECISION = frozenset({"decision", "path", "request"})
_BELIEFS = frozenset({"added", "removed", "asserted", "withdrawn", "doubts"})
_WHERE_NEEDED = ("withdrawn", "doubts")
"""Keys that a line has only where there is something to say."""


@dataclass(frozen=True, slots=True)
class Divergence:
    """The first place where a replay differs from the record.

    Args:
        cycle: The cycle.
        key: The key of its line.
        recorded: What stands there.
        replayed: What the replay came to.
    """

    cycle: int
    key: str
    recorded: object
    replayed: object

    def __str__(self) -> str:
        old, new = (json.dumps(each, ensure_ascii=False) for each in (self.recorded, self.replayed))
        return f"cycle {self.cycle}, {self.key}: recorded {old}, replayed {new}"


@dataclass(frozen=True, slots=True)
class Replay:
    """What came of a replay.

    Args:
        cycles: How many cycles were gone through.
        beliefs: Where the beliefs first differ; None if they never do.
        decisions: Where anything else first differs: goals, path, decision, candidates.
    """

    cycles: int
    beliefs: Divergence | None = None
    decisions: Divergence | None = None

    @property
    def agrees(self) -> bool:
        """Whether all beliefs are as recorded."""
        return self.beliefs is None

    def __str__(self) -> str:
        if self.beliefs is not None:
            return f"the beliefs differ from the record; first in {self.beliefs}"
        same = f"{self.cycles} cycles replayed: all beliefs are as recorded"
        if self.decisions is None:
            return f"{same}, and all decisions"
        return f"{same}; the decisions are not, first in {self.decisions}"


def replay(recording: Recording, functions: Functions | None = None) -> Replay:
    """Give an agent the percepts and outcomes of a run, and compare what it comes to.

    The agent is made of what the header says, so that a run of another domain text, or of another
    version of the program, shows where it would go another way.

    Args:
        recording: The run.
        functions: The Python functions that its domain was given.

    Raises:
        TraceError: the header does not say what ran.
        DomainError: a goal in it does not parse.
        InferenceError: a test of the domain cannot be evaluated.
    """
    agent = agent_of(recording, functions)
    beliefs: Divergence | None = None
    decisions: Divergence | None = None
    for cycle in recording.cycles:
        recorded = recording.record(cycle)
        percepts, outcomes = inputs_of(recorded)
        if recorded.get(RESUMED):
            agent = resumed_agent(recording, functions, before=cycle)
        tell_goals(agent, recorded)
        decision = agent.cycle(percepts, outcomes)
        replayed = json.loads(json.dumps(cycle_record(decision, percepts, outcomes)))
        unsaid = {key: None for key in _WHERE_NEEDED if key in recorded}
        for key, value in {**unsaid, **replayed}.items():
            if recorded.get(key) == value or (key in _DECISION and LOST in recorded):
                continue
            found = Divergence(cycle, key, recorded.get(key), value)
            if key in _BELIEFS:
                beliefs = beliefs or found
            else:
                decisions = decisions or found
        if beliefs is not None:
            break  # from here on it is another run
    return Replay(len(recording), beliefs, decisions)
