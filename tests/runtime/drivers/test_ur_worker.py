"""The worker's reactions, one by one, with an arm that misbehaves on purpose."""

from __future__ import annotations

import dataclasses
import itertools
import re

import pytest

from runtime.drivers import ArmState, Grip, MoveJoints
from runtime.drivers.limits import tcp_matrix
from runtime.drivers.steps import MoveLinear, Press, Tare
from runtime.drivers.ur_link import Begin, Close, Ended, Ready, StateBoard, Stop
from runtime.drivers.ur_worker import _Worker
from runtime.errors import DriverError
from runtime.kinematics import matrix_to_pose


class Arm:
    """An arm whose clock runs with each look at it, and which does as it is told to."""

    version = "3.15.0"

    def __init__(self, config, **behaviour):
        self.config = config
        self.at = config.look_joints
        self.clock = 0.0
        self.number = 7
        self.running = False
        self.target = None
        self.closed = False
        self.slider = behaviour.get("slider", 1.0)
        self.begins = behaviour.get("begins", True)
        self.takes_s = behaviour.get("takes_s", 1.0)
        self.ends_off = behaviour.get("ends_off", 0.0)
        self.switches = behaviour.get("switches", True)
        self.feels = behaviour.get("feels", True)
        self.lost_at = behaviour.get("lost_at", float("inf"))
        self.until = 0.0
        self.done = []
        self.bias = behaviour.get("bias", (0.0,) * 6)
        self.felt_n = 0.0
        self.pushes = 0

    def state(self):
        self.clock += 0.05
        if self.running and self.clock >= self.until:
            self.running = False
            self.at = (self.target[0] + self.ends_off, *self.target[1:])
        gripped = self.closed and self.feels
        return ArmState(self.joints(), self.tcp_pose(), self.closed, gripped, self.clock)

    def joints(self):
        return self.at

    def tcp_pose(self):
        return matrix_to_pose(tcp_matrix(self.config, self.at))

    def timestamp_s(self):
        return self.clock

    def stands_still(self):
        return not self.running

    def trouble(self):
        return "the cable was cut" if self.clock >= self.lost_at else ""

    def speed_fraction(self):
        return self.slider

    def kick(self):
        pass

    def move(self, step):
        self.done.append("move")
        before = self.number
        if self.begins:
            self.number += 1
            self.running = True
            self.target = step.joints
            self.until = self.clock + self.takes_s
        return before

    def operation(self):
        return self.number, self.running

    def stop(self):
        self.done.append("stop")
        self.running = False

    def set_gripper(self, *, close):
        self.done.append("close" if close else "open")
        if self.switches:
            self.closed = close

    def set_payload(self, mass_kg, _centre_of_gravity_m):
        self.done.append(mass_kg)

    def wrench(self):
        return (*self.bias[:2], self.bias[2] + self.felt_n, *self.bias[3:])

    def zero_force(self):
        self.done.append("zero")

    def push(self, _push, _frame):
        self.pushes += 1
        if self.done[-1:] != ["push"]:
            self.done.append("push")

    def end_push(self):
        self.done.append("end push")

    def end_program(self):
        self.done.append("end program")


@pytest.fixture
def move(config):
    end = (config.look_joints[0] - 0.3, *config.look_joints[1:])
    return MoveJoints(end, config.look_joints)


class Orders:
    """The pipe, as the worker sees it; the driver closes it after the first step's report."""

    def __init__(self, *orders):
        self.waiting = list(orders)
        self.reports = []
        self.gone = False

    def poll(self, _timeout):
        return self.gone or bool(self.waiting)

    def recv(self):
        if self.gone:
            raise EOFError
        return self.waiting.pop(0)

    def send(self, report):
        self.reports.append(report)
        if isinstance(report, Ended):
            self.waiting.append(Close())


def serve(config, arm, orders):
    """Let a worker carry orders out; give its reports."""
    _Worker(arm, orders, StateBoard(), config).run()
    return orders.reports


def carry_out(config, arm, step):
    """Let a worker carry one step out; give the reason if it failed."""
    ready, ended = serve(config, arm, Orders(Begin(5, step)))
    assert ready == Ready("3.15.0")
    assert ended.number == 5
    assert arm.done.pop() == "end program"
    return ended.reason


def test_a_move_that_arrives_succeeds(config, move):
    arm = Arm(config)
    assert carry_out(config, arm, move) == ""
    assert arm.done == ["move"]


def test_a_move_to_where_the_arm_is_is_none(config, move):
    arm = Arm(config)
    there = dataclasses.replace(move, joints=move.start)
    assert carry_out(config, arm, there) == ""
    assert arm.done == []


def test_a_move_said_to_be_done_that_was_not_made_has_failed(config, move):
    arm = Arm(config, ends_off=0.1)
    assert carry_out(config, arm, move) == "the arm ended 0.100 rad from its target"


