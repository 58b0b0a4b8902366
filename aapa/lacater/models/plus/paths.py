"""The way of one move along the floor: known how it goes, fitted where it goes.

A thing that is moved starts slowly, and stops slowly, at a time that whoever moves it knows. Where
it stands at some moments then tells where it is going to stop: each of them is a measurement of
the whole way, weighted by the share of it that has been gone.
"""

from __future__ import annotations

from typing import Final

from aapa.lacater.generator.motion import Profile, pick_place, slide
from aapa.lacater.models.plus.ground import Place

_LEAST: Final = 2e-3
"""Below this sum of squared shares a way is not known well enough to be followed."""


class Path:
    """One move.

    Args:
        origin: Where it begins, in units of the scene.
        start: Its first frame.
        end: Its last frame, as planned.
        lifted: It is picked and placed, not slid.
    """

    __slots__ = ("_across", "_ahead", "_profile", "_weight", "end", "origin", "start")

    def __init__(self, origin: Place, start: int, end: int, *, lifted: bool) -> None:
        moves = (pick_place if lifted else slide)(end - start + 1)
        self._profile: Profile = moves.filmed
        self.origin, self.start, self.end = origin, start, end
        self._across = self._ahead = self._weight = 0.0

    def share(self, frame: int) -> float:
        """Give which share of the way has been gone at a frame."""
        return float(self._profile.travel[min(max(frame - self.start, 0), self.end - self.start)])

    def height(self, frame: int) -> float:
        """Give how high it is lifted at a frame, as a share of the full lift."""
        return float(self._profile.lift[min(max(frame - self.start, 0), self.end - self.start)])

    def add(self, frame: int, place: Place) -> None:
        """Take in where it was seen at a frame."""
        share = self.share(frame)
        self._across += share * (place[0] - self.origin[0])
        self._ahead += share * (place[1] - self.origin[1])
        self._weight += share * share

    def place(self, frame: int) -> Place | None:
        """Give where it is at a frame; None while the way is not known."""
        share = self.share(frame)
        if share == 0.0:
            return self.origin
        if self._weight < _LEAST:
            return None
        share /= self._weight
        return self.origin[0] + share * self._across, self.origin[1] + share * self._ahead
