"""AAPA and aapa-plus on generated videos, beside the paper's table; each idea left out in turn.

    python benchmarks/aapa_table.py [--data data/generated] [--tuning-data data/tuning]
        [--videos 1000] [--tuning-videos 300] [--jobs 2] [--out docs/results/aapa.md]

A folder that is not there is generated, from seed 1 for the table and from seed 2 for tuning and
ablation: nothing was tuned on the videos of the table.
"""

from __future__ import annotations

import argparse
import math
import statistics
import time
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path

from aapa_bounds import BOUNDS, bounds
from aapa_trouble import TROUBLE, troubled

from aapa.lacater.generator import DetectorNoise, Recipe, generate_dataset
from aapa.lacater.layout import PerceptionKind
from aapa.lacater.metric import TASKS
from aapa.lacater.models import Model, model_named
from aapa.lacater.models.plus import BeyondAapa, Ideas
from aapa.lacater.reading import Dataset
from icarus_lite import load_domain
from runtime.cater.attachments import AttachmentEngine, timed_actions
from runtime.cater.evaluate import How, cater_domain, evaluate
from runtime.cater.evaluation import Job, cast_of, frames_of, run_model
from runtime.cater.report import Row

MODELS = (
    "last-seen",
    "heuristic",
    "pa-6500",
    "aapa-3000",
    "aapa-6500",
    "aapa-10000",
    "aapa-plus",
    "aapa-plus-camera",
    "aapa-plus-without-planned-end",
    "aapa-plus-without-reports",
)
ABLATION = (
    "aapa-10000",
    "aapa-plus",
    "aapa-plus-without-ground",
    "aapa-plus-without-hidden-motion",
    "aapa-plus-without-bounded",
    "aapa-plus-without-planned-end",
    "aapa-plus-without-planned-end-without-bounded",
    "aapa-plus-without-lock",
    "aapa-plus-without-rest",
    "aapa-plus-without-geometry",
    "aapa-plus-without-reports",
    "aapa-plus-without-reports-without-rivals",
    "aapa-plus-without-reports-without-geometry",
)
PAPER = {
    PerceptionKind.PP: (
        ("OPNet", (90.02, 73.81, 84.40, 77.08, 87.09), None),
        ("OPNet+AA", (93.23, 87.91, 89.97, 87.81, 91.74), None),
        ("AAPA-6k5", (99.38, 90.53, 93.86, 82.54, 96.31), (0.28, 2.51, 0.77, 1.94, 0.62)),
        ("AAPA-10k", (99.60, 90.53, 94.16, 83.02, 96.54), (0.11, 2.51, 0.46, 1.48, 0.42)),
    ),
    PerceptionKind.OD: (
        ("OPNet", (88.98, 80.19, 77.07, 56.04, 82.35), None),
        ("PA-6k5", (86.80, 79.43, 67.14, 26.54, 76.96), (3.21, 5.19, 13.0, 29.9, 7.9)),
        ("AAPA-6k5", (88.67, 82.15, 80.79, 68.25, 84.66), None),
        ("AAPA-10k", (88.75, 82.15, 80.64, 68.22, 84.63), (1.35, 2.44, 2.64, 5.12, 2.10)),
    ),
}
"""Liang et al. 2021: mIoU in %, mean distance in px; by the four labels, and overall."""

OTHER_SEEDS = (3, 4, 5, 6, 7)
"""Of the sets of videos that tell how far one set is from the next; the table's own is 1."""

TITLES = {PerceptionKind.PP: "perfect perception", PerceptionKind.OD: "object detector"}
TARGETS = {
    PerceptionKind.PP: (98.0, 93.0, 0.8),
    PerceptionKind.OD: (89.0, 82.0, None),
}
WITHIN = 1.0  # points from the paper


def prepared(root: Path, seed: int, videos: int, jobs: int) -> Path:
    """Give a data set's folder, generated if it is not there."""
    if not (root / "labels").is_dir():
        generate_dataset(root, Recipe(seed, DetectorNoise()), videos, jobs, lambda _d, _n: None)
    return root


def measured(root: Path, models: Sequence[str], kind: PerceptionKind, jobs: int) -> list[str]:
    """Give a table's lines, and whether the targets of aapa-plus are met."""
    job = Job(root, cater_domain(), tuple(models), kind)
    report = evaluate(job, How(processes=jobs, fresh=True), lambda _d, _n: None, print)
    lines = [f"{report.videos} videos, {len(report.skipped)} skipped.", ""]
    lines += table(report.rows)
    lines += target_lines(report.rows, kind)
    return lines


