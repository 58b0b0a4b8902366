"""What becomes of a part that was let go: seated, proud of its seat, jammed, or screwed in."""

from __future__ import annotations

import math

import pytest

from runtime.cell import Mishaps

TURN = 2 * math.pi


def into_thread(bench):
    """Bring the plug down to the beginning of its thread; gives the tool's height there."""
    assert bench.pick("plug-1")
    part = bench.world.parts["plug-1"]
    x, y, z = bench.seat("plug-1", "case-1")
    top = z + part.model.seats[0].thread.depth_m + part.model.grasp_height_m
    bench.press(x, y, 10.0, top)
    return top


def turn_in(bench, turns, step=0.2):
    """Turn clockwise as seen from above, following the thread down; re-grip every half turn."""
    done = 0.0
    start = bench.yaw
    while done < turns * TURN - 1e-9:
        step_now = min(step, turns * TURN - done)
        done += step_now
        contact = bench.world.contact()
        turned = min(bench.world._insertion.turning.turned_rad + step_now, 4 * TURN)
        height = contact.thread.top_z - contact.thread.pitch_m * turned / TURN
        bench.move(z=height - 5e-4, yaw=bench.yaw - step_now, force_n=10.0)
        if start - bench.yaw > math.pi:
            bench.open()
            bench.move(yaw=start)
            assert bench.close()
    return bench


def test_let_go_in_its_seat_it_is_seated(bench):
    bench.pick("hubcover-1")
    bench.push_in("hubcover-1", "case-1")
    assert bench.world.parts["hubcover-1"].seated


@pytest.mark.parametrize(("above", "seated"), [(0.0015, True), (0.003, False)])
def test_let_go_above_its_seat_it_sticks_there(bench, above, seated):
    bench.pick("input-1")
    bench.push_in("input-1", "case-1")  # pressed in once
    assert bench.grip("input-1")
    x, y, z = bench.seat("input-1", "case-1")
    grasp = bench.world.parts["input-1"].model.grasp_height_m
    bench.move(x, y, z + grasp - 6e-4, force_n=12.0)
    bench.move(z=z + grasp + above)
    bench.open()
    part = bench.world.parts["input-1"]
    assert part.seated is seated
    assert part.parent == "case-1"
    assert part.position[2] == pytest.approx(z if seated else z + above)


def test_a_light_touch_does_not_seat_it(bench):
    bench.pick("input-1")
    x, y, z = bench.seat("input-1", "case-1")
    bench.move(x, y, z + 0.05)
    bench.move(z=z + bench.world.parts["input-1"].model.grasp_height_m, force_n=2.0)
    bench.open()
    assert not bench.world.parts["input-1"].seated
    bench.grip("input-1")
    bench.push_in("input-1", "case-1")
    assert bench.world.parts["input-1"].seated


def test_let_go_on_the_rim_it_stays_on_the_rim(bench):
    bench.pick("hubcover-1")
    x, y, z = bench.seat("hubcover-1", "case-1")
    bench.press(x + 0.006, y, 12.0, z, search_m=0.0)
    bench.open()
    part = bench.world.parts["hubcover-1"]
    assert (part.parent, part.seated) == ("case-1", False)
    assert part.position[2] == pytest.approx(z + 0.004)


def test_a_jam_stops_it_on_its_way_and_a_second_try_goes_in(new_bench):
    bench = new_bench(mishaps=Mishaps(jam_rate=1.0))
    bench.pick("bearing-1")
    rest = bench.push_in("bearing-1", "input-1")
    assert 0.004 < rest < 0.022  # 25 mm of shaft
    part = bench.world.parts["bearing-1"]
    assert (part.parent, part.seated) == ("input-1", False)
    bench.grip("bearing-1")
    bench.move(z=0.2)
    assert bench.push_in("bearing-1", "input-1") < 3e-4
    assert bench.world.parts["bearing-1"].seated


def test_lifted_only_within_the_hole_it_still_jams(new_bench):
    bench = new_bench(mishaps=Mishaps(jam_rate=1.0))
    bench.pick("bearing-1")
    x, y, z = bench.seat("bearing-1", "input-1")
    z += bench.world.parts["bearing-1"].model.grasp_height_m
    first = bench.press(x, y, 12.0, z)
    bench.move(z=bench.place[2] + 0.002)
    assert bench.press(x, y, 12.0, z) == pytest.approx(first, abs=1e-5)


def test_pressed_hard_an_unheld_case_moves_aside(bench):
    before = bench.world.parts["case-1"].position
    bench.world.insert("hubcover-1", "case-1")
    bench.pick("casingtop-1")
    bench.push_in("casingtop-1", "case-1", search_m=0.0)
    case = bench.world.parts["case-1"].position
    assert math.dist(case, before) == pytest.approx(0.008)
    assert not bench.world.parts["casingtop-1"].seated
    # What sits in it has gone with it.
    assert bench.world.parts["hubcover-1"].position == pytest.approx(
        tuple(bench.seat("hubcover-1", "case-1"))
    )


def test_pressed_gently_the_case_stays_where_it_is(bench):
    before = bench.world.parts["case-1"].position
    bench.pick("hubcover-1")
    bench.push_in("hubcover-1", "case-1", force_n=18.0)
    assert bench.world.parts["case-1"].position == before


