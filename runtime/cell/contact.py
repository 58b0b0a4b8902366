"""What the tool would touch: a small field of heights around it, for the arm's controller.

A robot feels the world through the forces on its tool. In the simulation the controller has to know
what is there to press against; this is what the cell tells it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from runtime.cell.arrangement import Arrangement
from runtime.cell.insertion import Insertion, Turning
from runtime.cell.seating import Opening
from runtime.cell.support import Floats, heading
from runtime.kinematics import Matrix

STEP_M: Final = 0.0005
"""Distance between two heights, m."""

STIFFNESS_N_M: Final = 20_000.0
"""Of fingers, part and table together, N/m."""

FRICTION_NM: Final = 0.25
"""The moment that turning a part in its thread takes, Nm."""

_WALL_M: Final = 0.00075  # a higher step than this between two heights is a wall
_FOOT_M: Final = 0.00045
_HALF: Final = 20  # heights on each side of the middle
_CELL_M: Final = 0.002  # the middle is moved in steps of this
_NEAR_M: Final = 0.06  # what is farther below is not told to an arm that moves across
_NEAR_BELOW_M: Final = 0.30  # ... and this far to one that stands still or comes down
_ACROSS_M: Final = 0.004  # an arm that has moved less than this between two looks stands still


@dataclass(frozen=True, slots=True)
class Thread:
    """A thread the held part is in.

    Args:
        axis: x and y of the tool centre point when the part is in line with it, m.
        top_z: Height of the tool centre point when the part is not screwed in at all, m.
        pitch_m: How far one turn goes down.
        turns: How many until it is tight.
        turned_rad: How far it was screwed in when the tool was turned by `at_yaw_rad`.
        at_yaw_rad: Angle of the tool's x axis about the base's z axis, rad.
        friction_nm: The moment that turning takes.
        jam_at_rad: Where it binds, None if it does not.
    """

    axis: tuple[float, float]
    top_z: float
    pitch_m: float
    turns: float
    turned_rad: float
    at_yaw_rad: float
    friction_nm: float = FRICTION_NM
    jam_at_rad: float | None = None


@dataclass(frozen=True, slots=True)
class Contact:
    """The heights of the tool centre point at which the held part touches what is below.

    Args:
        origin: x and y of the first height, m in the base frame.
        step_m: Distance between two heights.
        heights: [i][j] is that at x = origin[0] + i step, y = origin[1] + j step.
        stiffness_n_m: Force per depth below that height, N/m.
        thread: The thread the part is in.
    """

    origin: tuple[float, float]
    step_m: float
    heights: tuple[tuple[float, ...], ...]
    stiffness_n_m: float = STIFFNESS_N_M
    thread: Thread | None = None

    def request(self) -> dict[str, object]:
        """Give it as the controller's bench is told it, ready for JSON."""
        thread = self.thread
        return {
            "origin": list(self.origin),
            "step_m": self.step_m,
            "heights": [list(row) for row in self.heights],
            "stiffness_n_m": self.stiffness_n_m,
            "thread": None
            if thread is None
            else {
                "axis": list(thread.axis),
                "top_z": thread.top_z,
                "pitch_m": thread.pitch_m,
                "turns": thread.turns,
                "turned_rad": thread.turned_rad,
                "at_yaw_rad": thread.at_yaw_rad,
                "friction_nm": thread.friction_nm,
                "jam_at_rad": thread.jam_at_rad,
            },
        }

    def height_at(self, x: float, y: float) -> float | None:
        """Give the height at a place, bilinear between the given ones; None outside."""
        patch = self._patch(x, y)
        return None if patch is None else patch[0]

    def press_n(self, x: float, y: float, z: float) -> float | None:
        """Give how hard the tool presses down where it is; None outside.

        On a slope the surface pushes along its normal, with the depth along that.
        """
        patch = self._patch(x, y)
        if patch is None:
            return None
        height, slope_x, slope_y = patch
        depth = max(0.0, height - z)
        return self.stiffness_n_m * depth / (1 + slope_x**2 + slope_y**2)

    def _patch(self, x: float, y: float) -> tuple[float, float, float] | None:
        """Give the height at a place and how it changes with x and y; None outside."""
        across = (x - self.origin[0]) / self.step_m, (y - self.origin[1]) / self.step_m
        i, j = math.floor(across[0]), math.floor(across[1])
        if not (0 <= i < len(self.heights) - 1 and 0 <= j < len(self.heights[0]) - 1):
            return None
        u, v = across[0] - i, across[1] - j
        (a, b), (c, d) = self.heights[i][j : j + 2], self.heights[i + 1][j : j + 2]
        near, far = (1 - v) * a + v * b, (1 - v) * c + v * d
        slopes = (far - near) / self.step_m, ((1 - u) * (b - a) + u * (d - c)) / self.step_m
        return (1 - u) * near + u * far, *slopes


