"""Whether what was learned of the detector's errors is of use with another detector.

The correction of `aapa-refined` was trained on the usual noise and on noise drawn about it. Here
are detectors of one kind each, some beyond all that it was trained on.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from aapa.lacater.generator import DetectorNoise
from aapa.lacater.generator.video import generate_video
from aapa.lacater.layout import PerceptionKind
from aapa.lacater.metric import TASKS, first_sighting, mean_over_videos, score_video
from aapa.lacater.models import model_named
from icarus_lite import load_domain
from runtime.cater.attachments import AttachmentEngine, timed_actions
from runtime.cater.evaluate import cater_domain
from runtime.cater.evaluation import cast_of, frames_of, run_model

USUAL = DetectorNoise()
DETECTORS = {
    "the usual one": USUAL,
    "jitter 0.3 px": replace(USUAL, jitter_px=0.3),
    "jitter 1.0 px": replace(USUAL, jitter_px=1.0),
    "jitter 1.5 px (beyond training)": replace(USUAL, jitter_px=1.5),
    "no lasting jitter (beyond training)": replace(USUAL, lasting=0.0),
    "all jitter lasting (beyond training)": replace(USUAL, lasting=1.0),
    "10 % missed (beyond training)": replace(USUAL, miss_rate=0.1),
}
"""What detectors are like, by title."""

MODELS = ("aapa-plus", "aapa-refined")


def noise_rows(seed: int, videos: int) -> list[dict]:
    """Give a row for each detector: mIoU of both models, %, and their difference.

    Args:
        seed: Of the generator; nothing was trained on it.
        videos: How many.
    """
    engine = AttachmentEngine(load_domain(cater_domain()))
    models = [model_named(name) for name in MODELS]
    scores: dict[str, list[list[list[float]]]] = {title: [] for title in DETECTORS}
    for number in range(videos):
        for title, noise in DETECTORS.items():
            made = generate_video(seed, number, noise)
            video, perception = made.video, made.perceptions[PerceptionKind.OD]
            start, snitch = first_sighting(perception), video.labels.snitch
            if start is None or snitch is None or video.scene is None:
                continue
            reports = engine.reports(timed_actions(video.scene), perception.frames)
            frames, cast = frames_of(perception, reports), cast_of(video.scene)
            found = [
                score_video(
                    run_model(model, frames, cast), snitch.astype(float), video.masks, start
                )
                for model in models
            ]
            scores[title].append([[100 * score.miou[task] for task in TASKS] for score in found])
    return [_row(title, np.array(each)) for title, each in scores.items()]


def _row(title: str, scores: np.ndarray) -> dict:
    """Sum up (videos, 2, tasks) scores."""
    columns = {
        name: [mean_over_videos(scores[:, index, task]) for task in range(len(TASKS))]
        for index, name in enumerate(MODELS)
    }
    gains = scores[:, 1] - scores[:, 0]
    columns["gain"] = [mean_over_videos(gains[:, task]) for task in range(len(TASKS))]
    return {
        "perception": "noise",
        "model": title,
        "videos": len(scores),
        **{name: [[mean.mean, mean.sem] for mean in means] for name, means in columns.items()},
    }


def noise_table(rows: list[dict]) -> list[str]:
    """Give the table of all rows."""
    lines = ["| detector | | " + " | ".join(TASKS) + " |", "| --- " * (len(TASKS) + 2) + "|"]
    for row in rows:
        for name in MODELS:
            cells = " | ".join(f"{mean:.2f}" for mean, _ in row[name])
            lines.append(f"| {row['model']} | `{name}` | {cells} |")
        cells = " | ".join(f"{mean:+.2f} ± {sem:.2f}" for mean, sem in row["gain"])
        lines.append(f"| | difference | {cells} |")
    return [*lines, ""]
