"""What the tool may touch: a surface of heights, and a thread on it.

Everything here is geometry in the base frame for a tool that points straight down; what the arm
feels of it from cycle to cycle is in `touch`. Positions in m, angles in rad, forces in N.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

MOST_FORCE_N: Final = 500.0
"""No contact presses harder than this: by then a real arm has stopped long ago."""

ON_THE_AXIS_M: Final = 0.003
"""A thread is met where the tool centre point is no further than this from its axis."""

_CLOSE_BY_M: Final = 0.00075
_MOST_CELLS: Final = 250_000
_FARTHEST: Final = 100.0
_STIFFEST: Final = 1e7


class ContactError(ValueError):
    """A description of a contact is not one; the text says which value and what it should be."""


@dataclass(frozen=True, slots=True)
class Patch:
    """The surface under one point: its height and how that changes with x and y, m/m."""

    height: float
    slope_x: float
    slope_y: float


@dataclass(frozen=True, slots=True)
class Surface:
    """Heights at which the tool centre point touches, on a grid; bilinear in between.

    Args:
        origin: x and y of the first height, m.
        step_m: Distance between neighbours, m, > 0.
        heights: heights[i][j] is where the tool touches at x = origin[0] + i * step_m,
            y = origin[1] + j * step_m; at least 2 by 2, m.
        stiffness_n_m: Force for each metre below, > 0.
    """

    origin: tuple[float, float]
    step_m: float
    heights: tuple[tuple[float, ...], ...]
    stiffness_n_m: float

    def under(self, x: float, y: float) -> Patch | None:
        """Give the surface at a place; None outside of the grid."""
        along, across = (x - self.origin[0]) / self.step_m, (y - self.origin[1]) / self.step_m
        last_i, last_j = len(self.heights) - 1, len(self.heights[0]) - 1
        if not (0 <= along <= last_i and 0 <= across <= last_j):
            return None
        i, j = min(int(along), last_i - 1), min(int(across), last_j - 1)
        u, v = along - i, across - j
        (a, b), (c, d) = self.heights[i][j : j + 2], self.heights[i + 1][j : j + 2]
        near, far = a + (b - a) * v, c + (d - c) * v
        return Patch(
            near + (far - near) * u,
            (far - near) / self.step_m,
            ((b - a) * (1 - u) + (d - c) * u) / self.step_m,
        )

    def floor(self, x: float, y: float) -> float | None:
        """Give the lowest height close by: what holds a tool that has come down between walls.

        Between walls that are hardly farther apart than two heights, every place lies on a slope,
        and slopes alone would let the tool slide through.
        """
        reach = _CLOSE_BY_M / self.step_m
        along, across = (x - self.origin[0]) / self.step_m, (y - self.origin[1]) / self.step_m
        rows = self.heights[max(0, math.ceil(along - reach)) : math.floor(along + reach) + 1]
        low, high = max(0, math.ceil(across - reach)), math.floor(across + reach) + 1
        return min((height for row in rows for height in row[low:high]), default=None)


@dataclass(frozen=True, slots=True)
class Thread:
    """A right-handed thread about a vertical axis: clockwise, seen from above, goes in.

    Args:
        axis: Its x and y, m.
        top_z: Height of the tool centre point at which the thread begins, m.
        pitch_m: How far a whole turn goes in, m.
        turns: How many turns until it is tight.
        turned_rad: How far it had been turned in when the tool's yaw was `at_yaw_rad`.
        at_yaw_rad: That yaw.
        friction_nm: The moment that turning takes.
        jam_at_rad: Where it sticks before it is tight, or None.
    """

    axis: tuple[float, float]
    top_z: float
    pitch_m: float
    turns: float
    turned_rad: float
    at_yaw_rad: float
    friction_nm: float
    jam_at_rad: float | None

    @property
    def end_rad(self) -> float:
        """How far it can be turned in."""
        tight = 2 * math.pi * self.turns
        return tight if self.jam_at_rad is None else min(tight, self.jam_at_rad)

    def height(self, turned_rad: float) -> float:
        """Give the height at which the tool touches, turned in this far."""
        inside = min(max(turned_rad, 0.0), 2 * math.pi * self.turns)
        return self.top_z - self.pitch_m * inside / (2 * math.pi)

    def is_under(self, x: float, y: float) -> bool:
        """Whether a place is on its axis."""
        return math.hypot(x - self.axis[0], y - self.axis[1]) <= ON_THE_AXIS_M


@dataclass(frozen=True, slots=True)
class Contact:
    """What is near the tool."""

    surface: Surface
    thread: Thread | None = None


def parse_contact(given: Any) -> Contact | None:
    """Read a contact from JSON: null, or an object as the bench describes it.

    Raises:
        ContactError: A key is missing or unknown, or a value is not in its range.
    """
    if given is None:
        return None
    keys = _object(given, '"contact"', ("origin", "step_m", "heights", "stiffness_n_m", "thread"))
    surface = Surface(
        _pair(keys["origin"], "origin"),
        _positive(keys["step_m"], "step_m", _FARTHEST),
        _grid(keys["heights"]),
        _positive(keys["stiffness_n_m"], "stiffness_n_m", _STIFFEST),
    )
    return Contact(surface, _thread(keys.get("thread")))


def _thread(given: Any) -> Thread | None:
    if given is None:
        return None
    names = (
        *("axis", "top_z", "pitch_m", "turns", "turned_rad", "at_yaw_rad", "friction_nm"),
        "jam_at_rad",
    )
    keys = _object(given, '"thread"', names)
    jam = keys.get("jam_at_rad")
    return Thread(
        _pair(keys["axis"], "axis"),
        _number(keys["top_z"], "top_z", -_FARTHEST, _FARTHEST),
        _positive(keys["pitch_m"], "pitch_m", 1.0),
        _positive(keys["turns"], "turns", 1000.0),
        _number(keys["turned_rad"], "turned_rad", -1e4, 1e4),
        _number(keys["at_yaw_rad"], "at_yaw_rad", -1e4, 1e4),
        _number(keys["friction_nm"], "friction_nm", 0.0, 1000.0),
        None if jam is None else _number(jam, "jam_at_rad", 0.0, 1e4),
    )


def _object(given: Any, what: str, names: tuple[str, ...]) -> Mapping[str, Any]:
    """Check the keys of an object; the last of `names` may be left out."""
    if not isinstance(given, dict):
        raise ContactError(f"{what} takes an object or null, not {given!r:.80}")
    for key in given:
        if key not in names:
            raise ContactError(f'{what} has no key "{key}"; it has {", ".join(names)}')
    for name in names[:-1]:
        if name not in given:
            raise ContactError(f'{what} lacks "{name}"')
    return given


def _grid(given: Any) -> tuple[tuple[float, ...], ...]:
    wrong = '"heights" takes a list of at least two rows, each of the same two or more numbers, m'
    if not isinstance(given, list) or len(given) < 2 or not isinstance(given[0], list):
        raise ContactError(wrong)
    width = len(given[0])
    if width < 2 or not all(isinstance(row, list) and len(row) == width for row in given):
        raise ContactError(wrong)
    if len(given) * width > _MOST_CELLS:
        raise ContactError(f'"heights" has more than {_MOST_CELLS} numbers')
    return tuple(
        tuple(_number(height, "heights", -_FARTHEST, _FARTHEST) for height in row) for row in given
    )


def _pair(given: Any, name: str) -> tuple[float, float]:
    if not isinstance(given, list) or len(given) != 2:
        raise ContactError(f'"{name}" takes a list of two numbers, m, not {given!r:.80}')
    x, y = (_number(element, name, -_FARTHEST, _FARTHEST) for element in given)
    return x, y


def _positive(given: Any, name: str, most: float) -> float:
    value = _number(given, name, 0.0, most)
    if value <= 0:
        raise ContactError(f'"{name}" must be greater than 0')
    return value


def _number(given: Any, name: str, least: float, most: float) -> float:
    if isinstance(given, bool) or not isinstance(given, int | float):
        raise ContactError(f'"{name}" takes numbers, not {given!r:.80}')
    if not least <= given <= most:  # not a number included
        raise ContactError(f'"{name}" is {given!r:.40}, but must be from {least:g} to {most:g}')
    return float(given)
