"""Pressing with the real client against the stand-in, which is told what it touches."""

from __future__ import annotations

import dataclasses
import math
import os
import re
import signal
import subprocess
import sys

import pytest

from icarus_lite import Action, Status
from runtime.controller.process import ControllerProcess
from runtime.drivers import UrDriver

pytestmark = pytest.mark.robot

INSERT = Action("insert", ("hand1", "hubcover", "case"))
FIELD_M = 0.012
STEP_M = 0.0005
STIFFNESS_N_M = 20_000.0


@pytest.fixture(scope="module")
def controller(config):
    with ControllerProcess.start("ur5", clock=10.0, joints=config.look_joints) as process:
        yield process


@pytest.fixture
def driver(controller, config, parts, run, await_that):
    """A driver whose arm looks and holds a part, as the gripper's sensor has it."""
    controller.bench({"contact": None})
    controller.set_tool_input(0, on=False)
    long = dataclasses.replace(config.force, press_time_s=120.0)
    patient = dataclasses.replace(config, force=long)
    with UrDriver(controller.address, patient, parts) as driver:
        driver.park()
        run(driver, dict)
        grip(driver, controller, await_that)
        yield driver


def grip(driver, controller, await_that):
    """Close the gripper on a part, wherever the arm is."""
    controller.bench({"outputs": {"tool_digital_out_0": True}})
    controller.set_tool_input(0, on=True)
    await_that(lambda: driver.state().gripped and driver.state().gripper_closed)


@pytest.fixture
def held(driver, scene, parts):
    """The scene with a part in the hand, as anchoring would give it."""

    def _held(name="hubcover", type_="hubcover"):
        x, y, z = driver.state().tcp_pose[:3]
        return scene(**{"hand1": (x, y, z), name: (x, y, z - parts[type_].grasp_height_m)})

    return _held


@pytest.fixture
def feel(driver, controller):
    """The gripper's sensor: it feels a part whenever the gripper is closed."""

    def _feel():
        state = driver.state()
        if state.gripped != state.gripper_closed:
            controller.set_tool_input(0, on=state.gripper_closed)

    return _feel


def seat_of(parts, name="hubcover"):
    """Give where the tool is when a part is seated in the case of the scene."""
    x, y, z = (a + b for a, b in zip((0.40, 0.16, 0.035), parts[name].seats[0].offset, strict=True))
    return x, y, z + parts[name].grasp_height_m


def surface(middle, height):
    """Give a contact whose height at a distance from the middle a function tells."""
    x, y = middle
    count = round(2 * FIELD_M / STEP_M) + 1
    ticks = [-FIELD_M + STEP_M * index for index in range(count)]
    return {
        "origin": [x - FIELD_M, y - FIELD_M],
        "step_m": STEP_M,
        "heights": [[height(dx, dy) for dy in ticks] for dx in ticks],
        "stiffness_n_m": STIFFNESS_N_M,
    }


def opening(seat, *, aside=(0.0, 0.0), depth_m=0.006, floor_m=0.0):
    """Give a chamfered pocket in a flat rim, some way beside where the driver expects it."""
    x, y, z = seat

    def height(dx, dy):
        away = math.hypot(dx - aside[0], dy - aside[1])
        if away <= 0.001:
            return z + floor_m
        return z + min(depth_m, max(floor_m, depth_m - (0.004 - away)))

    return surface((x, y), height)


def test_a_part_is_pressed_home(driver, controller, held, feel, parts, run):
    seat = seat_of(parts)
    controller.bench({"contact": opening(seat)})
    driver.start(INSERT, (INSERT,), held())
    outcome = run(driver, held, feel)
    assert outcome.status is Status.SUCCEEDED, outcome.reason
    assert re.search(r"pressed with 1[2345] N", outcome.reason), outcome.reason
    state = driver.state()
    assert state.tcp_pose[:2] == pytest.approx(seat[:2], abs=1e-3)
    assert (state.gripper_closed, state.gripped) == (False, False)
    pressed_in = parts["hubcover"].seats[0].press_n / STIFFNESS_N_M
    assert state.tcp_pose[2] == pytest.approx(seat[2] - pressed_in, abs=5e-4)


def test_an_opening_that_is_not_where_it_was_seen_is_found(
    driver, controller, held, feel, parts, run
):
    seat, aside = seat_of(parts), (-0.004, 0.003)
    controller.bench({"contact": opening(seat, aside=aside)})
    driver.start(INSERT, (INSERT,), held())
    outcome = run(driver, held, feel)
    assert outcome.status is Status.SUCCEEDED, outcome.reason
    x, y, _ = driver.state().tcp_pose[:3]
    found = (x - seat[0] - aside[0], y - seat[1] - aside[1])
    assert math.hypot(*found) < 0.002
    assert driver.state().tcp_pose[2] < seat[2] + 1e-3


