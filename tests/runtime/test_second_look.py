"""The second look: back to the look pose, and long enough there, before a run may end."""

from __future__ import annotations

import pytest
from scripted_assembly import Body

from icarus_lite import Outcome, Status
from runtime.drivers import PARK
from runtime.second_look import LoopLimits, SecondLook

LIMITS = LoopLimits(patience=3, patience_s=8, confirm=4, confirm_s=2, company_s=10)


@pytest.fixture
def body() -> Body:
    return Body()


def looking(body: Body, times_s: list[float]) -> SecondLook:
    look = SecondLook(body, LIMITS, begun=True)
    for now_s in times_s:
        look.count(now_s)
    return look


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
    assert looking(body, times_s).confirmed(times_s[-1], company=False) is confirmed


def test_in_company_a_look_takes_longer_but_not_for_ever(body: Body) -> None:
    look = looking(body, [0, 1, 2, 3])
    assert not look.confirmed(11.9, company=True)
    assert look.confirmed(12.0, company=True)


def test_counting_begins_anew_when_something_else_is_believed(body: Body) -> None:
    look = looking(body, [0, 1, 2, 3])
    look.interrupt()
    look.count(4)
    assert not look.confirmed(4, company=False)
    assert not look.in_vain(4)


def test_it_is_in_vain_after_enough_looks_over_enough_time(body: Body) -> None:
    look = looking(body, [0, 1, 2])
    assert not look.in_vain(7.9)
    assert look.in_vain(8.0)
    assert not looking(body, [0, 9]).in_vain(9)


def test_a_lost_arm_has_to_go_back_again(body: Body) -> None:
    look = looking(body, [0, 1, 2, 3])
    look.lost()
    assert not look.there
    look.retreat((), {})
    assert body.started == [str(PARK)]
