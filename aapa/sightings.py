"""What a detection makes of an anchor, old or new, in one frame."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from aapa.anchors import Anchor, AnchorFields, AnchorStatus, anchor_of, anchors_of
from aapa.costs import Place
from aapa.detections import Box, Detection, Position
from aapa.parameters import AnchoringParameters
from aapa.reasons import AT_REST, FIRST_TIME
from aapa.view import View


@dataclass(frozen=True, slots=True, eq=False)
class Sightings:
    """One frame's circumstances, and the anchors that detections give in them.

    Args:
        number: The frame's, counted from 1.
        parameters: How much perception is trusted.
        parents: The attachment hierarchy, child to parent; empty where it is left out of account.
        view: The image of this frame.
    """

    number: int
    parameters: AnchoringParameters
    parents: Mapping[str, str]
    view: View

    def place(self, thing: Anchor | Detection) -> Place:
        """Give what the alignment compares."""
        if self.parameters.space == "image":
            box = thing.box
            return Place(thing.type, ((box[0] + box[2]) / 2, (box[1] + box[3]) / 2), box)
        # Base space has positions everywhere: the detections were checked for them.
        assert thing.position is not None
        return Place(thing.type, thing.position)

    def of_body(self, name: str, detection: Detection, old: Anchor | None) -> Anchor:
        """Give the anchor of a body that reports its own place."""
        streak = 1 if old is None else max(old.streak, 0) + 1
        return self._visible(name, detection, 1.0, "It reports its own place.", streak)

    def of_new(self, name: str, detection: Detection) -> Anchor:
        """Give the anchor of something seen for the first time."""
        confidence = self.parameters.initial_confidence
        return self._visible(name, detection, confidence, FIRST_TIME, 1)

    def of_old(self, anchor: Anchor, detection: Detection, squared: float) -> Anchor:
        """Give an anchor that was aligned with a detection.

        Args:
            anchor: As it was before this frame.
            detection: What it was aligned with.
            squared: The squared distance of their centres, px² or m².
        """
        parameters = self.parameters
        confidence = anchor.confidence
        if confidence < 1.0:
            # Rounded, so that ten gains of 0.1 are 1 and nothing depends on float dust.
            confidence = min(1.0, round(confidence + parameters.confidence_gain, 9))
        box, position = detection.box, detection.position
        gain = parameters.position_gain
        half_hidden = detection.score < parameters.sure_score and anchor.confidence >= 1.0
        if half_hidden:
            gain = 0.0
        if gain < 1 and not self._has_been_moved(anchor, squared, half_hidden=half_hidden):
            if parameters.space == "image":
                box = _mixed(anchor.box, box, gain)
            position = _between(anchor.position, position, gain)
        size = anchor.size if half_hidden else detection.size
        if size is None and position is not None:
            size = self.view.size_of(detection.box, detection.position)
        streak = anchor.streak
        return anchor_of(
            anchor.name,
            anchor.type,
            box,
            AnchorStatus.VISIBLE,
            None,
            confidence,
            position,
            size or anchor.size,
            self.number,
            self._how_far(squared) if squared else AT_REST,
            streak + 1 if streak > 0 else 1,
        )

    def of_pairs(self, pairs: Iterable[tuple[Anchor, Detection, float]]) -> list[Anchor]:
        """Give what `of_old` gives for each anchor, its detection and their squared distance."""
        parameters = self.parameters
        if parameters.position_gain < 1 or parameters.sure_score or parameters.space == "base":
            return [self.of_old(*pair) for pair in pairs]
        # The same, written out for what most of a frame is: it is half of all the work.
        number, gain, visible = self.number, parameters.confidence_gain, AnchorStatus.VISIBLE
        rows: list[AnchorFields] = []
        for anchor, detection, squared in pairs:
            confidence, streak = anchor.confidence, anchor.streak
            if confidence < 1.0:
                confidence = min(1.0, round(confidence + gain, 9))
            rows.append(
                (
                    anchor.name,
                    anchor.type,
                    detection.box,
                    visible,
                    None,
                    confidence,
                    detection.position,
                    detection.size or anchor.size,
                    number,
                    math.sqrt(squared) if squared else AT_REST,
                    streak + 1 if streak > 0 else 1,
                )
            )
        return anchors_of(rows)

    def without_report(self, body: Anchor) -> Anchor:
        """Give the last of a body that no longer reports its place."""
        return Anchor(
            body.name,
            body.type,
            body.box,
            AnchorStatus.MISSING,
            position=body.position,
            size=body.size,
            last_seen=body.last_seen,
            reason="It no longer reports its place; it is given up.",
            streak=-1,
        )

    def _visible(
        self, name: str, detection: Detection, confidence: float, reason: str, streak: int
    ) -> Anchor:
        return anchor_of(
            name,
            detection.type,
            detection.box,
            AnchorStatus.VISIBLE,
            None,
            confidence,
            detection.position,
            detection.size or self.view.size_of(detection.box, detection.position),
            self.number,
            reason,
            streak,
        )

    def _has_been_moved(self, anchor: Anchor, squared: float, *, half_hidden: bool) -> bool:
        """Tell whether noise cannot be why an anchor is seen elsewhere."""
        if anchor.status is AnchorStatus.ATTACHED or anchor.name in self.parents:
            return True
        # The middle of what shows of a thing is as far as half of it from its own middle.
        if half_hidden and anchor.size is not None and squared <= max(anchor.size) ** 2 / 4:
            return False
        # Half the radius is no noise: what comes back there has been moved.
        return anchor.status is not AnchorStatus.VISIBLE and squared > self.parameters.radius**2 / 4

    def _how_far(self, squared: float) -> str:
        unit = "px" if self.parameters.space == "image" else "m"
        return f"It is seen {math.sqrt(squared):.3g} {unit} from its last place."


def _mixed(old: Box, new: Box, gain: float) -> Box:
    (a, b, c, d), (x1, y1, x2, y2) = old, new
    keep = 1 - gain
    return (
        keep * a + gain * x1,
        keep * b + gain * y1,
        keep * c + gain * x2,
        keep * d + gain * y2,
    )


def _between(old: Position | None, new: Position | None, gain: float) -> Position | None:
    if old is None or new is None:
        return new
    (a, b, c), (x, y, z) = old, new
    keep = 1 - gain
    return keep * a + gain * x, keep * b + gain * y, keep * c + gain * z
