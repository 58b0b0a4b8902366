"""The anchoring cycle: from the detections of a frame to the objects believed to be there."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from operator import attrgetter

from aapa.alignment import Place, align, squared_distance
from aapa.anchors import Anchor, AnchorStatus
from aapa.boxes import centre_of
from aapa.camera import Camera
from aapa.detections import Box, Detection, Position
from aapa.hierarchy import parents_of
from aapa.hypotheses import Move, explain, move_between
from aapa.names import NameRegister
from aapa.parameters import AnchoringParameters
from aapa.validation import check_camera, checked_detections
from aapa.view import View

_by_name = attrgetter("name")


@dataclass(frozen=True, slots=True)
class AnchoringState:
    """All that anchoring remembers from one frame to the next.

    Args:
        anchors: Every maintained anchor, sorted by name, those not yet reported included.
        dropped: The anchors given up in the last step, sorted by name, each with the reason.
        register: The names given so far.
        frame: How many steps there have been.
    """

    anchors: tuple[Anchor, ...] = ()
    dropped: tuple[Anchor, ...] = ()
    register: NameRegister = field(default_factory=NameRegister)
    frame: int = 0


class Anchoring:
    """Objects that keep their names from frame to frame, seen or not.

    Args:
        parameters: How much perception is trusted; the paper's values if left out.

    Example:
        >>> anchoring = Anchoring(AnchoringParameters(tau=6500))
        >>> [cone] = anchoring.update([Detection("cone", (10, 10, 30, 40))])
        >>> cone.name, str(cone.status)
        ('cone-1', 'visible')
    """

    def __init__(self, parameters: AnchoringParameters | None = None) -> None:
        self.parameters = parameters or AnchoringParameters()
        self.state = AnchoringState()

    @property
    def anchors(self) -> tuple[Anchor, ...]:
        """Every maintained anchor, sorted by name, whatever its confidence."""
        return self.state.anchors

    @property
    def dropped(self) -> tuple[Anchor, ...]:
        """The anchors that the last update gave up, sorted by name, each with the reason."""
        return self.state.dropped

    @property
    def frame(self) -> int:
        """How many updates there have been."""
        return self.state.frame

    def update(
        self,
        detections: Iterable[Detection],
        attachments: Iterable[tuple[str, str]] = (),
        camera: Camera | None = None,
    ) -> tuple[Anchor, ...]:
        """Take in one frame, and give the anchors to be believed in.

        Args:
            detections: What the detector reports, in any order, and the bodies that report
                their own place.
            attachments: (child, parent) pairs that were believed when the frame was taken: an
                action that ended at frame t carries its object from frame t + 1 on.
            camera: The camera at this frame; base space reasons with its pose.

        Returns:
            The anchors of at least the least reported confidence, sorted by name; bodies have
            full confidence.

        Raises:
            AnchoringError: A detection, an attachment or the camera is malformed. The state
                stays as it was.
        """
        self.state = step(self.state, detections, attachments, camera, self.parameters)
        least = self.parameters.min_report_confidence
        return tuple(anchor for anchor in self.state.anchors if anchor.confidence >= least)


def step(
    state: AnchoringState,
    detections: Iterable[Detection],
    attachments: Iterable[tuple[str, str]],
    camera: Camera | None,
    parameters: AnchoringParameters,
) -> AnchoringState:
    """Give the state after one more frame; arguments and errors are those of `update`.

    Source: Liang et al. 2021, section III-B, b: alignment, then hypothesis reasoning.
    """
    found = checked_detections(detections, parameters.space)
    if camera is not None:
        check_camera(camera)
    parents = parents_of(attachments)
    frame = _Frame(
        state.frame + 1,
        parameters,
        parents if parameters.use_attachments else {},
        View(parameters, camera),
    )
    reported = {detection.name: detection for detection in found if detection.name is not None}
    register = state.register.with_bodies(frozenset(reported))
    old_bodies = [anchor for anchor in state.anchors if anchor.name in register.bodies]
    old_things = [anchor for anchor in state.anchors if anchor.name not in register.bodies]
    bodies = [frame.of_body(name, reported[name]) for name in sorted(reported)]
    things, lost, register = _aligned(
        old_things, [detection for detection in found if detection.name is None], register, frame
    )
    seen = sorted([*bodies, *things], key=_by_name)
    moves = _moves_of_parents(state.anchors, seen, frame.parents)
    explanation = explain(lost, seen, moves, frame.parents, frame.view)
    gone = [frame.without_report(anchor) for anchor in old_bodies if anchor.name not in reported]
    return AnchoringState(
        tuple(sorted([*seen, *explanation.kept], key=_by_name)),
        tuple(sorted([*gone, *explanation.dropped], key=_by_name)),
        register,
        frame.number,
    )


def _aligned(
    anchors: Sequence[Anchor],
    detections: Sequence[Detection],
    register: NameRegister,
    frame: _Frame,
) -> tuple[list[Anchor], list[Anchor], NameRegister]:
    """Give the anchors with a detection, old and new, those without, and the names given."""
    # Solved in an order of its own, so that even ties do not depend on the detector's.
    order = sorted(range(len(detections)), key=lambda index: _canonical(detections[index]))
    old = [frame.place(anchor) for anchor in anchors]
    new = [frame.place(detections[index]) for index in order]
    alignment = align(old, new, frame.parameters.tau)
    seen = [
        frame.of_sighting(
            anchors[row],
            detections[order[column]],
            squared_distance(old[row].centre, new[column].centre),
        )
        for row, column in alignment.pairs
    ]
    # New objects are numbered as the detector lists them.
    anchored = {anchor.name for anchor in anchors}
    for index in sorted(order[column] for column in alignment.appeared):
        detection = detections[index]
        unique = detection.type in frame.parameters.unique_types
        name, register = register.with_new(detection.type, unique=unique, anchored=anchored)
        anchored.add(name)
        seen.append(frame.of_new(name, detection))
    return seen, [anchors[index] for index in alignment.lost], register


def _moves_of_parents(
    old: Sequence[Anchor], seen: Sequence[Anchor], parents: Mapping[str, str]
) -> dict[str, Move]:
    """Give how far each seen parent went; one that was not anchored before has not moved."""
    carriers = set(parents.values())
    before = {anchor.name: anchor for anchor in old if anchor.name in carriers}
    return {
        anchor.name: move_between(before[anchor.name], anchor)
        for anchor in seen
        if anchor.name in before
    }


def _canonical(detection: Detection) -> tuple[str, Box, tuple[float, ...], float]:
    return detection.type, detection.box, detection.position or (), detection.score


@dataclass(frozen=True, slots=True, eq=False)
class _Frame:
    """One frame's circumstances, and what a detection makes of an anchor in them."""

    number: int
    parameters: AnchoringParameters
    parents: Mapping[str, str]
    view: View

    def place(self, thing: Anchor | Detection) -> Place:
        if self.parameters.space == "image":
            return Place(thing.type, centre_of(thing.box))
        # Base space has positions everywhere: the detections were checked for them.
        assert thing.position is not None
        return Place(thing.type, thing.position)

    def of_body(self, name: str, detection: Detection) -> Anchor:
        return self._visible(name, detection, 1.0, "It reports its own place.")

    def of_new(self, name: str, detection: Detection) -> Anchor:
        confidence = self.parameters.initial_confidence
        return self._visible(name, detection, confidence, "It is seen for the first time.")

    def of_sighting(self, anchor: Anchor, detection: Detection, cost: float) -> Anchor:
        unit = "px" if self.parameters.space == "image" else "m"
        return self._visible(
            anchor.name,
            self._tempered(anchor, detection, cost),
            min(1.0, round(anchor.confidence + self.parameters.confidence_gain, 9)),
            f"It is seen {math.sqrt(cost):.3g} {unit} from its last place.",
        )

    def without_report(self, body: Anchor) -> Anchor:
        return Anchor(
            body.name,
            body.type,
            body.box,
            AnchorStatus.MISSING,
            position=body.position,
            size=body.size,
            last_seen=body.last_seen,
            reason="It no longer reports its place; it is given up.",
        )

    def _tempered(self, anchor: Anchor, detection: Detection, cost: float) -> Detection:
        """Give the detection as far as the gain goes along with it."""
        gain = self.parameters.position_gain
        carried = anchor.status is AnchorStatus.ATTACHED or anchor.name in self.parents
        # Half the alignment radius is no noise: what comes back there has been moved.
        strayed = anchor.status is not AnchorStatus.VISIBLE and cost > self.parameters.tau / 4
        size = detection.size or self.view.size_of(detection.box, detection.position) or anchor.size
        if gain == 1 or carried or strayed:
            return Detection(detection.type, detection.box, 1.0, detection.position, size)
        box = detection.box
        if self.parameters.space == "image":
            (a, b, c, d), (x1, y1, x2, y2) = anchor.box, box
            keep = 1 - gain
            box = (
                keep * a + gain * x1,
                keep * b + gain * y1,
                keep * c + gain * x2,
                keep * d + gain * y2,
            )
        position = _between(anchor.position, detection.position, gain)
        return Detection(detection.type, box, 1.0, position, size)

    def _visible(self, name: str, detection: Detection, confidence: float, reason: str) -> Anchor:
        return Anchor(
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
        )


def _between(old: Position | None, new: Position | None, gain: float) -> Position | None:
    if old is None or new is None:
        return new
    (a, b, c), (x, y, z) = old, new
    keep = 1 - gain
    return keep * a + gain * x, keep * b + gain * y, keep * c + gain * z
