"""The person's body as solids: a torso, one arm of two links, and a hand.

The person stands opposite the robot. Where the hand is to be follows from what the person does; the
arm is bent to get there, and the shoulder leans after it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from runtime.cell.arrangement import PlacedPart
from runtime.kinematics import Matrix
from runtime.parts import PartModel, Primitive, Vector

PERSON: Final = "person"
"""The name of the person, and the detector's class for a hand."""

UPPER_M: Final = 0.30
"""Shoulder to elbow."""

FORE_M: Final = 0.27
"""Elbow to wrist."""

SHOULDER: Final = (1.02, 0.20, 0.42)
"""The shoulder of a person who stands upright, m in the base frame."""

REST: Final = (0.90, 0.32, 0.06)
"""The hand of a person who does nothing, m: beside the table, out of the camera's view."""

_WRIST_M: Final = 0.075  # from the middle of the palm back to the wrist
_STRETCH: Final = 0.96  # of the arm's length; farther and the shoulder leans forward
_ELBOW_WAY: Final = np.array([0.15, 0.75, -0.65])  # elbows hang down and outwards
_SKIN: Final = (0.80, 0.62, 0.50)

HAND: Final = PartModel(
    PERSON,
    (
        Primitive("box", (0.095, 0.085, 0.028), (0.0, 0.0, 0.0), _SKIN),
        Primitive("box", (0.060, 0.076, 0.020), (0.070, 0.0, -0.008), _SKIN),
        Primitive("box", (0.060, 0.020, 0.022), (0.020, -0.052, -0.012), _SKIN),
    ),
    (0.195, 0.146, 0.037),
    0.0,
    0.2,
)
"""The hand, palm down: x is towards the fingertips, z up, its place the middle of the palm."""


@dataclass(frozen=True, slots=True, eq=False)
class Body:
    """Where the person's solids are, each (4, 4) in the base frame.

    Args:
        torso: Between the shoulders.
        upper: At the shoulder, z towards the elbow.
        fore: At the elbow, z towards the wrist.
        hand: The middle of the palm.
    """

    torso: Matrix
    upper: Matrix
    fore: Matrix
    hand: Matrix

    @property
    def poses(self) -> tuple[Matrix, Matrix, Matrix, Matrix]:
        """All of them, in the order of `LIMBS`."""
        return self.torso, self.upper, self.fore, self.hand

    def placed_hand(self) -> PlacedPart:
        """Give the hand as something that stands in the way and can be seen."""
        return PlacedPart(PERSON, HAND, self.hand)


LIMBS: Final = ("person-torso", "person-upper", "person-fore", "person-hand")
"""The names of the person's bodies in the scene."""


def body_at(palm: Vector) -> Body:
    """Give the body of a person whose palm is at a place, m in the base frame."""
    target = np.array(palm)
    shoulder = np.array(SHOULDER)
    forward = target[:2] - shoulder[:2]
    forward /= max(1e-9, float(np.linalg.norm(forward)))
    ahead = np.array([forward[0], forward[1], 0.0])
    wrist = target - _WRIST_M * ahead
    away = wrist - shoulder
    length = float(np.linalg.norm(away))
    most = _STRETCH * (UPPER_M + FORE_M)
    if length > most:
        shoulder = shoulder + away * (1 - most / length)
        away, length = wrist - shoulder, most
    elbow = _elbow(shoulder, away, length)
    torso = np.eye(4)
    torso[:3, 3] = shoulder[0] + 0.06, shoulder[1] - 0.20, shoulder[2]
    hand = np.eye(4)
    hand[:3, 0], hand[:3, 1] = ahead, np.array([-ahead[1], ahead[0], 0.0])
    hand[:3, 3] = target
    return Body(torso, _along(shoulder, elbow), _along(elbow, wrist), hand)


def _elbow(shoulder: NDArray[np.float64], away: NDArray[np.float64], length: float) -> Matrix:
    """Give the elbow of an arm that reaches `away` from the shoulder (law of cosines)."""
    along = away / length
    share = (UPPER_M**2 - FORE_M**2 + length**2) / (2 * length)
    off = math.sqrt(max(0.0, UPPER_M**2 - share**2))
    across = _ELBOW_WAY - along * float(_ELBOW_WAY @ along)
    across /= max(1e-9, float(np.linalg.norm(across)))
    elbow: Matrix = shoulder + share * along + off * across
    return elbow


def _along(start: NDArray[np.float64], end: NDArray[np.float64]) -> Matrix:
    """Give the frame of a limb: at its start, z towards its end."""
    z = (end - start) / max(1e-9, float(np.linalg.norm(end - start)))
    helper = np.array([1.0, 0.0, 0.0]) if abs(z[0]) < 0.9 else np.array([0.0, 1.0, 0.0])
    x = np.cross(helper, z)
    x /= np.linalg.norm(x)
    pose = np.eye(4)
    pose[:3, 0], pose[:3, 1], pose[:3, 2], pose[:3, 3] = x, np.cross(z, x), z, start
    return pose
