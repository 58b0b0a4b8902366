"""Force mode against contacts, on the arm: balance, walls, threads, and the limit on the force."""

from __future__ import annotations

import math

import numpy as np
import pytest

from runtime.controller.arm import HOME, Arm
from runtime.controller.contact import Contact, Surface, Thread
from runtime.controller.force_control import ForceMode
from runtime.controller.motions import JointMove, MotionError
from runtime.controller.tool_motions import LinearMove, ToolSpeed
from runtime.kinematics import UR5, UR16E, pose_to_matrix

STILL = (0.0,) * 6
DOWN = (False, False, True, False, False, False)
SCREWING = (False, False, True, False, False, True)
LIMITS = (0.1, 0.1, 0.05, 1.0, 1.0, 1.0)
NEVER = math.inf


class Rig:
    """An arm above a surface, both placed relative to where its tool is at first."""

    def __init__(self, model=UR5, joints=HOME):
        self.arm = Arm(model, joints)
        self.dt = 1 / model.frequency_hz
        self.x, self.y, self.z = self.arm.tcp_pose[:3]
        self.forces: list[float] = []

    def near(self, heights, stiffness=3e4, step=0.005, thread=None):
        """Put a surface under the tool: heights(dx, dy) above the tool's first height, m."""
        half = 20
        grid = tuple(
            tuple(
                self.z + heights((i - half) * step, (j - half) * step) for j in range(2 * half + 1)
            )
            for i in range(2 * half + 1)
        )
        corner = (self.x - half * step, self.y - half * step)
        self.arm.be_near(Contact(Surface(corner, step, grid, stiffness), thread))

    def yaw(self) -> float:
        turn = pose_to_matrix(self.arm.tcp_pose)
        return math.atan2(turn[1, 0], turn[0, 0])

    def run(self, seconds):
        for _ in range(round(seconds / self.dt)):
            self.arm.step(self.dt)
            self.forces.append(math.hypot(*self.arm.wrench[:3]))

    @property
    def below(self) -> float:
        """How far the tool has come down."""
        return self.z - self.arm.tcp_pose[2]


def press(force_n, compliant=DOWN, moment=0.0, **settings):
    return ForceMode(STILL, compliant, (0, 0, -force_n, 0, 0, moment), LIMITS, **settings)


@pytest.mark.parametrize(
    ("model", "stiffness"),
    [(UR5, 2e3), (UR5, 3e4), (UR5, 1e6), (UR16E, 3e4), (UR16E, 1e6)],
)
def test_it_comes_to_rest_where_the_forces_balance_at_any_stiffness(model, stiffness):
    rig = Rig(model)
    rig.near(lambda _x, _y: -0.01, stiffness)
    rig.arm.force_mode = press(20)
    rig.run(1.5)
    assert rig.arm.wrench == pytest.approx((0, 0, 20, 0, 0, 0), abs=0.1)
    assert rig.arm.tcp_speed == pytest.approx(STILL, abs=1e-5)
    assert rig.below == pytest.approx(0.01 + 20 / stiffness, rel=0.01)
    # No bounce worth the name, and none after the first.
    assert max(rig.forces) < 2.5 * 20
    first = next(i for i, force in enumerate(rig.forces) if force > 19)
    assert all(force > 5 for force in rig.forces[first:])
    assert rig.arm.tcp_pose[:2] == pytest.approx((rig.x, rig.y), abs=1e-6)


def test_a_low_speed_limit_does_not_limit_the_force():
    rig = Rig()
    rig.near(lambda _x, _y: -0.002)
    slow = (0.1, 0.1, 0.005, 1.0, 1.0, 1.0)
    rig.arm.force_mode = ForceMode(STILL, DOWN, (0, 0, -60, 0, 0, 0), slow)
    rig.run(0.2)
    assert rig.arm.tcp_speed[2] == pytest.approx(-0.005, abs=1e-4)
    rig.run(1.5)
    assert rig.arm.wrench[2] == pytest.approx(60, abs=0.1)


def test_with_nothing_under_it_it_goes_on_at_its_limit():
    rig = Rig()
    rig.arm.force_mode = press(20)
    rig.run(1.0)
    assert rig.arm.tcp_speed == pytest.approx((0, 0, -0.05, 0, 0, 0), abs=1e-4)
    assert rig.arm.wrench == STILL


def test_damping_makes_it_slow_and_no_damping_keeps_its_speed():
    slow = Rig()
    slow.arm.force_mode = press(20, damping=1.0)
    slow.run(0.5)
    assert slow.arm.tcp_speed[2] == pytest.approx(-0.002, abs=2e-4)
    free = Rig()
    free.arm.force_mode = press(5, damping=0.0)
    free.run(0.024)
    free.arm.force_mode = press(0, damping=0.0)
    free.run(0.008)
    going = free.arm.tcp_speed[2]
    assert going < -0.01
    free.run(0.5)
    assert free.arm.tcp_speed[2] == pytest.approx(going, rel=1e-3)


