"""What stops the arm, and how it is made fit to be driven again, at the operator's word."""

from __future__ import annotations

import socket

import pytest

from icarus_lite import Action, Status
from runtime.controller.process import ControllerProcess
from runtime.drivers import DryRunDriver, Recoverable, UrDriver
from runtime.drivers.limits import joint_distance
from runtime.errors import ControllerError, DriverError

pytestmark = pytest.mark.robot

GRASP = Action("grasp", ("hand1", "hubcover"))


@pytest.fixture(scope="module")
def controller(config):
    with ControllerProcess.start("ur5", clock=4.0, joints=config.look_joints) as process:
        yield process


@pytest.fixture
def moving(controller, config, parts, scene, run, await_that):
    """A driver whose arm is on its way to the hub cover."""
    controller.bench({"contact": None})
    with UrDriver(controller.address, config, parts) as driver:
        driver.park()
        assert run(driver, scene).status is Status.SUCCEEDED
        first = driver.state().joints
        driver.start(GRASP, (GRASP,), scene())

        def has_left():
            assert driver.poll(scene()).status is Status.RUNNING
            return joint_distance(first, driver.state().joints) > 0.05

        await_that(has_left)
        yield driver


def dashboard(controller, *commands):
    """Do what a person does on the teach pendant."""
    with socket.create_connection((controller.address, 29999), timeout=5) as pendant:
        lines = pendant.makefile("rw")
        lines.readline()
        for command in commands:
            lines.write(command + "\n")
            lines.flush()
            lines.readline()


def test_a_protective_stop_is_unlocked_only_at_the_operator_s_word(
    moving, controller, scene, run, await_that, stands_still
):
    controller.bench({"fault": {"protective_stop": True}})
    outcome = run(moving, scene)
    assert outcome.status is Status.FAILED
    assert "a protective stop" in outcome.reason
    assert "nothing is recovered without your word" in outcome.reason
    await_that(lambda: stands_still(controller))
    where = controller.bench({"query": "state"})["joints"]
    assert controller.bench({"query": "state"})["safety"] == "PROTECTIVE_STOP"
    with pytest.raises(DriverError, match="protective stop"):
        moving.state()

    done = moving.recover()

    assert done == "the protective stop was unlocked; the arm can be driven again"
    assert controller.bench({"query": "state"})["safety"] == "NORMAL"
    assert controller.bench({"query": "state"})["joints"] == where, "the old move does not go on"
    assert moving.poll(scene()) is None
    moving.park()
    assert run(moving, scene).status is Status.SUCCEEDED


def test_an_emergency_stop_is_for_a_person_to_clear(moving, controller, scene, run, await_that):
    controller.bench({"fault": {"emergency_stop": True}})
    assert "an emergency stop" in run(moving, scene).reason
    with pytest.raises(ControllerError, match="release the button, power the arm on"):
        moving.recover()
    controller.bench({"fault": {"emergency_stop": False}})
    with pytest.raises(ControllerError, match="power it on and release its brakes"):
        moving.recover()
    with pytest.raises(DriverError):
        moving.state()
    dashboard(controller, "power on", "brake release")
    await_that(lambda: controller.bench({"query": "state"})["robot_mode"] == "RUNNING")
    assert moving.recover() == "the arm can be driven again"
    moving.park()
    assert run(moving, scene).status is Status.SUCCEEDED


@pytest.mark.parametrize("fault", ["drop_rtde", "kill_script"])
def test_a_lost_link_is_opened_anew(
    moving, controller, scene, run, await_that, stands_still, fault
):
    controller.bench({"fault": {fault: True}})
    assert run(moving, scene).status is Status.FAILED
    await_that(lambda: stands_still(controller))
    where = controller.bench({"query": "state"})["joints"]
    assert moving.recover() == "the arm can be driven again"
    assert controller.bench({"query": "state"})["joints"] == where
    moving.park()
    assert run(moving, scene).status is Status.SUCCEEDED


def test_a_driver_that_was_closed_stays_closed(controller, config, parts):
    driver = UrDriver(controller.address, config, parts)
    driver.close()
    with pytest.raises(DriverError, match="the driver was closed"):
        driver.recover()
    with pytest.raises(DriverError, match="the driver was closed"):
        driver.state()


def test_only_an_arm_that_can_stop_can_be_recovered(config, parts):
    assert isinstance(UrDriver, Recoverable)
    assert not isinstance(DryRunDriver(config, parts), Recoverable)
