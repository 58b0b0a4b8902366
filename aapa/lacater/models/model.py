"""What a model of object permanence is: boxes and action reports in, the snitch's box out.

A model is a name and a way to start a tracker for a video. A tracker is asked frame by frame, and
has nothing but what it is handed: the detections of this frame, the actions that began or ended
in it, and the attachments believed after the frame before. It sees no label, no true box and no
later frame; what it wants to remember it keeps itself. The harness is in charge of the order:
every frame of a video once, from frame 0 on, and a new tracker for each video.

Actions and attachments name objects as the scene file does ("Cone_0", "Spl_0"). The `cast` tells
the class of each such name, as whoever reports an action knows what kind of thing it was done
with. Which detection that is has to be found out: `grounding.py` does it for models that anchor.

To add a model: write a class with `observe`, and give it a name in `catalogue.py`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Literal, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from aapa.anchors import Attachment
from aapa.detections import Box
from aapa.lacater.camera import FloorCamera


@dataclass(frozen=True, slots=True)
class ActionReport:
    """An action that begins or ends, as it is reported.

    Args:
        action: Its name in the words of the domain, such as "contain".
        args: The objects it is done with, as the scene names them, the one that moves first.
        status: "running" in the frame in which it begins, "succeeded" in that in which it ends.
        planned_end: With "running": the frame in which it is going to end, where whoever acts
            knows that; None where not. A model that uses it says so.
    """

    action: str
    args: tuple[str, ...]
    status: Literal["running", "succeeded"]
    planned_end: int | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Frame:
    """All that a tracker is handed in one frame.

    Args:
        number: From 0, one more each time.
        boxes: (n, 4) whole px, x1 y1 x2 y2, the surest first.
        classes: (n,) class numbers, see `aapa.lacater.classes`.
        actions: What began or ended in this frame.
        attachments: (child, parent) believed after the frame before, by the scene's names.
        camera: Where the camera stands, as far as somebody has calibrated it. A model that uses
            it says so in its name.
    """

    number: int
    boxes: NDArray[np.int64]
    classes: NDArray[np.int64]
    actions: tuple[ActionReport, ...] = ()
    attachments: tuple[Attachment, ...] = ()
    camera: FloorCamera | None = None


class Tracker(Protocol):
    """Follows the snitch through one video."""

    def observe(self, frame: Frame) -> Box | None:
        """Take in one frame, and give the snitch's box, px.

        Returns:
            Where the snitch is, seen or hidden; None only before it was seen for the first time.
        """
        ...


@runtime_checkable
class SureTracker(Tracker, Protocol):
    """A tracker that says how sure it is of its last answer."""

    @property
    def confidence(self) -> float:
        """In [0, 1]."""
        ...


@dataclass(frozen=True, slots=True)
class Model:
    """A way to follow the snitch, under a name.

    Args:
        name: As it is given on the command line, such as "aapa-6500".
        start: Makes a tracker for a video from the cast: the class number of each object that
            actions may name.
        parameters: What there was to choose, for the report.
    """

    name: str
    start: Callable[[Mapping[str, int]], Tracker]
    parameters: Mapping[str, object] = field(default_factory=dict)