def test_a_greater_gain_gets_up_speed_sooner():
    speeds = []
    for gain in (0.5, 1.0, 2.0):
        rig = Rig()
        rig.arm.force_mode = press(2, gain=gain)
        rig.run(0.016)
        speeds.append(-rig.arm.tcp_speed[2])
    assert speeds[1] == pytest.approx(2 * speeds[0], rel=0.01)
    assert speeds[2] == pytest.approx(2 * speeds[1], rel=0.01)


def test_a_wired_force_counts_like_a_contact():
    rig = Rig()
    rig.arm.external_wrench = (0, 0, 20, 0, 0, 0)
    rig.arm.force_mode = press(20)
    rig.run(0.5)
    assert rig.arm.tcp_speed == STILL


def test_what_was_zeroed_is_not_felt():
    rig = Rig()
    rig.arm.external_wrench = (3, -2, 30, 0, 0, 1)
    rig.arm.zero_wrench()
    rig.near(lambda _x, _y: -0.002)
    rig.arm.force_mode = press(10)
    rig.run(1.0)
    assert rig.arm.wrench == pytest.approx((0, 0, 10, 0, 0, 0), abs=0.1)
    assert rig.arm.raw_wrench == pytest.approx((3, -2, 40, 0, 0, 1), abs=0.1)


def test_a_wall_stops_what_yields_and_pushes_sideways():
    rig = Rig()
    rig.near(lambda x, _y: 0.02 if x > 0.0149 else -0.02)
    rig.arm.force_mode = ForceMode(
        STILL, (True, False, False, False, False, False), (12, 0, 0, 0, 0, 0), LIMITS
    )
    rig.run(1.5)
    fx, _fy, _fz = rig.arm.wrench[:3]
    assert fx == pytest.approx(-12, abs=0.2)
    assert 0.009 < rig.arm.tcp_pose[0] - rig.x < 0.016
    assert max(map(abs, rig.arm.tcp_speed)) < 1e-4


def test_a_peg_slides_along_the_rim_and_falls_into_its_hole():
    rig = Rig()
    hole = (0.01, 0.0)
    rig.near(
        lambda x, y: -0.02 if math.hypot(x - hole[0], y - hole[1]) < 0.004 else -0.005, step=0.001
    )
    rig.arm.force_mode = press(10)
    rig.run(0.6)
    assert rig.below == pytest.approx(0.005 + 10 / 3e4, abs=1e-4)
    pose = rig.arm.tcp_pose
    rig.arm.command(LinearMove(rig.arm.tool, (pose[0] + 0.01, *pose[1:]), 0.5, 0.02), "search")
    rig.run(1.5)
    # The program's own axis was followed, the yielding one was left to the force.
    assert rig.arm.tcp_pose[0] - rig.x == pytest.approx(0.01, abs=1e-5)
    assert rig.below == pytest.approx(0.02 + 10 / 3e4, abs=1e-4)


def test_a_hole_no_wider_than_two_heights_holds_the_tool_at_its_bottom():
    rig = Rig()
    rig.near(lambda x, y: -0.02 if math.hypot(x, y) < 1e-4 else -0.005, step=0.001)
    every_way = (True, True, True, False, False, False)
    rig.arm.force_mode = press(12, every_way, damping=0.02)
    rig.run(2.0)
    assert rig.below == pytest.approx(0.02 + 12 / 3e4, abs=1e-4)
    assert rig.arm.wrench[2] == pytest.approx(12, abs=1.0)
    assert max(rig.forces) < 40
    assert math.dist(rig.arm.tcp_pose[:2], (rig.x, rig.y)) < 0.001


def test_after_force_mode_a_line_goes_on_from_where_the_tool_is():
    rig = Rig()
    rig.near(lambda _x, _y: -0.01)
    rig.arm.force_mode = press(10)
    rig.run(0.5)
    rig.arm.force_mode = None
    before = rig.arm.tcp_pose
    up = (*before[:2], before[2] + 0.02, *before[3:])
    move = LinearMove(rig.arm.tool, up, 0.5, 0.1)
    rig.arm.command(move, "retreat")
    heights = []
    while not move.done:
        rig.run(rig.dt)
        heights.append(rig.arm.tcp_pose[2])
    assert heights == sorted(heights)
    assert rig.arm.tcp_pose == pytest.approx(up, abs=1e-9)
    assert rig.arm.wrench == STILL


