"""How near the generated data comes to what is published of LA-CATER, and how the noise was set.

    python benchmarks/generator_calibration.py [--videos 1000] [--seed 1] [--tuning-videos 250]
        [--tuning-seed 2] [--jobs 2] [--out docs/results/generator.md]

One number is fitted, the jitter of the detector's boxes, to one published figure, the visible
level of AAPA-10k with the trained detector, on the tuning seed. All else is only reported.
"""

from __future__ import annotations

import argparse
import math
import multiprocessing
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from aapa.lacater.generator import DetectorNoise, generate_video, simulate
from aapa.lacater.generator.detector import detect
from aapa.lacater.generator.visibility import visible_shares
from aapa.lacater.label_rules import contained_frames, frame_masks
from aapa.lacater.layout import PerceptionKind
from aapa.lacater.metric import first_sighting, score_video
from aapa.lacater.models import model_named
from aapa.lacater.video import Perception
from aapa.lacater.video import Video as LabelledVideo
from icarus_lite import load_domain
from runtime.cater.attachments import AttachmentEngine, timed_actions
from runtime.cater.evaluate import cater_domain
from runtime.cater.evaluation import cast_of, frames_of, run_model

TASKS = ("visible", "occluded", "contained", "carried")
COLUMNS = (*TASKS, "overall")
SPLITS = (
    ("train", 9300, (63.00, 3.03, 29.43, 4.54)),
    ("dev", 3327, (63.27, 2.89, 29.19, 4.65)),
    ("test", 1371, (64.13, 3.07, 28.56, 4.24)),
)
EPISODES = (343, 732, 255, 28, 3)
"""Videos of the test split with 0, 1, … containment episodes."""

PAPER_PP = (99.60, 90.53, 94.16, 83.02, 96.54)
PAPER_OD = (88.75, 82.15, 80.64, 68.22, 84.63)
PAPER_OD_L2 = (1.35, 2.44, 2.64, 5.12, 2.10)
TARGET = PAPER_OD[0]
MODEL = "aapa-10000"
FLICKER = {"contained": 2.64 - 2.25, "carried": 5.12 - 4.65}
"""Px: the published mL2 of AAPA-10k less that of AAPA-6k5, with the trained detector."""

RADII_PX = (math.sqrt(6500), 100.0)
JITTERS = (0.0, 0.4, 0.6, 0.7, 0.8)
LASTING = (0.0, 0.5, 0.9)


NOTHING = (math.nan,) * len(COLUMNS)


@dataclass(frozen=True, slots=True)
class Scores:
    """What AAPA-10k scores on one video: IoU in 0…1, distance in px."""

    miou: tuple[float, ...] = NOTHING
    ml2: tuple[float, ...] = NOTHING


@dataclass(frozen=True, slots=True)
class Counted:
    """What is counted in one video."""

    shares: tuple[float, ...]
    episodes: int
    elapsed: tuple[float, ...]
    smallest: tuple[int, ...]
    largest: tuple[int, ...]
    od: Scores
    pp: Scores


@lru_cache(maxsize=1)
def engine() -> AttachmentEngine:
    """Give the engine that infers the attachments, one a process."""
    return AttachmentEngine(load_domain(cater_domain()))


def counted(seed: int, number: int) -> Counted:
    """Count and score one video."""
    made = generate_video(seed, number, DetectorNoise())
    video, scene = made.video, made.video.scene
    assert scene is not None
    assert video.labels.snitch is not None
    contained = video.masks.containment
    begun = contained & ~np.concatenate([[False], contained[:-1]])
    since = np.arange(len(contained)) - np.maximum.accumulate(
        np.where(begun, np.arange(len(contained)), 0)
    )
    snitch = video.labels.snitch[:, 2:] - video.labels.snitch[:, :2]
    od, pp = (scored(video, made.perceptions[kind]) for kind in PerceptionKind)
    return Counted(
        tuple(float(getattr(video.masks, task).mean()) for task in TASKS),
        int(begun.sum()),
        tuple(mean_or_nan(since[getattr(video.masks, task)]) for task in FLICKER),
        tuple(snitch.min(axis=0).tolist()),
        tuple(snitch.max(axis=0).tolist()),
        od,
        pp,
    )


