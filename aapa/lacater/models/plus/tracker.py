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
from aapa.lacater.models.plus.appearance import Appearance
from aapa.lacater.models.plus.belonging import Belonging
from aapa.lacater.models.plus.carrying import NO_TRIM, Bond, Trim, trim_of, trimmed, untrimmed
from aapa.lacater.models.plus.containment import REACH
from aapa.lacater.models.plus.ground import GroundView, Place
from aapa.lacater.models.plus.hiding import behind
from aapa.lacater.models.plus.ideas import Ideas
from aapa.lacater.models.plus.insight import Insight
from aapa.lacater.models.plus.paths import Path
from aapa.lacater.models.plus.reasons import Belief, Ground, belief, confidence
from aapa.lacater.models.plus.rivals import OUTSIDE
from aapa.lacater.models.plus.scenery import Boxes, Scenery
from aapa.lacater.models.plus.solids import SNITCH_SOLID
from aapa.lacater.models.plus.standing import TRIM_SHARE, foot_of, stands
from aapa.lacater.models.plus.suspicion import Suspicion
from aapa.lacater.models.plus.things import STILL, Thing, distance
from aapa.lacater.models.rounding import rounded

SLID: Final = frozenset({"slide"})
"""Actions that push a thing along the floor, with all that stands in it."""

LIFTED: Final = frozenset({"pick-place", "contain"})
"""Actions that lift a thing, and set it down elsewhere."""