def test_a_straight_move_is_judged_by_the_tool(config, move):
    pose = matrix_to_pose(tcp_matrix(config, move.joints))
    linear = MoveLinear(pose, move.joints, move.start, 0.1)
    assert carry_out(config, Arm(config), linear) == ""
    reason = carry_out(config, Arm(config, ends_off=0.01), linear)
    assert reason.startswith("the tool ended 0.00")


def test_a_move_is_not_made_from_anywhere_else_than_planned(config, move):
    arm = Arm(config)
    arm.at = (move.start[0] + 0.02, *move.start[1:])
    reason = carry_out(config, arm, move)
    assert reason == (
        "the arm stands 0.020 rad from where the motion was planned to start (at most 0.01)"
    )
    assert arm.done == []


def test_a_move_that_does_not_begin_is_given_up(config, move, monkeypatch):
    monkeypatch.setattr("runtime.drivers.ur_worker._BEGIN_WITHIN_S", 0.05)
    arm = Arm(config, begins=False)
    assert "was not begun by the controller in time" in carry_out(config, arm, move)
    assert arm.done == ["move", "stop"]


def test_a_move_that_does_not_end_is_stopped(config, move, monkeypatch):
    monkeypatch.setattr("runtime.drivers.ur_worker._NEWS_WITHIN_S", 0.0)
    arm = Arm(config, takes_s=100.0)
    assert "was not finished in time" in carry_out(config, arm, move)
    assert arm.done == ["move", "stop"]
    assert arm.clock < 3.0


def test_a_clock_that_is_told_of_before_the_end_of_the_move_fails_nothing(config, move):
    # The client has a stream for each, and on a fast clock one is soon a second behind.
    arm = Arm(config, takes_s=1.0)
    operation = arm.operation

    def behind():
        if arm.running and arm.clock > 0.8:
            arm.clock = max(arm.clock, 5.0)
            arm.until = 5.5
        return operation()

    arm.operation = behind
    assert carry_out(config, arm, move) == ""
    assert arm.done == ["move"]


def test_a_move_that_begins_late_has_its_whole_time(config, move):
    # On a fast clock much robot time passes while an order is on its way.
    arm = Arm(config, takes_s=1.0)
    begun = arm.move

    def late(step):
        before = begun(step)
        arm.clock += 100.0
        arm.until = arm.clock + 1.0
        return before

    arm.move = late
    assert carry_out(config, arm, move) == ""


def test_a_turned_down_speed_slider_is_waited_for(config, move):
    arm = Arm(config, takes_s=10.0, slider=0.1)
    assert carry_out(config, arm, move) == ""


def test_the_loss_of_the_arm_ends_the_worker(config, move):
    arm = Arm(config, lost_at=0.5)
    with pytest.raises(DriverError, match="the cable was cut"):
        carry_out(config, arm, move)


def test_a_stop_that_comes_with_the_order_lets_nothing_move(config, move):
    arm = Arm(config)
    orders = Orders(Begin(1, move), Stop(), Close())
    assert serve(config, arm, orders) == [Ready("3.15.0")]
    assert arm.done == ["end program"]


def test_a_stop_in_the_middle_of_a_move_stops_the_arm(config, move):
    arm, orders = Arm(config, takes_s=100.0), Orders(Begin(1, move))
    begun = arm.move

    def move_and_stop(step):
        orders.waiting += [Stop(), Close()]
        return begun(step)

    arm.move = move_and_stop
    assert serve(config, arm, orders) == [Ready("3.15.0")]
    assert arm.done == ["move", "stop", "end program"]


def test_without_a_driver_the_arm_is_stopped_and_the_program_ended(config, move):
    arm, orders = Arm(config, takes_s=100.0), Orders(Begin(1, move))
    begun = arm.move

    def move_and_lose_the_driver(step):
        orders.gone = True
        return begun(step)

    arm.move = move_and_lose_the_driver
    serve(config, arm, orders)
    assert arm.done == ["move", "stop", "end program"]


def test_a_grip_switches_feels_and_tells_the_payload(config):
    arm = Arm(config)
    assert carry_out(config, arm, Grip(close=True, expect_gripped=True, payload_kg=1.2)) == ""
    assert arm.done == ["close", 1.2]
    assert arm.clock >= config.gripper.close_time_s


def test_an_output_that_does_not_switch_is_named(config, monkeypatch):
    monkeypatch.setattr("runtime.drivers.ur_worker._OUTPUT_WITHIN_S", 0.05)
    arm = Arm(config, switches=False)
    reason = carry_out(config, arm, Grip(close=True, expect_gripped=True, payload_kg=1.2))
    assert "output does not switch" in reason


