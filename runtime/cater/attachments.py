"""What the engine believes of who moves with whom, frame by frame, from a video's recorded actions.

The domain alone says which actions attach and which detach. An action that attaches has done so
when it has ended; one that detaches has done so as soon as it begins, for what is lifted off holds
no longer. The engine is stepped where something is reported, and its hierarchy is kept between.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

from aapa.anchors import Attachment
from aapa.lacater.models import ActionReport
from aapa.lacater.scene import Scene
from icarus_lite import Action, Outcome, Status
from icarus_lite.inference import InferenceEngine, Memory
from icarus_lite.language.syntax import Domain
from icarus_lite.symbols import ATTACHED

_NOTHING = "_no_op"
"""CATER's record of an object with which nothing was done."""


@dataclass(frozen=True, slots=True)
class TimedAction:
    """An action that took place.

    Args:
        name: In the words of the domain, such as "pick-place".
        args: The objects, as the scene names them, the one that moves first.
        start: Its first frame.
        end: Its last frame.
    """

    name: str
    args: tuple[str, ...]
    start: int
    end: int


@dataclass(frozen=True, slots=True)
class FrameReports:
    """What is known of the actions in one frame.

    Args:
        actions: What begins or ends in it.
        attachments: (child, parent) pairs believed after the frame before, oldest first.
    """

    actions: tuple[ActionReport, ...] = ()
    attachments: tuple[Attachment, ...] = ()


def timed_actions(scene: Scene) -> tuple[TimedAction, ...]:
    """Give a scene's actions in the order in which they begin.

    CATER's "_pick_place" of a cone is (pick-place Cone_0), its "_contain" of the snitch
    (contain Cone_0 Spl_0). What a stack does stands in the record of each of its objects.
    """
    actions = [
        TimedAction(
            move.action.strip("_").replace("_", "-"),
            (instance,) if move.other is None else (instance, move.other),
            move.start,
            move.end,
        )
        for instance, moves in scene.movements.items()
        for move in moves
        if move.action != _NOTHING
    ]
    return tuple(sorted(actions, key=lambda action: (action.start, action.end, action.args)))


class AttachmentEngine:
    """Infers attachments from actions, with the rules of a domain.

    Args:
        domain: Its attachment rules, and its skills where their effects attach or detach.
    """

    def __init__(self, domain: Domain) -> None:
        self._engine = InferenceEngine(_that_attaches(domain))
        attaching = {rule.attach.predicate for rule in domain.attachments}
        detaching = {rule.until.predicate for rule in domain.attachments if rule.until is not None}
        self._works_at_once = frozenset(detaching - attaching)

    def reports(self, actions: Iterable[TimedAction], frames: int) -> tuple[FrameReports, ...]:
        """Give what is known of the actions in each frame of a video.

        Args:
            actions: In any order.
            frames: The length of the video.
        """
        told = _told(actions)
        reports: list[FrameReports] = []
        memory, attachments = Memory(), tuple[Attachment, ...]()
        for frame in range(frames):
            now = told.get(frame, ())
            reports.append(FrameReports(now, attachments))
            outcomes = [self._outcome(report) for report in now if self._counts(report)]
            if outcomes:
                memory = self._engine.step(memory, (), outcomes)
                pairs = memory.state.hierarchy.pairs()
                attachments = tuple(Attachment(str(child), str(parent)) for child, parent in pairs)
        return tuple(reports)

    def _counts(self, report: ActionReport) -> bool:
        begins = report.status == "running"
        return begins == (report.action in self._works_at_once)

    def _outcome(self, report: ActionReport) -> Outcome:
        return Outcome(Action(report.action, report.args), Status.SUCCEEDED)


def _told(actions: Iterable[TimedAction]) -> dict[int, tuple[ActionReport, ...]]:
    """Give what is reported in each frame; in one frame, what ends is told before what begins."""
    ordered = sorted(actions, key=lambda action: (action.start, action.end, action.args))
    told: dict[int, tuple[ActionReport, ...]] = {}
    for action in ordered:
        ended = ActionReport(action.name, action.args, "succeeded")
        told[action.end] = (*told.get(action.end, ()), ended)
    for action in ordered:
        begun = ActionReport(action.name, action.args, "running", action.end)
        told[action.start] = (*told.get(action.start, ()), begun)
    return told


def _that_attaches(domain: Domain) -> Domain:
    """Give the domain without what has no bearing on the attachments.

    They follow from the attachment rules and from skills with `attached` among their effects.
    Where there is no such skill, nothing else is needed; where there is one, its conditions may
    rest on any concept, and all is kept. Contradictions are left out: nothing is perceived here
    that could speak against an attachment.
    """
    effects: Sequence[str] = [
        effect.atom.predicate for skill in domain.skills for effect in skill.effects
    ]
    if ATTACHED in effects:
        return replace(domain, contradictions=())
    return replace(domain, concepts=(), skills=(), contradictions=())