@pytest.mark.parametrize(("model", "jam"), [(UR5, None), (UR5, 0.8), (UR16E, 0.8)])
def test_a_screw_is_turned_in_by_a_limited_moment_until_it_is_tight(model, jam):
    rig = Rig(model)
    turns = 0.25
    thread = Thread((rig.x, rig.y), rig.z - 0.01, 0.0015, turns, 0.0, rig.yaw(), 0.3, jam)
    rig.near(lambda _x, _y: -0.03, thread=thread)
    rig.arm.force_mode = press(10, SCREWING, moment=-1.5)
    turned_at_first = rig.arm.joints[5]
    rig.run(0.7)
    assert rig.arm.wrench[5] == pytest.approx(0.3, abs=0.01)  # what friction takes
    rig.run(2.3)
    end = 2 * math.pi * turns if jam is None else jam
    assert rig.arm.wrench == pytest.approx((0, 0, 10, 0, 0, 1.5), abs=0.1)
    turned = abs(rig.arm.joints[5] - turned_at_first)
    assert end < turned < end + 1.5 / 8 + 0.01
    inside = min(turned, 2 * math.pi * turns)
    deep = 0.01 + 0.0015 * inside / (2 * math.pi)
    assert rig.below == pytest.approx(deep + 10 / 3e4, abs=2e-5)
    # And out again: it lifts the hand.
    rig.arm.force_mode = press(2, SCREWING, moment=1.5)
    rig.run(0.5)
    assert rig.arm.wrench[5] == pytest.approx(-0.3, abs=0.01)
    assert rig.arm.tcp_speed[2] > 1e-4


def test_less_than_its_friction_does_not_turn_a_screw():
    rig = Rig()
    thread = Thread((rig.x, rig.y), rig.z - 0.001, 0.0015, 1, 0.0, rig.yaw(), 0.5, None)
    rig.near(lambda _x, _y: -0.03, thread=thread)
    rig.arm.force_mode = press(10, SCREWING, moment=-0.4)
    rig.run(2.0)
    assert rig.arm.joints[5] == pytest.approx(HOME[5], abs=1e-3)
    assert rig.arm.wrench[5] == pytest.approx(0.4, abs=1e-6)


def test_above_its_thread_the_tool_turns_freely():
    rig = Rig()
    thread = Thread((rig.x, rig.y), rig.z - 0.02, 0.0015, 1, 0.0, rig.yaw(), 0.5, None)
    rig.near(lambda _x, _y: -0.05, thread=thread)
    rig.arm.command(JointMove((*HOME[:5], 1.0), 2.0, 1.0), "turning")
    rig.run(0.5)
    assert rig.arm.wrench == STILL


def test_a_thread_is_followed_through_half_a_turn_and_more_by_position_moves():
    rig = Rig()
    thread = Thread((rig.x, rig.y), rig.z + 0.002, 0.0015, 4, 0.0, rig.yaw(), 0.5, None)
    rig.near(lambda _x, _y: -0.05, stiffness=1e4, thread=thread)
    assert rig.arm.touch.wrench[2] == pytest.approx(20, abs=0.1)
    rig.arm.command(JointMove((*HOME[:5], 5.0), 2.0, 1.5), "turning")
    rig.run(1.0)
    assert rig.arm.wrench[5] == pytest.approx(0.5)
    rig.run(4.0)
    assert rig.arm.joints[5] == 5.0
    gone = 0.0015 * 5.0 / (2 * math.pi)
    assert rig.arm.wrench[2] == pytest.approx(1e4 * (0.002 - gone), abs=0.1)


def test_a_line_that_presses_too_hard_stops_and_may_back_out_but_not_go_on():
    rig = Rig()
    rig.near(lambda _x, _y: -0.01)
    pose = rig.arm.tcp_pose
    down = ToolSpeed(rig.arm.tool, (0, 0, -0.05, 0, 0, 0), 1.0, 1.0)
    rig.arm.command(down, "pressing")
    with pytest.raises(MotionError, match=r"the tool presses with \d+ N, more than 150 N"):
        rig.run(2.0)
    assert rig.forces[-1] > 100
    rig.arm.hold()
    rig.run(0.5)
    deep = rig.below
    assert deep < 0.01 + 300 / 3e4
    rig.arm.unhold()
    with pytest.raises(MotionError, match="the tool presses"):
        rig.run(2.0)
    rig.arm.hold()
    rig.run(0.5)
    rig.arm.release()
    rig.arm.unhold()
    move = LinearMove(rig.arm.tool, pose, 0.5, 0.1)
    rig.arm.command(move, "backing out")
    while not move.done:
        rig.run(rig.dt)
    assert rig.arm.wrench == STILL


