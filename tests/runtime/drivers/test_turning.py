"""Turning a thread in numbers: no arm, no clock."""

from __future__ import annotations

import dataclasses
import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from runtime.drivers.force import Finish, Reading
from runtime.drivers.steps import Turn
from runtime.drivers.turning import Turning

PITCH = 0.0015
AT = (0.40, 0.10)
SPIN = 2.0  # rad/s per Nm


def turn(**changes):
    step = Turn(
        clockwise=True,
        angle_rad=10.0,
        most_rad=12.0,
        wrist_until_rad=5.8,
        press_n=8.0,
        torque_nm=1.5,
        pitch_m=PITCH,
        then=(),
    )
    return dataclasses.replace(step, **changes)


class Screw:
    """A tool in a thread that ends somewhere, stiffly."""

    def __init__(self, *, wrist=0.0, end=math.inf, friction=0.25, dt=0.02, pitch=PITCH):
        self.wrist = self.first = wrist
        self.end = end
        self.friction = friction
        self.dt = dt
        self.pitch = pitch
        self.time_s = 0.0
        self.moment = 0.0

    def reading(self):
        z = 0.05 - self.pitch * (self.wrist - self.first) / (2 * math.pi)
        return Reading(
            self.time_s,
            (*AT, z, math.pi, 0.0, 0.0),
            self.wrist,
            (0.0, 0.0, 8.0, 0.0, 0.0, self.moment),
        )

    def step(self, push):
        asked = -push.wrench[5]  # wrist 3 turns the other way about the vertical
        over = max(0.0, abs(self.wrist - self.first) - self.end)
        resists = self.friction + 8.0 * over
        torque = math.copysign(max(0.0, abs(asked) - resists), asked)
        self.moment = math.copysign(min(abs(asked), resists), asked)
        speed = max(-push.speeds[5], min(push.speeds[5], SPIN * torque))
        self.wrist += speed * self.dt
        self.time_s += self.dt


def carry_out(motion, screw):
    for _ in range(20_000):
        told = motion.next(screw.reading())
        if isinstance(told, Finish):
            return told
        assert told.compliant == (True, True, True, False, False, True)
        assert told.wrench[2] == -8.0
        screw.step(told)
    return pytest.fail("it never ended")


@settings(max_examples=12)
@given(end=st.floats(0.5, 5.0), dt=st.sampled_from([0.008, 0.05, 0.16]))
def test_it_stops_where_the_torque_stops_it(config, end, dt):
    screw = Screw(end=end, dt=dt)
    finish = carry_out(Turning(turn(), config), screw)
    assert finish.reason == ""
    assert finish.felt.stalled
    assert finish.felt.turned_rad == pytest.approx(end, abs=0.25)
    assert abs(screw.moment) <= 1.5


@settings(max_examples=12)
@given(
    wrist=st.floats(-5.0, 5.0),
    clockwise=st.booleans(),
    dt=st.sampled_from([0.008, 0.05, 0.16, 0.4]),
)
def test_it_ends_before_the_wrist_s_limit_whatever_the_cycle(config, wrist, clockwise, dt):
    until = 5.8 if clockwise else -5.8
    screw = Screw(wrist=wrist, dt=dt)
    step = turn(clockwise=clockwise, angle_rad=30.0, most_rad=30.0, wrist_until_rad=until)
    finish = carry_out(Turning(step, config), screw)
    assert finish.reason == ""
    assert not finish.felt.stalled
    assert abs(screw.wrist) <= 5.8 + 1e-9
    assert screw.wrist == pytest.approx(until, abs=0.05)
    assert finish.felt.turned_rad == pytest.approx(screw.wrist - wrist)


def test_it_turns_no_farther_than_asked(config):
    screw = Screw()
    finish = carry_out(
        Turning(turn(clockwise=False, most_rad=2.0, wrist_until_rad=-5.8), config), screw
    )
    assert finish.felt.turned_rad == pytest.approx(-2.0, abs=0.05)
    assert not finish.felt.stalled
    risen_m = screw.pitch * -finish.felt.turned_rad / (2 * math.pi)
    assert finish.felt.sunk_m == pytest.approx(-risen_m, abs=0.0005)


def test_what_does_not_follow_its_thread_has_failed(config):
    finish = carry_out(Turning(turn(), config), Screw(pitch=0.012))
    assert finish.reason.startswith("it came 5.")
    assert "mm down beside its thread after 0." in finish.reason


def test_too_much_force_ends_it(config):
    screw = Screw()
    motion = Turning(turn(), config)
    for _ in range(2):
        told = motion.next(
            dataclasses.replace(screw.reading(), wrench=(0.0, 70.0, 0.0, 0.0, 0.0, 0.0))
        )
        screw.step(told) if not isinstance(told, Finish) else None
    assert isinstance(told, Finish)
    assert told.reason.startswith("it met 70 N, more than the 60 N allowed after 0.00 turns")


def test_it_gives_up_in_time(config):
    short = dataclasses.replace(
        config, force=dataclasses.replace(config.force, turn_time_s=5.0, turning_speed=0.1)
    )
    finish = carry_out(Turning(turn(), short), Screw())
    assert finish.reason.startswith("it took more than 5 s after 0.0")