@pytest.mark.parametrize(
    ("contact", "reason"),
    [
        (lambda seat: opening(seat, floor_m=0.004), r"jammed 3\.[0-9] mm above its seat at \d+ N"),
        (
            lambda seat: opening(seat, aside=(0.02, 0.0)),
            r"found no opening within 6 mm: it stands 5\.\d mm above its seat at \d+ N",
        ),
        (lambda _seat: None, r"it went \d\.\d mm below its seat and met nothing"),
    ],
    ids=["jammed", "no opening", "nothing there"],
)
def test_what_does_not_go_in_comes_up_again_and_is_still_held(
    driver, controller, config, held, feel, parts, run, contact, reason
):
    controller.bench({"contact": contact(seat_of(parts))})
    driver.start(INSERT, (INSERT,), held())
    outcome = run(driver, held, feel)
    assert outcome.status is Status.FAILED
    assert re.match(reason, outcome.reason), outcome.reason
    state = driver.state()
    assert (state.gripper_closed, state.gripped) == (True, True)
    assert state.tcp_pose[2] == pytest.approx(config.heights.transit_m, abs=1e-3)


def test_a_way_down_that_is_blocked_ends_before_the_arm_is_stopped_by_itself(
    controller, config, parts, scene, run, await_that
):
    slow = dataclasses.replace(
        config,
        speeds=dataclasses.replace(config.speeds, tool=0.01),
        force=dataclasses.replace(config.force, most_n=30.0),
    )
    x, y, _ = scene()["hubcover"].position
    top = 0.1
    controller.bench({"contact": surface((x, y), lambda _dx, _dy: top)})
    grasp = Action("grasp", ("hand1", "hubcover"))
    with UrDriver(controller.address, slow, parts) as driver:
        controller.bench({"outputs": {"tool_digital_out_0": False}})
        controller.set_tool_input(0, on=False)
        await_that(lambda: not driver.state().gripped)
        driver.start(grasp, (grasp,), scene())
        outcome = run(driver, scene)
    assert outcome.status is Status.FAILED
    assert "on its way down the tool met" in outcome.reason
    assert "more than the 30 N allowed" in outcome.reason
    assert controller.bench({"query": "state"})["safety"] == "NORMAL"


@pytest.fixture
def searching(config, parts, controller):
    """Give a configuration with which a part is searched for slowly, and the place for it."""
    force = dataclasses.replace(
        config.force, search_speed=0.001, search_radius_m=0.015, press_time_s=120.0
    )
    seat = seat_of(parts)
    controller.set_tool_input(0, on=True)
    controller.bench(
        {
            "outputs": {"tool_digital_out_0": True},
            "contact": surface(seat[:2], lambda _dx, _dy: seat[2] + 0.006),
        }
    )

    def presses():
        state = controller.bench({"query": "state"})
        return state["tcp"][2] < seat[2] + 0.0062

    return dataclasses.replace(config, force=force), presses


def begin_search(driver, scene, parts):
    x, y, z = driver.state().tcp_pose[:3]
    anchors = scene(hand1=(x, y, z), hubcover=(x, y, z - parts["hubcover"].grasp_height_m))
    driver.start(INSERT, (INSERT,), anchors)
    return anchors


def poll_until(driver, held, condition, await_that):
    def polled():
        outcome = driver.poll(held)
        assert outcome.status is Status.RUNNING, outcome.reason
        return condition()

    await_that(polled, within_s=30.0)


def test_a_stop_ends_force_mode_and_the_arm_can_go_on(
    controller, parts, scene, searching, run, await_that, stands_still
):
    config, presses = searching
    with UrDriver(controller.address, config, parts) as driver:
        held = begin_search(driver, scene, parts)
        poll_until(driver, held, presses, await_that)
        driver.stop()
        await_that(lambda: not controller.bench({"query": "state"})["force_mode"])
        await_that(lambda: stands_still(controller))
        where = controller.bench({"query": "state"})["joints"]
        assert driver.poll(held) is None
        signal.sigtimedwait([], 0.2)
        assert driver.state().joints == pytest.approx(where, abs=1e-6)
        driver.park()
        assert run(driver, lambda: held).status is Status.SUCCEEDED


