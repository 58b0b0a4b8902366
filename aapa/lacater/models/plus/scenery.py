"""All objects of a video as they are seen: which detection is whose, and from where.

The detections' classes tell who they are. Of several things alike each gets the nearest box. The
noise is estimated from what is at rest: where it flickers, boxes are means of cut off px, and lie
half a px off; where it does not, they are taken as they are.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Final

from aapa.boxes import centre_of, moved
from aapa.detections import Box
from aapa.errors import AnchoringError
from aapa.lacater.models.model import Frame
from aapa.lacater.models.plus.calibration import calibrated
from aapa.lacater.models.plus.ground import GroundView
from aapa.lacater.models.plus.ideas import Ideas
from aapa.lacater.models.plus.solids import Solid, solid_of
from aapa.lacater.models.plus.things import Thing
from aapa.lacater.video import HEIGHT, WIDTH

Boxes = list[list[int]]
"""Detections of one class, whole px, the surest first."""

START_VIEW: Final = GroundView(height=5.0, pitch=0.5, focal=350.0, size=(WIDTH, HEIGHT))
"""Where self-calibration starts; the focal length is that of CATER's lens."""

_MOST_SAMPLES: Final = 40
_HALF_PX: Final = 0.5
_NOISY: Final = 0.45
_ENOUGH: Final = 20
_FLICKER_PX: Final = 2.5
_STEADY_PX: Final = 0.3


class Scenery:
    """What is seen.

    Args:
        ideas: Which of them are used.
        cast: The class number of each object.
        target: The class of which a caller may know better what to believe.
    """

    def __init__(self, ideas: Ideas, cast: Mapping[str, int], target: int) -> None:
        self._averages = ideas.rest
        self._is_calibrated = ideas.camera
        self._target = target
        self.things = {name: Thing(number) for name, number in cast.items()}
        self._of_class: dict[int, list[str]] = {}
        for name, number in cast.items():
            self._of_class.setdefault(number, []).append(name)
        self.solids: dict[str, Solid] = {
            name: solid
            for name, number in cast.items()
            if number != target and (solid := solid_of(number)) is not None
        }
        self.view: GroundView | None = None
        """The camera as far as it has been found out."""
        self._samples: list[tuple[Solid, Box]] = []
        self._sampled = 0
        self._at_rest = self._changed = 0

    def alike(self, name: str) -> Sequence[str]:
        """Give all of the class of a thing, itself among them."""
        return self._of_class[self.things[name].number]

    def look(self, frame: Frame, believed: Callable[[Boxes], Boxes]) -> bool:
        """Find everything in a frame.

        Args:
            frame: Its detections.
            believed: Gives, of the boxes of the target's class, those that may be its.

        Returns:
            Whether something of the target's class is seen.

        Raises:
            AnchoringError: The camera should be given, and is not.
        """
        found: dict[int, Boxes] = {}
        for number, box in zip(frame.classes.tolist(), frame.boxes.tolist(), strict=True):
            found.setdefault(number, []).append(box)
        if self._is_calibrated and self.view is None:
            self.view = _given(frame)
        known = self._at_rest >= _ENOUGH
        flicker = _STEADY_PX if known and not self.is_noisy else _FLICKER_PX
        seen = False
        for number, names in self._of_class.items():
            boxes = found.get(number, [])
            if number == self._target and boxes:
                boxes = believed(boxes)
            taken = self._share_out(names, boxes, flicker)
            seen = seen or (taken and number == self._target)
        return seen

    def box_of(self, name: str) -> Box | None:
        """Give the box of a thing as well as it is known, px; None if it was never seen."""
        thing = self.things[name]
        if not self._averages:
            return thing.last
        box = thing.mean
        off = _HALF_PX if self.is_noisy else 0.0
        return moved(box, off, off) if box is not None and off else box

    @property
    def is_noisy(self) -> bool:
        """Whether the boxes of what is at rest differ from frame to frame."""
        return self._changed > _NOISY * self._at_rest

    def seen(self) -> list[tuple[str, Box]]:
        """Give the name and box, px, of all that is seen in this frame, but for the target."""
        return [
            (name, thing.last)
            for name, thing in self.things.items()
            if not thing.missed and thing.last is not None and thing.number != self._target
        ]

    def keep_sample(self, name: str) -> None:
        """Remember the box of what is about to leave its place, for the calibration."""
        solid, box = self.solids.get(name), self.box_of(name)
        thing = self.things[name]
        if solid is None or box is None or not thing.seen or thing.roaming:
            return
        if len(self._samples) < _MOST_SAMPLES:
            self._samples.append((solid, box))

    def camera(self) -> GroundView | None:
        """Give the camera, found anew where more has been seen since, unless it is given."""
        if self._is_calibrated:
            return self.view
        if self.view is None or len(self._samples) > self._sampled:
            self._sampled = len(self._samples)
            self.view = self.estimate(self.view) or self.view
        return self.view

    def estimate(self, guess: GroundView | None) -> GroundView | None:
        """Find out where the camera stands by all that is at rest, and was; keep nothing of it.

        Args:
            guess: Where to start, if anything is known.

        Returns:
            None where that does not determine a camera.
        """
        now = [
            (solid, box)
            for name, solid in self.solids.items()
            if self.things[name].seen
            and not self.things[name].roaming
            and (box := self.box_of(name)) is not None
        ]
        return calibrated(guess or START_VIEW, [*self._samples, *now])

    def tell_apart(self, name: str, box: Box) -> None:
        """Of several alike, take the one that is nearest to a box for the one of this name."""
        alike = self.alike(name)
        if len(alike) == 1:
            return
        u, v = centre_of(box)

        def far(other: str) -> float:
            last = self.things[other].last
            if last is None:
                return math.inf
            across, down = centre_of(last)
            return math.hypot(across - u, down - v)

        nearest = min(alike, key=far)
        things = self.things
        things[name], things[nearest] = things[nearest], things[name]

    def _share_out(self, names: Sequence[str], boxes: Boxes, flicker: float) -> bool:
        taken = False
        for name in names:
            thing = self.things[name]
            before, rested = thing.last, thing.seen
            index = thing.offer(boxes, flicker, strict=self._averages)
            if index is None:
                continue
            taken = True
            if rested and not thing.moving:
                self._at_rest += 1
                self._changed += before != thing.last
            if len(names) > 1:
                boxes = boxes[:index] + boxes[index + 1 :]
        return taken


def _given(frame: Frame) -> GroundView:
    if frame.camera is None:
        raise AnchoringError(
            "this model has to know where the camera stands, and neither camera.yaml beside "
            "labels/ nor the scene file says so; aapa-plus finds it out by itself"
        )
    camera = frame.camera
    return GroundView(camera.height, camera.pitch, camera.focal, (WIDTH, HEIGHT))