def test_the_thread_takes_hold_at_its_beginning(bench):
    top = into_thread(bench)
    contact = bench.world.contact()
    assert contact.thread is not None
    assert contact.thread.top_z == pytest.approx(top)
    assert contact.thread.axis == pytest.approx(tuple(bench.seat("plug-1", "case-1")[:2]))
    assert (contact.thread.turned_rad, contact.thread.jam_at_rad) == (0.0, None)
    bench.open()
    part = bench.world.parts["plug-1"]
    assert (part.parent, part.seated, part.turned_rad) == ("case-1", False, 0.0)


def test_while_it_turns_the_contact_stays_the_same_object(bench):
    top = into_thread(bench)
    first = bench.world.contact()
    bench.move(z=top - 0.0005, yaw=-1.0)
    bench.move(z=top - 0.0010, yaw=-2.0)
    assert bench.world.contact() is first
    bench.open()
    assert bench.world.parts["plug-1"].turned_rad == pytest.approx(2.0)


def test_counter_clockwise_it_does_not_go_in(bench):
    top = into_thread(bench)
    bench.move(z=top, yaw=2.0)
    bench.open()
    assert bench.world.parts["plug-1"].turned_rad == 0.0


def test_screwed_in_with_new_grips_it_ends_in_its_seat(bench):
    into_thread(bench)
    turn_in(bench, 2.5)
    bench.open()
    part = bench.world.parts["plug-1"]
    assert part.turned_rad == pytest.approx(2.5 * TURN, abs=1e-6)
    assert not part.seated
    assert part.position[2] == pytest.approx(bench.seat("plug-1", "case-1")[2] + 1.5 * 0.0015)
    assert bench.close()
    turn_in(bench, 1.6)
    bench.open()
    part = bench.world.parts["plug-1"]
    assert part.seated
    assert part.turned_rad == pytest.approx(4 * TURN)  # no farther than tight
    assert part.position[2] == pytest.approx(bench.seat("plug-1", "case-1")[2])


def test_pulled_while_it_is_screwed_in_it_slips_out_of_the_fingers(bench):
    into_thread(bench)
    turn_in(bench, 0.4)
    turned = bench.world._insertion.turning.turned_rad
    assert bench.move(z=bench.place[2] + 0.003)
    assert not bench.move(z=bench.place[2] + 0.010)
    part = bench.world.parts["plug-1"]
    assert bench.world.held is None
    assert (part.parent, part.turned_rad) == ("case-1", pytest.approx(turned))


def test_unscrewed_it_comes_out(bench):
    bench.world.insert("plug-1", "case-1")
    assert bench.world.parts["plug-1"].seated
    assert bench.grip("plug-1")
    for _ in range(30):
        if bench.world._insertion.turning.turned_rad < 0.3:
            break
        bench.move(z=bench.place[2] + 0.0015 / 4, yaw=bench.yaw + math.pi / 2)
        bench.open()
        bench.move(yaw=0.0)
        assert bench.close()
    assert bench.move(z=0.3)
    assert bench.world.held == "plug-1"
    bench.move(0.3, 0.2, 0.3)
    bench.open()
    assert bench.world.parts["plug-1"].parent is None


def test_askew_the_thread_binds_and_after_turning_back_it_goes_in(new_bench):
    bench = new_bench(mishaps=Mishaps(cross_thread_rate=1.0))
    top = into_thread(bench)
    bind = bench.world.contact().thread.jam_at_rad
    assert 0.3 * TURN <= bind <= 1.2 * TURN
    assert bind < 2.9, "one grip turns it as far as it goes"
    bench.move(yaw=-(bind + 0.1))
    bench.move(z=top, yaw=0.0)
    bench.move(z=top + 0.03)
    assert bench.world.held == "plug-1"
    bench.press(bench.place[0], bench.place[1], 10.0, top)
    assert bench.world.contact().thread.jam_at_rad is None


def test_a_part_that_slips_falls_where_it_was_and_is_no_longer_felt(new_bench):
    bench = new_bench(mishaps=Mishaps(slip_rate=1.0, slip_after_m=(0.35, 0.36)))
    assert bench.pick("hubcover-1")  # 0.29 m up
    assert not bench.move(0.4, 0.12)
    assert bench.world.held is None
    part = bench.world.parts["hubcover-1"]
    assert part.position[:2] == pytest.approx((0.4, 0.12))
    assert part.parent is not None or part.position[2] == pytest.approx(0.012)


@pytest.mark.parametrize("spun", [3.6, 5.5, 8.0])
def test_turns_are_counted_however_seldom_one_looks(bench, spun):
    top = into_thread(bench)
    thread = bench.world.parts["plug-1"].model.seats[0].thread
    bench.yaw -= spun
    bench.move(z=top - thread.pitch_m * spun / TURN - 2e-4, spun_rad=0.2 - spun)
    assert bench.world._insertion.turning.turned_rad == pytest.approx(spun)
    bench.open()
    assert bench.world.parts["plug-1"].turned_rad == pytest.approx(spun)