def test_the_watchdog_ends_force_mode_when_the_process_that_watches_is_killed(
    controller, parts, scene, searching, run, await_that, stands_still
):
    config, presses = searching
    driver = UrDriver(controller.address, config, parts)
    held = begin_search(driver, scene, parts)
    poll_until(driver, held, presses, await_that)
    os.kill(driver._worker.pid, signal.SIGKILL)
    outcome = run(driver, lambda: held)
    assert outcome.status is Status.FAILED
    assert "ended by itself (status -9)" in outcome.reason
    await_that(lambda: controller.bench({"query": "state"})["program_state"] == "STOPPED")
    await_that(lambda: stands_still(controller))
    driver.close()


def test_a_lost_part_ends_force_mode(
    controller, parts, scene, searching, run, await_that, stands_still
):
    config, presses = searching
    with UrDriver(controller.address, config, parts) as driver:
        held = begin_search(driver, scene, parts)
        poll_until(driver, held, presses, await_that)
        controller.set_tool_input(0, on=False)
        outcome = run(driver, lambda: held)
        assert "no longer feels the part" in outcome.reason
        await_that(lambda: stands_still(controller))


ORPHAN = """
import sys, time
from dataclasses import replace
from aapa import Anchor, AnchorStatus
from icarus_lite import Action
from runtime.config import load_robot
from runtime.drivers import UrDriver
from runtime.parts import load_parts

def main():
    config, parts = load_robot("ur5"), load_parts()
    force = replace(
        config.force, search_speed=0.001, search_radius_m=0.015, press_time_s=120.0
    )
    driver = UrDriver(sys.argv[1], replace(config, force=force), parts)
    x, y, z = driver.state().tcp_pose[:3]
    places = {
        "hand1": ("hand", (x, y, z)),
        "hubcover": ("hubcover", (x, y, z - parts["hubcover"].grasp_height_m)),
        "case": ("case", (0.40, 0.16, 0.035)),
    }
    anchors = {
        name: Anchor(name, kind, (0.0, 0.0, 1.0, 1.0), AnchorStatus.VISIBLE, None, 1.0, place)
        for name, (kind, place) in places.items()
    }
    insert = Action("insert", ("hand1", "hubcover", "case"))
    driver.start(insert, (insert,), anchors)
    while True:
        driver.poll(anchors)
        time.sleep(0.01)

if __name__ == "__main__":
    main()
"""


def test_the_arm_stops_pressing_when_the_program_that_drives_it_is_killed(
    controller, searching, tmp_path, await_that, stands_still
):
    _, presses = searching
    program = tmp_path / "orphan.py"
    program.write_text(ORPHAN, encoding="utf-8")
    child = subprocess.Popen([sys.executable, str(program), controller.address])
    try:
        await_that(presses, within_s=40.0)
    finally:
        child.send_signal(signal.SIGKILL)
        child.wait()
    await_that(lambda: stands_still(controller))
    await_that(lambda: controller.bench({"query": "state"})["program_state"] == "STOPPED")


PLACE = Action("place", ("hand1", "hubcover"))


@pytest.fixture
def fresh(config, parts, await_that):
    """A controller that has felt nothing yet, and a driver of its arm that holds a part."""
    with (
        ControllerProcess.start("ur5", clock=10.0, joints=config.look_joints) as controller,
        UrDriver(controller.address, config, parts) as driver,
    ):
        grip(driver, controller, await_that)
        yield controller, driver


@pytest.mark.parametrize("stands_m", [0.0, 0.06], ids=["the table", "something unseen"])
def test_what_a_part_is_put_down_on_is_never_pressed_hard(fresh, scene, parts, run, stands_m):
    (controller, driver), cover = fresh, parts["hubcover"]
    x, y, z = driver.state().tcp_pose[:3]

    def held():
        state = driver.state()
        at = (*state.tcp_pose[:2], state.tcp_pose[2] - cover.grasp_height_m)
        # All else stands elsewhere, so it is put down where the hand is.
        return scene(**{"hand1": state.tcp_pose[:3], "hubcover": at, "plug-1": (0.6, 0.3, 0.013)})

    def feel():
        controller.set_tool_input(0, on=driver.state().gripper_closed)

    height = stands_m + cover.size[2] / 2 + cover.grasp_height_m
    controller.bench({"contact": surface((x, y), lambda _dx, _dy: height)})
    driver.start(PLACE, (PLACE,), held())
    outcome = run(driver, held, feel)
    if stands_m:
        assert outcome.status is Status.FAILED
        assert re.search(r"in the way: it stands (59|60)\.\d mm above", outcome.reason)
        assert driver.state().gripped
        assert driver.state().tcp_pose[2] > z - 0.2
    else:
        assert outcome.status is Status.SUCCEEDED, outcome.reason
        assert driver.state().tcp_pose[2] == pytest.approx(height, abs=1e-3)
    assert controller.bench({"query": "journal"})["journal"]["force_n"] < 60.0
