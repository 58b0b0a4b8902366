"""A recorded run gone through again: does the agent come to the same?"""

from __future__ import annotations

import json
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass

from icarus_lite.agent import Agent
from icarus_lite.errors import FrameError, TraceError
from icarus_lite.inference import Functions
from icarus_lite.language.fragments import parse_atom
from icarus_lite.trace.reader import inputs_of
from icarus_lite.trace.record import cycle_record
from icarus_lite.trace.recording import Recording

_BELIEFS = frozenset({"added", "removed", "asserted"})


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
    header = recording.header
    agent = Agent(
        recording.domain,
        _texts(header, "goals", recording.path),
        intentions=_texts(header, "intentions", recording.path),
        functions=functions,
        given=[parse_atom(text) for text in _texts(header, "given", recording.path)],
        others=_texts(header, "others", recording.path) if "others" in header else None,
        long_term=header.get("long_term") is not False,
    )
    beliefs: Divergence | None = None
    decisions: Divergence | None = None
    for cycle in recording.cycles:
        recorded = recording.record(cycle)
        percepts, outcomes = inputs_of(recorded)
        _tell(agent, recorded)
        decision = agent.cycle(percepts, outcomes)
        replayed = json.loads(json.dumps(cycle_record(decision, percepts, outcomes)))
        for key, value in replayed.items():
            if recorded.get(key) == value:
                continue
            found = Divergence(cycle, key, recorded.get(key), value)
            if key in _BELIEFS:
                beliefs = beliefs or found
            else:
                decisions = decisions or found
        if beliefs is not None:
            break  # from here on it is another run
    return Replay(len(recording), beliefs, decisions)


def _tell(agent: Agent, recorded: Mapping[str, object]) -> None:
    """Add and remove the goals that were added and removed before a cycle."""
    told = recorded.get("told")
    for row in told if isinstance(told, list) else ():
        if "removed" in row:
            with suppress(FrameError):  # of another domain text it may never have been a goal
                agent.remove_goal(row["removed"])
        else:
            agent.add_goal(
                f"({' '.join(row['goals'])})",
                priority=row["priority"],
                maintain=row["maintain"],
                name=row["added"],
            )


def _texts(header: Mapping[str, object], key: str, path: str) -> tuple[str, ...]:
    found = header.get(key)
    if not isinstance(found, list) or not all(isinstance(each, str) for each in found):
        raise TraceError(f'key "{key}" of the header is not a list of texts', path=path, line=1)
    return tuple(found)