_FLICKER_PX: Final = 1.5
_PAUSE_PX: Final = 0.2
_MISSED: Final = 3
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
        self._appearance = Appearance()
        self._suspicion = Suspicion(ideas, self._scenery, self._belonging, self._snitch)
        self._ground = Ground.UNSEEN
        self._slides = False
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
        self._suspicion.hear(frame)
        if self._scenery.look(frame, self._believed):
            self._see(frame.number)
        elif self._box is not None:
            self._ground = Ground.REMEMBERED
            if self._ideas.geometry and not self._uncovered() and self._snitch not in self._paths:
                self._suspicion.look(self._box)
            self._reason(frame.number)
        for name in [name for name, path in self._paths.items() if path.end <= frame.number]:
            del self._paths[name]
        return None if self._box is None else rounded(self._box)

    @property
    def view(self) -> GroundView | None:
        """The camera as it has been found out so far."""
        return self._scenery.view

    @property
    def belief(self) -> Belief:
        """Why the snitch is taken to be where it is, how sure that is, and where else it may be."""
        containers = [self._belonging.parents[child] for child in self._chain()]
        thing = self._scenery.things.get(self._snitch)
        root = self._scenery.things.get(self._belonging.outermost(self._snitch))
        return belief(
            self._ground,
            containers,
            self._suspicion.ranked,
            0 if thing is None else thing.missed,
            moves=root is not None and (root.moving or root.roaming),
        )

    @property
    def confidence(self) -> float:
        """How sure that is, in [0, 1]."""
        held = self._belonging.outermost(self._snitch)
        outside = held == self._snitch
        return confidence(self._ground, OUTSIDE if outside else held, self._suspicion.ranked)

    @property
    def insight(self) -> Insight:
        """What the last answer was made of, before it was rounded."""
        name, scenery = self._snitch, self._scenery
        outermost = self._belonging.outermost(name)
        path = self._paths.get(name) or self._paths.get(outermost)
        trim = self._trim if self._bond is None else self._bond.trim
        known = self._box, self._ground, scenery, self._appearance
        return Insight(*known, name, outermost, path, trim)

    @property
    def parents(self) -> Mapping[str, str]:
        """What is believed to stand in what, child to parent, reported or inferred."""
        return self._belonging.parents

    # What is reported

    def _hear(self, report: ActionReport, frame: int) -> None:
        if not report.args or report.args[0] not in self._scenery.things:
            return
        if report.status == "succeeded":
            self._has_ended(report)
        else:
            self._has_begun(report, frame)

    def _has_ended(self, report: ActionReport) -> None:
        name = report.args[0]
        for other in self._scenery.alike(name):
            self._scenery.things[other].come_to_rest()
        if name == self._snitch:
            self._slides = False
            if report.action not in SLID | LIFTED:
                self._appearance.forget()

    def _has_begun(self, report: ActionReport, frame: int) -> None:
        name, things = report.args[0], self._scenery.things
        alike = self._scenery.alike(name)
        for other in alike:
            if other not in self._belonging.parents:
                self._scenery.keep_sample(other)
        if name == self._snitch:
            self._slides = report.action in SLID
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
            unseen = self._scenery.things[name].missed > 0
            lifted = report.action in LIFTED
            self._paths[name] = Path(origin, frame, end, lifted=lifted, sure=not unseen)

    def _place_of_snitch(self) -> Place | None:
        view = self._scenery.camera()
        if view is None or self._box is None:
            return None
        place = view.place(SNITCH_SOLID, self._box)
        if place is not None:
            self._trim = trim_of(view, place, self._box, 1.0, self._appearance.more(view, place))
        return place

    # What is seen

    def _believed(self, boxes: Boxes) -> Boxes:
        """Of boxes of the snitch, give those that show it, though it may be contained.

        Where it was never seen, any sighting says more than none.
        """
        if self._belonging.is_reported(self._snitch):
            return [] if self._ideas.lock and self._box is not None else boxes
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
        self._bond, self._ground = None, Ground.SEEN
        self._suspicion.forget()
        self._belonging.forget(*self._belonging.inferred)
        self._box = self._scenery.box_of(self._snitch)
        if self._box is None:
            return
        path, view = self._paths.get(self._snitch), self._scenery.view
        if path is None or path.height(frame) == 0.0:
            self._appearance.add(self._box, again=self._scenery.things[self._snitch].seen > 1)
        if path is None or view is None:
            return
        lift = LIFT * path.height(frame)
        plain = untrimmed(view, path.place(frame) or path.origin, self._trim, self._box, lift)
        place = view.place(SNITCH_SOLID, plain, lift)
        if place is not None:
            path.add(frame, place)

    # What is inferred

    def _uncovered(self) -> bool:
        """Tell whether a cone is seen again that was believed to stand in another one."""
        outermost = self._belonging.outermost(self._snitch)
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
            reported = all(map(self._belonging.is_reported, self._chain()))
            self._ground = Ground.REPORTED if reported else Ground.INFERRED
            bond = self._bond_with(root)
            if bond is not None:
                self._carry(bond, self._scenery.things[root], frame)
            return
        self._bond = None
        path = self._paths.get(self._snitch)
        place = None if path is None else path.place(frame)
        if path is not None and place is not None:
            self._ground = Ground.ON_PATH
            self._put(place, self._trim, LIFT * path.height(frame))
            if not path.lifted:
                self._bound()
        elif self._ideas.bounded and self._ideas.hidden_motion and path is None:
            self._go_on()

    def _bound(self) -> None:
        """Put what is not seen back behind what can hide it."""
        if self._box is not None and self._ideas.bounded:
            # A detector that flickers misses at times what is in full view.
            least = _MISSED if self._scenery.is_noisy else 1
            if self._scenery.things[self._snitch].missed >= least:
                self._box = behind(self._box, self._in_front()) or self._box

    def _go_on(self) -> None:
        """Lead a move of unknown end on, as far as it can go unseen."""
        thing = self._scenery.things.get(self._snitch)
        if self._box is None or thing is None or not self._slides:
            return
        if math.hypot(*thing.pace) < _FLICKER_PX:
            return
        ahead = moved(self._box, *thing.pace)
        hidden = behind(ahead, self._in_front())
        if hidden != ahead:
            # It has come to the end of what hides it: it would be seen if it had not stopped.
            thing.pace = STILL
        self._ground = Ground.GOES_ON
        self._box = hidden or self._box

    def _in_front(self) -> list[Box]:
        parents = self._belonging.parents
        return [box for name, box in self._scenery.seen() if name not in parents]

    def _chain(self) -> list[str]:
        """Give the snitch and all that it stands in, but for the outermost."""
        chain, name = [], self._snitch
        while name in self._belonging.parents:
            chain.append(name)
            name = self._belonging.parents[name]
        return chain

    def _root_of_snitch(self) -> str | None:
        root = self._belonging.outermost(self._snitch)
        return root if root != self._snitch and root in self._scenery.things else None

    def _carry(self, bond: Bond, thing: Thing, frame: int) -> None:
        path = self._paths.get(bond.root)
        box = None if thing.missed else self._scenery.box_of(bond.root)
        if not (thing.moving or thing.roaming or path is not None):
            self._rest(bond, box)
            return
        if box is None:
            bond.lost = True
        elif self._box is not None:
            if distance(box, bond.stood) < _PAUSE_PX:
                bond.rested = self._box
            bond.stood = box
        if bond.place is None:
            if box is not None:
                (u, v), (u0, v0) = centre_of(box), centre_of(bond.since)
                self._box = moved(bond.child, u - u0, v - v0)
            return
        place = None if box is None else foot_of(self._scenery, bond, box)
        if box is not None and place is None and thing.roaming:
            # Nobody said so, but it leaves the floor, and what it covered stays behind.
            self._box = bond.rested
            self._suspicion.rule_out(bond.root)
            self._belonging.deny(bond.root)
            return
        if path is not None:
            place = self._follow(bond, path, frame, place)
        if place is not None:
            bond.place = place
            self._put(place, bond.trim)

    def _follow(self, bond: Bond, path: Path, frame: int, place: Place | None) -> Place | None:
        """Give where the container is by all that was seen of its way."""
        if place is not None:
            path.add(frame, place)
            self._trim_anew(bond, path.origin)
        return path.place(frame) or place

    def _rest(self, bond: Bond, box: Box | None) -> None:
        """Keep the child where it is, unless its container was moved while it was not seen."""
        if bond.lost and box is not None:
            self._find_again(bond, box)
        bond.lost = bond.lost or box is None
        if self._box is not None:
            bond.rested = self._box

    def _find_again(self, bond: Bond, box: Box) -> None:
        """Go after a container that was moved while it was not seen."""
        place = foot_of(self._scenery, bond, box)
        if place is None:
            return
        bond.lost = False
        if bond.place is not None and math.dist(place, bond.place) > REACH:
            bond.place = place
            self._put(place, bond.trim)

    def _trim_anew(self, bond: Bond, origin: Place) -> None:
        """Compare the child's box once more, now that it is better known where it stood."""
        if self._scenery.view is not None and bond.rested == bond.child:
            view = self._scenery.view
            more = self._appearance.more(view, origin)
            bond.trim = trim_of(view, origin, bond.child, TRIM_SHARE, more)

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
            place, trim, is_late = stands(self._scenery, self._appearance, root, box, self._box)
            if is_late and place is not None:
                self._put(place, trim)
        lost = self._scenery.things[root].missed > 0
        self._bond = Bond(root, place, trim, box, self._box, self._box, box, lost)
        return self._bond
