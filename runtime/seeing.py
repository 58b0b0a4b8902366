"""The eyes of the loop: what is detected, the anchors it keeps, and what is perceived of them."""

from __future__ import annotations

import time
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Protocol

from aapa import Anchor, Anchoring, AnchorStatus, Attachment, Camera, Detection
from icarus_lite import Percept
from runtime.config import RobotConfig
from runtime.drivers import ArmState
from runtime.expecting import Expectation
from runtime.percepts import hand_detection, is_in_company, percepts_of


class PerceptSource(Protocol):
    """Whatever reports detections: a camera with a detector, or the simulated cell."""

    def update(self, arm: ArmState) -> None:
        """Take note of where the arm is and what its gripper does."""

    def look(self) -> tuple[Sequence[Detection], Camera]:
        """Give the next frame's detections and the camera that took it."""


@dataclass(frozen=True, slots=True)
class Seen:
    """One frame, from the detections to the percepts.

    Args:
        detections: What was detected; the hand is not among it.
        before: The anchors of the frame before.
        percepts: What the mind is told.
        looked_s: When the detections were there, s of this process.
        anchored_s: When the anchors were.
    """

    detections: tuple[Detection, ...]
    before: tuple[Anchor, ...]
    percepts: tuple[Percept, ...]
    looked_s: float
    anchored_s: float


class Sight:
    """Sees, and keeps in mind what is out of sight.

    Args:
        anchoring: Keeps the anchors.
        source: Where detections come from.
        config: The robot.
        anchors: What was anchored last, where a run is gone on with.
    """

    def __init__(
        self,
        anchoring: Anchoring,
        source: PerceptSource,
        config: RobotConfig,
        anchors: tuple[Anchor, ...] = (),
    ) -> None:
        self._anchoring = anchoring
        self._source = source
        self._config = config
        self._expectation = Expectation()
        self.anchors = anchors
        """What is anchored now."""
        self.company = False
        """Whether somebody's hand is in sight."""

    @property
    def frame(self) -> int:
        """The number of the last frame, as the anchoring counts."""
        return self._anchoring.frame

    def by_name(self) -> dict[str, Anchor]:
        """Give what is anchored now, by name."""
        return {anchor.name: anchor for anchor in self.anchors}

    def update(self, arm: ArmState) -> None:
        """Tell the source of detections where the arm is."""
        self._source.update(arm)

    def look(self, arm: ArmState, attachments: Sequence[Attachment], *, acting: bool) -> Seen:
        """Take in the next frame.

        Args:
            arm: The arm, in this moment.
            attachments: What is believed to be attached to what.
            acting: Whether the arm is carrying something out.
        """
        detections, camera = self._source.look()
        looked_s = time.perf_counter()
        hand = hand_detection(arm, camera, self._config)
        before = self.anchors
        self.anchors = self._anchoring.update([*detections, hand], attachments, camera)
        self.company = is_in_company(self.anchors, detections)
        expected = self._expectation.update(
            self.anchors, detections, attachments, camera, company=self.company
        )
        anchored_s = time.perf_counter()
        percepts = percepts_of(self.anchors, arm, self._config, acting=acting, expected=expected)
        return Seen(tuple(detections), before, percepts, looked_s, anchored_s)

    def shows_another_of(self, wanted: Collection[str]) -> bool:
        """Tell whether what there is but one of, and which matters, is seen in another place."""
        unique = self._anchoring.parameters.unique_types
        return any(
            anchor.type in unique
            and anchor.type in wanted
            and anchor.name not in wanted
            and anchor.status is AnchorStatus.VISIBLE
            for anchor in self._anchoring.anchors
        )

    def takes_on_trust(self, wanted: Collection[str], *, visited: bool) -> bool:
        """Tell whether something that matters is not seen, though it may have been taken away.

        Args:
            wanted: What matters, by name.
            visited: Whether anybody's hand has been near since it was put there.
        """
        shown = self._expectation.shown
        return any(
            anchor.status is AnchorStatus.ATTACHED and (visited or anchor.name in shown)
            for anchor in self.anchors
            if anchor.name in wanted
        )
