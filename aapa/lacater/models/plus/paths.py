"""The way of one move along the floor: known how it goes, fitted where it goes.

A thing that is moved starts slowly, and stops slowly, at a time that whoever moves it knows. Where
it stands at some moments then tells where it is going to stop: each of them is a measurement of
the whole way, weighted by the share of it that has been gone.
"""

from __future__ import annotations

from typing import Final

from aapa.lacater.generator.motion import Profile, pick_place, slide
from aapa.lacater.models.plus.ground import Place

_SURE: Final = 4.0
"""As so many sightings counts where it stood at first, which was seen for long."""

_UNSURE: Final = 0.1
"""The same, where it was not seen just before."""

_LEAST: Final = 2e-3
"""Below this spread of the shares a way is not known well enough to be followed."""


class Path:
    """One move.

    Args:
        origin: Where it begins, in units of the scene.
        start: Its first frame.
        end: Its last frame, as planned.
        lifted: It is picked and placed, not slid.
        sure: It was seen where it begins just before.
    """

    __slots__ = (
        "_across",
        "_ahead",
        "_count",
        "_profile",
        "_shares",
        "_squares",
        "end",
        "lifted",
        "start",
    )

    def __init__(
        self, origin: Place, start: int, end: int, *, lifted: bool, sure: bool = True
    ) -> None:
        moves = (pick_place if lifted else slide)(end - start + 1)
        self._profile: Profile = moves.filmed
        self.start, self.end, self.lifted = start, end, lifted
        # Sums over what was seen.
        weight = _SURE if sure else _UNSURE
        self._count, self._shares, self._squares = weight, 0.0, 0.0
        self._across, self._ahead = [weight * origin[0], 0.0], [weight * origin[1], 0.0]

    def share(self, frame: int) -> float:
        """Give which share of the way has been gone at a frame."""
        return float(self._profile.travel[min(max(frame - self.start, 0), self.end - self.start)])

    def height(self, frame: int) -> float:
        """Give how high it is lifted at a frame, as a share of the full lift."""
        return float(self._profile.lift[min(max(frame - self.start, 0), self.end - self.start)])

    def add(self, frame: int, place: Place) -> None:
        """Take in where it was seen at a frame."""
        share = self.share(frame)
        self._count += 1.0
        self._shares += share
        self._squares += share * share
        for sums, value in ((self._across, place[0]), (self._ahead, place[1])):
            sums[0] += value
            sums[1] += share * value

    @property
    def origin(self) -> Place:
        """Where it began, as well as that is known by now."""
        return self._at(0.0) or (self._across[0] / self._count, self._ahead[0] / self._count)

    def place(self, frame: int) -> Place | None:
        """Give where it is at a frame; None while the way is not known."""
        share = self.share(frame)
        return self.origin if share == 0.0 else self._at(share)

    def _at(self, share: float) -> Place | None:
        """Give the point of the fitted line at which a share of the way is gone."""
        spread = self._count * self._squares - self._shares * self._shares
        if spread < _LEAST:
            return None
        # The weights of the mean and of the slope of a straight line fitted by least squares.
        mean = (self._squares - share * self._shares) / spread
        slope = (share * self._count - self._shares) / spread
        return (
            mean * self._across[0] + slope * self._across[1],
            mean * self._ahead[0] + slope * self._ahead[1],
        )
