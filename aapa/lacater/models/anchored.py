"""PA and AAPA: the snitch is where its anchor is."""

from __future__ import annotations

from collections.abc import Mapping

from aapa.anchoring import AnchoringState, step
from aapa.anchors import Anchor
from aapa.detections import Box, Detection
from aapa.lacater.classes import CLASS_NAMES, SNITCH_NAME
from aapa.lacater.models.grounding import Grounding, surest
from aapa.lacater.models.model import Frame
from aapa.lacater.video import HEIGHT, WIDTH
from aapa.parameters import AnchoringParameters


class AnchoredSnitch:
    """Anchors everything that is detected, and reports the snitch's anchor.

    A detection of the snitch beyond the radius of alignment makes a second anchor. The one of
    higher confidence is reported, so that what is seen but once is not believed, and what is
    seen again and again is: the paper's assumption that objects are consistent.

    Args:
        parameters: Of the anchoring; without `use_attachments` this is the paper's PA.
        cast: The class number of each object that actions may name.
    """

    def __init__(self, parameters: AnchoringParameters, cast: Mapping[str, int]) -> None:
        self._parameters = parameters
        self._grounding = Grounding(cast)
        self._state = AnchoringState()
        self._box: Box | None = None

    def observe(self, frame: Frame) -> Box | None:
        """Take in one frame, and give the box of the snitch's anchor, px.

        The last one is held when the anchor has been given up; None until there was one.

        Raises:
            AnchoringError: A detection is malformed.
        """
        self._state = step(
            self._state,
            detections_of(frame),
            self._grounding.grounded(frame.attachments, self._state.anchors)
            if self._parameters.use_attachments
            else (),
            None,
            self._parameters,
        )
        anchor = self.anchor
        if anchor is not None:
            self._box = anchor.box
        return self._box

    @property
    def anchors(self) -> tuple[Anchor, ...]:
        """Every anchor that is maintained, sorted by name."""
        return self._state.anchors

    @property
    def anchor(self) -> Anchor | None:
        """The snitch's anchor, or None while it has none."""
        return next(iter(surest(a for a in self._state.anchors if a.type == SNITCH_NAME)), None)


def detections_of(frame: Frame) -> list[Detection]:
    """Give a frame's detections for the anchoring, their classes by name."""
    return [
        Detection(CLASS_NAMES[number], (x1, y1, x2, y2))
        for number, (x1, y1, x2, y2) in zip(
            frame.classes.tolist(), frame.boxes.astype(float).tolist(), strict=True
        )
    ]


def lacater_parameters(tau: float, *, use_attachments: bool) -> AnchoringParameters:
    """Give the parameters for LA-CATER: tau in squared px, everything else as the paper has it."""
    return AnchoringParameters(tau=tau, use_attachments=use_attachments, image_size=(WIDTH, HEIGHT))
