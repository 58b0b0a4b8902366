"""What a network is told to look at, frame by frame: the snitch, or the outermost thing over it.

That is the paper's vector v. It follows from the attachments that the engine believes: while the
snitch is attached to something, its highest parent is looked at, for that is the one that can be
seen; else the snitch itself.

Source: Liang et al. 2021, section III-A (OPNet+AA).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from aapa.anchors import Attachment
from aapa.hierarchy import parents_of
from aapa.lacater.classes import SNITCH
from runtime.cater.attachments import FrameReports

UNKNOWN: Final = -1
"""In place of a class: what is to be looked at is of none that the detector knows."""


def looked_at(reports: Sequence[FrameReports], target: str) -> tuple[str, ...]:
    """Give the name of what is to be looked at in each frame, to know where the target is.

    Args:
        reports: What is known in each frame; the attachments are those after the frame before.
        target: The name of what has to be found, in the words of the actions.

    Raises:
        AnchoringError: A child has two parents, or the attachments run in a circle.
    """
    names: list[str] = []
    told: Sequence[Attachment] | None = None
    outermost = target
    for report in reports:
        if report.attachments is not told:
            told = report.attachments
            outermost = _outermost(target, parents_of(told))
        names.append(outermost)
    return tuple(names)


def classes_looked_at(
    reports: Sequence[FrameReports], cast: Mapping[str, int]
) -> NDArray[np.int64]:
    """Give (frames,) the class of what is to be looked at, to know where the snitch is.

    Args:
        reports: What is known in each frame.
        cast: The class number of each object that actions may name.

    Returns:
        The snitch's class where it is attached to nothing, `UNKNOWN` where its outermost parent
        is of no class that the detector knows.
    """
    snitch = next((name for name, number in cast.items() if number == SNITCH), "")
    names = looked_at(reports, snitch)
    return np.array([cast.get(name, UNKNOWN) for name in names], dtype=np.int64)


def _outermost(child: str, parents: Mapping[str, str]) -> str:
    while child in parents:
        child = parents[child]
    return child
