"""How a move goes: how far along it a thing is at each frame, and how high it is lifted.

The scene files have every move interpolated linearly, as it was planned; the pictures, and with
them the boxes, ease in and out of each part of it.

Source: the published generator of CATER; Blender's automatic Bezier handles for the easing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Final

import numpy as np
from numpy.typing import NDArray

LIFT: Final = 2.0
"""How high a thing is lifted to be set down elsewhere, in units of the scene."""

QUARTER_TURN: Final = 90.0 / 180.0 * 3.14
"""How far a thing is turned by one action, rad; CATER's pi is 3.14."""

# The length of the handles of a curve's segment, as a share of it, that Blender 2.7 chooses.
_HANDLE = 1.0 / 2.5614


@dataclass(frozen=True, slots=True, eq=False)
class Profile:
    """One way to go from a place to another in n frames.

    Args:
        travel: (n,) share of the way across the floor gone at each frame.
        lift: (n,) share of the full lift.
    """

    travel: NDArray[np.float64]
    lift: NDArray[np.float64]

    def path(self, origin: NDArray[np.float64], target: NDArray[np.float64]) -> NDArray[np.float64]:
        """Give the places (n, 3) on the way from one place (3,) to another of the same height."""
        path = origin + self.travel[:, None] * (target - origin)
        path[:, 2] += LIFT * self.lift
        return path


@dataclass(frozen=True, slots=True, eq=False)
class Moves:
    """A way to go, twice: as it is planned, and as it is filmed."""

    planned: Profile
    filmed: Profile


@cache
def slide(frames: int) -> Moves:
    """Give the straight way along the floor, in so many frames."""
    last = frames - 1
    still = np.zeros(frames)
    return Moves(
        Profile(_linear((0, last), (0, 1), frames), still),
        Profile(_eased((0, last), (0, 1), frames), still),
    )


@cache
def pick_place(frames: int) -> Moves:
    """Give the way through the air: up, across, down, in so many frames."""
    last, up, over = frames - 1, int(0.2 * frames), int(0.8 * frames)
    # At the top it waits a frame on either side in the plan; in the pictures only before it goes.
    return Moves(
        Profile(
            _linear((0, up + 1, over, last), (0, 0, 1, 1), frames),
            _linear((0, up, over + 1, last), (0, 1, 1, 0), frames),
        ),
        Profile(
            _eased((0, up + 1, over, last), (0, 0, 1, 1), frames),
            _eased((0, up, over, last), (0, 1, 1, 0), frames),
        ),
    )


@cache
def turn(frames: int) -> NDArray[np.float64]:
    """Give the share of a turn that is filmed at each of so many frames, (n,)."""
    return _eased((0, frames - 1), (0, 1), frames)


def eased(share: NDArray[np.float64]) -> NDArray[np.float64]:
    """Give how far a value has come when a share of its time is over: slow, fast, slow.

    The curve is a cubic Bezier with flat handles; its time is solved for the parameter.
    """
    parameter = np.array(share, dtype=np.float64)
    for _ in range(30):
        rest = 1.0 - parameter
        time = (
            3.0 * rest**2 * parameter * _HANDLE
            + 3.0 * rest * parameter**2 * (1.0 - _HANDLE)
            + parameter**3
        )
        slope = (
            3.0 * rest**2 * _HANDLE
            + 6.0 * rest * parameter * (1.0 - 2.0 * _HANDLE)
            + 3.0 * parameter**2 * _HANDLE
        )
        parameter = np.clip(parameter - (time - share) / slope, 0.0, 1.0)
    return 3.0 * parameter**2 - 2.0 * parameter**3


def _linear(keys: Sequence[int], values: Sequence[float], frames: int) -> NDArray[np.float64]:
    return np.interp(np.arange(frames), keys, values)


def _eased(keys: Sequence[int], values: Sequence[float], frames: int) -> NDArray[np.float64]:
    # A piecewise curve: how far along its own segment each frame is, eased, then put in place.
    position = np.interp(np.arange(frames), keys, np.arange(len(keys)))
    segment = np.minimum(position.astype(np.intp), len(keys) - 2)
    table = np.array(values, dtype=np.float64)
    step = table[segment + 1] - table[segment]
    way: NDArray[np.float64] = table[segment] + step * eased(position - segment)
    return way
