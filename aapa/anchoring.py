"""The anchoring cycle: from the detections of a frame to the objects believed to be there."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from operator import attrgetter

from aapa.alignment import align, squared_distance
from aapa.anchors import Anchor
from aapa.camera import Camera
from aapa.costs import CENTRE
from aapa.crowds import align_crowd, are_many
from aapa.detections import Box, Detection
from aapa.hierarchy import parents_of
from aapa.hypotheses import Move, explain, move_between
from aapa.names import NameRegister
from aapa.parameters import AnchoringParameters
from aapa.reuniting import reunited
from aapa.sightings import Sightings
from aapa.singles import Aligned, align_singles
from aapa.validation import check_camera, checked_detections
from aapa.view import View

_by_name = attrgetter("name")
_in_image = attrgetter("type", "box", "score")


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

    @classmethod
    def of(cls, anchors: Iterable[Anchor], frame: int) -> AnchoringState:
        """Give a state to go on from, of anchors that were written down and a count of frames."""
        kept = tuple(sorted(anchors, key=_by_name))
        return cls(kept, (), NameRegister.of((each.name, each.type) for each in kept), frame)


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
        return tuple([anchor for anchor in self.state.anchors if anchor.confidence >= least])


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
    frame = Sightings(
        state.frame + 1,
        parameters,
        parents if parameters.use_attachments else {},
        View(parameters, camera),
    )
    reported = {detection.name: detection for detection in found if detection.name is not None}
    if reported or state.register.bodies:
        return _with_bodies(state, found, reported, frame)
    seen, lost, register = _aligned(state.anchors, found, state.register, frame)
    return _explained(state, seen, lost, (), register, frame)


def _with_bodies(
    state: AnchoringState,
    found: Sequence[Detection],
    reported: Mapping[str, Detection],
    frame: Sightings,
) -> AnchoringState:
    """Give the next state where bodies report, or have reported, their own place."""
    register = state.register.with_bodies(frozenset(reported))
    old_bodies = {a.name: a for a in state.anchors if a.name in register.bodies}
    old_things = [a for a in state.anchors if a.name not in old_bodies]
    bodies = [
        frame.of_body(name, reported[name], old_bodies.get(name)) for name in sorted(reported)
    ]
    unnamed = [detection for detection in found if detection.name is None]
    things, lost, register = _aligned(old_things, unnamed, register, frame)
    seen = sorted([*bodies, *things], key=_by_name)
    gone = [frame.without_report(body) for name, body in old_bodies.items() if name not in reported]
    return _explained(state, seen, lost, gone, register, frame)


def _explained(
    state: AnchoringState,
    seen: Sequence[Anchor],
    lost: Sequence[Anchor],
    gone: Sequence[Anchor],
    register: NameRegister,
    frame: Sightings,
) -> AnchoringState:
    """Give the next state, in which what is lost has been reasoned about.

    Args:
        state: The last one.
        seen: The anchors that have a detection, sorted by name.
        lost: Those that have none.
        gone: Those given up already.
        register: The names given so far.
        frame: The circumstances.
    """
    seen, lost = reunited(seen, lost, frame.parameters)
    if not lost:
        return AnchoringState(
            tuple(seen), tuple(sorted(gone, key=_by_name)), register, frame.number
        )
    moves = _moves_of_parents(state.anchors, seen, frame.parents)
    explanation = explain(lost, seen, moves, frame.parents, frame.view)
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
    frame: Sightings,
) -> tuple[Sequence[Anchor], Sequence[Anchor], NameRegister]:
    """Give the anchors with a detection, sorted by name, those without, and the names given."""
    parameters = frame.parameters
    aligned: Aligned | None = None
    if parameters.comparison is CENTRE:
        if parameters.space == "image":
            aligned = align_singles(anchors, detections, parameters.tau)
        if aligned is None and are_many(anchors, detections):
            aligned = align_crowd(anchors, detections, parameters.tau, parameters.space)
    if aligned is None:
        aligned = _align_each(anchors, detections, frame)
    seen = frame.of_pairs(aligned.pairs)
    if not aligned.appeared:
        return seen, aligned.lost, register
    new, register = _named(aligned.appeared, anchors, register, frame)
    return sorted(seen + new, key=_by_name), aligned.lost, register


def _align_each(
    anchors: Sequence[Anchor], detections: Sequence[Detection], frame: Sightings
) -> Aligned:
    """Align with any cost, in either space."""
    order = _order(detections)
    old = [frame.place(anchor) for anchor in anchors]
    found = [frame.place(detections[index]) for index in order]
    alignment = align(old, found, frame.parameters.tau, frame.parameters.comparison)
    pairs = [
        (
            anchors[row],
            detections[order[column]],
            squared_distance(old[row].centre, found[column].centre),
        )
        for row, column in alignment.pairs
    ]
    # New objects are numbered as the detector lists them.
    appeared = sorted(order[number] for number in alignment.appeared)
    return Aligned(
        pairs,
        [anchors[row] for row in alignment.lost],
        [detections[column] for column in appeared],
    )


def _named(
    appeared: Sequence[Detection],
    anchors: Sequence[Anchor],
    register: NameRegister,
    frame: Sightings,
) -> tuple[list[Anchor], NameRegister]:
    """Give the anchors of what has appeared, and the register with their names."""
    types = frame.parameters.unique_types
    # Whether a name is taken now is asked of unique types alone.
    anchored = {anchor.name for anchor in anchors} if types else set()
    new: list[Anchor] = []
    for detection in appeared:
        unique = detection.type in types
        name, register = register.with_new(detection.type, unique=unique, anchored=anchored)
        anchored.add(name)
        new.append(frame.of_new(name, detection))
    return new, register


def _order(detections: Sequence[Detection]) -> Sequence[int]:
    """Give an order to align in, in which even ties do not depend on the detector's."""
    if len({detection.type for detection in detections}) == len(detections):
        return range(len(detections))  # no two compete
    plain = all(detection.position is None for detection in detections)
    keys = list(map(_in_image if plain else _canonical, detections))
    return sorted(range(len(detections)), key=keys.__getitem__)


def _moves_of_parents(
    old: Sequence[Anchor], seen: Sequence[Anchor], parents: Mapping[str, str]
) -> dict[str, Move]:
    """Give how far each seen parent went; one that was not anchored before has not moved."""
    if not parents:
        return {}
    carriers = set(parents.values())
    before = {anchor.name: anchor for anchor in old if anchor.name in carriers}
    return {
        anchor.name: move_between(before[anchor.name], anchor)
        for anchor in seen
        if anchor.name in before
    }


def _canonical(detection: Detection) -> tuple[str, Box, tuple[float, ...], float]:
    return detection.type, detection.box, detection.position or (), detection.score