def table(rows: Sequence[Row]) -> list[str]:
    """Give mIoU with its standard error, mL2, and mIoU against boxes that were not rounded."""
    lines = [
        "| Model | " + " | ".join(TASKS) + " | mL2, px (same order) | exact boxes, mIoU |",
        "| --- " * (len(TASKS) + 3) + "|",
    ]
    for row in rows:
        cells = [f"{row.miou[task].mean:.2f} ± {row.miou[task].sem:.2f}" for task in TASKS]
        distances = " / ".join(f"{row.ml2[task].mean:.2f}" for task in TASKS)
        exact = row.miou_exact
        bare = "" if exact is None else " / ".join(f"{exact[task].mean:.2f}" for task in TASKS)
        lines.append(f"| {row.model} | " + " | ".join(cells) + f" | {distances} | {bare} |")
    return [*lines, ""]


def paper_table(kind: PerceptionKind) -> list[str]:
    """Give the published rows, on LA-CATER itself."""
    lines = [
        "The paper, on LA-CATER's 1,371 test videos:",
        "",
        "| Model | " + " | ".join(TASKS) + " | mL2, px |",
        "| --- " * (len(TASKS) + 2) + "|",
    ]
    for name, miou, ml2 in PAPER[kind]:
        cells = " | ".join(f"{value:.2f}" for value in miou)
        distances = "" if ml2 is None else " / ".join(f"{value:.2f}" for value in ml2)
        lines.append(f"| {name} | {cells} | {distances} |")
    return [*lines, ""]


def target_lines(rows: Sequence[Row], kind: PerceptionKind) -> list[str]:
    """Say which targets are met."""
    row = next((row for row in rows if row.model == "aapa-plus"), None)
    if row is None:
        return []
    overall, carried, distance = TARGETS[kind]
    checks = [
        ("overall", row.miou["overall"].mean, ">=", overall),
        ("carried", row.miou["carried"].mean, ">=", carried),
    ]
    if distance is not None:
        checks.append(("mL2 carried", row.ml2["carried"].mean, "<=", distance))
    said = []
    for name, value, sign, bound in checks:
        met = value >= bound if sign == ">=" else value <= bound
        said.append(f"{name} {value:.2f} (wanted {sign} {bound:g}: {'met' if met else 'MISSED'})")
    return ["aapa-plus: " + "; ".join(said) + ".", ""]


def seeds(roots: Mapping[int, Path], jobs: int) -> list[str]:
    """Give AAPA-10k's row on several sets of videos, on all of them, and the paper's."""
    lines = ["| Videos | " + " | ".join(TASKS) + " |", "| --- " * (len(TASKS) + 1) + "|"]
    rows = []
    for seed, root in roots.items():
        job = Job(root, cater_domain(), ("aapa-10000",), PerceptionKind.PP)
        report = evaluate(job, How(processes=jobs, fresh=True), lambda _d, _n: None, print)
        [row] = report.rows
        rows.append(row)
        cells = [f"{row.miou[task].mean:.2f} ± {row.miou[task].sem:.2f}" for task in TASKS]
        lines.append(f"| seed {seed}, {report.videos} videos | " + " | ".join(cells) + " |")
    cells, apart = [], []
    for task, paper in zip(TASKS, PAPER[PerceptionKind.PP][-1][1], strict=True):
        mean = statistics.fmean(row.miou[task].mean for row in rows)
        error = math.hypot(*(row.miou[task].sem for row in rows)) / len(rows)
        cells.append(f"{mean:.2f} ± {error:.2f}")
        apart.append((abs(mean - paper), task))
    lines.append("| **all of them** | " + " | ".join(cells) + " |")
    published = " | ".join(f"{value:.2f}" for value in PAPER[PerceptionKind.PP][-1][1])
    lines.append(f"| the paper, LA-CATER | {published} |")
    most, where = max(apart)
    said = "met" if most <= WITHIN else "MISSED"
    lines += ["", f"Farthest from the paper: {where}, by {most:.2f} points (wanted <= 1: {said})."]
    return [*lines, ""]


def speed(root: Path, kind: PerceptionKind, videos: int = 40) -> list[str]:
    """Give frames a second of processor time, by one process, attachments not counted."""
    dataset = Dataset(root)
    engine = AttachmentEngine(load_domain(cater_domain()))
    work = []
    for name in dataset.videos[:videos]:
        video = dataset.video(name)
        perception = dataset.perception(video, kind)
        if video.scene is not None:
            reports = engine.reports(timed_actions(video.scene), perception.frames)
            work.append((frames_of(perception, reports), cast_of(video.scene)))
    frames = sum(len(film) for film, _ in work)
    detections = sum(len(frame.boxes) for film, _ in work for frame in film) / frames
    plus = Model("aapa-plus", partial(BeyondAapa, Ideas()))
    rates = []
    for model in (model_named("aapa-10000"), plus):
        begun = time.process_time()
        for film, cast in work:
            run_model(model, film, cast)
        rates.append(f"{model.name} {frames / (time.process_time() - begun):,.0f}")
    return [f"- {kind.name}, {detections:.1f} detections a frame: {', '.join(rates)}"]


