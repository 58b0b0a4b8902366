"""A task that was cut off, taken up where its trace ends.

The mind goes on with the beliefs, attachments and goals of the record. The eyes go on with the
anchors of its last line, and see at once which of them still hold. The body begins afresh: what was
under way when the run was cut off counts as failed, whatever had come of it.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import msgspec

from aapa import Anchor, AnchoringState, AnchorStatus
from icarus_lite import Agent, Outcome, Status
from icarus_lite.errors import TraceError
from icarus_lite.language.syntax import Domain
from icarus_lite.trace import Recording, parse_action, resumed_agent, stream_trace
from runtime.cycle_report import CycleReport
from runtime.errors import UsageError
from runtime.percepts import PERSON_TYPE
from runtime.workplace import Workplace

CUT_OFF = "the run was cut off while it was under way"
"""Why the action of a run that was cut off has failed."""


def world_path(trace: Path) -> Path:
    """Give the file beside a trace that has the simulated cell as the run left it."""
    return trace.with_suffix(".cell.json")


def world_keeper(workplace: Workplace, trace: Path) -> Callable[[CycleReport], None]:
    """Write the simulated cell down, and give an observer that does whenever it has changed.

    A real cell stays as it is when the program that ran in it is gone; a simulated one is gone
    with it, so that a run could not be taken up. The file is there before the first line of the
    trace, and is replaced in one go.
    """
    path, draft = world_path(trace), trace.with_suffix(".cell.json.new")
    last: Mapping[str, object] | None = None

    def keep(_report: CycleReport | None = None) -> None:
        nonlocal last
        world = workplace.cell.snapshot()
        if world != last:
            draft.write_text(json.dumps(world), encoding="utf-8")
            draft.replace(path)
            last = world

    path.parent.mkdir(parents=True, exist_ok=True)
    keep()
    return keep


def read_world(trace: Path) -> Mapping[str, object]:
    """Read the simulated cell as a run left it. Raises UsageError if it is not there."""
    path = world_path(trace)
    try:
        world = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise UsageError(
            f"{trace} cannot be taken up: the simulated cell as the run left it cannot be read "
            f"from {path} ({error}). It is kept beside the trace until the goal is reached"
        ) from None
    if not isinstance(world, dict):
        raise UsageError(f"{path} is not a simulated cell as a run left it")
    return world


class _AnchorRow(msgspec.Struct):
    """An anchor as the trace has it: see `runtime.cycle_report.anchor_row`."""

    name: str
    type: str
    box: tuple[float, float, float, float]
    status: str
    confidence: float
    reason: str
    parent: str | None = None
    position: tuple[float, float, float] | None = None
    size: tuple[float, float] | None = None
    last_seen: int = 0
    streak: int = 0


class _ArmRow(msgspec.Struct):
    """The arm as the trace has it."""

    joints: tuple[float, float, float, float, float, float]
    gripper_closed: bool
    gripped: bool


class _Decision(msgspec.Struct):
    kind: str
    action: str | None = None


class _Line(msgspec.Struct):
    """What a run is taken up from, of the last line of its trace."""

    cycle: int
    anchors: tuple[_AnchorRow, ...]
    arm: _ArmRow
    decision: _Decision


@dataclass(frozen=True, slots=True)
class CutOff:
    """Where a recorded run ends.

    Args:
        agent: Believes what was believed last.
        anchoring: What was anchored last.
        interrupted: The action that was under way, failed; None if there was none.
        joints: Where the arm stood, rad; None if no cycle was recorded.
        gripper_closed: Whether its gripper was closed.
        cycle: The last cycle; -1 if none was recorded.
        seed: Of the scene and its noise.
    """

    agent: Agent
    anchoring: AnchoringState
    interrupted: Outcome | None
    joints: tuple[float, float, float, float, float, float] | None
    gripper_closed: bool
    cycle: int
    seed: int


def task_of(trace: Path) -> str:
    """Give the name of the task that a trace has recorded.

    Raises:
        TraceError: it is no trace, or of a run without a task.
    """
    task = next(iter(stream_trace(trace))).get("task")
    if not isinstance(task, str):
        raise TraceError("is not the trace of a task", path=str(trace), line=1)
    return task


def read_cut_off(path: Path, domain: Domain, task: str, robot: str) -> CutOff:
    """Read where the run of a trace ends.

    Args:
        path: The trace.
        domain: The domain to go on with: it must be the one that ran.
        task: The task, which must be the one that ran.
        robot: The robot's model, likewise.

    Raises:
        UsageError: it is the trace of something else.
        TraceError: it is no trace, or damaged anywhere but in its last line.
    """
    recording = Recording(path)
    head = recording.header
    for key, wanted in (("task", task), ("robot", robot)):
        if head.get(key) != wanted:
            raise UsageError(
                f"{path} is the trace of {key} {head.get(key)}, not of {key} {wanted}: "
                "a run is resumed as what it was"
            )
    told = head.get("domain")
    if not isinstance(told, Mapping) or told.get("text") != domain.source.text:
        raise UsageError(
            f"{domain.source.path} is not the domain that {path} was recorded with; undo its "
            "changes, or start the task anew"
        )
    agent = resumed_agent(recording)
    seed = head.get("seed")
    if not isinstance(seed, int):
        raise TraceError('key "seed" of the header is not a number', path=str(path), line=1)
    if not recording.cycles:
        return CutOff(agent, AnchoringState(), None, None, False, -1, seed)  # noqa: FBT003
    line = _last_line(recording)
    interrupted = None
    if line.decision.kind in ("act", "continue", "abort") and line.decision.action is not None:
        interrupted = Outcome(parse_action(line.decision.action), Status.FAILED, CUT_OFF)
    return CutOff(
        agent,
        _anchoring(line),
        interrupted,
        line.arm.joints,
        line.arm.gripper_closed,
        line.cycle,
        seed,
    )


def _last_line(recording: Recording) -> _Line:
    last = recording.cycles[-1]
    try:
        return msgspec.convert(recording.record(last), _Line)
    except msgspec.ValidationError as error:
        number = len(recording) + 1
        message = f"cannot be taken up: {error}"
        raise TraceError(message, path=str(recording.path), line=number) from None


def _anchoring(line: _Line) -> AnchoringState:
    """Give what anchoring remembered of what it reported.

    But for people: where their hands are now has nothing to do with where they were.
    """
    anchors = (
        Anchor(
            row.name,
            row.type,
            row.box,
            AnchorStatus(row.status),
            row.parent,
            row.confidence,
            row.position,
            row.size,
            row.last_seen,
            row.reason,
            row.streak,
        )
        for row in line.anchors
        if row.type != PERSON_TYPE
    )
    return AnchoringState.of(anchors, line.cycle + 1)