def scored(made: LabelledVideo, perception: Perception) -> Scores:
    """Score AAPA-10k on one video; all NaN where the snitch is never detected."""
    start = first_sighting(perception)
    assert made.scene is not None
    assert made.labels.snitch is not None
    if start is None:
        return Scores()
    reports = engine().reports(timed_actions(made.scene), made.labels.frames)
    boxes = run_model(model_named(MODEL), frames_of(perception, reports), cast_of(made.scene))
    score = score_video(boxes, made.labels.snitch.astype(np.float64), made.masks, start)
    return Scores(
        tuple(score.miou[column] for column in COLUMNS),
        tuple(score.ml2[column] for column in COLUMNS),
    )


def visible_levels(
    seed: int, noises: Sequence[DetectorNoise], number: int
) -> tuple[float, ...] | None:
    """Give the visible mIoU of AAPA-10k on one video under each noise; None without the snitch."""
    simulation = simulate(seed, number)
    labels, scene = simulation.labels(), simulation.scene()
    masks = frame_masks(labels, scene)
    shares = visible_shares(simulation, contained_frames(scene, labels.frames))
    reports = engine().reports(timed_actions(scene), labels.frames)
    assert labels.snitch is not None
    levels = []
    for noise in noises:
        perception = detect(simulation, shares, noise, np.random.default_rng((seed, number)))
        start = first_sighting(perception)
        if start is None:
            return None
        boxes = run_model(model_named(MODEL), frames_of(perception, reports), cast_of(scene))
        score = score_video(boxes, labels.snitch.astype(np.float64), masks, start)
        levels.append(score.miou["visible"])
    return tuple(levels)


def distances_on_the_floor() -> NDArray[np.float64]:
    """Give the distances, px, between the images of many pairs of places on the floor."""
    places = np.array(
        [
            simulation.viewpoint.project(simulation.planned[:, 0])[:, :2][:2]
            for simulation in (simulate(3, number) for number in range(400))
        ]
    )
    first, second = places[:, 0], places[:, 1]
    pairs: NDArray[np.float64] = np.linalg.norm(first[:, None] - second[None], axis=-1)
    return pairs[~np.eye(len(pairs), dtype=np.bool_)]


def mean_or_nan(values: NDArray[np.int64]) -> float:
    """Give the mean of some numbers, NaN of none."""
    return float(values.mean()) if len(values) else math.nan


def mean_sem(values: NDArray[np.float64]) -> tuple[float, float]:
    """Give mean and standard error over videos, NaN left out."""
    known = values[~np.isnan(values)]
    return float(known.mean()), float(known.std(ddof=1) / math.sqrt(len(known)))


def pooled() -> tuple[float, ...]:
    """Give the published shares over all three splits."""
    total = sum(count for _, count, _ in SPLITS)
    return tuple(
        sum(count * shares[i] for _, count, shares in SPLITS) / total for i in range(len(TASKS))
    )


def scene_report(videos: Sequence[Counted], seed: int) -> Iterator[str]:
    """Report what the scenes are like."""
    shares = 100 * np.array([video.shares for video in videos])
    yield f"## Labels ({len(videos)} videos, seed {seed})"
    yield ""
    yield "Shares of the frames, %. *Off* is the distance from the published, all splits together,"
    yield "in standard errors of ours."
    yield ""
    yield "| | " + " | ".join(TASKS) + " |"
    yield "|---|" + "---|" * len(TASKS)
    for name, count, published in SPLITS:
        yield f"| LA-CATER {name}, {count} | " + " | ".join(f"{s:.2f}" for s in published) + " |"
    yield "| LA-CATER, all | " + " | ".join(f"{s:.2f}" for s in pooled()) + " |"
    rows = [mean_sem(shares[:, i]) for i in range(len(TASKS))]
    yield "| generated | " + " | ".join(f"{m:.2f} ± {s:.2f}" for m, s in rows) + " |"
    off = [(m - p) / s for (m, s), p in zip(rows, pooled(), strict=True)]
    yield "| off | " + " | ".join(f"{o:+.1f}" for o in off) + " |"
    yield ""
    yield "## Containment episodes"
    yield ""
    yield "Videos in a thousand with so many episodes; the published are of the test split (the"
    yield "public track vectors of OPNet+AA)."
    yield ""
    counts = np.bincount([video.episodes for video in videos], minlength=len(EPISODES))
    known = np.array(EPISODES) / sum(EPISODES)
    share = counts[: len(EPISODES)] / len(videos)
    error = np.sqrt(known * (1 - known) * (1 / len(videos) + 1 / sum(EPISODES)))
    yield "| episodes | " + " | ".join(map(str, range(len(EPISODES)))) + " |"
    yield "|---|" + "---|" * len(EPISODES)
    yield "| LA-CATER | " + " | ".join(f"{1000 * k:.0f}" for k in known) + " |"
    yield "| generated | " + " | ".join(f"{1000 * s:.0f}" for s in share) + " |"
    yield "| off, SE | " + " | ".join(f"{z:+.1f}" for z in (share - known) / error) + " |"
    yield ""
    low = np.min([video.smallest for video in videos], axis=0)
    high = np.max([video.largest for video in videos], axis=0)
    yield f"The snitch's boxes are {low[0]} x {low[1]} to {high[0]} x {high[1]} px (published: "
    yield "15 x 16 to 41 x 41, of nine times as many videos)."
    yield ""


