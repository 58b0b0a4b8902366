"""How fast detections become objects: AAPA beside three trackers, and alignment at scale.

All trackers see the same videos in turn, video by video in one process, so that what else the
machine does meets all of them; what counts is their ratio. Only the calls that take in a frame
are timed: each gets its detections made up beforehand, in its own kind of object.
"""

from __future__ import annotations

import argparse
import gc
import math
import os
import platform
import statistics
import time
from collections.abc import Callable
from functools import partial
from importlib.metadata import version
from pathlib import Path

import numpy as np
from scipy.optimize import linear_sum_assignment
from tracking_peers import Frame, Peer, aapa, others

from aapa import Anchoring, AnchoringParameters, Detection, Place, align
from aapa.lacater.perception_file import read_perception

WANTED = 9
"""Detections a frame."""

SIZES = (15, 100, 300, 1000, 2000, 5000)
TAUS = (400.0, 3000.0, 6500.0)


def main() -> None:
    """Measure, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("data", type=Path, help="made by `icarus cater generate`")
    parser.add_argument("--videos", type=int, default=20)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--out", type=Path)
    args = parser.parse_args()
    videos = nearest_to(WANTED, args.data / "perfect_perception", args.videos)
    page = "\n".join([*peers_section(videos, args.rounds), *scaling_section(args.rounds)]) + "\n"
    print(page)
    if args.out:
        args.out.write_text(page, encoding="utf-8")


def nearest_to(wanted: float, folder: Path, count: int) -> list[list[Frame]]:
    """Give the videos whose mean number of detections comes nearest to the one wanted."""
    videos = []
    for path in sorted(folder.glob("*.pkl")):
        seen = read_perception(path)
        frames = [
            (boxes.astype(np.float64), classes)
            for boxes, classes in zip(seen.boxes, seen.classes, strict=True)
        ]
        mean = sum(len(boxes) for boxes, _ in frames) / len(frames)
        videos.append((abs(mean - wanted), path.name, frames))
    videos.sort(key=lambda video: video[:2])
    return [frames for _, _, frames in videos[:count]]


def measured(peer: Peer, video: list[Frame]) -> float:
    """Give the seconds that a new tracker takes for the frames of a video."""
    given = [peer.given(frame) for frame in video]
    update = peer.fresh()
    gc.collect()
    start = time.perf_counter()
    for frame in given:
        update(frame)
    return time.perf_counter() - start


def peers_section(videos: list[list[Frame]], rounds: int) -> list[str]:
    """Measure the trackers in turn, and give the lines of their section."""
    trackers = [aapa(), *others()]
    frames = sum(map(len, videos))
    detections = sum(len(boxes) for video in videos for boxes, _ in video)
    for peer in trackers:
        measured(peer, videos[0])
    times: dict[str, list[float]] = {peer.name: [] for peer in trackers}
    for _ in range(rounds):
        for video in videos:
            for peer in trackers:
                times[peer.name].append(measured(peer, video) / len(video))
    ours = times[trackers[0].name]
    rows = []
    for peer in trackers:
        ratios = [theirs / own for theirs, own in zip(times[peer.name], ours, strict=True)]
        median = statistics.median(times[peer.name])
        low, high = np.percentile(ratios, [10, 90])
        rows.append(
            f"| {peer.name} | {1e6 * median:.0f} | {1 / median:,.0f} | "
            f"{statistics.median(ratios):.1f} | {low:.1f}…{high:.1f} |"
        )
    where = (
        f"{platform.machine()}, CPython {platform.python_version()}, numpy {np.__version__}, "
        f"scipy {version('scipy')}; norfair {version('norfair')}, trackers "
        f"{version('trackers')}. Times depend on the machine and on what else it does; the "
        "ratios are of measurements taken one right after the other. While this page was made, "
        f"{os.getloadavg()[0]:.1f} processes shared {os.cpu_count()} cores."
    )
    how = (
        f"{len(videos)} generated videos, {frames:,} frames, {detections / frames:.1f} "
        f"detections a frame, perfect perception; {rounds} rounds. One measurement is one "
        "video, taken by each in turn; the last column holds eight of ten ratios. AAPA runs "
        "without attachments, since the others know none; all with the settings they come with."
    )
    return [
        "# How fast detections become objects",
        "",
        "`make bench-tracking` writes this page.",
        "",
        where,
        "",
        "## Beside trackers",
        "",
        how,
        "",
        "| | µs a frame, median | frames/s | times as long as AAPA | from…to |",
        "|---|---|---|---|---|",
        *rows,
        "",
    ]


def scene(count: int, chance: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """One object to 60 x 60 px, moved by 6 px; one of twenty missed, as many new."""
    side = 60 * math.sqrt(count)
    old = chance.uniform(0, side, (count, 2))
    new = old + chance.normal(0, 6, old.shape)
    new = new[chance.random(count) > 0.05]
    new = np.concatenate([new, chance.uniform(0, side, (count - len(new), 2))])
    return old, new[chance.permutation(len(new))]


def scaling_section(rounds: int) -> list[str]:
    """Measure the alignment at growing scale, and give the lines of its section."""
    rows = []
    for tau in TAUS:
        cells = []
        for count in SIZES:
            times = []
            chance = np.random.default_rng(count)
            for _ in range(rounds + 1):
                old, new = scene(count, chance)
                anchors = [Place("object", (x, y)) for x, y in old.tolist()]
                found = [Place("object", (x, y)) for x, y in new.tolist()]
                times.append(mean_of(partial(align, anchors, found, tau), count))
            cells.append(f"{1e3 * statistics.median(times[1:]):.2f} ({1e3 * min(times[1:]):.2f})")
        rows.append(f"| align, tau {tau:.0f} | " + " | ".join(cells) + " |")
    rows.append(
        "| scipy, full matrix, tau 3000 | " + " | ".join(dense(n, rounds) for n in SIZES) + " |"
    )
    rows.append("| whole frame, tau 3000 | " + " | ".join(whole(n, rounds) for n in SIZES) + " |")
    heads = " | ".join(f"N = {count:,}" for count in SIZES)
    return [
        "## At scale",
        "",
        "Milliseconds, median (least) of " + f"{rounds}; all objects of one type, one to 60 x 60 "
        "px, moved by 6 px (standard deviation), 5 % missed and as many new. Each is the exact "
        "optimum. `whole frame` is "
        "`Anchoring.update`: checks, alignment, and the reasoning about what is missed.",
        "",
        f"| | {heads} |",
        "|---|" + "---|" * len(SIZES),
        *rows,
    ]


def mean_of(call: Callable[[], object], count: int) -> float:
    """Give the seconds of a call; the mean of several in a row where it is short."""
    repeats = max(1, 1000 // count)
    gc.collect()
    start = time.perf_counter()
    for _ in range(repeats):
        call()
    return (time.perf_counter() - start) / repeats


def solve_all(old: np.ndarray, new: np.ndarray) -> None:
    """Make the full matrix, and let scipy find the optimum."""
    costs = ((old[:, None] - new[None]) ** 2).sum(axis=-1)
    linear_sum_assignment(np.minimum(costs, 3000.0))


def dense(count: int, rounds: int) -> str:
    """Give the time that scipy takes for the full matrix, making the matrix included."""
    times = []
    chance = np.random.default_rng(count)
    for _ in range(min(rounds, 3) + 1):
        old, new = scene(count, chance)
        times.append(mean_of(partial(solve_all, old, new), count))
    return f"{1e3 * statistics.median(times[1:]):.2f} ({1e3 * min(times[1:]):.2f})"


def whole(count: int, rounds: int) -> str:
    """Give the time of an update that takes in a frame with many objects."""
    times = []
    chance = np.random.default_rng(count)
    for _ in range(rounds + 1):
        old, new = scene(count, chance)
        anchoring = Anchoring(AnchoringParameters(tau=3000))
        before, after = (
            [Detection("object", (x - 9.0, y - 9.0, x + 9.0, y + 9.0)) for x, y in centres.tolist()]
            for centres in (old, new)
        )
        anchoring.update(before)
        gc.collect()
        start = time.perf_counter()
        anchoring.update(after)
        times.append(time.perf_counter() - start)
    return f"{1e3 * statistics.median(times[1:]):.2f} ({1e3 * min(times[1:]):.2f})"


if __name__ == "__main__":
    main()
