"""The simulated person as the loop has it: what they tell, in the names that the robot has."""

from __future__ import annotations

from dataclasses import dataclass, replace

import pytest

from aapa import Anchor, AnchorStatus
from icarus_lite import Action, Outcome, load_domain
from runtime.cell import Act, Cell, CellParameters, PersonParameters, Report
from runtime.cell.acts import Pointed
from runtime.cell_source import CellColleague, known_actions, names_for

CASE = Anchor("case", "case", (0, 0, 9, 9), AnchorStatus.VISIBLE, None, 1.0, (0.4, 0.1, 0.04))
COVER = Anchor(
    "hubcover", "hubcover", (0, 0, 9, 9), AnchorStatus.ATTACHED, "case", 1.0, (0.4, 0.06, 0.03)
)
BEARING_1 = replace(CASE, name="bearing-1", type="bearing", position=(0.3, 0.2, 0.01))
BEARING_2 = replace(CASE, name="bearing-2", type="bearing", position=(0.5, -0.2, 0.01))
ANCHORS = {each.name: each for each in (CASE, COVER, BEARING_1, BEARING_2)}


def told(*args, pointed):
    return Report("take-away", args, "succeeded", asked=False, pointed=pointed)


def test_the_only_one_of_its_type_is_meant_wherever_it_is_believed_to_be():
    report = told("hubcover-1", pointed=(Pointed("hubcover", (0.9, -0.3, 0.0)),))
    assert names_for(report, ANCHORS) == ("hubcover",)
    nowhere = {"hubcover": replace(COVER, position=None)}
    assert names_for(report, nowhere) == ("hubcover",)


@pytest.mark.parametrize(("x", "name"), [(0.31, "bearing-1"), (0.48, "bearing-2")])
def test_of_several_the_one_is_meant_where_it_was(x, name):
    place = next(each.position for each in ANCHORS.values() if each.name == name)
    report = told("bearing-7", pointed=(Pointed("bearing", (x, *place[1:])),))
    assert names_for(report, ANCHORS) == (name,)


def test_each_argument_has_a_name_of_its_own_and_what_is_no_thing_keeps_its_word():
    report = Report(
        "put-back",
        ("hubcover-1", "0.4", "plug-1"),
        "succeeded",
        asked=False,
        pointed=(Pointed("hubcover", (0, 0, 0)), None, Pointed("plug", (0, 0, 0))),
    )
    assert names_for(report, ANCHORS) == ("hubcover", "0.4", "plug-1")  # no plug is anchored


@dataclass
class Clock:
    """Of a source, only the time is asked."""

    time_s: float = 0.0


def colleague(domain, act, seconds=40.0):
    """Give a cell in which a person does something unasked, and all that is told of it."""
    person = PersonParameters((act,), delay_s=(0.0, 0.0))
    with Cell("ur5", 3, CellParameters(person=person)) as cell:
        clock = Clock()
        someone = CellColleague(cell, clock, known_actions(domain))  # type: ignore[arg-type]
        places = {name: part.position for name, part in cell.truth.parts.items()}
        # Named the other way round than the cell has them, as an agent's own counting may be.
        anchors = {
            "hubcover": replace(COVER, position=places["hubcover-1"]),
            "case": CASE,
            "bearing-1": replace(BEARING_1, position=places["bearing-2"]),
            "bearing-2": replace(BEARING_2, position=places["bearing-1"]),
        }
        outcomes: list[Outcome] = []
        for tick in range(round(seconds / 0.1)):
            clock.time_s = tick * 0.1
            outcomes += someone.reports(anchors)
    return outcomes


@pytest.fixture
def domain(gearbox):
    return load_domain(gearbox)


@pytest.mark.parametrize(
    ("part", "name"),
    [("hubcover-1", "hubcover"), ("bearing-2", "bearing-1"), ("bearing-1", "bearing-2")],
)
def test_what_the_person_does_unasked_is_told_in_the_agents_names(domain, part, name):
    outcomes = colleague(domain, Act("take-away", (part,), at_s=0.5))
    assert outcomes == [Outcome(Action("take-away", (name,)))]


def test_who_held_something_unasked_lets_go_of_the_same(domain):
    outcomes = colleague(domain, Act("hold", ("case-1",), at_s=0.5), seconds=150.0)
    assert outcomes == [
        Outcome(Action("hold", ("case",))),
        Outcome(Action("let-go", ("case",))),
    ]


@pytest.mark.parametrize("reports", [True, False])
def test_who_held_something_when_the_run_was_cut_off_says_that_they_have_let_go(domain, reports):
    person = PersonParameters((Act("hold", ("case-1",), at_s=0.0),), reports)
    with Cell("ur5", 3, CellParameters(person=person)) as cell:
        for tick in range(100):
            cell.person.step(tick * 0.1)
        assert cell.person.holds == "case-1"
        kept = cell.snapshot()
    with Cell("ur5", 3, CellParameters(person=person)) as again:
        again.restore(kept)
        assert again.person.holds is None
        someone = CellColleague(again, Clock(), known_actions(domain))  # type: ignore[arg-type]
        told = [Outcome(Action("let-go", ("case",)))] if reports else []
        assert list(someone.reports(ANCHORS)) == told
        assert list(someone.reports(ANCHORS)) == []