def score_report(videos: Sequence[Counted]) -> Iterator[str]:
    """Report what AAPA-10k scores on the data, beside the paper."""
    yield "## AAPA-10k on this data"
    yield ""
    yield "Only the first column of the second pair of rows was fitted, on other videos."
    yield ""
    yield "| | " + " | ".join(COLUMNS) + " |"
    yield "|---|" + "---|" * len(COLUMNS)
    for name, attribute, published in (("perfect", "pp", PAPER_PP), ("detector", "od", PAPER_OD)):
        scores = 100 * np.array([getattr(video, attribute).miou for video in videos])
        yield f"| {name}, paper | " + " | ".join(f"{p:.2f}" for p in published) + " |"
        rows = [mean_sem(scores[:, i]) for i in range(len(COLUMNS))]
        yield f"| {name}, generated | " + " | ".join(f"{m:.2f} ± {s:.2f}" for m, s in rows) + " |"
    distances = np.array([video.od.ml2 for video in videos])
    rows = [mean_sem(distances[:, i]) for i in range(len(COLUMNS))]
    yield "| detector, px, paper | " + " | ".join(f"{p:.2f}" for p in PAPER_OD_L2) + " |"
    yield "| detector, px, generated | " + " | ".join(f"{m:.2f} ± {s:.2f}" for m, s in rows) + " |"
    yield ""


def fitted(jitters: Sequence[float], levels: NDArray[np.float64]) -> float:
    """Give the jitter at which the level is the published one."""
    return float(np.interp(-TARGET, -levels[1:], jitters[1:]))


def noise_report(
    videos: Sequence[Counted], tuning: NDArray[np.float64], seed: int
) -> Iterator[str]:
    """Report how each number of the noise was come by."""
    default = DetectorNoise()
    means = 100 * np.nanmean(tuning, axis=0)
    levels, lasting = means[: len(JITTERS)], means[len(JITTERS) :]
    yield "## The detector's noise"
    yield ""
    yield "**Whole px.** The published detections are cut down to whole px, the labels rounded. For"
    yield f"boxes of about 22 px this alone brings AAPA-10k's visible level to {levels[0]:.2f}"
    yield "from 99.6; most of the published loss is this, and no matter of the network."
    yield ""
    yield f"**Jitter** ({default.jitter_px} px): fitted to the published visible level, {TARGET},"
    yield f"of AAPA-10k on {len(tuning)} videos of seed {seed}. Interpolated: "
    yield f"{fitted(JITTERS, levels):.3f} px."
    yield ""
    yield "| jitter, px | " + " | ".join(f"{j:g}" for j in JITTERS) + " |"
    yield "|---|" + "---|" * len(JITTERS)
    yield "| visible level | " + " | ".join(f"{level:.2f}" for level in levels) + " |"
    yield ""
    yield f"**Lasting jitter** ({default.lasting:g} of the variance): nothing is published that"
    yield "would tell. A network gives the same box for the same picture, but no two compressed"
    yield "frames are quite the same; half and half is our choice. It does not move the level"
    yield (
        "("
        + ", ".join(
            f"{level:.2f} at {share:g}" for share, level in zip(LASTING, lasting, strict=True)
        )
        + "), but the more lasts, the less there is to gain from averaging over frames."
    )
    yield ""
    yield from false_snitch_report(videos)
    yield "**Class 0** is never reported: it is the network's background class. **Misses** "
    yield f"({default.miss_rate:.0%} of the frames, in bursts), **classes mistaken** "
    yield f"({default.swap_rate * default.swap_frames:.1%} of the frames of each object, "
    yield f"{default.swap_frames:g} frames at a time, for one of the next size or the other"
    yield f"material), **other false boxes** ({default.false_others:g} begin per frame),"
    yield f"**{default.half_seen:.0%} seen** as the point where half is found, and jitter doubled"
    yield "for what is hidden: the paper says that there are few errors, that classes are mistaken"
    yield "in some frames, and no more. These are our choices; no column was fitted with them."
    yield ""
    yield "Not modelled: the heavy tail of the published per-video scores (a standard error of 0.15"
    yield "over 1,371 videos is a spread of 5.5 points between videos, larger than ours), which"
    yield "looks like a few videos in which the detector fails for long."
    yield ""


