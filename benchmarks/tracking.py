"""How fast detections become objects: AAPA beside three trackers, and at growing scale.

All trackers see the same videos in turn, video by video in one process, so that what else the
machine does meets all of them; what counts is their ratio. Only the calls that take in a frame
are timed, by the processor time they take: each gets its detections made up beforehand, in its
own kind of object.
"""

from __future__ import annotations

import argparse
import gc
import os
import platform
import statistics
import time
from importlib.metadata import version
from pathlib import Path

import numpy as np
from tracking_peers import Peer, Recorded, others, ours, recorded
from tracking_scale import scaling_section

WANTED = 9
"""Detections a frame."""


def main() -> None:
    """Measure, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("data", type=Path, help="made by `icarus cater generate`")
    parser.add_argument("--domain", type=Path, default=Path("domains/cater.icr"))
    parser.add_argument("--videos", type=int, default=20)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--out", type=Path)
    args = parser.parse_args()
    videos = nearest_to(WANTED, recorded(args.data, args.domain), args.videos)
    before = os.getloadavg()[0]
    sections = [*peers_section(videos, args.rounds), *scaling_section(args.rounds)]
    lines = [*opening(before, os.getloadavg()[0]), *sections]
    page = "\n".join(lines) + "\n"
    print(page)
    if args.out:
        args.out.write_text(page, encoding="utf-8")


def nearest_to(wanted: float, videos: list[Recorded], count: int) -> list[Recorded]:
    """Give the videos whose mean number of detections comes nearest to the one wanted."""
    return sorted(videos, key=lambda v: abs(v.detections / len(v.frames) - wanted))[:count]


def opening(before: float, after: float) -> list[str]:
    """Give the lines that say where and how all this was measured."""
    return [
        "# How fast detections become objects",
        "",
        "`make bench-tracking` writes this page.",
        "",
        (
            f"{platform.machine()}, CPython {platform.python_version()}, numpy {np.__version__}, "
            f"scipy {version('scipy')}; norfair {version('norfair')}, trackers "
            f"{version('trackers')}. All times are processor time. They depend on the machine, and "
            "with caches shared on what else it does; ratios are of measurements taken one right "
            f"after the other. {before:.1f} processes at first, and {after:.1f} in the end, "
            f"shared {os.cpu_count()} cores."
        ),
        "",
    ]


def measured(peer: Peer, video: Recorded) -> float:
    """Give the seconds of processor time that a new tracker takes for the frames of a video."""
    given = [peer.given(frame) for frame in video.frames]
    update = peer.fresh(video)
    gc.collect()
    start = time.process_time()
    for frame in given:
        update(frame)
    return time.process_time() - start


def peers_section(videos: list[Recorded], rounds: int) -> list[str]:
    """Measure the trackers in turn, and give the lines of their section."""
    mine, theirs = ours(), others()
    peers = [*mine, *theirs]
    for peer in peers:
        measured(peer, videos[0])
    times: dict[str, list[float]] = {peer.name: [] for peer in peers}
    for _ in range(rounds):
        for video in videos:
            for peer in peers:
                times[peer.name].append(measured(peer, video) / len(video.frames))
    rows = []
    for peer in peers:
        median = statistics.median(times[peer.name])
        ratios = " | ".join(spread(times[peer.name], times[own.name]) for own in mine)
        rows.append(f"| {peer.name} | {1e6 * median:.0f} | {1 / median:,.0f} | {ratios} |")
    fastest = min(theirs, key=lambda peer: statistics.median(times[peer.name]))
    leads = [
        f"{own.name.split()[0]} takes in {ratio(times[fastest.name], times[own.name]):.1f} times"
        for own in mine
    ]
    frames, detections = sum(len(v.frames) for v in videos), sum(v.detections for v in videos)
    return [
        "## Beside trackers",
        "",
        (
            f"{len(videos)} generated videos, {frames:,} frames, {detections / frames:.1f} "
            f"detections a frame, perfect perception; {rounds} rounds. One measurement is one "
            "video, taken by each in turn; ratios are medians, with the span of eight in ten "
            "behind. AAPA runs without attachments, since the others know none; aapa-plus cannot "
            "do without the reported actions and gets them, and what the engine has inferred from "
            "them, with its frames. All run with the settings they come with."
        ),
        "",
        "| | µs a frame, median | frames/s | times as long as AAPA | times as long as aapa-plus |",
        "|---|---|---|---|---|",
        *rows,
        "",
        (
            f"In the same time {' and '.join(leads)} as many frames as the fastest of the others, "
            f"{fastest.name.split()[0]}."
        ),
        "",
    ]


def ratio(theirs: list[float], own: list[float]) -> float:
    """Give the median of how many times as long a measurement took as the one beside it."""
    return statistics.median(a / b for a, b in zip(theirs, own, strict=True))


def spread(theirs: list[float], own: list[float]) -> str:
    """Give that median, and the span of eight in ten."""
    ratios = [a / b for a, b in zip(theirs, own, strict=True)]
    low, high = np.percentile(ratios, [10, 90])
    return f"{statistics.median(ratios):.2f} ({low:.2f}…{high:.2f})"


if __name__ == "__main__":
    main()
