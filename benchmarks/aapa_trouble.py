"""AAPA and aapa-plus when actions are reported late, not at all, or without a word of what with."""

from __future__ import annotations

import random
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from aapa.lacater.layout import PerceptionKind
from aapa.lacater.metric import TASKS, VideoScore, first_sighting, score_video, table_row
from aapa.lacater.models import Frame, model_named
from aapa.lacater.reading import Dataset
from icarus_lite import load_domain
from runtime.cater.attachments import AttachmentEngine, TimedAction, timed_actions
from runtime.cater.evaluate import cater_domain
from runtime.cater.evaluation import cast_of, frames_of, run_model

TROUBLED = ("aapa-10000", "aapa-plus", "aapa-plus-without-rivals")
LATE_FRAMES = 10
LOST_SHARE = 1 / 3

TROUBLE = """A report that comes late finds the cone already on its way; one that never comes leaves
the snitch without a container. `aapa-plus` then believes what it sees: a cone that stands where
something vanished contains it, and what is seen to move moves. Where it is said that something is
done, but not with what, it weighs all cones that may contain the snitch from frame to frame;
`without-rivals` believes in the nearest at once."""


@dataclass(frozen=True, slots=True)
class Trouble:
    """A way in which the reports of actions may be bad.

    Args:
        title: In words.
        late: By how many frames all come too late.
        lost: The share of the actions that are never reported.
        nameless: They are reported without a word of what they are done with.
    """

    title: str
    late: int = 0
    lost: float = 0.0
    nameless: bool = False


TROUBLES = (
    Trouble("all in time"),
    Trouble(f"all {LATE_FRAMES} frames late, no planned end", late=LATE_FRAMES),
    Trouble("a third of the actions never reported", lost=LOST_SHARE),
    Trouble("all without their participants", nameless=True),
)


def troubled(root: Path, kind: PerceptionKind, videos: int) -> list[str]:
    """Give the table of bad reports: aapa-10000 beside aapa-plus with and without its rivals."""
    dataset = Dataset(root)
    engine = AttachmentEngine(load_domain(cater_domain()))
    models = [model_named(name) for name in TROUBLED]
    lines = [
        "| Reports | Model | " + " | ".join(TASKS) + " |",
        "| --- " * (len(TASKS) + 2) + "|",
    ]
    for trouble in TROUBLES:
        scores: dict[str, list[VideoScore]] = {model.name: [] for model in models}
        for name in dataset.videos[:videos]:
            video = dataset.video(name)
            perception = dataset.perception(video, kind)
            start = first_sighting(perception)
            snitch = video.labels.snitch
            if start is None or snitch is None or video.scene is None:
                continue
            actions = spoilt(timed_actions(video.scene), trouble, name)
            reports = engine.reports(actions, perception.frames)
            frames = [as_told(f, trouble) for f in frames_of(perception, reports)]
            for model in models:
                boxes = run_model(model, frames, cast_of(video.scene))
                score = score_video(boxes, snitch.astype(float), video.masks, start)
                scores[model.name].append(score)
        for model in models:
            miou, _ = table_row(scores[model.name])
            cells = " | ".join(f"{miou[task].mean:.2f}" for task in TASKS)
            lines.append(f"| {trouble.title} | {model.name} | {cells} |")
    return [*lines, ""]


def spoilt(actions: Sequence[TimedAction], trouble: Trouble, name: str) -> list[TimedAction]:
    """Give the actions as they are reported; what one stack does is lost or reported as one."""
    chance = random.Random(f"lost {name}")  # noqa: S311 - an experiment, no secret
    fate: dict[tuple[str, int, int], bool] = {}
    kept = []
    for action in actions:
        key = (action.name, action.start, action.end)
        if not fate.setdefault(key, chance.random() < trouble.lost):
            late = trouble.late
            kept.append(replace(action, start=action.start + late, end=action.end + late))
    return kept


def as_told(frame: Frame, trouble: Trouble) -> Frame:
    """Give a frame with its reports as they come.

    Those that come late would name a wrong planned end, and have none. Where it is not said what
    is done with what, the engine cannot know of any attachment either.
    """
    if trouble.nameless:
        actions = tuple(replace(a, args=(), planned_end=None) for a in frame.actions)
        return replace(frame, actions=actions, attachments=())
    if not trouble.late or not frame.actions:
        return frame
    return replace(frame, actions=tuple(replace(a, planned_end=None) for a in frame.actions))
