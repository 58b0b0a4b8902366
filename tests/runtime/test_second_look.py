"""The second look: back to the look pose, and long enough there, before a run may end."""

from __future__ import annotations

from collections.abc import Container, Iterable

import pytest
from scripted_assembly import Body

from icarus_lite import Outcome, Status
from runtime.drivers import PARK
from runtime.second_look import LoopLimits, SecondLook

LIMITS = LoopLimits(patience=3, patience_s=8, confirm=4, confirm_s=2, company_s=10)


@pytest.fixture
def body() -> Body:
    return Body()


def looking(body: Body, times_s: Iterable[float], *, achieved: bool = True) -> SecondLook:
    look = SecondLook(body, LIMITS, begun=True)
    for now_s in times_s:
        look.count(now_s, achieved=achieved, unsettled=False)
    return look


def confirmed_after(
    look: SecondLook, company: Container[int] = (), *, doubtful: bool = False
) -> int | None:
    """Give the time at which a goal counts, one look a second; None if it never does."""
    for second in range(60):
        look.count(float(second), achieved=True, unsettled=second in company)
        if look.confirmed(float(second), doubtful=doubtful):
            return second
    return None


def test_an_arm_goes_back_once_and_is_there_when_it_says_so(body: Body) -> None:
    look = SecondLook(body, LIMITS, begun=False)
    assert look.retreat((), {}) is None
    assert look.retreat((Outcome(PARK, Status.RUNNING),), {}) is None
    assert not look.there
    assert body.started == [str(PARK)]
    assert look.retreat((Outcome(PARK),), {}) is None
    assert look.there
    assert body.started == [str(PARK)]


def test_an_arm_at_its_look_pose_stays_there(body: Body) -> None:
    look = SecondLook(body, LIMITS, begun=True)
    assert look.retreat((), {}) is None
    assert look.there
    assert not body.started


def test_an_arm_that_cannot_go_back_says_why(body: Body) -> None:
    look = SecondLook(body, LIMITS, begun=False)
    look.retreat((), {})
    failed = Outcome(PARK, Status.FAILED, "something is in the way")
    assert look.retreat((failed,), {}) == (
        "the arm cannot go back to its look pose: something is in the way"
    )


def test_the_way_back_is_broken_off_for_something_to_do(body: Body) -> None:
    look = SecondLook(body, LIMITS, begun=False)
    look.retreat((), {})
    look.break_off()
    assert body.stops == 1
    look.retreat((), {})
    assert body.started == [str(PARK)] * 2
    there = SecondLook(body, LIMITS, begun=True)
    there.break_off()
    assert body.stops == 1
    assert not there.there


@pytest.mark.parametrize(
    ("times_s", "confirmed"),
    [
        ([0, 1, 2], False),  # too few looks
        ([0, 0.1, 0.2, 0.3], False),  # too short
        ([0, 1, 2, 3], True),
    ],
)
def test_a_goal_is_confirmed_by_enough_looks_over_enough_time(
    body: Body, times_s: list[float], *, confirmed: bool
) -> None:
    assert looking(body, times_s).confirmed(times_s[-1], doubtful=False) is confirmed


def test_a_look_begins_anew_once_the_hand_of_a_person_is_gone(body: Body) -> None:
    assert confirmed_after(looking(body, ())) == 3
    assert confirmed_after(looking(body, ()), company={1, 2}) == 5  # with the last that saw it


def test_a_hand_that_stays_does_not_hold_it_up_for_ever(body: Body) -> None:
    assert confirmed_after(looking(body, ()), company=range(60)) == 12


def test_what_may_have_been_taken_is_waited_for_as_long_as_in_an_impasse(body: Body) -> None:
    assert confirmed_after(looking(body, ()), doubtful=True) == 8
    assert confirmed_after(looking(body, ()), company={5}, doubtful=True) == 13


def test_counting_begins_anew_when_something_else_is_believed(body: Body) -> None:
    look = looking(body, [0, 1, 2, 3])
    look.interrupt()
    look.count(4, achieved=True, unsettled=False)
    assert not look.confirmed(4, doubtful=False)
    assert not look.in_vain(4)


def test_an_impasse_is_looked_at_anew_and_so_is_a_goal_believed_again(body: Body) -> None:
    look = looking(body, range(30))
    for second in range(30, 38):
        look.count(second, achieved=False, unsettled=False)
        assert not look.in_vain(second)
    look.count(38, achieved=False, unsettled=False)
    assert look.in_vain(38)
    look.count(39, achieved=True, unsettled=False)
    assert not look.confirmed(39, doubtful=False)


def test_a_visit_is_remembered_until_the_arm_does_something(body: Body) -> None:
    look = looking(body, [0])
    assert not look.visited
    look.notice(company=True)
    look.notice(company=False)
    look.interrupt()
    assert look.visited
    look.break_off()
    assert not look.visited


def test_it_is_in_vain_after_enough_looks_over_enough_time(body: Body) -> None:
    look = looking(body, [0, 1, 2], achieved=False)
    assert not look.in_vain(7.9)
    assert look.in_vain(8.0)
    assert not looking(body, [0, 9], achieved=False).in_vain(9)


def test_a_lost_arm_has_to_go_back_again(body: Body) -> None:
    look = looking(body, [0, 1, 2, 3])
    look.lost()
    assert not look.there
    look.retreat((), {})
    assert body.started == [str(PARK)]
