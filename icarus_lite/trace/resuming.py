"""A recorded run taken up again: an agent that believes what was believed when the record ends.

Effects that persist, attachments and goals come from the record; the beliefs follow from them.
Plans do not: the world may have gone on, and the next decision is made afresh. The first line of
the rest says so under `resumed`, and a replay does the same there.
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from typing import Final

from icarus_lite.agent import Agent
from icarus_lite.errors import FrameError, TraceError
from icarus_lite.inference import Functions
from icarus_lite.language.fragments import parse_atom
from icarus_lite.trace.recording import Recording

RESUMED: Final = "resumed"
"""The key of a line that says that the run was cut off before it, and taken up there."""


def agent_of(recording: Recording, functions: Functions | None = None) -> Agent:
    """Give the agent of a run as it was before the first cycle.

    Args:
        recording: The run.
        functions: The Python functions that its domain was given.

    Raises:
        TraceError: the header does not say what ran.
        DomainError: a goal in it does not parse.
    """
    header = recording.header
    return Agent(
        recording.domain,
        _texts(header, "goals", recording.path),
        intentions=_texts(header, "intentions", recording.path),
        functions=functions,
        given=[parse_atom(text) for text in _texts(header, "given", recording.path)],
        others=_texts(header, "others", recording.path) if "others" in header else None,
        long_term=header.get("long_term") is not False,
    )


def resumed_agent(
    recording: Recording, functions: Functions | None = None, *, before: int | None = None
) -> Agent:
    """Give the agent of a run as it goes on after the last recorded cycle.

    Args:
        recording: The run.
        functions: The Python functions that its domain was given.
        before: The cycle with which it goes on; None for the one after the last.

    Raises:
        TraceError: the header does not say what ran, or a line is damaged.
        DomainError: a goal does not parse.
        InferenceError: a test of the domain cannot be evaluated.
    """
    agent = agent_of(recording, functions)
    cycles = [cycle for cycle in recording.cycles if before is None or cycle < before]
    for cycle in cycles:
        tell_goals(agent, recording.record(cycle))
    if cycles:
        last = cycles[-1]
        _drop_reached(agent, recording.record(last))
        agent.take_up(recording.at(last).memory, recording.chronicle_until(last))
    return agent


def tell_goals(agent: Agent, recorded: Mapping[str, object]) -> None:
    """Add and remove the goals that were added and removed before a recorded cycle."""
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


def _drop_reached(agent: Agent, recorded: Mapping[str, object]) -> None:
    """Drop the goals that were told and are no longer on the agenda: they were reached."""
    rows = recorded.get("agenda")
    kept = {row["goal"] for row in rows} if isinstance(rows, list) else set()
    for name in agent.goal_names:
        if name not in kept:
            with suppress(FrameError):  # it is about to be dropped anyway
                agent.remove_goal(name)


def _texts(header: Mapping[str, object], key: str, path: str) -> tuple[str, ...]:
    found = header.get(key)
    if not isinstance(found, list) or not all(isinstance(each, str) for each in found):
        raise TraceError(f'key "{key}" of the header is not a list of texts', path=path, line=1)
    return tuple(found)
