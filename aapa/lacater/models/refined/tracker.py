"""`aapa-refined`: what `aapa-plus` believes, its box put right by what was learned of its errors.

Who is where is settled by rules, and stays so; learned is no more than by how many px each edge is
off, never more than `MOST_PX`. It goes frame by frame, and sees no label and no later frame.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Final

from aapa.detections import Box
from aapa.lacater.models.model import Frame
from aapa.lacater.models.plus import BeyondAapa, Ideas
from aapa.lacater.models.refined.evidence import WIDTH_OF_EVIDENCE, Evidence
from aapa.lacater.models.refined.recurrent import GatedUnit, Weights, read_weights
from aapa.lacater.models.rounding import rounded
from aapa.lacater.video import HEIGHT, WIDTH

MOST_PX: Final = 4.0
"""No edge is moved farther."""


class Refined:
    """Follows the snitch through a video.

    Args:
        ideas: Which of those of `aapa-plus` are used.
        weights: What was learned.
        cast: The class number of each object that actions may name.
    """

    def __init__(self, ideas: Ideas, weights: Weights, cast: Mapping[str, int]) -> None:
        self._tracker = BeyondAapa(ideas, cast)
        self._evidence = Evidence()
        self._unit = GatedUnit(weights)

    def observe(self, frame: Frame) -> Box | None:
        """Take in one frame, and give the snitch's box, px; None until it was seen.

        Raises:
            AnchoringError: The attachments run in a circle, or a child has two parents.
        """
        self._tracker.observe(frame)
        insight = self._tracker.insight
        if insight.box is None:
            return None
        offs = self._unit.step(self._evidence.numbers(insight, frame.number))
        return corrected(insight.box, offs.tolist())

    @property
    def confidence(self) -> float:
        """How sure that is, in [0, 1]: as sure as `aapa-plus`."""
        return self._tracker.confidence


def corrected(box: Box, offs: list[float]) -> Box:
    """Give a box with its edges moved, px, within the image, rounded as labels are."""
    x1, y1, x2, y2 = (
        edge + min(max(off, -MOST_PX), MOST_PX) for edge, off in zip(box, offs, strict=True)
    )
    x1, y1 = min(max(x1, 0.0), WIDTH), min(max(y1, 0.0), HEIGHT)
    return rounded((x1, y1, min(max(x2, x1), WIDTH), min(max(y2, y1), HEIGHT)))


@cache
def shipped_weights() -> Weights:
    """Give the weights that come with the program.

    Raises:
        DatasetError: They are missing or damaged.
    """
    path = Path(str(files("aapa.lacater.models.refined"))) / "weights.npz"
    return read_weights(path, WIDTH_OF_EVIDENCE, 4)
