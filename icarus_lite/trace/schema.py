"""What is read back of a trace's lines: the part that the beliefs of a run follow from.

Lines hold more (the decision, the path, anchors, the arm, timings: see `record`); keys that are
not named here are skipped, not errors. `docs/reference/trace.md` describes them all.
"""

from __future__ import annotations

import msgspec

from icarus_lite.outcomes import Status
from icarus_lite.symbols import Value


class PerceptRow(msgspec.Struct, frozen=True):
    """An object as it was perceived."""

    type: str
    name: str
    attributes: dict[str, Value] = {}


class PresenceRow(msgspec.Struct, frozen=True):
    """The name alone of an object that was perceived."""

    name: str


class OutcomeRow(msgspec.Struct, frozen=True):
    """What became of an action."""

    name: str
    args: tuple[Value, ...] = ()
    status: Status = Status.SUCCEEDED
    reason: str = ""


class BeliefRow(msgspec.Struct, frozen=True):
    """A belief that was added; its supports are read where somebody asks."""

    belief: str


class AssertedRow(msgspec.Struct, frozen=True):
    """An effect that an action asserted in this cycle."""

    belief: str
    action: str
    attributes: dict[str, Value] = {}


class WithdrawnRow(msgspec.Struct, frozen=True):
    """A belief that was withdrawn in this cycle, and what contradicted it."""

    belief: str
    because: tuple[str, ...]
    cycles: int = 1


class DoubtRow(msgspec.Struct, frozen=True):
    """A belief that was in doubt after this cycle: see `Doubt`."""

    belief: str
    rule: int
    cycles: int
    limit: int


class ChangeLine(msgspec.Struct, frozen=True):
    """What a cycle changed."""

    cycle: int
    percepts: tuple[PresenceRow, ...]
    added: tuple[BeliefRow, ...]
    removed: tuple[str, ...]
    asserted: tuple[AssertedRow, ...]
    outcomes: tuple[OutcomeRow, ...]
    withdrawn: tuple[WithdrawnRow, ...] = ()


class InputLine(msgspec.Struct, frozen=True):
    """What entered a cycle, and what was noted and doubted in it."""

    cycle: int
    percepts: tuple[PerceptRow, ...]
    outcomes: tuple[OutcomeRow, ...]
    notes: tuple[str, ...] = ()
    doubts: tuple[DoubtRow, ...] = ()
