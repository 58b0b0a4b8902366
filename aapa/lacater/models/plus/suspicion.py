"""What may contain the snitch, though nobody reported it: asked while it is not seen."""

from __future__ import annotations

from aapa.boxes import centre_of
from aapa.detections import Box
from aapa.lacater.models.model import Frame
from aapa.lacater.models.plus.belonging import Belonging
from aapa.lacater.models.plus.containment import distances
from aapa.lacater.models.plus.ideas import Ideas
from aapa.lacater.models.plus.rivals import OUTSIDE, Rival, Rivals
from aapa.lacater.models.plus.scenery import Scenery
from aapa.lacater.models.plus.solids import SNITCH_SOLID

_SETS_OVER = "contain"


class Suspicion:
    """Finds out from what stands where which cone the hidden snitch is in.

    Args:
        ideas: Which of them are used.
        scenery: What is seen.
        belonging: What is believed to stand in what; it is told what is found out.
        snitch: Its name.
    """

    def __init__(self, ideas: Ideas, scenery: Scenery, belonging: Belonging, snitch: str) -> None:
        self._ideas = ideas
        self._scenery = scenery
        self._belonging = belonging
        self._snitch = snitch
        self._rivals = Rivals()
        self._of = snitch
        self._told = False

    @property
    def ranked(self) -> tuple[Rival, ...]:
        """All places where it may be, the surest first; empty where there is no such doubt."""
        return self._rivals.ranked if self._rivals.are_several else ()

    def hear(self, frame: Frame) -> None:
        """Note whether something has been set over something, without a word of what."""
        self._told = self._ideas.reports and any(
            report.action == _SETS_OVER and report.status == "succeeded" and not report.args
            for report in frame.actions
        )

    def forget(self) -> None:
        """It is seen: nothing of this is in doubt any more."""
        if self._rivals.are_several:
            self._rivals, self._of = Rivals(), self._snitch

    def rule_out(self, container: str) -> None:
        """No longer believe in one of the cones: it was seen to leave it behind."""
        self._rivals.rule_out(container)

    def look(self, box: Box) -> None:
        """Believe that it is in the cone that stands, the most surely, where it vanished.

        Args:
            box: Where it vanished, px; or with it, the cone that it is in.
        """
        outermost = self._belonging.outermost(self._snitch)
        thing = self._scenery.things.get(outermost)
        if thing is None or not thing.missed:
            return
        far = self._distances(outermost, box)
        if self._of != outermost:
            self._of, self._rivals = outermost, Rivals()
        if self._ideas.rivals:
            self._rivals.weigh(far, told=self._told)
            surest = self._rivals.ranked[0].container
        else:
            surest = min(far, key=lambda name: far[name], default=OUTSIDE)
        if surest in far:
            self._belonging.infer(outermost, surest)

    def _distances(self, outermost: str, box: Box) -> dict[str, float]:
        """Give how far off the cones stand that are seen about the box and could hold a thing."""
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
            return {}
        radius = self._scenery.solids.get(outermost, SNITCH_SOLID).radius
        return distances(view, place, radius, cones)


def _around(outer: Box, inner: Box) -> bool:
    """Tell whether the middle of a box lies within another."""
    u, v = centre_of(inner)
    return outer[0] <= u <= outer[2] and outer[1] <= v <= outer[3]
