"""The table of an evaluation: mIoU and mL2 by task, for the eye and as JSON."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from rich.box import SIMPLE_HEAD
from rich.table import Table

from aapa.lacater.layout import PerceptionKind
from aapa.lacater.metric import TASKS, Mean, VideoScore, mean_over_videos, table_row
from aapa.lacater.models import Model, Network
from runtime.cater.evaluation import Job, VideoResult
from runtime.cater.sureness import Sureness

_DIGITS = 6


@dataclass(frozen=True, slots=True)
class Row:
    """One model's line of the table.

    Args:
        model: Its name.
        parameters: What there was to choose.
        miou: Mean intersection over union, %, by task.
        ml2: Mean distance of the box centres, px, by task.
        miou_exact: As `miou`, against the boxes before rounding; None where there are none.
        ml2_exact: As `ml2`, against those.
        confidence: How sure the model says it is, in [0, 1], by task; None if it does not say.
        right: In which share of the frames its box shares half of the union with the true one;
            None as above.
    """

    model: str
    parameters: Mapping[str, object]
    miou: Mapping[str, Mean]
    ml2: Mapping[str, Mean]
    miou_exact: Mapping[str, Mean] | None = None
    ml2_exact: Mapping[str, Mean] | None = None
    confidence: Mapping[str, Mean] | None = None
    right: Mapping[str, Mean] | None = None

    def to_json(self) -> dict[str, object]:
        """Give the row as it stands in the JSON document."""
        entry: dict[str, object] = {
            "model": self.model,
            "parameters": dict(self.parameters),
            "miou": _pairs(self.miou),
            "ml2": _pairs(self.ml2),
        }
        if self.miou_exact is not None and self.ml2_exact is not None:
            entry["miou_exact"] = _pairs(self.miou_exact)
            entry["ml2_exact"] = _pairs(self.ml2_exact)
        if self.confidence is not None and self.right is not None:
            entry["confidence"] = _pairs(self.confidence)
            entry["right"] = _pairs(self.right)
        return entry


@dataclass(frozen=True, slots=True)
class Report:
    """What an evaluation found.

    Args:
        perception: Whose detections the models got.
        videos: How many videos the table is over.
        rows: One a model.
        skipped: The videos left out, each with the reason.
        videos_per_second: How many videos each model gets through in a second of processor time,
            with the detections and attachments at hand. Unlike all else it differs from run to run.
    """

    perception: PerceptionKind
    videos: int
    rows: tuple[Row, ...]
    skipped: Mapping[str, str]
    videos_per_second: Mapping[str, float] = field(default_factory=dict)

    def to_json(self) -> dict[str, object]:
        """Give the document of `icarus cater evaluate --json`, but for how long it took."""
        return {
            "videos": self.videos,
            "perception": str(self.perception),
            "rows": [row.to_json() for row in self.rows],
            "skipped": [{"video": video, "reason": why} for video, why in self.skipped.items()],
        }

    def speeds_json(self) -> dict[str, float | None]:
        """Give how many videos a second each model takes, None where that is not known."""
        return {name: _number(speed) for name, speed in self.videos_per_second.items()}

    def tables(self) -> tuple[Table, ...]:
        """Give the tables of mIoU and mL2, of mIoU before rounding where it is known, of speed."""
        name = "detections" if self.perception is PerceptionKind.OD else "perfect perception"
        scope = f"{self.videos} videos, {name}"
        tables = [
            _table(f"mIoU, % ± SEM ({scope})", {row.model: row.miou for row in self.rows}),
            _table(f"mL2, px ± SEM ({scope})", {row.model: row.ml2 for row in self.rows}),
        ]
        exact = {row.model: row.miou_exact for row in self.rows if row.miou_exact is not None}
        if exact:
            title = f"mIoU against the boxes before rounding, % ± SEM ({scope})"
            tables.append(_table(title, exact))
        tables.append(_speeds(self.videos_per_second))
        return tuple(tables)

    def skipped_lines(self, most: int = 10) -> tuple[str, ...]:
        """Give what to tell of the videos left out: how many, and why."""
        if not self.skipped:
            return ()
        listed = list(self.skipped.items())[:most]
        rest = len(self.skipped) - len(listed)
        videos: dict[str, list[str]] = {}
        for video, why in listed:
            videos.setdefault(why, []).append(video)
        return (
            f"{len(self.skipped)} of {self.videos + len(self.skipped)} videos were skipped:",
            *(_skipped_line(why, names) for why, names in videos.items()),
            *((f"  and {rest} more; --json lists them all",) if rest else ()),
        )


def _skipped_line(why: str, videos: Sequence[str]) -> str:
    """Say why videos were left out, and which, where the reason does not tell it itself."""
    if len(videos) > 1:
        return f"  {why} ({len(videos)} times, first in {videos[0]})"
    return f"  {why}" if videos[0] in why else f"  {videos[0]}: {why}"


def report_of(job: Job, results: Sequence[VideoResult]) -> Report:
    """Make the table of all results; it does not depend on their order."""
    ordered = sorted(results, key=lambda result: result.video)
    scored = [result for result in ordered if not result.skipped]
    return Report(
        job.perception,
        len(scored),
        tuple(_row(model, number, scored) for number, model in enumerate(job.followers())),
        {result.video: result.skipped for result in ordered if result.skipped},
        {name: _speed(number, scored) for number, name in enumerate(job.models)},
    )


def _row(model: Model | Network, number: int, results: Sequence[VideoResult]) -> Row:
    name, parameters = model.name, model.parameters
    miou, ml2 = table_row([result.scores[number] for result in results])
    exact: list[VideoScore] = [
        result.exact_scores[number] for result in results if result.exact_scores
    ]
    row = Row(name, parameters, miou, ml2)
    # Exact scores of some of the videos only would not compare with the others' row.
    if results and len(exact) == len(results):
        miou_exact, ml2_exact = table_row(exact)
        row = replace(row, miou_exact=miou_exact, ml2_exact=ml2_exact)
    sure = [each for result in results if (each := _sureness_of(result, number)) is not None]
    if not sure:
        return row
    return replace(
        row,
        confidence=_means([each.confidence for each in sure]),
        right=_means([each.right for each in sure]),
    )


def _sureness_of(result: VideoResult, number: int) -> Sureness | None:
    return result.sureness[number] if result.sureness else None


def _means(columns: Sequence[Mapping[str, float]]) -> dict[str, Mean]:
    return {task: mean_over_videos(column[task] for column in columns) for task in TASKS}


def _speed(number: int, results: Sequence[VideoResult]) -> float:
    took = sum(result.seconds[number] for result in results if result.seconds)
    return round(len(results) / took, 1) if took > 0 else math.nan


def _pairs(means: Mapping[str, Mean]) -> dict[str, list[float | None]]:
    return {task: [_number(means[task].mean), _number(means[task].sem)] for task in TASKS}


def _number(value: float) -> float | None:
    return None if math.isnan(value) else round(value, _DIGITS)


def _table(title: str, rows: Mapping[str, Mapping[str, Mean]]) -> Table:
    table = Table(title=title, title_justify="left", box=SIMPLE_HEAD, pad_edge=False)
    table.add_column("model", no_wrap=True)
    for task in TASKS:
        table.add_column(task, justify="right", no_wrap=True)
    for model, means in rows.items():
        table.add_row(model, *(_cell(means[task]) for task in TASKS))
    return table


def _speeds(speeds: Mapping[str, float]) -> Table:
    title = "Videos a second of processor time, one core"
    table = Table(title=title, title_justify="left", box=SIMPLE_HEAD, pad_edge=False)
    table.add_column("model", no_wrap=True)
    table.add_column("videos/s", justify="right", no_wrap=True)
    for model, speed in speeds.items():
        table.add_row(model, "-" if math.isnan(speed) else f"{speed:.1f}")
    return table


def _cell(mean: Mean) -> str:
    if math.isnan(mean.mean):
        return "-"
    return f"{mean.mean:.2f}" if math.isnan(mean.sem) else f"{mean.mean:.2f} ± {mean.sem:.2f}"
