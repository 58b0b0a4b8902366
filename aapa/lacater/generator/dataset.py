"""Generates a data set into a folder: on several cores, resumable, the same bytes every time."""

from __future__ import annotations

import json
import multiprocessing
import re
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Final

from aapa.errors import AnchoringError, DatasetError
from aapa.lacater.generator.noise import DetectorNoise
from aapa.lacater.generator.simulation import video_name
from aapa.lacater.generator.video import generate_video
from aapa.lacater.layout import frame_lists_folder, labels_path, video_of_labels
from aapa.lacater.reading import Dataset
from aapa.lacater.video import FrameMasks
from aapa.lacater.writing import write_frame_lists, write_video

RECIPE_FILE: Final = "generator.json"
"""Says in the folder what its videos were made with."""

LARGEST_COUNT: Final = 1_000_000
"""Video names have six digits."""

_VERSION = 1
"""Goes up whenever the same seed would give other videos."""

_BATCH = 8


@dataclass(frozen=True, slots=True)
class Recipe:
    """What a generated data set is made with; with a video's number it says all about the video.

    Args:
        seed: At least 0.
        noise: What the trained detector is like.

    Raises:
        AnchoringError: The seed is negative.
    """

    seed: int
    noise: DetectorNoise = field(default_factory=DetectorNoise)

    def __post_init__(self) -> None:
        if self.seed < 0:
            raise AnchoringError(f"the seed is {self.seed}; it has to be at least 0")


def generate_dataset(
    root: Path,
    recipe: Recipe,
    count: int,
    jobs: int,
    progress: Callable[[int, int], None],
) -> None:
    """Make videos 0 to count - 1 in a folder, those left out that are there already.

    Interrupted, it can be called again and goes on. The frame lists come last; they hold every
    video of the folder.

    Args:
        root: The folder; made if need be.
        recipe: What the videos are made with.
        count: How many videos there are to be.
        jobs: How many processes work on it; the result does not depend on it.
        progress: Told how many videos are done, and of how many.

    Raises:
        DatasetError: The folder holds something else, or cannot be written.
        AnchoringError: There cannot be so many videos.
    """
    if not 0 < count <= LARGEST_COUNT:
        raise AnchoringError(f"{count} videos; there have to be 1 to {LARGEST_COUNT}")
    _claim(root, recipe)
    present = _present(root)
    missing = [number for number in range(count) if video_name(number) not in present]
    done = count - len(missing)
    progress(done, count)
    if missing:
        # Lists that lack a video would be an error to a reader; without any it derives its own.
        _remove_frame_lists(root)
    masks: dict[str, FrameMasks] = {}
    for batch in _made(root, recipe, missing, jobs):
        masks.update(batch)
        done += len(batch)
        progress(done, count)
    if present:
        there = Dataset(root)
        # Without frame lists the reader derives them, from what is in the files.
        _remove_frame_lists(root)
        masks.update({name: there.video(name).masks for name in present})
    write_frame_lists(root, {name: masks[name] for name in sorted(masks)})


def _made(
    root: Path, recipe: Recipe, numbers: Sequence[int], jobs: int
) -> Iterator[dict[str, FrameMasks]]:
    batches = [numbers[start : start + _BATCH] for start in range(0, len(numbers), _BATCH)]
    if jobs == 1 or len(batches) <= 1:
        for batch in batches:
            yield _make(root, recipe, batch)
        return
    # Not forked: the threads of numerical libraries do not survive that everywhere.
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(min(jobs, len(batches)), mp_context=context) as pool:
        futures = [pool.submit(_make, root, recipe, batch) for batch in batches]
        try:
            for future in as_completed(futures):
                yield future.result()
        except BrokenProcessPool as error:
            raise DatasetError(
                "a worker process ended unexpectedly, perhaps for want of memory; the same "
                "command with fewer --jobs goes on where it stopped",
                path=str(root),
            ) from error
        finally:
            pool.shutdown(wait=False, cancel_futures=True)


def _make(root: Path, recipe: Recipe, numbers: Sequence[int]) -> dict[str, FrameMasks]:
    masks = {}
    for number in numbers:
        made = generate_video(recipe.seed, number, recipe.noise)
        write_video(root, made.video, made.perceptions)
        masks[made.video.name] = made.video.masks
    return masks


def _claim(root: Path, recipe: Recipe) -> None:
    """Write the recipe into the folder, or make sure that it is the one that is there."""
    path = root / RECIPE_FILE
    wanted = {"version": _VERSION, **asdict(recipe)}
    text = json.dumps(wanted, indent=1) + "\n"
    try:
        if not path.exists():
            if labels_path(root, "").parent.exists():
                raise DatasetError(
                    f"holds a data set without {RECIPE_FILE}, which was not generated here; "
                    "choose another folder",
                    path=str(root),
                )
            root.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
            return
        found = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "it is not UTF-8"
        raise DatasetError(f"cannot be used: {reason}", path=str(path)) from error
    if found != text:
        raise DatasetError(_difference(found, wanted), path=str(path))
    _sweep(root)


def _difference(found: str, wanted: dict[str, object]) -> str:
    choose = "choose another folder, or remove this one"
    try:
        there = json.loads(found)
    except ValueError:
        return f"is damaged; {choose}"
    if not isinstance(there, dict) or there.get("version") != _VERSION:
        return f"was written by another version of the generator; {choose}"
    if there.get("seed") != wanted["seed"]:
        return f"its videos have seed {there.get('seed')}, not {wanted['seed']}; {choose}"
    return f"its videos were made with other detector noise; {choose}"


def _present(root: Path) -> frozenset[str]:
    """Give the videos that are whole: the labels of each were written last."""
    folder = labels_path(root, "").parent
    if not folder.is_dir():
        return frozenset()
    names = (video_of_labels(path) for path in folder.iterdir())
    return frozenset(name for name in names if name is not None)


def _remove_frame_lists(root: Path) -> None:
    folder = frame_lists_folder(root)
    if folder.is_dir():
        for path in folder.iterdir():
            path.unlink()
        folder.rmdir()


def _sweep(root: Path) -> None:
    """Remove the half-written files of a run that was killed."""
    for path in root.glob("*/.*.part"):
        if re.fullmatch(r"\..+\.\d+\.part", path.name):
            path.unlink(missing_ok=True)
