"""`aapa-plus`: the snitch's box, with what the paper's anchoring leaves to be wished for.

Who moves with whom comes from the engine, as it does for AAPA. What is added is geometry, and the
knowledge of what moves and what rests: `ideas.py` lists what can be switched off.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Final

from aapa.boxes import centre_of, moved
from aapa.detections import Box
from aapa.lacater.classes import SNITCH
from aapa.lacater.generator.motion import LIFT
from aapa.lacater.models.model import ActionReport, Frame
from aapa.lacater.models.plus.belonging import Belonging
from aapa.lacater.models.plus.carrying import NO_TRIM, Bond, Trim, trim_of, trimmed, untrimmed
from aapa.lacater.models.plus.containment import FITS_PX, REACH, container_at, misfit, on_floor
from aapa.lacater.models.plus.ground import GroundView, Place
from aapa.lacater.models.plus.ideas import Ideas
from aapa.lacater.models.plus.paths import Path
from aapa.lacater.models.plus.scenery import Boxes, Scenery
from aapa.lacater.models.plus.solids import SNITCH_SOLID
from aapa.lacater.models.plus.things import Thing, distance

SLID: Final = frozenset({"slide"})
"""Actions that push a thing along the floor, with all that stands in it."""

LIFTED: Final = frozenset({"pick-place", "contain"})
"""Actions that lift a thing, and set it down elsewhere."""

_TRIM_SHARE: Final = 0.6
_FITS_STEADY_PX: Final = 1.6
_LONG_UNSEEN: Final = 5
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
        self._scenery = Scenery(ideas, cast, SNITCH)
        self._belonging = Belonging()
        self._snitch = next((name for name, number in cast.items() if number == SNITCH), "")
        self._paths: dict[str, Path] = {}
        self._box: Box | None = None
        self._bond: Bond | None = None
        self._trim: Trim = NO_TRIM
        self._elsewhere = 0

    def observe(self, frame: Frame) -> Box | None:
        """Take in one frame, and give the snitch's box, px; None until it was seen.

        Raises:
            AnchoringError: The attachments run in a circle, or a child has two parents.
        """
        if self._ideas.reports:
            self._belonging.report(frame.attachments)
            for report in frame.actions:
                self._hear(report, frame.number)
        if self._scenery.look(frame, self._believed):
            self._see(frame.number)
        elif self._box is not None:
            if self._ideas.geometry:
                self._infer(self._box)
            self._reason(frame.number)
        for name in [name for name, path in self._paths.items() if path.end <= frame.number]:
            del self._paths[name]
        return None if self._box is None else rounded(self._box)

    @property
    def view(self) -> GroundView | None:
        """The camera as it has been found out so far."""
        return self._scenery.view

    @property
    def parents(self) -> Mapping[str, str]:
        """What is believed to stand in what, child to parent, reported or inferred."""
        return self._belonging.parents

    # What is reported

    def _hear(self, report: ActionReport, frame: int) -> None:
        things = self._scenery.things
        if not report.args or report.args[0] not in things:
            return
        name = report.args[0]
        alike = self._scenery.alike(name)
        if report.status == "succeeded":
            for other in alike:
                things[other].come_to_rest()
            return
        for other in alike:
            if other not in self._belonging.parents:
                self._scenery.keep_sample(other)
        self._set_on_path(report, frame)
        for other in alike:
            things[other].set_off()
        if report.action in SLID:
            for child in self._belonging.children_of(name):
                if child in things:
                    things[child].free = True

    def _set_on_path(self, report: ActionReport, frame: int) -> None:
        name, end = report.args[0], report.planned_end
        if not self._ideas.planned_end or end is None or end <= frame:
            return
        if report.action not in SLID | LIFTED or name in self._belonging.parents:
            return
        origin: Place | None = None
        if name == self._snitch:
            origin = self._place_of_snitch() if self._ideas.hidden_motion else None
        elif report.action in SLID and name == self._root_of_snitch():
            bond = self._bond_with(name)
            origin = None if bond is None else bond.place
        if origin is not None:
            self._paths[name] = Path(origin, frame, end, lifted=report.action in LIFTED)

    def _place_of_snitch(self) -> Place | None:
        view = self._scenery.camera()
        if view is None or self._box is None:
            return None
        place = view.place(SNITCH_SOLID, self._box)
        if place is not None:
            self._trim = trim_of(view, place, self._box, 1.0)
        return place

    # What is seen

    def _believed(self, boxes: Boxes) -> Boxes:
        """Of boxes of the snitch, give those that show it, though it may be contained."""
        if self._belonging.is_reported(self._snitch):
            return [] if self._ideas.lock else boxes
        if self._snitch not in self._belonging.parents or self._box is None:
            return boxes
        here = self._box
        near = [box for box in boxes if distance(box, here) < _NEAR_PX]
        self._elsewhere = 0 if near else self._elsewhere + 1
        if near or self._elsewhere >= _INSISTS or not self._ideas.lock:
            self._scenery.things[self._snitch].free = True
            return near or boxes
        return []

    def _see(self, frame: int) -> None:
        self._bond = None
        self._belonging.forget(*self._belonging.inferred)
        self._box = self._scenery.box_of(self._snitch)
        path, view = self._paths.get(self._snitch), self._scenery.view
        if path is None or view is None or self._box is None:
            return
        lift = LIFT * path.height(frame)
        plain = untrimmed(view, path.place(frame) or path.origin, self._trim, self._box, lift)
        place = view.place(SNITCH_SOLID, plain, lift)
        if place is not None:
            path.add(frame, place)

    # What is inferred

    def _infer(self, box: Box) -> None:
        """Find out from what stands where that the hidden snitch is in a cone, or no longer is."""
        outermost = self._belonging.outermost(self._snitch)
        if self._uncovered(outermost) or self._snitch in self._paths:
            return
        thing = self._scenery.things.get(outermost)
        if thing is None or not thing.missed:
            return
        cones = [
            (name, solid, seen)
            for name, solid in self._scenery.solids.items()
            if solid.is_cone
            and name not in self._belonging.parents
            and self._scenery.things[name].is_settled
            and (seen := self._scenery.box_of(name)) is not None
            and _around(seen, box)
        ]
        view = self._scenery.camera() if cones else None
        place = None if view is None else view.place(SNITCH_SOLID, box)
        if view is None or place is None:
            return
        radius = self._scenery.solids.get(outermost, SNITCH_SOLID).radius
        container = container_at(view, place, radius, cones)
        if container is not None:
            self._belonging.infer(outermost, container)

    def _uncovered(self, outermost: str) -> bool:
        """Tell whether a cone is seen again that was believed to stand in another one."""
        things, bond = self._scenery.things, self._bond
        for child in self._belonging.inferred:
            if child != self._snitch and child in things and not things[child].missed:
                if bond is not None and bond.root == outermost and things[outermost].roaming:
                    # What is seen again has been uncovered, and stands where it stood.
                    self._box = bond.rested
                self._belonging.forget(child)
                return True
        return False

    # What follows for the hidden snitch

    def _reason(self, frame: int) -> None:
        root = self._root_of_snitch()
        if root is not None:
            bond = self._bond_with(root)
            if bond is not None:
                self._carry(bond, self._scenery.things[root], frame)
            return
        self._bond = None
        path = self._paths.get(self._snitch)
        place = None if path is None else path.place(frame)
        if path is not None and place is not None:
            self._put(place, self._trim, LIFT * path.height(frame))

    def _root_of_snitch(self) -> str | None:
        root = self._belonging.outermost(self._snitch)
        return root if root != self._snitch and root in self._scenery.things else None

    def _carry(self, bond: Bond, thing: Thing, frame: int) -> None:
        path = self._paths.get(bond.root)
        if not (thing.moving or thing.roaming or path is not None):
            if self._box is not None:
                bond.rested = self._box
            return
        box = None if thing.missed else self._scenery.box_of(bond.root)
        if bond.place is None:
            if box is not None:
                (u, v), (u0, v0) = centre_of(box), centre_of(bond.since)
                self._box = moved(bond.child, u - u0, v - v0)
            return
        place = None if box is None else self._on_floor(bond.root, box)
        if box is not None and place is None and thing.roaming:
            # Nobody said so, but it leaves the floor, and what it covered stays behind.
            self._box = bond.rested
            self._belonging.deny(bond.root)
            return
        if path is not None:
            if place is not None:
                path.add(frame, place)
                self._trim_anew(bond, path.origin)
            place = path.place(frame) or place
        if place is not None:
            bond.place = place
            self._put(place, bond.trim)

    def _trim_anew(self, bond: Bond, origin: Place) -> None:
        """Compare the child's box once more, now that it is better known where it stood."""
        if self._scenery.view is not None and bond.rested == bond.child:
            bond.trim = trim_of(self._scenery.view, origin, bond.child, _TRIM_SHARE)

    def _on_floor(self, name: str, box: Box) -> Place | None:
        view, solid = self._scenery.view, self._scenery.solids.get(name)
        if view is None or solid is None:
            return None
        fits = FITS_PX if self._scenery.is_noisy else _FITS_STEADY_PX
        bond = self._bond
        # How badly it fitted at rest is the calibration's fault, and says nothing of lifting.
        excuse = 0.0 if bond is None else misfit(view, solid, bond.since) or 0.0
        return on_floor(view, solid, box, fits + excuse)

    def _put(self, place: Place, trim: Trim, lift: float = 0.0) -> None:
        if self._scenery.view is None:
            return
        box = trimmed(self._scenery.view, place, trim, lift)
        if box is not None:
            self._box = box

    def _bond_with(self, root: str) -> Bond | None:
        """Give how the snitch stands in its container, noted when it is first asked for."""
        if self._bond is not None and self._bond.root == root:
            return self._bond
        if self._box is None:
            return None
        self._scenery.tell_apart(root, self._box)
        box = self._scenery.box_of(root)
        if box is None:
            return None
        place, trim = None, NO_TRIM
        if self._ideas.ground:
            place, trim = self._stand_in(root, box, self._box)
        self._bond = Bond(root, place, trim, box, self._box, self._box)
        return self._bond

    def _stand_in(self, root: str, box: Box, child: Box) -> tuple[Place | None, Trim]:
        """Give where a container and its child stand, and the trim of the child's box."""
        view, solid = self._scenery.camera(), self._scenery.solids.get(root)
        if view is None or solid is None:
            return None, NO_TRIM
        own = view.place(SNITCH_SOLID, child)
        # What has long been hidden itself may be anywhere; then the child's own box tells.
        stale = self._scenery.things[root].missed >= _LONG_UNSEEN
        place = own if stale else view.place(solid, box)
        if place is None:
            return None, NO_TRIM
        if own is not None and math.dist(place, own) > REACH:
            # The report comes late: the container has gone on, and the child with it.
            self._put(place, NO_TRIM)
            return place, NO_TRIM
        return place, trim_of(view, place, child, _TRIM_SHARE)


def rounded(box: Box) -> Box:
    """Round a box as labels are: the corner, and by themselves the width and the height.

    Example:
        >>> rounded((0.4, 0.6, 10.8, 10.8))
        (0, 1, 10, 11)
    """
    x, y = round(box[0]), round(box[1])
    return x, y, x + round(box[2] - box[0]), y + round(box[3] - box[1])


def _around(outer: Box, inner: Box) -> bool:
    """Tell whether the middle of a box lies within another."""
    u, v = centre_of(inner)
    return outer[0] <= u <= outer[2] and outer[1] <= v <= outer[3]
