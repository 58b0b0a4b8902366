"""The simulated cell as the loop has it: percepts, and the colleague who works in it.

The cell follows the arm's measured joints. What its parts do to the arm in return, the gripper's
sensor and the forces on the tool, goes over wires to the controller; a dry run has only the sensor.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from typing import Final

from aapa import Anchor, Camera, Detection
from icarus_lite import Action, Outcome, Status, Value
from icarus_lite.language.syntax import Domain
from runtime.cell import Cell
from runtime.cell.acts import Pointed, Report
from runtime.cell.contact import Contact
from runtime.drivers import ArmState

HOLD: Final = "hold"
LET_GO: Final = "let-go"
"""What a person says who no longer holds what they said they hold."""


@dataclass(frozen=True, slots=True)
class Wires:
    """From the cell to the body.

    Args:
        feel: Tells the gripper's sensor whether a part is between the fingers.
        touch: Tells the controller what the tool would touch; None where nothing feels forces.
        followed: Tells it that the cell is where the arm is, so that it waits for a late one; None
            where nothing can run ahead.
    """

    feel: Callable[[bool], None]
    touch: Callable[[Contact | None], None] | None = None
    followed: Callable[[], None] | None = None


class CellSource:
    """Percepts from the simulated cell.

    Args:
        cell: The cell.
        wires: From the cell to the body.

    Attributes:
        gripped: What the gripper's sensor was told last.
        time_s: The arm's clock at the last update, s.
    """

    def __init__(self, cell: Cell, wires: Wires) -> None:
        self._cell = cell
        self._wires = wires
        self.gripped = False
        self._contact: Contact | None = None
        self.time_s = 0.0

    def update(self, arm: ArmState) -> None:
        """Move the scene to where the arm is, and let the arm feel what it does."""
        self.time_s = arm.timestamp_s
        gripped = self._cell.update(arm.joints, arm.gripper_closed, arm.force_n)
        if gripped != self.gripped:
            self._wires.feel(gripped)
            self.gripped = gripped
        if self._wires.touch is not None:
            contact = self._cell.contact()
            if contact is not self._contact:
                self._wires.touch(contact)
                self._contact = contact
        if self._wires.followed is not None:
            self._wires.followed()

    def look(self) -> tuple[list[Detection], Camera]:
        """Give the next frame's detections and the camera that took it."""
        return self._cell.look()


class CellColleague:
    """The simulated person, asked by the names the robot has for things.

    Args:
        cell: The cell the person works in.
        source: Knows the time on the arm's clock.
        known: The actions that the domain knows; what else is reported means nothing to it.
    """

    def __init__(self, cell: Cell, source: CellSource, known: Collection[str]) -> None:
        self._cell = cell
        self._source = source
        self._known = frozenset(known)
        self._holds: tuple[Value, ...] | None = None
        self._let_go = cell.person.let_go

    def ask(self, action: Action, _sentence: str, anchors: Mapping[str, Anchor]) -> None:
        """Ask the person, pointing at each thing where it is anchored."""
        things = tuple(
            (str(name), anchors[str(name)].position if str(name) in anchors else None)
            for name in action.args
        )
        self._cell.person.ask(action.name, things)

    def reports(self, anchors: Mapping[str, Anchor]) -> tuple[Outcome, ...]:
        """Let the person go on until now, and give what was reported of it.

        Who said that they hold something says as well when they let go of it. What was not asked
        for they tell in words of their own, and point: see `names_for`.
        """
        told = [
            Outcome(
                Action(report.name, report.args if report.asked else names_for(report, anchors)),
                Status(report.status),
                report.reason,
            )
            for report in self._cell.person.step(self._source.time_s)
        ]
        if self._let_go is not None:
            name = _anchored_as(self._let_go, anchors) or self._let_go.type
            told.append(Outcome(Action(LET_GO, (name,))))
            self._let_go = None
        if self._holds is not None and self._cell.person.holds is None:
            told.append(Outcome(Action(LET_GO, self._holds)))
            self._holds = None
        for outcome in told:
            if outcome.action.name == HOLD and outcome.status is Status.SUCCEEDED:
                self._holds = outcome.action.args
        return tuple(outcome for outcome in told if outcome.action.name in self._known)


def names_for(report: Report, anchors: Mapping[str, Anchor]) -> tuple[str, ...]:
    """Give the arguments of a report as the names of what is anchored.

    The one anchor of its type is meant; of several, the one nearest to where the person points.
    What has no anchor keeps the name that it was given.
    """
    pointed = report.pointed or (None,) * len(report.args)
    return tuple(
        given if thing is None else _anchored_as(thing, anchors) or given
        for given, thing in zip(report.args, pointed, strict=True)
    )


def _anchored_as(thing: Pointed, anchors: Mapping[str, Anchor]) -> str | None:
    alike = [anchor for anchor in anchors.values() if anchor.type == thing.type]
    placed = [
        (math.dist(anchor.position, thing.place), anchor.name)
        for anchor in alike
        if anchor.position is not None
    ]
    if placed:
        return min(placed)[1]
    return alike[0].name if len(alike) == 1 else None


def known_actions(domain: Domain) -> frozenset[str]:
    """Give the names of all actions that mean something to a domain."""
    attached = [
        pattern.predicate
        for rule in domain.attachments
        for pattern in (rule.attach, rule.until)
        if pattern is not None
    ]
    return frozenset({clause.head.predicate for clause in domain.skills} | set(attached))