def false_snitch_report(videos: Sequence[Counted]) -> Iterator[str]:
    """Report how often the snitch is seen where it is not, and what that is concluded from."""
    default = DetectorNoise()
    far = distances_on_the_floor()
    ring = float(np.mean(far * ((far > RADII_PX[0]) & (far <= RADII_PX[1]))))
    elapsed = np.array([video.elapsed for video in videos])
    yield f"**False snitches** ({default.false_snitches:g} begin per frame): the paper puts the"
    yield "difference between AAPA-6k5 and AAPA-10k down to the snitch being seen elsewhere. While"
    yield "it is contained nothing corrects such a box. One that begins at any frame, anywhere on"
    yield "the floor, is believed by tau 10000 and not by 6500 if it is 80.6 to 100 px away, and"
    yield "costs its distance until the snitch comes out. Rate = difference / (mean time since"
    yield f"containment x mean of distance over that ring, {ring:.1f} px):"
    yield ""
    yield "| task | difference, px (published) | time, frames (generated) | rate per frame |"
    yield "|---|---|---|---|"
    for index, (task, difference) in enumerate(FLICKER.items()):
        frames = mean_sem(elapsed[:, index])[0]
        rate = difference / (frames * ring)
        yield f"| {task} | {difference:.2f} | {frames:.0f} | {rate:.5f} |"
    yield ""


def speed(seed: int, count: int = 60) -> float:
    """Give how many videos one core generates in a minute, files not included."""
    generate_video(seed, 0, DetectorNoise())
    begun = time.process_time()
    for number in range(count):
        generate_video(seed, number, DetectorNoise())
    return 60 * count / (time.process_time() - begun)


def main() -> int:
    """Measure all and write the page; the exit status says whether the jitter is the fitted one."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--videos", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--tuning-videos", type=int, default=250)
    parser.add_argument("--tuning-seed", type=int, default=2)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--out", type=Path)
    arguments = parser.parse_args()
    default = DetectorNoise()
    noises = [replace(default, jitter_px=jitter) for jitter in JITTERS]
    noises += [replace(default, lasting=share) for share in LASTING]
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(arguments.jobs, mp_context=context) as pool:
        videos = list(
            pool.map(partial(counted, arguments.seed), range(arguments.videos), chunksize=10)
        )
        levels = pool.map(
            partial(visible_levels, arguments.tuning_seed, noises),
            range(arguments.tuning_videos),
            chunksize=5,
        )
        tuning = np.array([level for level in levels if level is not None])
    rate = speed(arguments.seed)
    lines = [
        "# The generator beside LA-CATER",
        "",
        "Made by `make bench-generator`.",
        "",
        *scene_report(videos, arguments.seed),
        *score_report(videos),
        *noise_report(videos, tuning, arguments.tuning_seed),
        "## Speed",
        "",
        f"{rate:.0f} videos a minute on one core, {rate * 300 / 60:.0f} frames a second, before",
        "they are written.",
    ]
    text = "\n".join(lines) + "\n"
    print(text)
    if arguments.out:
        arguments.out.parent.mkdir(parents=True, exist_ok=True)
        arguments.out.write_text(text, encoding="utf-8")
    best = fitted(JITTERS, 100 * np.nanmean(tuning, axis=0)[: len(JITTERS)])
    return 0 if abs(best - default.jitter_px) < 0.02 else 1


if __name__ == "__main__":
    raise SystemExit(main())
