"""Where something hidden may be, when nobody said: the few places that are possible, weighed.

It may still stand where it vanished, behind what is in front of it, or in any of the cones that
could have come over it. Each frame a cone is seen to stand on the very place speaks for that
cone, each frame it is seen to stand elsewhere against it; when it is told that something, not
said what, was set over something, that speaks for those that stand near. The best is believed,
and may change, until the thing is seen again.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Final, NamedTuple

from aapa.lacater.models.plus.containment import REACH

OUTSIDE: Final = ""
"""In nothing: behind something, where it vanished."""

_STEP: Final = 1.5
_WORST: Final = -3.0
_TOLD: Final = 3.0
_MOST: Final = 12.0


class Rival(NamedTuple):
    """One place where the thing may be.

    Args:
        container: The cone it may be in; `OUTSIDE` if it is in none.
        weight: How sure that is, in [0, 1]; those of all rivals add up to 1.
    """

    container: str
    weight: float


class Rivals:
    """What speaks for each of the possible containers of one hidden thing."""

    __slots__ = ("_scores",)

    def __init__(self) -> None:
        self._scores: dict[str, float] = {}

    def weigh(self, far: Mapping[str, float], *, told: bool) -> None:
        """Take in one frame.

        Args:
            far: For each cone that could hold the thing and stands still, how far from where it
                vanished, in units of the scene.
            told: An action ended in this frame that set something over something.
        """
        for name, distance in far.items():
            speaks = max(1.0 - (distance / REACH) ** 2, _WORST) * _STEP
            if told and distance < REACH:
                speaks += _TOLD
            score = self._scores.get(name, 0.0) + speaks
            self._scores[name] = min(max(score, -_MOST), _MOST)

    def rule_out(self, container: str) -> None:
        """No longer believe in one of the cones: it was seen to hold nothing."""
        self._scores[container] = -_MOST

    @property
    def are_several(self) -> bool:
        """There is a cone that it may be in."""
        return bool(self._scores)

    @property
    def ranked(self) -> tuple[Rival, ...]:
        """All that is possible, the surest first; of equals, the one that was thought of first."""
        powers = {name: math.exp(score) for name, score in self._scores.items()}
        total = 1.0 + sum(powers.values())
        rivals = [Rival(OUTSIDE, 1.0 / total)]
        rivals += [Rival(name, power / total) for name, power in powers.items()]
        return tuple(sorted(rivals, key=lambda rival: -rival.weight))
