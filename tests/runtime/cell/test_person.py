"""What the person does, when, and what they tell of it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from runtime.cell import PERFECT, Act, Cell, CellParameters, Person, PersonParameters, Report
from runtime.cell.acts import Pointed
from runtime.cell.body import REST
from runtime.errors import UsageError

AT_ONCE = PersonParameters(delay_s=(0.0, 0.0))


@pytest.fixture
def someone(bench):
    """A person at the bench, and a clock that is asked to go on."""
    bench.move(0.2, -0.3, 0.4)
    return Person(bench.world, 0, AT_ONCE)


def wait(person, seconds=30.0, step=0.1, start=None):
    """Let time go by until the first report; gives the reports and the time."""
    time_s = start if start is not None else person._now_s
    for _ in range(round(seconds / step)):
        time_s += step
        reports = person.step(time_s)
        if reports:
            return reports, time_s
    return (), time_s


def ask(person, bench, name, *parts):
    person.step(person._now_s)
    places = [(part, bench.world.parts[f"{part}-1"].position) for part in parts]
    person.ask(name, places)


def test_nobody_is_there_until_they_are_needed(someone, bench):
    assert someone.body is None
    assert someone.place is None
    assert someone.step(0.0) == ()
    ask(someone, bench, "take-away", "plug")
    assert someone.place == REST


def test_asked_to_put_a_part_in_they_do_and_say_so(someone, bench):
    ask(someone, bench, "put-in", "transfer", "case")
    reports, seconds = wait(someone)
    assert reports == (Report("put-in", ("transfer", "case"), "succeeded"),)
    assert 3 < seconds < 15
    assert bench.world.parts["transfer-1"].seated
    assert someone.place == REST
    assert someone.carries is None


def test_a_screw_is_screwed_in(someone, bench):
    ask(someone, bench, "put-in", "plug", "case")
    wait(someone)
    part = bench.world.parts["plug-1"]
    assert part.seated
    assert part.turned_rad == pytest.approx(8 * math.pi)


def test_the_hand_carries_the_part_smoothly(someone, bench):
    ask(someone, bench, "put-in", "transfer", "case")
    places, parts = [], []
    for tick in range(1200):
        someone.step(tick * 0.01)
        places.append(someone.place)
        if someone.carries:
            parts.append(np.subtract(bench.world.parts["transfer-1"].position, someone.place))
    speeds = np.linalg.norm(np.diff(places, axis=0), axis=1) / 0.01
    assert 0.3 < speeds.max() < 1.6
    assert np.abs(np.diff(speeds)).max() < 0.08  # no jumps of speed
    assert np.ptp(parts, axis=0) == pytest.approx([0, 0, 0], abs=1e-9)


def test_how_often_one_looks_makes_no_difference(new_bench):
    ends = []
    for step in (0.02, 0.31):
        bench = new_bench()
        person = Person(bench.world, 4)
        person.step(0.0)
        person.ask("put-back", [("plug", None), ("0.45", None), ("-0.05", None)])
        bench.move(0.2, -0.3, 0.4)
        reports, seconds = wait(person, step=step)
        assert reports[0].status == "succeeded"
        assert bench.world.parts["plug-1"].position == pytest.approx((0.45, -0.05, 0.013))
        ends.append(seconds)
    assert ends[0] == pytest.approx(ends[1], abs=0.9)  # waiting is noticed at the next look


def test_a_part_is_put_down_beside_what_stands_there_not_into_it(bench):
    person = Person(bench.world, 4)
    person.step(0.0)
    bench.move(0.2, -0.3, 0.4)
    x, y, _ = bench.world.parts["case-1"].position
    edge = x - bench.world.parts["case-1"].model.size[0] / 2  # the wall's own place
    person.ask("put-back", [("hubcover", None), (f"{edge - 0.01:.3f}", None), (f"{y}", None)])
    assert wait(person)[0][0].status == "succeeded"
    cover = bench.world.parts["hubcover-1"]
    assert cover.position[2] == pytest.approx(cover.model.size[2] / 2)
    assert edge - cover.position[0] >= cover.model.size[0] / 2
    assert math.dist(cover.position[:2], (edge - 0.01, y)) < 0.08
    assert bench.grip("hubcover-1")
    assert bench.world.contact().press_n(*bench.place) < 20.0


def test_the_same_seed_takes_the_same_time_to_begin(new_bench):
    def begin(seed):
        bench = new_bench()
        person = Person(bench.world, seed)
        bench.move(0.2, -0.3, 0.4)
        person.step(0.0)
        person.ask("take-away", [("plug", None)])
        return wait(person)[1]

    assert begin(1) == begin(1)
    assert len({begin(seed) for seed in range(5)}) > 2


def test_the_part_that_is_meant_is_the_nearest_of_its_type(someone, bench):
    someone.step(0.0)
    someone.ask("take-away", [("bearing-7", (0.31, -0.19, 0.01))])
    reports, _ = wait(someone)
    assert reports[0].args == ("bearing-7",)
    assert bench.world.parts["bearing-2"].position[0] > 0.8
    assert bench.world.parts["bearing-1"].position[0] == pytest.approx(0.3)


@pytest.mark.parametrize(
    ("asked", "reason"),
    [
        (("take-away", [("plug", (0.2, -0.3, 0.0))]), "there is no plug near (0.20, -0.30) m"),
        (("take-away", [("gear", None)]), "there is no gear"),
        (("put-in", [("plug", None), ("input", None)]), "the plug fits nowhere in the input"),
        (("put-back", [("plug", None)]), "nobody said where to put the plug"),
        (("put-back", [("plug", None), ("here", None), ("0", None)]), "'here' is no place"),
    ],
)
def test_what_cannot_be_done_is_told_with_its_reason(someone, asked, reason):
    someone.step(0.0)
    someone.ask(*asked)
    reports, _ = wait(someone)
    assert [(report.status, report.reason) for report in reports] == [("failed", reason)]


def test_what_the_robot_holds_is_not_taken_from_it(someone, bench):
    bench.pick("plug-1")
    someone.step(0.0)
    someone.ask("take-away", [("plug", None)])
    reports, _ = wait(someone)
    assert reports[0].reason == "the robot holds the plug"
    assert bench.world.held == "plug-1"


def test_a_part_that_has_gone_meanwhile_is_missed(someone, bench):
    ask(someone, bench, "take-away", "plug")
    someone.step(1.0)
    bench.pick("plug-1")
    bench.move(0.2, -0.3, 0.4)
    reports, _ = wait(someone)
    assert reports[0].reason in ("the robot holds the plug", "the plug is no longer there")
    wait(someone, 5)
    assert someone.place == REST


def test_into_a_seat_that_is_taken_they_do_not_force_it(someone, bench):
    bench.world.insert("bearing-2", "input-1")
    ask(someone, bench, "put-in", "bearing", "input")
    reports, _ = wait(someone)
    assert reports[0].reason == "something is in the way of the bearing"
    wait(someone, 8)
    assert someone.carries is None
    assert not bench.world.parts["bearing-1"].seated


def test_they_wait_until_the_robot_is_out_of_the_way(someone, bench):
    x, y, _ = bench.world.parts["plug-1"].position
    bench.move(x, y, 0.12)
    ask(someone, bench, "take-away", "plug")
    reports, now = wait(someone, 10)
    assert reports == ()
    assert math.dist(someone.place, bench.place) > 0.15
    bench.move(0.2, -0.3, 0.4)
    reports, _ = wait(someone, start=now)
    assert reports[0].status == "succeeded"


def test_they_do_not_wait_for_ever(someone, bench):
    x, y, _ = bench.world.parts["plug-1"].position
    bench.move(x, y, 0.12)
    ask(someone, bench, "take-away", "plug")
    reports, seconds = wait(someone, 60)
    assert reports[0].reason == "the robot's arm was in the way for 40 s"
    assert seconds > 40


def test_the_hand_never_comes_close_to_the_tool(someone, bench):
    """The tool wanders about over the table; the person sees to it."""
    rng = np.random.default_rng(5)
    closest = math.inf
    for part in ("plug", "transfer", "bearing"):
        ask(someone, bench, "take-away", part)
    for tick in range(600):
        before = math.dist(someone.place, bench.place)
        someone.step(tick * 0.1)
        after = math.dist(someone.place, bench.place)
        if after < before - 1e-6:  # they came closer, not the tool
            closest = min(closest, after)
        if tick % 40 == 0:
            bench.move(*rng.uniform((0.25, -0.25, 0.3), (0.5, 0.25, 0.45)))
    assert closest > 0.1


def test_held_until_something_was_pressed_in(someone, bench):
    ask(someone, bench, "hold", "case")
    reports, _ = wait(someone)
    assert reports == (Report("hold", ("case",), "succeeded"),)
    assert someone.holds == "case-1"
    assert math.dist(someone.place, bench.world.parts["case-1"].position) < 0.2
    before = bench.world.parts["case-1"].position
    bench.pick("casingtop-1")
    assert bench.push_in("casingtop-1", "case-1") < 3e-4
    assert bench.world.parts["casingtop-1"].seated
    assert bench.world.parts["case-1"].position == before
    someone.step(someone._now_s + 0.5)
    assert someone.holds == "case-1"  # the robot is still there
    bench.move(0.2, -0.3, 0.4)
    wait(someone, 5)
    assert someone.holds is None
    assert someone.place == REST


def test_asked_again_for_what_they_hold_they_say_so_and_hold_on(someone, bench):
    ask(someone, bench, "hold", "case")
    wait(someone)
    someone.ask("hold", [("case", bench.world.parts["case-1"].position)])
    reports, _ = wait(someone)
    assert reports == (Report("hold", ("case",), "succeeded"),)
    for tick in range(200):
        assert someone.step(someone._now_s + 0.1 * (tick % 2)) == ()
        assert someone.holds == "case-1"
    someone.ask("take-away", [("plug", None)])  # something else: they let go
    reports, _ = wait(someone)
    assert reports[0].name == "take-away"
    assert someone.holds is None


def test_what_they_do_of_their_own_accord_waits_while_they_hold_for_somebody(bench):
    bench.move(0.2, -0.3, 0.4)
    script = (Act("reach-in", at_s=6.0),)
    person = Person(bench.world, 0, PersonParameters(acts=script, delay_s=(0.0, 0.0)))
    ask(person, bench, "hold", "case")
    wait(person)
    for _ in range(300):
        person.step(person._now_s + 0.1)
        assert person.holds == "case-1"
    person.ask("release", [("case", None)])
    told = [each.name for _ in range(300) for each in person.step(person._now_s + 0.1)]
    assert sorted(told) == ["reach-in", "release"]
    assert person.holds is None


def test_they_let_go_when_they_are_told(someone, bench):
    ask(someone, bench, "hold", "case")
    wait(someone)
    someone.ask("release", [("case", None)])
    reports, _ = wait(someone)
    assert reports == (Report("release", ("case",), "succeeded"),)
    assert someone.holds is None


def test_one_who_refuses_says_so_and_does_nothing(bench):
    person = Person(bench.world, 0, PersonParameters(refuses=1.0))
    person.step(0.0)
    person.ask("take-away", [("plug", None)])
    reports, _ = wait(person)
    assert reports[0].status == "failed"
    assert "does not want to" in reports[0].reason
    assert person.place == REST


def test_one_who_does_not_report_acts_all_the_same(bench):
    bench.move(0.2, -0.3, 0.4)
    person = Person(bench.world, 0, PersonParameters(reports=False))
    person.step(0.0)
    person.ask("put-in", [("transfer", None), ("case", None)])
    assert wait(person, 20)[0] == ()
    assert bench.world.parts["transfer-1"].seated


def test_the_script_is_followed_at_its_times_and_occasions(bench):
    bench.move(0.2, -0.3, 0.4)
    script = (
        Act("take-away", ("bearing-2",), at_s=2.0),
        Act("put-back", ("bearing-2", "0.25", "0.2"), when="held"),
    )
    person = Person(bench.world, 0, PersonParameters(acts=script))
    assert wait(person, 1.5) == ((), pytest.approx(1.5))
    assert person.doing is None
    reports, _ = wait(person)
    pointed = (Pointed("bearing", (0.3, -0.2, 0.0095)),)  # where it was, not where it is now
    assert reports == (
        Report("take-away", ("bearing-2",), "succeeded", asked=False, pointed=pointed),
    )
    assert bench.world.parts["bearing-2"].position[0] > 0.8
    bench.pick("hubcover-1")
    bench.move(0.2, -0.3, 0.4)
    reports, _ = wait(person)
    assert reports[0].name == "put-back"
    assert bench.world.parts["bearing-2"].position[:2] == pytest.approx((0.25, 0.2))


def test_what_was_inserted_can_be_taken_away_again(bench):
    person = Person(
        bench.world, 0, PersonParameters(acts=(Act("take-away", ("hubcover",), when="inserted"),))
    )
    person.step(0.0)
    bench.pick("hubcover-1")
    bench.push_in("hubcover-1", "case-1")
    bench.move(0.2, -0.3, 0.4)
    reports, _ = wait(person)
    assert reports[0].status == "succeeded"
    assert not bench.world.parts["hubcover-1"].seated


@pytest.mark.parametrize(
    ("make", "text"),
    [
        (lambda: Act("juggle", at_s=1.0), "does not know 'juggle', only hold, release, put-in"),
        (lambda: Act("hold", ("case",)), "needs either at_s or when"),
        (lambda: Act("put-in", ("plug",), at_s=0), r"\(put-in plug\): 1 arguments; expected 2"),
        (lambda: PersonParameters(refuses=2), "refuses = 2 is no probability"),
        (lambda: PersonParameters(delay_s=(3, 1)), r"delay_s = \(3, 1\)"),
        (lambda: PersonParameters(speed_m_s=0), "speed must be above 0"),
    ],
)
def test_wrong_scripts_are_refused(make, text):
    with pytest.raises(UsageError, match=text):
        make()


def test_an_unknown_skill_is_not_asked_for(someone):
    with pytest.raises(UsageError, match="does not know 'dance'"):
        someone.ask("dance")


def test_the_camera_sees_the_hand_and_not_what_is_under_it():
    cell = Cell("ur5", 2, CellParameters(detector=PERFECT, person=AT_ONCE))
    cell.update(cell.look_joints, gripper_closed=False)
    before = {d.type for d in cell.look()[0]}
    cell.person.step(0.0)
    cell.person.ask("reach-in", [("plug", cell.truth.parts["plug-1"].position)])
    cell.person.step(3.0)
    seen = {d.type: d.position for d in cell.look()[0]}
    assert before - set(seen) >= {"plug"}
    assert set(seen) - before == {"person"}
    assert math.dist(seen["person"][:2], cell.person.place[:2]) < 0.05
    cell.person.step(20.0)
    assert {d.type for d in cell.look()[0]} == before
