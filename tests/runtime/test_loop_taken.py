"""A person takes the part out once it is in, and says nothing: the run has to see it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import pytest
from scripted_assembly import CAMERA, CONFIG, INSERT, PICK, PLACES, Body, Eyes

from aapa import Anchoring, Camera, Detection
from icarus_lite import Agent, load_domain
from runtime.cycle_report import CycleReport
from runtime.loop import Loop, LoopResult
from runtime.percepts import PERSON_TYPE
from runtime.run import anchoring_parameters

SEAT = (0.42, -0.12, 0.04)
ASIDE = (0.35, 0.05, 0.01)
ABOVE_M = 0.3  # lower, and the gripper is before it
FAR_S = 1000


@dataclass(frozen=True)
class Visit:
    """A hand over the case from one time to another, counted from when the part was inserted, s.

    Args:
        hand: From and to.
        takes: Whether the hand takes the cover with it.
        back: When the cover lies on the table again.
        hides: Whether the cover cannot be seen in its seat.
    """

    hand: tuple[int, int] = (FAR_S, FAR_S)
    takes: bool = False
    back: int = FAR_S
    hides: bool = False


class Watching(Eyes):
    """Sees the cover in its seat, a hand over the case, and the cover where it was put down."""

    def __init__(self, body: Body, visit: Visit) -> None:
        super().__init__(body)
        self.visit, self.since, self.insertions = visit, 0, 0
        self.place = PLACES["hubcover"]

    def look(self) -> tuple[Sequence[Detection], Camera]:
        visit, now = self.visit, self.since
        seated = "hubcover" in self.body.inserted
        if seated:
            self.since += 1
        if seated and self.insertions == 0 and visit.takes and now >= visit.back:
            self.body.inserted.clear()  # as if it had never been in
            self.insertions, self.since = 1, 0
            self.place = ASIDE
            return self.look()
        first = self.insertions == 0
        hand = seated and first and visit.hand[0] <= now < visit.hand[1]
        taken = seated and first and visit.takes and now >= visit.hand[0]
        found = []
        if not hand:
            found.append(at("case", PLACES["case"], 40.0))
        hidden = hand or taken or (visit.hides and first) or self.hand[2] < ABOVE_M
        if seated and not hidden:
            found.append(at("hubcover", SEAT, 8.0))
        if not seated and self.body.held != "hubcover":
            found.append(at("hubcover", self.place, 8.0))
        if hand:
            found.append(at(PERSON_TYPE, (SEAT[0], SEAT[1], 0.1), 30.0))
        return found, CAMERA


def at(kind: str, place: tuple[float, float, float], half: float) -> Detection:
    u, v, _ = CAMERA.project(place)
    return Detection(kind, (u - half, v - half, u + half, v + half), 0.96, place, (0.06, 0.06))


def run(gearbox: Path, visit: Visit) -> tuple[LoopResult, list[CycleReport], Body]:
    body, reports = Body(), []
    loop = Loop(
        Agent(load_domain(gearbox), ["(attached hubcover case)"], long_term=False),
        Anchoring(anchoring_parameters()),
        body,
        Watching(body, visit),
        CONFIG,
        observers=[reports.append],
    )
    return loop.run(), reports, body


def withdrawn(reports: Sequence[CycleReport]) -> list[str]:
    return [str(each) for report in reports for each in report.decision.withdrawn]


@pytest.mark.parametrize("hand", [(4, 6), (8, 20), (12, 14)])
def test_a_hand_that_only_reaches_in_takes_nothing(gearbox: Path, hand: tuple[int, int]) -> None:
    result, reports, body = run(gearbox, Visit(hand))
    assert result.achieved
    assert withdrawn(reports) == []
    assert body.started.count(str(INSERT)) == 1


@pytest.mark.parametrize("hand", [(3, 6), (8, 12), (14, 16)])
def test_what_was_seen_in_its_place_and_is_kept_is_not_believed_to_be_there(
    gearbox: Path, hand: tuple[int, int]
) -> None:
    result, reports, body = run(gearbox, Visit(hand, takes=True))
    assert not result.achieved
    assert "hubcover" in result.reason
    (why,) = withdrawn(reports)
    assert why.endswith("(gone hubcover case) held for 12 cycles")
    assert body.started.count(str(INSERT)) == 1


@pytest.mark.parametrize("hides", [False, True])
def test_what_is_brought_back_is_put_in_again(gearbox: Path, *, hides: bool) -> None:
    result, reports, body = run(gearbox, Visit((4, 6), takes=True, back=17, hides=hides))
    assert result.achieved
    assert body.started.count(str(PICK)) == body.started.count(str(INSERT)) == 2
    (why,) = withdrawn(reports)
    assert ("apart" if hides else "gone") in why


def test_what_never_showed_is_believed_to_be_there_without_a_visit(gearbox: Path) -> None:
    result, reports, _ = run(gearbox, Visit(hides=True))
    assert result.achieved
    assert withdrawn(reports) == []
    visited = run(gearbox, Visit((8, 9), hides=True))[1]
    assert len(visited) > len(reports) + 5  # somebody was there: it may have been taken
