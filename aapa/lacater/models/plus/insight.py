"""What a tracker's answer was made of, for who wants to improve on it."""

from __future__ import annotations

from dataclasses import dataclass

from aapa.detections import Box
from aapa.lacater.models.plus.appearance import Appearance
from aapa.lacater.models.plus.carrying import Trim
from aapa.lacater.models.plus.paths import Path
from aapa.lacater.models.plus.reasons import Ground
from aapa.lacater.models.plus.scenery import Scenery


@dataclass(frozen=True, slots=True, eq=False)
class Insight:
    """All that is known of the snitch after a frame.

    Args:
        box: Its box before it is rounded, px; None until it was seen.
        ground: What the belief in it rests on.
        scenery: What is seen.
        appearance: How the snitch looks.
        snitch: Its name.
        outermost: The name of the outermost container that it is believed to stand in; its own
            where there is none.
        path: The move that it is on by itself or in its container, as far as one is reported.
        trim: How its box differs from a ball's.
    """

    box: Box | None
    ground: Ground
    scenery: Scenery
    appearance: Appearance
    snitch: str
    outermost: str
    path: Path | None
    trim: Trim
