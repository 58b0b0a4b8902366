"""Pressing against a surface in numbers: no arm, no clock."""

from __future__ import annotations

import dataclasses
import math
import random
import re

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from runtime.drivers.force import Finish, Reading
from runtime.drivers.pressing import Pressing
from runtime.drivers.steps import Press

SEAT = (0.40, 0.10, 0.05)
STIFFNESS = 20_000.0
YIELDS = 0.004  # m/s per N
MOUTH, PLAY = 0.0036, 0.0008
WALL = 0.001  # what rises this far above the tool is not climbed


def press(**changes):
    step = Press(
        pose=(*SEAT, math.pi, 0.0, 0.0),
        joints=(0.0,) * 6,
        start=(0.0,) * 6,
        length_m=0.03,
        press_n=12.0,
        search_m=0.006,
        spiral_m=0.002,
        tolerance_m=0.001,
    )
    return dataclasses.replace(step, **changes)


def pocket(aside=(0.0, 0.0), *, depth=0.006, floor=0.0):
    """Give the height at which a part stands over a chamfered pocket."""

    def height(x, y):
        away = math.dist((x, y), (SEAT[0] + aside[0], SEAT[1] + aside[1]))
        if away <= PLAY:
            return SEAT[2] + floor
        return SEAT[2] + max(floor, min(depth, depth - (MOUTH - away)))

    return height


class Tool:
    """A tool that yields to forces, slides down slopes and cannot go through walls."""

    def __init__(self, height, *, dt=0.02, extra=(0.0, 0.0, 0.0)):
        self.height = height
        self.dt = dt
        self.extra = extra
        self.at = [SEAT[0], SEAT[1], SEAT[2] + 0.03]
        self.time_s = 0.0
        self.most_n = 0.0  # what it has been pressed with so far

    def reading(self):
        x, y, z = self.at
        press_n = max(0.0, STIFFNESS * (self.height(x, y) - z))
        self.most_n = max(self.most_n, press_n)
        wrench = (self.extra[0], self.extra[1], press_n + self.extra[2], 0.0, 0.0, 0.0)
        return Reading(self.time_s, (x, y, z, math.pi, 0.0, 0.0), 0.0, wrench)

    def step(self, push):
        """Yield for one period, in small steps, the surface's slope pushing back."""
        parts = max(1, round(self.dt / 0.002))
        for _ in range(parts):
            x, y, z = self.at
            press_n = max(0.0, STIFFNESS * (self.height(x, y) - z))
            force = list(push.wrench[:3])
            reach = 2e-4
            for axis, (dx, dy) in enumerate(((reach, 0.0), (0.0, reach))):
                slope = (self.height(x + dx, y + dy) - self.height(x - dx, y - dy)) / (2 * reach)
                force[axis] -= press_n * max(-1.0, min(1.0, slope))
            force[2] += press_n
            for axis in range(3):
                speed = max(-push.speeds[axis], min(push.speeds[axis], YIELDS * force[axis]))
                moved = list(self.at)
                moved[axis] += speed * self.dt / parts
                is_wall = axis < 2 and self.height(*moved[:2]) > moved[2] + WALL
                if push.compliant[axis] and not is_wall:
                    self.at = moved
        self.time_s += self.dt


def carry_out(motion, tool):
    for _ in range(20_000):
        told = motion.next(tool.reading())
        if isinstance(told, Finish):
            return told
        assert told.wrench[2] <= 0, "it only ever presses downward"
        assert math.hypot(*told.wrench[:2]) <= 5.0 + 1e-9
        tool.step(told)
    return pytest.fail("it never ended")


def test_a_part_in_line_with_its_seat_is_pressed_home(config):
    tool = Tool(pocket())
    finish = carry_out(Pressing(press(), config), tool)
    assert finish.reason == ""
    assert tool.at[2] < SEAT[2]
    assert tool.most_n >= 0.95 * 12.0
    assert tool.reading().press_n == pytest.approx(8.0, abs=0.5), "the hand opens without force"
    pressed_n = int(re.match(r"pressed with (\d+) N", finish.felt.words)[1])
    assert 0.95 * 12.0 <= pressed_n <= tool.most_n


@settings(max_examples=12)
@given(
    angle=st.floats(0, 2 * math.pi),
    away=st.floats(0.0, 0.0065),
    dt=st.sampled_from([0.008, 0.05, 0.16]),
)
def test_an_opening_within_the_search_is_found_whatever_the_cycle(config, angle, away, dt):
    aside = (away * math.cos(angle), away * math.sin(angle))
    tool = Tool(pocket(aside), dt=dt)
    finish = carry_out(Pressing(press(), config), tool)
    assert finish.reason == ""
    assert math.dist(tool.at[:2], (SEAT[0] + aside[0], SEAT[1] + aside[1])) < 0.0015
    assert tool.at[2] < SEAT[2]


def test_a_machine_that_sleeps_for_a_while_does_not_end_it(config):
    """What could not be done meanwhile is not held against it, whenever that is."""
    asleep, reasons = 0, set()
    while True:
        tool, motion = Tool(pocket(), dt=0.05), Pressing(press(), config)
        readings = 0
        while not isinstance(told := motion.next(tool.reading()), Finish):
            tool.step(told)
            readings += 1
            if readings == asleep:
                tool.time_s += 5.0
        reasons.add(told.reason)
        if asleep > readings:
            break
        asleep += 1
    assert asleep > 30
    assert reasons == {""}


