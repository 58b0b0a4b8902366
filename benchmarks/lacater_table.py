"""The paper's comparison, complete: every row of its table, and ours beside, on generated videos.

    python benchmarks/lacater_table.py [--data build/lacater] [--rows build/lacater-rows.jsonl]
        [--videos 1371] [--jobs 2] [--models NAME,…] [--fresh] [--out docs/results/lacater.md]

A folder that is not there is generated, from seed 9: nothing was tuned or trained on its videos.
Each row is kept in a file as soon as it is there, so that the work can be done in parts; a row is
made anew with --fresh, or where its weights are others. With --models only these are made.
"""

from __future__ import annotations

import argparse
import hashlib
import math
from collections.abc import Sequence
from importlib.resources import files
from pathlib import Path

from lacater_noise import DETECTORS, noise_rows
from lacater_page import KINDS, MODELS, SEED, Rows, page

from aapa.errors import AnchoringError
from aapa.lacater.generator import DetectorNoise, Recipe, generate_dataset
from aapa.lacater.layout import PerceptionKind
from aapa.lacater.metric import TASKS
from aapa.lacater.models import Network, models_named
from runtime.cater.evaluate import How, cater_domain, evaluated_videos
from runtime.cater.evaluation import Job
from runtime.cater.report import report_of

NOISE_VIDEOS = 60
NOISE_KEY = next(iter(DETECTORS))


def prepared(root: Path, videos: int, jobs: int) -> Path:
    """Give the data set's folder, generated as far as it is not there."""
    if not (root / "containment_and_occlusions").is_dir():
        generate_dataset(root, Recipe(SEED, DetectorNoise()), videos, jobs, lambda _d, _n: None)
    return root


def digest_of(model: str) -> str | None:
    """Give what tells a model's weights apart; "" where it has none, None if it cannot be run."""
    try:
        [follower] = models_named([model])
    except AnchoringError as error:
        print(f"{model} is left out: {error}")
        return None
    file = follower.file if isinstance(follower, Network) else None
    if model == "aapa-refined":
        file = Path(str(files("aapa.lacater.models.refined"))) / "weights.npz"
    return "" if file is None else hashlib.sha256(file.read_bytes()).hexdigest()[:16]


def made(root: Path, kind: PerceptionKind, models: Sequence[str], jobs: int) -> list[dict]:
    """Run models on all videos, and give a row for each, with the score of every video."""
    job = Job(root, cater_domain(), tuple(models), kind)
    results = evaluated_videos(job, How(processes=jobs), _told, print)
    report = report_of(job, results)
    rows = []
    for number, row in enumerate(report.rows):
        scores = {
            result.video: [
                [_number(table[task]) for task in TASKS]
                for table in (result.scores[number].miou, result.scores[number].ml2)
            ]
            for result in sorted(results, key=lambda result: result.video)
            if not result.skipped
        }
        rows.append(
            {
                "perception": str(kind),
                "model": row.model,
                "weights": digest_of(row.model),
                "videos": report.videos,
                "skipped": len(report.skipped),
                "videos_per_second": report.videos_per_second[row.model],
                "row": row.to_json(),
                "scores": scores,
            }
        )
    return rows


def _told(done: int, total: int) -> None:
    if done % 100 < 8 or done == total:
        print(f"{done} of {total} videos", flush=True)


def _number(value: float) -> float | None:
    return None if math.isnan(value) else round(value, 5)


def main() -> int:
    """Make the rows that are not there, and the page."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, default=Path("build/lacater"))
    parser.add_argument("--rows", type=Path, default=Path("build/lacater-rows.jsonl"))
    parser.add_argument("--videos", type=int, default=1371)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--models", default=",".join(MODELS))
    parser.add_argument("--fresh", action="store_true")
    parser.add_argument("--out", type=Path)
    arguments = parser.parse_args()
    root = prepared(arguments.data, arguments.videos, arguments.jobs)
    rows = Rows(arguments.rows)
    wanted = {model: digest_of(model) for model in arguments.models.split(",")}
    for kind in KINDS:
        left = [
            model
            for model, weights in wanted.items()
            if weights is not None and (arguments.fresh or not rows.has(kind, model, weights))
        ]
        if left:
            print(f"{kind}: {', '.join(left)}")
            for row in made(root, kind, left, arguments.jobs):
                rows.add(row)
    learned = wanted.get("aapa-refined")
    if learned and (arguments.fresh or not rows.has("noise", NOISE_KEY, learned)):
        for row in noise_rows(SEED, NOISE_VIDEOS):
            rows.add(row | {"weights": learned})
    text = page(rows, root)
    if arguments.out:
        arguments.out.parent.mkdir(parents=True, exist_ok=True)
        arguments.out.write_text(text, encoding="utf-8")
    else:
        print(text)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
