"""Alignment, and whole frames, at growing scale: hundreds and thousands of objects of one type."""

from __future__ import annotations

import gc
import math
import statistics
import time
from collections.abc import Callable, Iterator
from functools import partial

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from aapa import Anchoring, AnchoringParameters, Detection, DetectionColumns, Place, align

Centres = NDArray[np.float64]
"""(n, 2) in px."""

SIZES = (15, 100, 300, 1000, 2000, 5000)
SPACING = 60.0
NOISE = 6.0
MISSED = 0.05
WARM = 5
FRAMES = 25


def scaling_section(rounds: int) -> list[str]:
    """Measure at each size, and give the lines of the section."""
    tables = [
        (f"align, tau {tau:.0f}", partial(aligning, scene, tau)) for tau in (400.0, 3000.0, 6500.0)
    ]
    tables += [
        ("align, tau 6500, all anew", partial(aligning, strangers, 6500.0)),
        ("scipy, full matrix, tau 3000", full_matrix),
        ("whole frame, tau 3000", partial(whole_frames, 3000.0)),
        ("whole frame, tau 6500", partial(whole_frames, 6500.0)),
        ("whole frame in columns, tau 3000", partial(whole_frames_in_columns, 3000.0)),
        ("whole frame in columns, tau 6500", partial(whole_frames_in_columns, 6500.0)),
    ]
    rows = []
    for name, measure in tables:
        cells = " | ".join(measure(count, rounds) for count in SIZES)
        rows.append(f"| {name} | {cells} |")
    heads = " | ".join(f"N = {count:,}" for count in SIZES)
    return [
        "## At scale",
        "",
        (
            f"Milliseconds, median (least) of {rounds} scenes. All objects are of one type, one to "
            f"{SPACING:.0f} x {SPACING:.0f} px, and move by {NOISE:.0f} px (standard deviation) "
            f"from frame to frame; {100 * MISSED:.0f} % are missed, and as many detections are of "
            "nothing. Each alignment is the exact optimum. *All anew* has places at random in both "
            "frames, the worst there is: nearly every pair is contested."
        ),
        "",
        (
            f"*Whole frame* is `Anchoring.update` in a stream of {FRAMES} frames, the first {WARM} "
            "left out: checks, alignment, an `Anchor` for every object (its reason is put into "
            "words when it is read), and the reasoning about what is missed, of which there is a "
            "backlog then. *In columns* is the same stream by `Anchoring.update_columns`: from an "
            "array of boxes, as detectors give it, to arrays of the names, boxes, confidences and "
            "statuses of all anchors. The reasons are kept as numbers; no `Anchor` is asked for."
        ),
        "",
        f"| | {heads} |",
        "|---|" + "---|" * len(SIZES),
        *rows,
    ]


def scene(count: int, chance: np.random.Generator) -> tuple[Centres, Centres]:
    """Give where objects were, and where they are detected now."""
    side = SPACING * math.sqrt(count)
    old = chance.uniform(0, side, (count, 2))
    return old, detected(old, side, chance)


def strangers(count: int, chance: np.random.Generator) -> tuple[Centres, Centres]:
    """Give places that have nothing to do with each other."""
    old, new = chance.uniform(0, SPACING * math.sqrt(count), (2, count, 2))
    return old, new


def detected(old: Centres, side: float, chance: np.random.Generator) -> Centres:
    """Give what is detected of objects, moved, some of them missed and others of nothing."""
    new = old + chance.normal(0, NOISE, old.shape)
    new = new[chance.random(len(old)) > MISSED]
    new = np.concatenate([new, chance.uniform(0, side, (len(old) - len(new), 2))])
    shuffled: Centres = new[chance.permutation(len(new))]
    return shuffled


def aligning(
    scenes: Callable[[int, np.random.Generator], tuple[Centres, Centres]],
    tau: float,
    count: int,
    rounds: int,
) -> str:
    """Give the time of `align`."""
    chance = np.random.default_rng(count)
    times = []
    for _ in range(rounds + 1):
        old, new = scenes(count, chance)
        anchors = [Place("object", (x, y)) for x, y in old.tolist()]
        found = [Place("object", (x, y)) for x, y in new.tolist()]
        times.append(mean_of(partial(align, anchors, found, tau), count))
    return shown(times[1:])


def full_matrix(count: int, rounds: int) -> str:
    """Give the time that scipy takes for the full matrix, making the matrix included."""
    chance = np.random.default_rng(count)
    times = []
    for _ in range(min(rounds, 3) + 1):
        old, new = scene(count, chance)
        times.append(mean_of(partial(solve_all, old, new), count))
    return shown(times[1:])


def solve_all(old: Centres, new: Centres) -> None:
    """Make the full matrix, and let scipy find the optimum."""
    costs = ((old[:, None] - new[None]) ** 2).sum(axis=-1)
    linear_sum_assignment(np.minimum(costs, 3000.0))


def whole_frames(tau: float, count: int, rounds: int) -> str:
    """Give the time of an update within a stream; one of each stream's frames after the other."""
    times = []
    for seed in range(max(1, rounds // 2)):
        anchoring = beginning(tau, count)
        for number, frame in enumerate(stream(count, seed)):
            start = time.process_time()
            anchoring.update(frame)
            if number >= WARM:
                times.append(time.process_time() - start)
    return shown(times)


def whole_frames_in_columns(tau: float, count: int, rounds: int) -> str:
    """Give the time from an array of boxes to arrays of what is anchored, within a stream."""
    times = []
    for seed in range(max(1, rounds // 2)):
        anchoring = beginning(tau, count)
        for number, boxes in enumerate(boxes_of(count, seed)):
            start = time.process_time()
            found = anchoring.update_columns(DetectionColumns("object", boxes))
            read = found.names, found.boxes, found.confidences, found.statuses
            if number >= WARM:
                times.append(time.process_time() - start)
            assert len(set(map(len, read))) == 1
    return shown(times)


def beginning(tau: float, count: int) -> Anchoring:
    """Give an anchoring that knows nothing yet of a scene of so many objects."""
    side = math.ceil(SPACING * math.sqrt(count))
    return Anchoring(AnchoringParameters(tau=tau, image_size=(side, side)))


def stream(count: int, seed: int) -> Iterator[list[Detection]]:
    """Give the detections of frame after frame."""
    for boxes in boxes_of(count, seed):
        yield [Detection("object", (a, b, c, d)) for a, b, c, d in boxes.tolist()]


def boxes_of(count: int, seed: int) -> Iterator[NDArray[np.float64]]:
    """Give (n, 4) the boxes that are detected in frame after frame, px."""
    chance = np.random.default_rng(seed)
    side = SPACING * math.sqrt(count)
    places = chance.uniform(0, side, (count, 2))
    for _ in range(FRAMES):
        places += chance.normal(0, NOISE, places.shape)
        centres = detected(places, side, chance)
        yield np.concatenate([centres - 9.0, centres + 9.0], axis=1)


def mean_of(call: Callable[[], object], count: int) -> float:
    """Give the seconds of a call; the mean of several in a row where it is short."""
    repeats = max(1, 1000 // count)
    gc.collect()
    start = time.process_time()
    for _ in range(repeats):
        call()
    return (time.process_time() - start) / repeats


def shown(times: list[float]) -> str:
    """Give the median, and the least, in ms."""
    return f"{1e3 * statistics.median(times):.2f} ({1e3 * min(times):.2f})"