@pytest.mark.parametrize("floor", [0.002, 0.004])
def test_a_part_that_sticks_on_its_way_is_jammed(config, floor):
    finish = carry_out(Pressing(press(), config), Tool(pocket(floor=floor)))
    above = floor * 1000 - 8 / 20
    assert finish.reason.startswith(f"jammed {above:.1f} mm above its seat at 8 N")


def test_a_part_that_drops_and_sticks_is_jammed_too(config):
    finish = carry_out(Pressing(press(), config), Tool(pocket((0.005, 0.0), floor=0.0025)))
    assert finish.reason.startswith("jammed 1.")


def test_without_an_opening_it_says_how_high_it_stands(config):
    finish = carry_out(Pressing(press(), config), Tool(pocket((0.05, 0.0))))
    assert finish.reason == "found no opening within 6 mm: it stands 5.6 mm above its seat at 8 N"


def test_where_there_is_nothing_it_does_not_go_on_down(config):
    tool = Tool(lambda _x, _y: 0.0)
    finish = carry_out(Pressing(press(), config), tool)
    assert "below its seat and met nothing" in finish.reason
    assert tool.at[2] > SEAT[2] - 0.006


@pytest.mark.parametrize("seed", range(6))
def test_a_sensor_that_is_off_by_half_is_read_more_than_once(config, seed):
    """What counts is the mean: no single reading has to be as great, none is enough."""
    rng = random.Random(seed)
    tool, motion = Tool(pocket()), Pressing(press(), config)
    noisy = 0
    while not isinstance(told := motion.next(reading := tool.reading()), Finish):
        tool.step(told)
        tool.extra = (0.0, 0.0, rng.uniform(-5.0, 5.0) if reading.press_n > 10 else 0.0)
        noisy += tool.extra[2] != 0
    assert told.reason == ""
    assert noisy > 10
    weak = Tool(pocket(), extra=(0.0, 0.0, -4.0))
    finish = carry_out(Pressing(press(), config), weak)
    assert finish.reason.startswith("could not be pressed home: 10 of 12 N reached")


def test_a_part_that_rests_on_its_seat_needs_no_opening(config):
    tool = Tool(lambda _x, _y: SEAT[2])
    finish = carry_out(Pressing(press(press_n=30.0), config), tool)
    assert finish.reason == ""
    assert tool.most_n >= 0.95 * 30.0


@pytest.mark.parametrize("floor", [0.0015, 0.002, 0.0024])
def test_a_part_that_gives_way_while_it_is_pressed_is_not_seated(config, floor):
    """Pressed with 34 N, all gives way by 1.7 mm: enough to look seated."""
    tool = Tool(pocket(floor=floor))
    finish = carry_out(Pressing(press(press_n=30.0), config), tool)
    above = floor * 1000 - 8 / 20
    assert tool.most_n >= 0.95 * 30.0
    assert finish.reason.startswith(
        f"jammed {above:.1f} mm above its seat at 8 N: it gave way to 3"
    )
    assert finish.reason.endswith(" N and came back")


def test_more_force_than_allowed_ends_it(config):
    finish = carry_out(Pressing(press(), config), Tool(pocket(), extra=(0.0, 65.0, 0.0)))
    assert finish.reason.startswith("it met 65 N, more than the 60 N allowed; it was ")


def test_a_single_knock_does_not(config):
    tool = Tool(pocket())
    motion = Pressing(press(), config)
    tool.extra = (80.0, 0.0, 0.0)
    assert not isinstance(motion.next(tool.reading()), Finish)
    tool.extra = (0.0, 0.0, 0.0)
    tool.time_s += 0.01
    assert carry_out(motion, tool).reason == ""


def test_a_tool_that_is_pushed_away_ends_it(config):
    tool = Tool(pocket())
    tool.at[0] += 0.02
    finish = carry_out(Pressing(press(), config), tool)
    assert finish.reason.startswith("the tool was pushed 20.0 mm aside")


def test_the_box_holds_for_force_as_well(config):
    x = config.workspace.x[1]
    step = press(pose=(x + 0.004, SEAT[1], SEAT[2], math.pi, 0.0, 0.0))
    tool = Tool(pocket())
    tool.at[0] = x + 0.0061
    finish = carry_out(Pressing(step, config), tool)
    assert "outside its box" in finish.reason


def test_it_gives_up_in_time(config):
    short = dataclasses.replace(
        config, force=dataclasses.replace(config.force, press_time_s=5.0, search_speed=0.001)
    )
    tool = Tool(pocket((0.05, 0.0)))
    finish = carry_out(Pressing(press(), short), tool)
    assert finish.reason.startswith("it took more than 5 s; it was 5.6 mm above its seat")
    assert tool.time_s < 5.2
    slow = Tool(pocket((0.05, 0.0)))
    carry_out(Pressing(press(), short, patience=2.0), slow)
    assert 9.9 < slow.time_s < 10.2, "a speed slider that is turned down is waited for"
