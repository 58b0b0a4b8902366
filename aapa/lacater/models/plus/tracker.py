"""`aapa-plus`: the snitch's box, with what the paper's anchoring leaves to be wished for.

Who moves with whom comes from the engine, as it does for AAPA. What is added is geometry, and the
knowledge of what moves and what rests: `ideas.py` lists what can be switched off.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Final

from aapa.boxes import centre_of, moved
from aapa.detections import Box
from aapa.hierarchy import parents_of
from aapa.lacater.classes import SNITCH
from aapa.lacater.generator.motion import LIFT
from aapa.lacater.models.model import ActionReport, Frame
from aapa.lacater.models.plus.calibration import calibrated
from aapa.lacater.models.plus.carrying import NO_TRIM, Bond, Trim, trim_of, trimmed, untrimmed
from aapa.lacater.models.plus.containment import container_at, on_floor
from aapa.lacater.models.plus.ground import GroundView, Place
from aapa.lacater.models.plus.ideas import Ideas
from aapa.lacater.models.plus.paths import Path
from aapa.lacater.models.plus.solids import SNITCH_SOLID, Solid, solid_of
from aapa.lacater.models.plus.things import Thing, distance
from aapa.lacater.video import HEIGHT, WIDTH

SLID: Final = frozenset({"slide"})
LIFTED: Final = frozenset({"pick-place", "contain"})

START_VIEW: Final = GroundView(height=5.0, pitch=0.5, focal=350.0, size=(WIDTH, HEIGHT))
"""Where self-calibration starts; the focal length is that of CATER's lens."""

_MOST_SAMPLES: Final = 40
_TRIM_SHARE: Final = 0.6
_HALF_PX: Final = 0.5
_NOISY: Final = 0.45
_FLICKER_PX: Final = 2.5
_STEADY_PX: Final = 0.3
_NEAR_PX: Final = 15.0
_INSISTS: Final = 3