@pytest.mark.parametrize(
    ("close", "feels", "reason"),
    [
        (True, False, "the gripper closed but feels no part"),
        (False, True, "the gripper opened but still feels a part"),
    ],
)
def test_a_grip_that_does_not_feel_as_expected_has_failed(config, close, feels, reason):
    quick = dataclasses.replace(
        config, gripper=dataclasses.replace(config.gripper, sense_time_s=0.05)
    )
    arm = Arm(quick, feels=feels)
    arm.switches = close
    arm.closed = not close
    if not close:
        # The output goes off, yet the sensor stays on.
        arm.state = lambda kept=arm.state: dataclasses.replace(
            kept(), gripper_closed=False, gripped=True
        )
    assert carry_out(quick, arm, Grip(close, close, 1.0)) == reason
    assert arm.done == ["close" if close else "open"]


@pytest.fixture
def press(config):
    pose = matrix_to_pose(tcp_matrix(config, config.look_joints))
    return Press(
        (*pose[:2], pose[2] - 0.03, *pose[3:]),
        config.look_joints,
        config.look_joints,
        length_m=0.03,
        press_n=12.0,
        search_m=0.006,
        spiral_m=0.002,
        tolerance_m=0.001,
    )


def test_the_force_sensor_is_zeroed_and_what_is_left_is_taken_off(config):
    arm = Arm(config, bias=(3.0, -2.0, 9.0, 0.1, 0.0, 0.2))
    worker = _Worker(arm, Orders(Begin(5, Tare())), StateBoard(), config)
    worker.run()
    assert arm.done == ["zero", "end program"]
    arm.felt_n = 12.0
    assert worker._sensor.read().wrench == pytest.approx((0.0, 0.0, 12.0, 0.0, 0.0, 0.0))


@pytest.mark.parametrize(
    ("bias", "shaken", "reason"),
    [
        ((0.0, 0.0, 40.0, 0.0, 0.0, 0.0), 0.0, "shows 40 N with nothing touched"),
        ((0.0,) * 6, 8.0, r"swings by \d+ N while the arm stands still"),
    ],
)
def test_a_force_sensor_that_cannot_be_zeroed_is_not_worked_with(config, bias, shaken, reason):
    arm = Arm(config, bias=bias)
    measured, signs = arm.wrench, itertools.cycle((1, -1))

    def wrench():
        x, y, z, *moments = measured()
        return (x + next(signs) * shaken, y, z, *moments)

    arm.wrench = wrench
    assert re.search(reason, carry_out(config, arm, Tare()))


def test_a_press_is_not_begun_from_anywhere_else_than_planned(config, press):
    arm = Arm(config)
    arm.at = (press.start[0] + 0.02, *press.start[1:])
    assert "from where the motion was planned to start" in carry_out(config, arm, press)
    assert arm.pushes == 0


def test_a_press_that_fails_ends_force_mode(config, press):
    arm = Arm(config)
    arm.felt_n = 90.0
    assert carry_out(config, arm, press).startswith("it met 90 N, more than the 60 N allowed")
    assert arm.done == ["push", "end push"]


def test_a_stop_in_the_middle_of_a_press_ends_force_mode(config, press):
    arm, orders = Arm(config), Orders(Begin(1, press))
    pushed = arm.push

    def push_and_stop(push, frame):
        if arm.pushes == 3:
            orders.waiting += [Stop(), Close()]
        pushed(push, frame)

    arm.push = push_and_stop
    assert serve(config, arm, orders) == [Ready("3.15.0")]
    assert arm.done == ["push", "end push", "end program"]


def test_without_a_driver_force_mode_is_ended(config, press):
    arm, orders = Arm(config), Orders(Begin(1, press))
    pushed = arm.push

    def push_and_lose_the_driver(push, frame):
        orders.gone = True
        pushed(push, frame)

    arm.push = push_and_lose_the_driver
    serve(config, arm, orders)
    assert arm.done == ["push", "end push", "end program"]


def test_an_arm_lost_in_the_middle_of_a_press_is_not_talked_to_any_more(config, press):
    arm = Arm(config, lost_at=0.5)
    with pytest.raises(DriverError, match="the cable was cut"):
        carry_out(config, arm, press)
    assert arm.done == ["push"]


def test_a_guarded_way_down_ends_where_it_meets_something(config, move):
    pose = matrix_to_pose(tcp_matrix(config, move.joints))
    down = MoveLinear(pose, move.joints, move.start, 0.1, guarded=True)
    arm = Arm(config, takes_s=0.5)
    arm.felt_n = 80.0
    reason = carry_out(config, arm, down)
    assert reason == "on its way down the tool met 80 N, more than the 60 N allowed"
    assert arm.done == ["move", "stop"]
    heedless = Arm(config, takes_s=0.5)
    heedless.felt_n = 80.0
    assert carry_out(config, heedless, dataclasses.replace(down, guarded=False)) == ""