class Feeling:
    """Works out the contact of the held part, anew only when it could have changed.

    Args:
        arrangement: The parts.
        insertion: How the held part goes into its seat.
    """

    def __init__(self, arrangement: Arrangement, insertion: Insertion) -> None:
        self._arrangement = arrangement
        self._insertion = insertion
        self._key: tuple[object, ...] | None = None
        self._contact: Contact | None = None
        self._last: tuple[float, float] | None = None
        self._before: tuple[float, float] = (math.inf, math.inf)
        self._still = False

    def follow(self, tool: Matrix) -> None:
        """Note where the tool, (4, 4), is at a new look."""
        here = (float(tool[0, 3]), float(tool[1, 3]))
        self._still = math.dist(here, self._before) < _ACROSS_M
        self._before = here

    def forget(self) -> None:
        """Note that the hand is empty."""
        self._key = self._contact = self._last = None

    def contact(self, held: str, tool: Matrix) -> Contact | None:
        """Give what the held part could touch around here; None if it is far from everything.

        Args:
            held: The part in the hand.
            tool: (4, 4), the tool centre point; taken as pointing straight down.
        """
        part = self._arrangement.part(held)
        yaw = heading(part.pose)
        beside = part.pose[:2, 3] - tool[:2, 3]
        middle = self._middle(held, part.pose, beside, tool)
        if middle is None:
            self.forget()
            return None
        # A part that is turned in its thread is round: its field stays as it is.
        turn = 0 if self._insertion.turning is not None else round(math.degrees(yaw))
        key = (held, middle, turn, self._arrangement.settled)
        if key == self._key:
            return self._contact
        above = float(tool[2, 3] - part.pose[2, 3])
        mouths = self._insertion.mouths(held)
        origin = self._origin(middle, beside, mouths)
        ticks = np.arange(2 * _HALF + 1) * STEP_M
        x, y = np.meshgrid(origin[0] + ticks, origin[1] + ticks, indexing="ij")
        places = np.column_stack([x.ravel(), y.ravel()]) + beside
        heights = self._arrangement.field(held, yaw, places, mouths)
        self._key, self._last = key, middle
        self._contact = Contact(
            (round(origin[0], 6), round(origin[1], 6)),
            STEP_M,
            _rows(_rounded(heights.reshape(x.shape)) + above),
            thread=self._thread(held, beside, above),
        )
        return self._contact

    def _middle(
        self, held: str, pose: Matrix, beside: Floats, tool: Matrix
    ) -> tuple[float, float] | None:
        """Give the middle of the field, m: around the tool, or around the seat it may come to.

        The arm may be faster than whoever looks at it: over nothing near, the field is already
        told that it will come down into.
        """
        here = (float(tool[0, 3]), float(tool[1, 3]))
        if self._last is not None and math.dist(self._last, here) < _HALF * STEP_M / 2:
            return self._last
        mouths = self._insertion.mouths(held)
        below = self._arrangement.field(held, heading(pose), pose[None, :2, 3], mouths)
        if float(pose[2, 3] - below[0]) <= (_NEAR_BELOW_M if self._still else _NEAR_M):
            return round(here[0] / _CELL_M) * _CELL_M, round(here[1] / _CELL_M) * _CELL_M
        if not mouths:
            return None
        x, y = pose[:2, 3].tolist()
        nearest = min(mouths, key=lambda mouth: mouth.beside_m(x, y))
        axis = np.round(np.asarray(nearest.centre[:2]) - beside, 4)
        return float(axis[0]), float(axis[1])

    @staticmethod
    def _origin(
        middle: tuple[float, float], beside: Floats, mouths: tuple[Opening, ...]
    ) -> tuple[float, float]:
        """Give the first place of the field, such that the axis of a seat is one of its places."""
        corner = np.asarray(middle) - _HALF * STEP_M
        for mouth in mouths:
            axis = np.asarray(mouth.centre[:2]) - beside
            if np.abs(axis - middle).max() <= _HALF * STEP_M:
                corner = axis + np.round((corner - axis) / STEP_M) * STEP_M
        x, y = corner.tolist()
        return x, y

    def _thread(self, held: str, beside: Floats, above: float) -> Thread | None:
        turning = self._insertion.turning
        if turning is None:
            return None
        for mouth in self._insertion.openings(held):
            if mouth.receiver == turning.receiver and mouth.seat.thread is not None:
                return _thread(mouth, turning, beside, above)
        return None


def _thread(mouth: Opening, turning: Turning, beside: Floats, above: float) -> Thread:
    thread = mouth.seat.thread
    assert thread is not None, "only a seat with a thread is screwed into"
    return Thread(
        axis=(
            round(mouth.centre[0] - float(beside[0]), 6),
            round(mouth.centre[1] - float(beside[1]), 6),
        ),
        top_z=round(mouth.floor_m + above, 6),
        pitch_m=thread.pitch_m,
        turns=thread.turns,
        turned_rad=round(turning.turned_rad, 6),
        at_yaw_rad=round(math.remainder(turning.yaw, 2 * math.pi), 6),
        jam_at_rad=round(turning.end_rad, 6) if turning.binds else None,
    )


def _rounded(heights: Floats) -> Floats:
    """Round off the feet of walls, as every milled corner is.

    An arm that presses down and sideways at once must not be held by the wall alone there: between
    two heights the field knows one slope only.
    """
    lowest = heights.copy()
    np.minimum(lowest[1:], heights[:-1], out=lowest[1:])
    np.minimum(lowest[:-1], heights[1:], out=lowest[:-1])
    np.minimum(lowest[:, 1:], heights[:, :-1], out=lowest[:, 1:])
    np.minimum(lowest[:, :-1], heights[:, 1:], out=lowest[:, :-1])
    return np.where(heights - lowest > _WALL_M, lowest + _FOOT_M, heights)


def _rows(heights: Floats) -> tuple[tuple[float, ...], ...]:
    return tuple(tuple(row) for row in np.round(heights, 5).tolist())
