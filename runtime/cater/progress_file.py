"""What has been evaluated so far, so that an evaluation that was interrupted goes on from there.

One line of JSON a video, after a header that says of what. Results of another data set, domain,
model, perception or version of the program are never taken for these.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Iterable, Mapping, Sequence
from importlib.resources import files
from pathlib import Path

from aapa.lacater.camera import CALIBRATION_FILE
from aapa.lacater.layout import (
    exact_boxes_path,
    frame_lists_folder,
    labels_path,
    perception_path,
    scene_path,
)
from aapa.lacater.metric import TASKS, VideoScore
from aapa.lacater.models import Network
from icarus_lite import load_domain
from runtime.cater.evaluation import Job, VideoResult
from runtime.cater.sureness import Sureness
from runtime.errors import UsageError

_FORMAT = 2
_PACKAGES = ("aapa", "icarus_lite", "runtime.cater")


class ProgressFile:
    """The results of one job, kept in a file until the job is done.

    Args:
        path: Made if need be. One that is of another job is begun anew.
        job: What is evaluated.

    Raises:
        UsageError: The file cannot be written.
    """

    def __init__(self, path: Path, job: Job) -> None:
        self.path = path
        self._job = job
        self._header = {"format": _FORMAT, "job": job_digest(job)}
        self.done = self._read()
        lines = [json.dumps(self._header), *(self._line(result) for result in self.done.values())]
        try:
            path.write_text("".join(f"{line}\n" for line in lines), encoding="utf-8")
            self._stream = path.open("a", encoding="utf-8")
        except OSError as error:
            raise UsageError(f"{path}: cannot be written: {error.strerror}") from error

    def add(self, results: Iterable[VideoResult]) -> None:
        """Keep some results; they are on disk when this returns."""
        self._stream.write("".join(f"{self._line(result)}\n" for result in results))
        self._stream.flush()

    def close(self, *, finished: bool) -> None:
        """Close the file, and remove it when there is nothing left to go on with."""
        self._stream.close()
        if finished:
            self.path.unlink(missing_ok=True)

    def _line(self, result: VideoResult) -> str:
        entry = {
            "video": result.video,
            "files": files_digest(self._job, result.video),
            "skipped": result.skipped,
            "scores": [_score_entry(score) for score in result.scores],
            "exact_scores": [_score_entry(score) for score in result.exact_scores],
            "seconds": [round(seconds, 6) for seconds in result.seconds],
            "sureness": [_sureness_entry(sureness) for sureness in result.sureness],
        }
        return json.dumps(entry)

    def _read(self) -> dict[str, VideoResult]:
        try:
            lines = self.path.read_text(encoding="utf-8").splitlines()
        except (OSError, UnicodeDecodeError):
            return {}
        entries = [_parsed(line) for line in lines]
        if not entries or entries[0] != self._header:
            return {}
        results: dict[str, VideoResult] = {}
        for entry in entries[1:]:
            # The last line may be cut off, and a video may have been written anew since.
            result = None if entry is None else _result(entry)
            if result is None or entry is None:
                continue
            if entry["files"] == files_digest(self._job, result.video):
                results[result.video] = result
        return results


def job_digest(job: Job) -> str:
    """Give a digest of all that results depend on, but for the videos' own files.

    Raises:
        DomainError: The domain cannot be loaded.
    """
    digest = hashlib.sha256()
    described = [str(job.root.resolve()), job.perception, *job.models]
    digest.update(json.dumps(described).encode())
    for model in job.followers():
        if isinstance(model, Network):
            digest.update(model.file.read_bytes())
    source = load_domain(job.domain).source
    for text in (source.text, *(included.text for included in source.included)):
        digest.update(text.encode())
    for package in _PACKAGES:
        for pattern in ("*.py", "*.npz"):
            for path in sorted(Path(str(files(package))).rglob(pattern)):
                digest.update(path.read_bytes())
    for path in sorted(frame_lists_folder(job.root).glob("*.txt")):
        digest.update(_stamp(path).encode())
    return digest.hexdigest()


def files_digest(job: Job, video: str) -> str:
    """Give what tells whether a video's files are still those that were evaluated."""
    root = job.root
    paths = (
        labels_path(root, video),
        scene_path(root, video),
        perception_path(root, video, job.perception),
        exact_boxes_path(root, video),
        root / CALIBRATION_FILE,
    )
    return hashlib.sha256(" ".join(map(_stamp, paths)).encode()).hexdigest()[:16]


def _stamp(path: Path) -> str:
    try:
        status = path.stat()
    except OSError:
        return "-"
    return f"{path.name}:{status.st_size}:{status.st_mtime_ns}"


def _score_entry(score: VideoScore) -> list[list[float | None]]:
    return [_column_entry(score.miou), _column_entry(score.ml2)]


def _score(entry: object) -> VideoScore:
    miou, ml2 = map(_column, entry)  # type: ignore[call-overload]
    return VideoScore(miou, ml2)


def _sureness_entry(sureness: Sureness | None) -> list[list[float | None]] | None:
    if sureness is None:
        return None
    return [_column_entry(sureness.confidence), _column_entry(sureness.right)]


def _sureness(entry: object) -> Sureness | None:
    if entry is None:
        return None
    confidence, right = map(_column, entry)  # type: ignore[call-overload]
    return Sureness(confidence, right)


def _column_entry(column: Mapping[str, float]) -> list[float | None]:
    return [None if math.isnan(column[task]) else column[task] for task in TASKS]


def _column(entry: Sequence[float | None]) -> dict[str, float]:
    return {task: math.nan if v is None else float(v) for task, v in zip(TASKS, entry, strict=True)}


def _parsed(line: str) -> Mapping[str, object] | None:
    try:
        entry = json.loads(line)
    except ValueError:
        return None
    return entry if isinstance(entry, dict) else None


def _result(entry: Mapping[str, object]) -> VideoResult | None:
    try:
        return VideoResult(
            str(entry["video"]),
            str(entry["skipped"]),
            tuple(map(_score, entry["scores"])),  # type: ignore[call-overload]
            tuple(map(_score, entry["exact_scores"])),  # type: ignore[call-overload]
            tuple(map(float, entry["seconds"])),  # type: ignore[call-overload]
            tuple(map(_sureness, entry["sureness"])),  # type: ignore[call-overload]
        )
    except (KeyError, TypeError, ValueError):
        return None