def test_a_knock_of_a_cycle_or_two_does_not_stop_the_arm():
    rig = Rig(UR16E)
    rig.near(lambda _x, _y: -0.01)
    rig.run(0.1)
    rig.near(lambda _x, _y: 0.01)
    rig.run(3 * rig.dt)
    assert rig.forces[-1] > 250
    rig.near(lambda _x, _y: -0.01)
    rig.run(0.5)
    assert rig.arm.wrench == STILL


def test_type_1_turns_y_towards_the_frame_and_type_3_turns_x_along_the_way():
    towards = Rig()
    x, y, z = towards.x, towards.y, towards.z
    centre = (x + 0.2, y, z, 0.0, 0.0, 0.0)
    towards.arm.force_mode = ForceMode(
        centre, (False, True, False, False, False, False), (0, 5, 0, 0, 0, 0), LIMITS, 1
    )
    towards.run(0.3)
    assert towards.arm.tcp_speed[0] > 0.02
    assert abs(towards.arm.tcp_speed[1]) < 1e-3
    along = Rig()
    along.arm.command(ToolSpeed(along.arm.tool, (0, -0.05, 0, 0, 0, 0), 1.0, 1.0), "going")
    along.run(0.2)
    along.arm.force_mode = ForceMode(
        STILL, (True, False, False, False, False, False), (10, 0, 0, 0, 0, 0), LIMITS, 3
    )
    along.run(0.3)
    assert along.arm.tcp_speed == pytest.approx((0, -0.1, 0, 0, 0, 0), abs=2e-3)


def test_contact_is_counted_from_its_first_cycle():
    rig = Rig()
    rig.near(lambda _x, _y: -0.01)
    rig.arm.command(ToolSpeed(rig.arm.tool, (0, 0, -0.02, 0, 0, 0), 1.0, 1.0), "probing")
    while rig.arm.wrench[2] < 60:
        rig.run(rig.dt)
    assert rig.arm.touch.cycles > 5
    pressed = np.array(rig.arm.joints_before(rig.arm.touch.cycles))
    height = rig.arm.tool.pose(pressed)[2, 3]
    # Just before it touched: no more than a cycle's way above.
    assert 0 < height - (rig.z - 0.01) + 0.5 / 3e4 <= 0.02 * rig.dt + 1e-6


def test_the_same_cycles_give_the_same_forces_whatever_the_wall_clock():
    def forces():
        rig = Rig()
        rig.near(lambda x, y: -0.01 + 0.1 * x - 0.05 * y)
        rig.arm.force_mode = press(15, (True, True, True, False, False, False))
        rig.run(0.5)
        return rig.forces

    assert forces() == forces()


@pytest.mark.parametrize("model", [UR5, UR16E])
def test_it_presses_as_hard_as_asked_however_slowly_it_may_move(model):
    rig = Rig(model)
    rig.near(lambda _x, _y: -0.002)
    slow = (0.005, 0.005, 0.01, 0.1, 0.1, 0.1)
    rig.arm.force_mode = ForceMode(STILL, DOWN, (0, 0, -60, 0, 0, 0), slow)
    rig.run(1.5)
    assert rig.arm.wrench[2] == pytest.approx(60, abs=0.3)
    assert max(rig.forces) < 1.2 * 60


@pytest.mark.parametrize("model", [UR5, UR16E])
@pytest.mark.parametrize("off_m", [0.0, 0.0001, 0.0002, 0.0003, 0.0004])
def test_a_narrow_pocket_holds_the_tool_at_its_floor(model, off_m):
    """Walls 1 mm apart, 60 mm high, on a grid of 0.5 mm: slopes everywhere but in the middle."""
    rig = Rig(model)

    def pocket(x: float, y: float) -> float:
        return -0.01 if math.hypot(x - off_m, y) < 0.0006 else 0.05

    rig.near(pocket, stiffness=2e4, step=0.0005)
    rig.arm.force_mode = press(15, (True, True, True, False, False, False))
    rig.run(2.0)
    assert rig.below == pytest.approx(0.01 + 15 / 2e4, abs=0.0008)
    assert rig.arm.wrench[2] == pytest.approx(15, abs=0.1), "walls and floor push together"


def test_a_wall_does_not_carry_what_leans_on_it():
    rig = Rig()
    rig.near(lambda x, _y: 0.05 if x > 0.002 else -0.02, stiffness=2e4, step=0.0005)
    sideways, slow = (True, False, True, False, False, False), (0.02, 0.02, 0.02, 1.0, 1.0, 1.0)
    rig.arm.force_mode = ForceMode(STILL, sideways, (5, 0, -15, 0, 0, 0), slow)
    rig.run(2.5)
    assert rig.below == pytest.approx(0.02 + 15 / 2e4, abs=0.0005)
    assert rig.arm.wrench[0] == pytest.approx(-5, abs=1)
