"""`evaluate`: the whole evaluation, from a folder to a report, resumed where it was left."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path

from aapa.errors import DatasetError
from aapa.lacater.reading import Dataset
from icarus_lite import load_domain
from runtime.cater.evaluation import Job, VideoResult
from runtime.cater.progress_file import ProgressFile
from runtime.cater.report import Report, report_of
from runtime.cater.workers import evaluate_on_cluster, evaluate_on_cores, usable_cores
from runtime.errors import UsageError

Progress = Callable[[int, int], None]
"""Called with the number of videos done, and of all."""


@dataclass(frozen=True, slots=True)
class How:
    """How to carry an evaluation out; none of this changes its result.

    Args:
        processes: How many work at a time; None takes all cores.
        scheduler: The address of a Dask scheduler; None works on this machine.
        progress_path: Where to keep what is done so far; None chooses a name in the data set.
        fresh: Begin anew even if there is something to go on from.
    """

    processes: int | None = None
    scheduler: str | None = None
    progress_path: Path | None = None
    fresh: bool = False


def evaluate(job: Job, how: How, progress: Progress, note: Callable[[str], None]) -> Report:
    """Run the models on every video of a data set, and make the table.

    With more than one process it starts Python anew in each, so that a script calls it under
    `if __name__ == "__main__":`.

    Args:
        job: Data set, domain, models and perception.
        how: Where it runs, and where it is kept meanwhile.
        progress: Told of each batch of videos.
        note: Told in words of what the person should know.

    Raises:
        AnchoringError: There is no such data set or model, or a model failed.
        DomainError: The domain cannot be loaded.
        DatasetError: Not a single video could be evaluated.
        UsageError: The file of results so far, or the cluster, cannot be used.
    """
    results = evaluated_videos(job, how, progress, note)
    report = report_of(job, results)
    if not report.videos:
        raise DatasetError(
            f"not one of {len(results)} videos can be evaluated; the first: "
            f"{next(iter(report.skipped.values()))}",
            path=str(job.root),
        )
    return report


def evaluated_videos(
    job: Job, how: How, progress: Progress, note: Callable[[str], None]
) -> list[VideoResult]:
    """Run the models on every video of a data set; see `evaluate`.

    Args:
        job: Data set, domain, models and perception.
        how: Where it runs, and where it is kept meanwhile.
        progress: Told of each batch of videos.
        note: Told in words of what the person should know.

    Raises:
        AnchoringError: There is no such data set or model, or a model failed.
        DomainError: The domain cannot be loaded.
        UsageError: The file of results so far, or the cluster, cannot be used.
    """
    load_domain(job.domain)
    job.followers()
    videos = Dataset(job.root).videos
    kept = _progress_file(job, how, note)
    done = {} if kept is None else {v: r for v, r in kept.done.items() if v in set(videos)}
    if done:
        note(f"{len(done)} of {len(videos)} videos were evaluated before; going on from there")
    left = [video for video in videos if video not in done]
    results: list[VideoResult] = list(done.values())
    finished = False
    try:
        progress(len(results), len(videos))
        batches = (
            evaluate_on_cluster(job, left, how.scheduler)
            if how.scheduler is not None
            else evaluate_on_cores(job, left, how.processes or usable_cores())
        )
        for batch in batches:
            results.extend(batch)
            if kept is not None:
                kept.add(batch)
            progress(len(results), len(videos))
        finished = True
    finally:
        if kept is not None:
            kept.close(finished=finished)
    return results


def cater_domain() -> Path:
    """Give the file of the domain that comes with the program, `cater.icr`.

    Raises:
        UsageError: It is not where it should be.
    """
    package = Path(str(files("runtime")))
    places = (package / "data" / "cater.icr", package.parent / "domains" / "cater.icr")
    for place in places:
        if place.is_file():
            return place
    raise UsageError("domains/cater.icr is missing; name a domain with --domain")


def _progress_file(job: Job, how: How, note: Callable[[str], None]) -> ProgressFile | None:
    path = how.progress_path
    chosen = path is not None
    if path is None:
        path = job.root / f".icarus-evaluation-{_tag(job)}.jsonl"
    if how.fresh:
        path.unlink(missing_ok=True)
    try:
        return ProgressFile(path, job)
    except UsageError as error:
        if chosen:
            raise
        note(f"{error}; if this is interrupted it begins anew (--progress names another file)")
        return None


def _tag(job: Job) -> str:
    """Give a short name for a table, so that two tables of one data set do not share a file."""
    return hashlib.sha256(" ".join((job.perception, *job.models)).encode()).hexdigest()[:12]
