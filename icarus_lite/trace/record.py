"""The trace: one JSON line a cycle, appended and flushed, so that a crash loses nothing."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Self

from icarus_lite._version import __version__
from icarus_lite.agent import Decision
from icarus_lite.errors import TraceError
from icarus_lite.execution import GoalChange, Request, SkillPath
from icarus_lite.inference import Assertion, BeliefState, Support
from icarus_lite.language.syntax import Atom, Domain
from icarus_lite.outcomes import Outcome
from icarus_lite.symbols import Percept
from icarus_lite.trace.plans import plan_row

FORMAT = "icarus-trace"
VERSION = 2
"""Of the lines. Version 1 had no `asserted`, so that nothing could be asked of it later."""


def header(
    domain: Domain,
    goals: Sequence[object],
    *,
    intentions: Sequence[object] = (),
    given: Sequence[Atom] = (),
    **extra: object,
) -> dict[str, object]:
    """Give the first line of a trace: what ran, on which text, with which settings.

    Args:
        domain: The domain; its text goes in whole, so that the trace explains itself.
        goals: The goals of the agent.
        intentions: The skills it is to carry out.
        given: The facts it begins with, as in a task's `:init`.
        extra: Whatever the caller wants recorded: task, robot, seed, configuration.
    """
    texts = [domain.source.text, *(source.text for source in domain.source.included)]
    return {
        "format": FORMAT,
        "version": VERSION,
        "icarus": __version__,
        "domain": {
            "name": domain.name,
            "path": domain.source.path,
            "sha256": hashlib.sha256("\0".join(texts).encode()).hexdigest(),
            "text": domain.source.text,
            "included": [
                {"path": source.path, "text": source.text} for source in domain.source.included
            ],
        },
        "goals": [str(goal) for goal in goals],
        "intentions": [str(intention) for intention in intentions],
        "given": [str(fact) for fact in given],
        **extra,
    }


def cycle_record(
    decision: Decision, percepts: Sequence[Percept], outcomes: Sequence[Outcome], **extra: object
) -> dict[str, object]:
    """Give one cycle as a line of the trace.

    Everything but `extra` (anchors, arm, timings) follows from the domain, the percepts and the
    outcomes, so that a replay gives the same bytes.
    """
    return {
        "cycle": decision.cycle,
        "outcomes": [_outcome(outcome) for outcome in outcomes],
        "percepts": [
            {"type": p.type, "name": p.name, "attributes": dict(p.attributes)} for p in percepts
        ],
        "added": [
            {"belief": str(b), "supports": [_support(s) for s in decision.state.supports[b]]}
            for b in decision.added
        ],
        "removed": [str(belief) for belief in decision.removed],
        "asserted": list(_asserted(decision)),
        **_judged(decision.state),
        "goals": [{"goal": str(g.goal), "satisfied": g.satisfied} for g in decision.goals],
        "path": [str(step.action) for step in decision.path],
        "plan": None if decision.plan is None else plan_row(decision.plan),
        "skills": None if decision.skill_path is None else _skill_path(decision.skill_path),
        "told": [_told(each) for each in decision.told],
        "agenda": [
            {
                "goal": each.name,
                "priority": each.priority,
                "maintain": each.maintain,
                "standing": str(each.standing),
                "reason": each.reason,
            }
            for each in decision.agenda
        ],
        "request": None if decision.request is None else _request(decision.request),
        "intentions": [{"skill": str(i.skill), "done": i.done} for i in decision.intentions],
        "decision": {
            "kind": str(decision.kind),
            "action": None if decision.step is None else str(decision.step.action),
            "commands": [str(command) for command in decision.commands],
            "reason": decision.reason,
        },
        "candidates": [
            {"skill": c.skill, "chosen": c.chosen, "why_not": c.why_not}
            for c in decision.candidates
        ],
        "failures": [{"reason": str(f.reason), "text": f.text} for f in decision.failures],
        "notes": list(decision.state.notes),
        **extra,
    }


def _asserted(decision: Decision) -> Iterator[dict[str, object]]:
    """Give what actions have asserted in this cycle, attachments last, attributes included.

    With `removed` this tells at any cycle which effects persist: see `Recording`.
    """
    state = decision.state
    for belief, cause in state.asserted():
        if cause.cycle == decision.cycle:
            row: dict[str, object] = {"belief": str(belief), "action": str(cause.action)}
            if belief.attributes:
                row["attributes"] = dict(belief.attributes)
            yield row


def _judged(state: BeliefState) -> dict[str, object]:
    """Give what was withdrawn, and what is in doubt; nothing where there is neither.

    The doubts go on from here, should the run be resumed.
    """
    rows: dict[str, object] = {}
    if state.withdrawn:
        rows["withdrawn"] = [
            {"belief": str(each.belief), "because": list(each.because), "cycles": each.cycles}
            for each in state.withdrawn
        ]
    if state.doubts:
        rows["doubts"] = [
            {"belief": str(each.belief), "rule": each.rule}
            | {"cycles": each.cycles, "limit": each.limit}
            for each in state.doubts
        ]
    return rows


def _told(change: GoalChange) -> dict[str, object]:
    """Give a goal that was added, or the name alone of one that was removed."""
    if not change.goals:
        return {"removed": change.name}
    return {
        "added": change.name,
        "goals": [str(each) for each in change.goals],
        "priority": change.priority,
        "maintain": change.maintain,
    }


def _request(request: Request) -> dict[str, object]:
    return {
        "agent": request.agent,
        "action": str(request.action),
        "sentence": request.sentence,
        "since": request.since,
    }


def _skill_path(path: SkillPath) -> dict[str, object]:
    """Give a skill path from its aim down to the primitive, with the clause of each level."""
    levels = [
        {
            "skill": str(level),
            "line": level.clause.span.line,
            "position": level.position,
            "bindings": dict(level.bindings),
        }
        for level in path.levels
    ]
    return {"aims": [str(aim) for aim in path.aims], "levels": levels}


def _outcome(outcome: Outcome) -> dict[str, object]:
    row: dict[str, object] = {
        "name": outcome.action.name,
        "args": list(outcome.action.args),
        "status": str(outcome.status),
    }
    return {**row, "reason": outcome.reason} if outcome.reason else row


def _support(support: Support) -> dict[str, object]:
    if isinstance(support, Assertion):
        return {"action": str(support.action), "cycle": support.cycle}
    return {
        "concept": str(support.clause.head),
        "line": support.clause.span.line,
        "because": [str(fact) for fact in support.matched],
        "absent": [str(atom) for atom in support.absent],
    }


def ensure_writable(path: str | Path) -> None:
    """Make a trace's folder and see that the file can be written, without touching its content.

    Raises:
        TraceError: it cannot.
    """
    try:
        Path(path).parent.mkdir(parents=True, exist_ok=True)
        existed = Path(path).exists()
        with Path(path).open("a", encoding="utf-8"):
            pass
        if not existed:
            Path(path).unlink()
    except OSError as error:
        raise TraceError(f"cannot be written: {error.strerror}", path=str(path)) from error


def _drop_broken_line(path: Path) -> None:
    """Cut a file after its last line that ends and can be read; a whole one gets its end."""
    with path.open("r+b") as file:
        data = file.read()
        end = data.rfind(b"\n") + 1
        last = data[end:]
        if not last:
            return
        try:
            json.loads(last)
        except ValueError:
            file.truncate(end)
        else:
            file.write(b"\n")


class TraceWriter:
    """Appends lines to a trace file; each is flushed before the next cycle begins.

    Args:
        path: The file; its folder is made if it is missing.
        first: The header, of a file that is begun: one that exists is replaced. None to go on with
            a trace; what was cut off of its last line is dropped.

    Raises:
        TraceError: the file cannot be written.
    """

    def __init__(self, path: str | Path, first: Mapping[str, object] | None) -> None:
        self.path = Path(path)
        ensure_writable(path)
        try:
            if first is None:
                _drop_broken_line(self.path)
            self._file = self.path.open("a" if first is None else "w", encoding="utf-8")
        except OSError as error:
            raise TraceError(f"cannot be written: {error.strerror}", path=str(path)) from error
        if first is not None:
            self.write(first)

    def write(self, record: Mapping[str, object]) -> None:
        """Append one line and flush it to the operating system.

        Raises:
            TraceError: the disk refuses.
        """
        try:
            self._file.write(json.dumps(record, ensure_ascii=False, allow_nan=False) + "\n")
            self._file.flush()
        except OSError as error:
            raise TraceError(f"cannot be written: {error.strerror}", path=str(self.path)) from error

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        value: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()
