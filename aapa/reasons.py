"""The sentences on why an object is believed to be where it is."""

from __future__ import annotations

from enum import IntEnum
from typing import Final

AT_REST: Final = "It is seen at its last place."
FIRST_TIME: Final = "It is seen for the first time."
OUTSIDE: Final = "It lies outside the image."
REACHES_OUT: Final = "Part of it reaches out of the image."
SEEN_TOO_LITTLE: Final = "it had been seen too little to be reasoned about"
UNEXPLAINED: Final = "nothing explains why"


class Why(IntEnum):
    """Which of the sentences it is, where thousands are kept as numbers until they are read."""

    AT_REST = 0
    MOVED = 1
    FIRST_TIME = 2
    OUTSIDE = 3
    REACHES_OUT = 4
    OCCLUDED = 5
    SEEN_TOO_LITTLE = 6
    UNEXPLAINED = 7


def seen_off(distance_px: float) -> str:
    """Say how far from its last place an object is seen."""
    return f"It is seen {distance_px:.3g} px from its last place."


def occluded_by(occluder: str) -> str:
    """Say what hides an object."""
    return f"{occluder} stands in front of it."


def not_seen(why: str, streak: int, confidence: float) -> str:
    """Say that an object is missed, and what follows.

    Args:
        why: That it is not reasoned about, or that nothing explains it.
        streak: Below 0, for how many frames in a row it has been missed.
        confidence: What is left of it; below 0 the object is given up.
    """
    how_long = f"for {-streak} frames " if streak < -1 else ""
    outcome = f"its confidence falls to {confidence:.3g}" if confidence >= 0 else "it is given up"
    return f"It is not seen {how_long}and {why}; {outcome}."