def main() -> int:
    """Measure all, and write the page; the exit status says whether all targets are met."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, default=Path("data/generated"))
    parser.add_argument("--tuning-data", type=Path, default=Path("data/tuning"))
    parser.add_argument("--videos", type=int, default=1000)
    parser.add_argument("--tuning-videos", type=int, default=300)
    parser.add_argument("--troubled-videos", type=int, default=150)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--out", type=Path)
    arguments = parser.parse_args()
    data = prepared(arguments.data, 1, arguments.videos, arguments.jobs)
    tuning = prepared(arguments.tuning_data, 2, arguments.tuning_videos, arguments.jobs)
    lines = [*INTRODUCTION.splitlines(), ""]
    for kind in (PerceptionKind.PP, PerceptionKind.OD):
        lines += [f"## {kind.name}: {TITLES[kind]}", "", *paper_table(kind)]
        lines += ["On generated videos:", "", *measured(data, MODELS, kind, arguments.jobs)]
    roots = {1: data} | {
        seed: prepared(
            data.with_name(f"{data.name}-{seed}"), seed, arguments.videos, arguments.jobs
        )
        for seed in OTHER_SEEDS
    }
    lines += ["## From one set of videos to the next", "", SEEDS, ""]
    lines += seeds(roots, arguments.jobs)
    lines += ["## Each idea left out", "", "On the tuning videos.", ""]
    for kind in (PerceptionKind.PP, PerceptionKind.OD):
        found = measured(tuning, ABLATION, kind, arguments.jobs)
        lines += [f"### {kind.name}", "", *found]
    lines += ["## Late and missing reports", "", TROUBLE, ""]
    for kind in (PerceptionKind.PP, PerceptionKind.OD):
        found = troubled(tuning, kind, arguments.troubled_videos)
        lines += [f"### {kind.name}: the first {arguments.troubled_videos} tuning videos", ""]
        lines += found
    lines += ["## What bounds it", "", BOUNDS, "", "Carried, perfect perception, `aapa-plus`:", ""]
    lines += bounds(data)
    lines += ["## Speed", "", "Frames a second of processor time, one process:", ""]
    for kind in (PerceptionKind.PP, PerceptionKind.OD):
        lines += speed(tuning, kind)
    text = "\n".join(lines).rstrip() + "\n"
    print(text)
    if arguments.out:
        arguments.out.parent.mkdir(parents=True, exist_ok=True)
        arguments.out.write_text(text, encoding="utf-8")
    return 1 if "MISSED" in text else 0


INTRODUCTION = """# AAPA, and beyond it

Made by `make bench-aapa`. mIoU in %, mean over videos ± its standard error, by the published
metric on labels rounded to px; mL2 in px; from the first detection of the snitch on. The last
column scores against the boxes before rounding, where nothing is cut off: even a model that
gives the rounded labels themselves gets only about 95 there, and so do all of these, whose boxes
are whole px.

The videos are generated, and harder or easier than LA-CATER's in ways that `generator.md` tells:
compare models on the same videos; the paper's rows are beside them for orientation.

What `aapa-plus` takes for granted beyond what AAPA does, and what a figure here therefore owes
to generated data:

- the sizes of CATER's classes (large, medium, small cones and balls), the focal length of its
  lens and that the camera is level. Where the camera stands it finds out from the boxes;
- `aapa-plus-camera` is told where the camera stands (by the scene file here). The others find it
  out from the boxes, so well that little is left to gain;
- how things speed up and slow down: the generator's own easing, which is Blender's. With another
  profile the row without the planned end is what is left;
- that a detector whose boxes flicker cuts them to whole px, as the published files are cut, so
  that they lie half a px off; this alone is worth almost three points with the detector here (OD
  overall on 60 tuning videos: 91.98 with it, 89.10 without);
- what an action is done with, and when it begins and ends. The planned end is what whoever acts
  knows when it begins: the row without it does not use it. The row without reports uses no
  action at all, neither participants nor times; it keeps the list of which classes there are."""

SEEDS = """The model of the paper, AAPA-10k, with perfect perception, on as many videos again of
other seeds. In most videos the snitch is never, or for a few frames only, occluded, and one video
in which it is lost behind something weighs as much as any other: the column *occluded* moves by
more than a point from a thousand videos to the next, here and there (the paper's own standard error
is 0.64). Whether it is the same model is told by all of them together."""

if __name__ == "__main__":
    raise SystemExit(main())
