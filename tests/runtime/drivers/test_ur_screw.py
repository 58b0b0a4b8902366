"""Screwing with the real client, the stand-in, and the cell that knows what a thread does."""

from __future__ import annotations

import dataclasses

import pytest

from aapa import Anchor, AnchorStatus
from icarus_lite import Action, Status
from runtime.cell import Cell
from runtime.cell.cell import CellParameters
from runtime.cell.mishaps import Mishaps
from runtime.controller.process import ControllerProcess
from runtime.drivers import UrDriver
from runtime.parts import ScrewThread

pytestmark = pytest.mark.robot

TURNS = 2.4  # more than wrist 3 can in one go


@pytest.fixture(scope="module")
def short(parts):
    """The parts, the plug with fewer turns than the drawing has."""
    plug = parts["plug"]
    (seat,) = plug.seats
    thread = ScrewThread(0.0015, TURNS)
    return {
        **parts,
        "plug": dataclasses.replace(plug, seats=(dataclasses.replace(seat, thread=thread),)),
    }


class Workbench:
    """An arm, a stand-in and a cell, wired as a run wires them."""

    def __init__(self, driver, controller, cell, run):
        self.driver = driver
        self.cell = cell
        self._controller = controller
        self._run = run
        self._gripped = self._contact = None

    def anchors(self):
        """Anchor everything where it truly is."""
        places = {name: (part.model.type, part.position) for name, part in self.parts.items()}
        places["hand1"] = ("hand", self.driver.state().tcp_pose[:3])
        return {
            name: Anchor(name, type_, (0.0, 0.0, 1.0, 1.0), AnchorStatus.VISIBLE, None, 1.0, place)
            for name, (type_, place) in places.items()
        }

    @property
    def parts(self):
        return self.cell.truth.parts

    def feel(self):
        """Let the cell follow the arm, and the arm feel the cell."""
        arm = self.driver.state()
        gripped = self.cell.update(arm.joints, arm.gripper_closed, arm.force_n)
        if gripped != self._gripped:
            self._controller.set_tool_input(0, on=gripped)
            self._gripped = gripped
        contact = self.cell.contact()
        if contact is not self._contact:
            self._controller.bench({"contact": None if contact is None else contact.request()})
            self._contact = contact

    def carry_out(self, name, *args):
        self.feel()
        action = Action(name, ("hand1", *args))
        self.driver.start(action, (action,), self.anchors())
        return self._run(self.driver, self.anchors, self.feel, within_s=90.0)


@pytest.fixture(scope="module")
def controller(config):
    with ControllerProcess.start("ur5", clock=15.0, joints=config.look_joints) as process:
        yield process


@pytest.fixture
def workbench(controller, config, short, run):
    def _workbench(**mishaps):
        cell = Cell("ur5", 0, CellParameters(mishaps=Mishaps(**mishaps)), parts=short)
        return Workbench(driver, controller, cell, run)

    controller.bench({"contact": None, "outputs": {"tool_digital_out_0": False}})
    controller.set_tool_input(0, on=False)
    with UrDriver(controller.address, config, short) as driver:
        yield _workbench


def test_a_plug_is_screwed_in_with_a_second_grip_and_out_again(workbench):
    bench = workbench()
    assert bench.carry_out("grasp", "plug-1").status is Status.SUCCEEDED
    outcome = bench.carry_out("screw-in", "plug-1", "case-1")
    assert outcome.status is Status.SUCCEEDED, outcome.reason
    turned = float(outcome.reason.split()[0])
    assert turned == pytest.approx(TURNS, abs=0.2)
    assert bench.cell.truth.seated == {"plug-1": "case-1"}
    assert not bench.driver.state().gripped

    outcome = bench.carry_out("unscrew", "plug-1", "case-1")
    assert outcome.status is Status.SUCCEEDED, outcome.reason
    assert bench.cell.truth.seated == {}
    assert bench.cell.truth.held == "plug-1"
    assert bench.driver.state().gripped


def test_a_crossed_thread_is_backed_out_and_the_next_try_succeeds(workbench):
    bench = workbench(cross_thread_rate=1.0, cross_thread_turns=(0.8, 1.0))
    bench.carry_out("grasp", "plug-1")
    outcome = bench.carry_out("screw-in", "plug-1", "case-1")
    assert outcome.status is Status.FAILED
    assert "turns: its thread is crossed; it was backed out and is still held" in outcome.reason
    assert bench.cell.truth.held == "plug-1"
    assert bench.cell.truth.seated == {}
    outcome = bench.carry_out("screw-in", "plug-1", "case-1")
    assert outcome.status is Status.SUCCEEDED, outcome.reason
    assert bench.cell.truth.seated == {"plug-1": "case-1"}


def test_a_screw_broken_off_half_way_stays_in_its_thread_and_is_begun_anew(
    workbench, controller, await_that
):
    bench = workbench()
    assert bench.carry_out("grasp", "plug-1").status is Status.SUCCEEDED
    action = Action("screw-in", ("hand1", "plug-1", "case-1"))
    bench.driver.start(action, (action,), bench.anchors())

    def half_in():
        bench.feel()
        bench.driver.poll(bench.anchors())
        return bench.cell.snapshot()["world"]["parts"]["plug-1"]["turned_rad"] > 3.0

    await_that(half_in, 60.0)
    bench.driver.stop()
    await_that(bench.driver._at_rest)

    assert bench.carry_out("rest").status is Status.SUCCEEDED
    assert bench.cell.truth.held is None
    plug = bench.parts["plug-1"]
    assert plug.parent == "case-1"
    assert 2.5 < plug.turned_rad < TURNS * 6.3
    left_at = plug.turned_rad

    outcome = bench.carry_out("unscrew", "plug-1", "case-1")
    assert outcome.status is Status.SUCCEEDED, (outcome.reason, left_at)
    assert bench.cell.truth.held == "plug-1"
    outcome = bench.carry_out("screw-in", "plug-1", "case-1")
    assert outcome.status is Status.SUCCEEDED, outcome.reason
    assert bench.cell.truth.seated == {"plug-1": "case-1"}
    assert controller.bench({"query": "journal"})["journal"]["force_n"] < 150.0
