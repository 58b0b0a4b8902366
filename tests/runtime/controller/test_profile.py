from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from runtime.controller.profile import Trapezoid

_SIZES = st.floats(1e-3, 10.0)


@given(_SIZES, _SIZES, _SIZES, st.floats(0, 1))
def test_limits_hold_and_the_whole_way_is_covered(length, speed, acceleration, share):
    way = Trapezoid.limited(length, speed, acceleration)
    at = share * way.duration_s
    step = 1e-4 * way.duration_s
    assert way.position(0.0) == 0.0
    assert way.position(way.duration_s) == length
    assert 0.0 <= way.speed(at) <= speed * (1 + 1e-12)
    assert abs(way.speed(at + step) - way.speed(at)) <= acceleration * step * (1 + 1e-6) + 1e-12
    assert 0.0 <= way.position(at) <= length * (1 + 1e-12)


@given(_SIZES, _SIZES, _SIZES, st.floats(0.01, 0.99))
def test_speed_is_the_slope_of_the_position(length, speed, acceleration, share):
    way = Trapezoid.limited(length, speed, acceleration)
    at, step = share * way.duration_s, 1e-5 * way.duration_s
    slope = (way.position(at + step) - way.position(at - step)) / (2 * step)
    assert slope == pytest.approx(way.speed(at), abs=2e-4 * way.peak)


def test_a_long_way_cruises_at_the_limit():
    way = Trapezoid.limited(2.0, 0.5, 1.0)
    assert way.duration_s == pytest.approx(2.0 / 0.5 + 0.5)
    assert way.speed(way.duration_s / 2) == 0.5


@given(_SIZES, _SIZES)
def test_a_timed_way_takes_its_time(length, duration):
    way = Trapezoid.timed(length, duration)
    assert way.duration_s == pytest.approx(duration)
    assert way.position(way.duration_s * 0.999999) == pytest.approx(length, rel=1e-5)


def test_no_way_takes_no_time():
    way = Trapezoid.limited(0.0, 1.0, 1.0)
    assert (way.duration_s, way.position(0.0), way.speed(0.0)) == (0.0, 0.0, 0.0)