class BeyondAapa:
    """Follows the snitch through a video.

    Args:
        ideas: Which of them are used.
        cast: The class number of each object that actions may name.
    """

    def __init__(self, ideas: Ideas, cast: Mapping[str, int]) -> None:
        self._ideas = ideas
        self._things = {name: Thing(number) for name, number in cast.items()}
        self._of_class: dict[int, list[str]] = {}
        for name, number in cast.items():
            self._of_class.setdefault(number, []).append(name)
        self._snitch = self._of_class.get(SNITCH, [""])[0]
        self._solids: dict[str, Solid] = {
            name: solid
            for name, number in cast.items()
            if number != SNITCH and (solid := solid_of(number)) is not None
        }
        self._parents: dict[str, str] = {}
        self._pairs: object = ()
        self._paths: dict[str, Path] = {}
        self._view: GroundView | None = None
        self._samples: list[tuple[Solid, Box]] = []
        self._sampled = 0
        self._box: Box | None = None
        self._bond: Bond | None = None
        self._trim: Trim = NO_TRIM
        self._at_rest = self._changed = 0
        self._reported: dict[str, str] = {}
        self._inferred: dict[str, str] = {}
        self._elsewhere = 0

    def observe(self, frame: Frame) -> Box | None:
        """Take in one frame, and give the snitch's box, px; None until it was seen."""
        if self._ideas.reports:
            if frame.attachments is not self._pairs:
                self._pairs = frame.attachments
                self._reported = parents_of(frame.attachments)
                self._unite()
            for report in frame.actions:
                self._hear(report, frame.number)
        seen = self._look(frame)
        if self._ideas.geometry:
            self._infer(seen)
        self._conclude(frame.number, seen)
        for name in [name for name, path in self._paths.items() if path.end <= frame.number]:
            del self._paths[name]
        return None if self._box is None else rounded(self._box)

    @property
    def view(self) -> GroundView | None:
        """The camera as it has been found out so far."""
        return self._view

    def _hear(self, report: ActionReport, frame: int) -> None:
        if not report.args or report.args[0] not in self._things:
            return
        name = report.args[0]
        alike = self._of_class[self._things[name].number]
        if report.status == "succeeded":
            for other in alike:
                self._things[other].come_to_rest()
            return
        for other in alike:
            self._sample(other)
        if report.planned_end is not None and report.planned_end > frame:
            self._set_on_path(report, frame)
        for other in alike:
            self._things[other].set_off()
        if report.action in SLID:
            self._free_all_in(name)

    def _free_all_in(self, name: str) -> None:
        for child, parent in self._parents.items():
            if parent == name:
                self._things[child].free = True
                self._free_all_in(child)

    def _set_on_path(self, report: ActionReport, frame: int) -> None:
        name, end = report.args[0], report.planned_end
        if not self._ideas.planned_end or end is None:
            return
        if report.action not in SLID | LIFTED or name in self._parents:
            return
        origin: Place | None = None
        if name == self._snitch:
            if self._ideas.hidden_motion and self._box is not None:
                origin = self._place_of_snitch()
        elif self._bond is not None and self._bond.root == name and report.action in SLID:
            origin = self._bond.place
        elif self._root_of_snitch() == name and report.action in SLID:
            self._bind(name)
            origin = None if self._bond is None else self._bond.place
        if origin is not None:
            self._paths[name] = Path(origin, frame, end, lifted=report.action in LIFTED)

    def _place_of_snitch(self) -> Place | None:
        view = self._camera()
        if view is None or self._box is None:
            return None
        place = view.place(SNITCH_SOLID, self._box)
        if place is not None:
            self._trim = trim_of(view, place, self._box, 1.0)
        return place

    def _unite(self) -> None:
        """Take together what is reported and what is inferred; a report counts for more."""
        for child in self._reported:
            self._inferred.pop(child, None)
        self._parents = {**self._inferred, **self._reported}

    def _infer(self, seen: bool) -> None:
        """Find out from where things stand that the snitch is in a cone, or no longer is."""
        outermost = self._root_of_snitch() or self._snitch
        if seen:
            if self._inferred:
                self._inferred.clear()
                self._unite()
            return
        for child in list(self._inferred):
            if child != self._snitch and child in self._things and not self._things[child].missed:
                del self._inferred[child]
                self._unite()
                return
        thing = self._things.get(outermost)
        if thing is None or not thing.missed or self._box is None or self._snitch in self._paths:
            return
        cones = [
            (name, solid, box)
            for name, solid in self._solids.items()
            if solid.is_cone
            and name != outermost
            and not (other := self._things[name]).missed
            and other.seen > 1
            and not other.roaming
            and name not in self._parents
            and (box := self._seen_box(name)) is not None
            and _around(box, self._box)
        ]
        if not cones:
            return
        view = self._camera()
        if view is None:
            return
        place = view.place(SNITCH_SOLID, self._box)
        radius = self._solids.get(outermost, SNITCH_SOLID).radius
        if place is None:
            return
        container = container_at(view, place, radius, cones)
        if container is not None:
            self._inferred[outermost] = container
            self._unite()

    def _believed(self, boxes: list[list[int]]) -> list[list[int]]:
        """Of boxes of the snitch, give those that show it, though it is thought to be contained."""
        if self._snitch in self._reported:
            return [] if self._ideas.lock else boxes
        if self._snitch not in self._inferred or self._box is None:
            return boxes
        here = self._box
        near = [box for box in boxes if distance(box, here) < _NEAR_PX]
        self._elsewhere = 0 if near else self._elsewhere + 1
        if near or self._elsewhere >= _INSISTS or not self._ideas.lock:
            self._things[self._snitch].free = True
            return near or boxes
        return []

    def _look(self, frame: Frame) -> bool:
        found: dict[int, list[list[int]]] = {}
        for number, box in zip(frame.classes.tolist(), frame.boxes.tolist(), strict=True):
            found.setdefault(number, []).append(box)
        seen = False
        strict = self._ideas.rest
        flicker = _FLICKER_PX if self._is_noisy else _STEADY_PX
        for number, names in self._of_class.items():
            boxes = found.get(number)
            if boxes is None:
                for name in names:
                    self._things[name].missed += 1
                continue
            left: list[list[int]] = boxes
            if number == SNITCH and self._parents:
                left = self._believed(boxes)
            for name in names:
                thing = self._things[name]
                before, rested = thing.box, thing.seen
                index = thing.offer(left, strict, flicker)
                if index is None:
                    continue
                if rested and not thing.moving:
                    self._at_rest += 1
                    self._changed += before != thing.box
                if len(names) > 1:
                    left = left[:index] + left[index + 1 :]
                seen = seen or number == SNITCH
        return seen

    @property
    def _offset(self) -> float:
        """Px by which boxes lie too low in number: those of a detector that are cut to whole px."""
        return _HALF_PX if self._is_noisy else 0.0

    @property
    def _is_noisy(self) -> bool:
        """Whether boxes of what is at rest differ from frame to frame."""
        return self._changed > _NOISY * self._at_rest

    def _seen_box(self, name: str) -> Box | None:
        """Give the box of a thing as well as it is known, px."""
        thing = self._things[name]
        if self._ideas.rest:
            box = thing.mean
            return None if box is None else moved(box, self._offset, self._offset)
        return None if thing.box is None else _box(thing.box)

    def _conclude(self, frame: int, seen: bool) -> None:
        path = self._paths.get(self._snitch)
        if seen:
            self._bond = None
            self._box = self._seen_box(self._snitch)
            if path is not None and self._box is not None:
                self._follow(path, frame, self._box)
            return
        if self._box is None:
            return
        root = self._root_of_snitch()
        if root is not None:
            self._carry(root, frame)
            return
        self._bond = None
        if path is not None and self._view is not None:
            place = path.place(frame)
            if place is not None:
                self._box = self._put(place, self._trim, LIFT * path.height(frame))

    def _follow(self, path: Path, frame: int, box: Box) -> None:
        """Take in where the snitch is seen on its way."""
        if self._view is None:
            return
        lift = LIFT * path.height(frame)
        guess = path.place(frame) or path.origin
        plain = untrimmed(self._view, guess, self._trim, box, lift)
        place = self._view.place(SNITCH_SOLID, plain, lift)
        if place is not None:
            path.add(frame, place)

    def _root_of_snitch(self) -> str | None:
        root = self._parents.get(self._snitch)
        while root is not None and root in self._parents:
            root = self._parents[root]
        return root if root in self._things else None

    def _carry(self, root: str, frame: int) -> None:
        if self._bond is None or self._bond.root != root:
            self._bind(root)
        bond, thing = self._bond, self._things[root]
        path = self._paths.get(root)
        if bond is None or not (thing.moving or thing.roaming or path is not None):
            return
        seen = thing.missed == 0
        box = self._seen_box(root) if seen else None
        if not self._ideas.ground or bond.place is None or self._view is None:
            if box is not None:
                (u, v), (u0, v0) = centre_of(box), centre_of(bond.since)
                self._box = moved(bond.child, u - u0, v - v0)
            return
        # A cone that leaves the floor has been lifted off what it covered.
        place = None if box is None else on_floor(self._view, self._solids[root], box)
        if path is not None:
            if place is not None:
                path.add(frame, place)
            place = path.place(frame) or place
        if place is not None:
            bond.place = place
            self._box = self._put(place, bond.trim)

    def _put(self, place: Place, trim: Trim, lift: float = 0.0) -> Box | None:
        assert self._view is not None
        try:
            return trimmed(self._view, place, trim, lift)
        except ValueError:
            return self._box

    def _bind(self, root: str) -> None:
        """Note how the snitch stands in a container that has just been set over it."""
        if self._box is None:
            return
        self._tell_twins_apart(root)
        box = self._seen_box(root)
        if box is None:
            return
        place: Place | None = None
        trim = NO_TRIM
        view = self._camera() if self._ideas.ground else None
        if view is not None and root in self._solids:
            place = view.place(self._solids[root], box)
            if place is not None:
                try:
                    trim = trim_of(view, place, self._box, _TRIM_SHARE)
                except ValueError:
                    place = None
        self._bond = Bond(root, place, trim, box, self._box)

    def _tell_twins_apart(self, root: str) -> None:
        """Of several alike the one that is nearest to the snitch has been set over it."""
        alike = self._of_class[self._things[root].number]
        if len(alike) == 1 or self._box is None:
            return
        u, v = centre_of(self._box)

        def far(name: str) -> float:
            box = self._things[name].box
            if box is None:
                return math.inf
            return math.hypot((box[0] + box[2]) / 2 - u, (box[1] + box[3]) / 2 - v)

        nearest = min(alike, key=far)
        things = self._things
        things[root], things[nearest] = things[nearest], things[root]

    def _sample(self, name: str) -> None:
        """Keep the box of what has been at rest, for the calibration."""
        thing = self._things[name]
        solid = self._solids.get(name)
        if solid is None or not thing.seen or name in self._parents:
            return
        box = self._seen_box(name)
        if box is not None and len(self._samples) < _MOST_SAMPLES:
            self._samples.append((solid, box))

    def _camera(self) -> GroundView | None:
        """Give the camera, found anew where more has been seen since."""
        now = [
            (solid, box)
            for name, solid in self._solids.items()
            if self._things[name].seen
            and name not in self._parents
            and (box := self._seen_box(name)) is not None
        ]
        seen = [*self._samples, *now]
        if self._view is None or len(self._samples) > self._sampled:
            self._sampled = len(self._samples)
            self._view = calibrated(self._view or START_VIEW, seen) or self._view
        return self._view


def rounded(box: Box) -> Box:
    """Round a box as labels are: the corner, and by themselves the width and the height."""
    x, y = round(box[0]), round(box[1])
    return x, y, x + round(box[2] - box[0]), y + round(box[3] - box[1])


def _around(outer: Box, inner: Box) -> bool:
    """Tell whether the middle of a box lies within another."""
    u, v = centre_of(inner)
    return outer[0] <= u <= outer[2] and outer[1] <= v <= outer[3]


def _box(values: Sequence[float]) -> Box:
    x1, y1, x2, y2 = values
    return x1, y1, x2, y2
