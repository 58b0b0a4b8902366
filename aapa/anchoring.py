"""The anchoring cycle: from the detections of a frame to the objects believed to be there."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from operator import attrgetter

import numpy as np

from aapa.anchors import Anchor
from aapa.camera import Camera
from aapa.columns import AnchorColumns, DetectionColumns
from aapa.columns.cycle import CrowdState, columns_of_anchors, sighted, suits
from aapa.columns.detections import columns_of
from aapa.crowds import are_many
from aapa.detections import Detection
from aapa.hierarchy import parents_of
from aapa.hypotheses import Move, explain, move_between
from aapa.names import NameRegister
from aapa.parameters import AnchoringParameters
from aapa.reuniting import reunited
from aapa.sightings import Sightings
from aapa.validation import check_camera, checked_detections
from aapa.view import View
from aapa.who import who_is_who

_by_name = attrgetter("name")


@dataclass(frozen=True, slots=True)
class AnchoringState:
    """All that anchoring remembers from one frame to the next.

    Args:
        anchors: Every maintained anchor, sorted by name, those not yet reported included.
        dropped: The anchors given up in the last step, sorted by name, each with the reason.
        register: The names given so far.
        frame: How many steps there have been.
        columns: The same anchors as columns, where the last step went by them.
    """

    anchors: tuple[Anchor, ...] = ()
    dropped: tuple[Anchor, ...] = ()
    register: NameRegister = field(default_factory=NameRegister)
    frame: int = 0
    columns: AnchorColumns | None = field(default=None, repr=False, compare=False)

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
        self._state = AnchoringState()
        self._crowd: CrowdState | None = None
        """What came after the state, where no anchor has been asked for as yet."""

    @property
    def state(self) -> AnchoringState:
        """All that is remembered; may be set to go on from another one."""
        if self._crowd is not None:
            self._state, self._crowd = _state_of(self._crowd), None
        return self._state

    @state.setter
    def state(self, state: AnchoringState) -> None:
        self._state, self._crowd = state, None

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
        return self._state.frame if self._crowd is None else self._crowd.frame

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
        state = self._state if self._crowd is None else self.state
        state = step(state, detections, attachments, camera, self.parameters)
        self._state, self._crowd = state, None
        least = self.parameters.min_report_confidence
        if state.columns is not None and (state.columns.confidences >= least).all():
            return state.anchors
        return tuple([anchor for anchor in state.anchors if anchor.confidence >= least])

    def update_columns(
        self,
        detections: DetectionColumns,
        attachments: Iterable[tuple[str, str]] = (),
        camera: Camera | None = None,
    ) -> AnchorColumns:
        """Take in one frame of arrays, and give arrays: `update` for hundreds of objects.

        The anchors are the same, but none is made before it is read. Both calls may be mixed.

        Args:
            detections: What the detector reports, in any order.
            attachments: As `update` takes them.
            camera: As `update` takes it.

        Returns:
            The anchors of at least the least reported confidence, sorted by name.

        Raises:
            AnchoringError: As in `update`; the state stays as it was.

        Example:
            >>> found = DetectionColumns("cone", [[10, 10, 30, 40], [50, 10, 70, 40]])
            >>> cones = Anchoring().update_columns(found)
            >>> cones.boxes.shape, cones[1].name
            ((2, 4), 'cone-2')
        """
        known: CrowdState | AnchoringState = self._crowd or self._state
        result: CrowdState | AnchoringState | None = None
        if are_many(known.anchors, detections) and suits(self.parameters, known.register):
            old = _columns_of(known)
            if old is not None and detections.are_sound:
                frame = _frame_after(known, attachments, camera, self.parameters)
                result = _step_of_crowd(old, detections, known.register, frame)
        if result is None:
            given = detections.objects()
            result = step(self.state, given, attachments, camera, self.parameters)
        if isinstance(result, CrowdState):
            self._crowd = result
            columns = result.anchors
        else:
            self.state = result
            columns = result.columns or AnchorColumns.of(result.anchors)
        reported = columns.confidences >= self.parameters.min_report_confidence
        return columns if reported.all() else columns.only(np.flatnonzero(reported))


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
    given = tuple(detections)
    crowd = None
    if are_many(state.anchors, given) and suits(parameters, state.register):
        crowd = columns_of(given)
    found = given if crowd is not None else checked_detections(given, parameters.space)
    frame = _frame_after(state, attachments, camera, parameters)
    if crowd is not None and (old := _columns_of(state)) is not None:
        result = _step_of_crowd(old, crowd, state.register, frame)
        if result is not None:
            return _state_of(result) if isinstance(result, CrowdState) else result
    reported = {detection.name: detection for detection in found if detection.name is not None}
    if reported or state.register.bodies:
        return _with_bodies(state, found, reported, frame)
    seen, lost, register = _aligned(state.anchors, found, state.register, frame)
    return _explained(state.anchors, seen, lost, (), register, frame)


def _frame_after(
    state: AnchoringState | CrowdState,
    attachments: Iterable[tuple[str, str]],
    camera: Camera | None,
    parameters: AnchoringParameters,
) -> Sightings:
    """Give the circumstances of the next frame, the attachments and the camera checked."""
    if camera is not None:
        check_camera(camera)
    parents = parents_of(attachments)
    return Sightings(
        state.frame + 1,
        parameters,
        parents if parameters.use_attachments else {},
        View(parameters, camera),
    )


def _columns_of(state: AnchoringState | CrowdState) -> AnchorColumns | None:
    """Give the anchors as columns; None if they have what columns do not hold."""
    if isinstance(state, CrowdState):
        return state.anchors
    return state.columns or columns_of_anchors(state.anchors)


def _state_of(crowd: CrowdState) -> AnchoringState:
    """Give the state with its anchors made."""
    return AnchoringState(
        crowd.anchors.anchors, crowd.dropped.anchors, crowd.register, crowd.frame, crowd.anchors
    )


def _step_of_crowd(
    old: AnchorColumns, detections: DetectionColumns, register: NameRegister, frame: Sightings
) -> CrowdState | AnchoringState | None:
    """Give the next state by columns, or None where they are of no use.

    Args:
        old: The anchors of the last frame.
        detections: Of this one, checked.
        register: The names given so far.
        frame: The circumstances.
    """
    met = sighted(old, detections, register, frame)
    if met is None:
        return None
    if not met.takes_attachments:
        return met.reasoned()
    return _explained(old, met.seen.anchors, met.lost.anchors, (), met.register, frame)


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
    return _explained(state.anchors, seen, lost, gone, register, frame)


def _explained(
    old: Sequence[Anchor],
    seen: Sequence[Anchor],
    lost: Sequence[Anchor],
    gone: Sequence[Anchor],
    register: NameRegister,
    frame: Sightings,
) -> AnchoringState:
    """Give the next state, in which what is lost has been reasoned about.

    Args:
        old: The anchors of the last frame.
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
    moves = _moves_of_parents(old, seen, frame.parents)
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
    aligned = who_is_who(anchors, detections, frame)
    seen = frame.of_pairs(aligned.pairs)
    if not aligned.appeared:
        return seen, aligned.lost, register
    new, register = _named(aligned.appeared, anchors, register, frame)
    return sorted(seen + new, key=_by_name), aligned.lost, register


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
