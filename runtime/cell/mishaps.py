"""What goes wrong with parts and fingers now and then; everything seeded, nothing by default."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from runtime.errors import UsageError


@dataclass(frozen=True, slots=True)
class Mishaps:
    """How often what goes wrong, each a probability in [0, 1].

    Args:
        slip_rate: A part that was gripped slips out of the fingers on its way.
        slip_after_m: From and to, how far it is carried until then, m.
        jam_rate: An insertion sticks part-way at its first try. Taken back out, it goes in.
        jam_share: From and to, the share of the way from the rim to the seat where it sticks.
        cross_thread_rate: A thread takes hold askew at the first try. Turned back, it goes in.
        cross_thread_turns: From and to, the turns after which it binds then.
    """

    slip_rate: float = 0.0
    slip_after_m: tuple[float, float] = (0.05, 0.45)
    jam_rate: float = 0.0
    jam_share: tuple[float, float] = (0.2, 0.8)
    cross_thread_rate: float = 0.0
    cross_thread_turns: tuple[float, float] = (0.3, 1.2)

    def __post_init__(self) -> None:
        """Check the rates. Raises UsageError."""
        for name in ("slip_rate", "jam_rate", "cross_thread_rate"):
            rate = getattr(self, name)
            if not 0 <= rate <= 1:
                raise UsageError(f"{name} = {rate:g} is no probability; expected 0 to 1.")


class Fate:
    """What will go wrong, drawn event by event.

    The draw for an event depends on the seed and on how many events of its kind came before.

    Args:
        seed: Of all draws.
        mishaps: How often what goes wrong.
    """

    def __init__(self, seed: int = 0, mishaps: Mishaps | None = None) -> None:
        self._seed = seed
        self._mishaps = mishaps or Mishaps()
        self._counts = {"slip": 0, "jam": 0, "thread": 0, "shove": 0}

    @property
    def counts(self) -> dict[str, int]:
        """How many events of each kind there have been."""
        return dict(self._counts)

    def go_on_from(self, counts: Mapping[str, int]) -> None:
        """Go on after so many events of each kind."""
        self._counts = {kind: int(counts.get(kind, 0)) for kind in self._counts}

    def slip_after_m(self) -> float | None:
        """Give how far the part that was just gripped is carried until it slips; None: it holds."""
        chance, share = self._draw("slip")
        return _between(self._mishaps.slip_after_m, share, chance < self._mishaps.slip_rate)

    def jam_share(self) -> float | None:
        """Give the share of its way at which an insertion sticks; None: it goes in."""
        chance, share = self._draw("jam")
        return _between(self._mishaps.jam_share, share, chance < self._mishaps.jam_rate)

    def binds_after_turns(self) -> float | None:
        """Give the turns after which a thread binds; None: it took hold straight."""
        chance, share = self._draw("thread")
        askew = chance < self._mishaps.cross_thread_rate
        return _between(self._mishaps.cross_thread_turns, share, askew)

    def shove_rad(self) -> float:
        """Give the direction in which a part that is pushed aside goes, rad."""
        return 2 * np.pi * self._draw("shove")[1]

    def _draw(self, kind: str) -> tuple[float, float]:
        number = self._counts[kind]
        self._counts[kind] += 1
        stream = [self._seed, 3, list(self._counts).index(kind), number]
        chance, share = np.random.default_rng(stream).random(2).tolist()
        return chance, share


def _between(limits: tuple[float, float], share: float, happens: bool) -> float | None:  # noqa: FBT001
    return limits[0] + share * (limits[1] - limits[0]) if happens else None
