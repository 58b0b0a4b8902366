"""The page of the experiment, made of its rows alone."""

from __future__ import annotations

import os
import platform
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path

from gearbox import figures, tables
from gearbox.rows import GOOD, Ending, Row
from gearbox.statistics import Rate, median
from gearbox.trials import NO_FAULT

_TASKS_FIGURE = "gearbox-tasks.svg"
_FAULTS_FIGURE = "gearbox-faults.svg"

_HOW_JUDGED = """\
*Done* is judged by the ground truth of the simulated cell, which nothing else in a run ever sees:
the parts really sit where the task wants them, and the run said so. Intervals are Wilson's, 95 %.
A *false belief* is an `attached` or `holding` that is not true of the world. Each is believed a
little longer than it is true, because an action has to be reported before its effects are taken
back; *outlived* counts the runs in which one went on after that report, *longest* is the worst of
them in seconds of the arm's clock. *Astray* is the share of anchors, over all cycles, that were
more than 60 mm from their object. Cycles and seconds are medians; *robot s* is the arm's clock,
*s* wall time with everything started and ended anew for the run."""

_HOW_FAULTS = """\
Each fault's moment is drawn from the run's seed. *Struck* counts the runs in which a witness saw
it: the controller's own journal, or the cell's truth; in the others the run was over first. In
half of the runs in which the controller causes it, drawn too, a person sees to the cause of the
stop and gives the word to go on; in the others nobody does, and the run ends. *Recovered* is done
and known to be, after an action had failed, a belief was withdrawn or the arm was set going again.
*Failed, reason true* is a run that ended as failed and gave what really happened as its reason.
*Otherwise* is what must not happen: a goal believed that is not true, a reason that is not the true
one, a program that came to no end. *Unsafe motions* are judged from the controller's journal, not
from what the driver says: motion after a stop or a lost link, places, angles or forces outside the
limits. A trace is *damaged* if it cannot be read again, or if a replay of it comes to
anything else than what is recorded."""

_TO_REPEAT = """\
```console
$ make experiment-gearbox
$ .venv/bin/python benchmarks/experiment_gearbox.py --tasks 1.4 --seeds 10 --attachments with
$ .venv/bin/python benchmarks/experiment_gearbox.py --tasks 1.1 --faults drop_rtde,jam --seeds 5
$ .venv/bin/python benchmarks/experiment_gearbox.py --page-only --out docs/results/gearbox.md
```

The first runs all of it, the others a part; each goes on where it, or another, was interrupted, and
runs several at a time (`--jobs`), each with a stand-in controller at a loopback address of its own.
A line for each run is kept in `build/experiment-gearbox.jsonl`, from which the page is made; the
traces of runs that ended badly are kept beside it, for `icarus repl` and `icarus why`."""

_HOW_TRAVELS = """\
Until it stood still, by the controller's journal, in the runs with faults. At a fast clock as many
milliseconds of this machine are more of the arm's time: what it would be at a robot is told by the
rows of clock 1."""


def write_page(rows: Sequence[Row], path: Path, images: Path) -> None:
    """Write the page and its figures."""
    path.parent.mkdir(parents=True, exist_ok=True)
    images.mkdir(parents=True, exist_ok=True)
    clock = usual_clock(rows)
    usual = [row for row in rows if row.trial.clock == clock]
    calm = [row for row in usual if row.trial.fault == NO_FAULT]
    (images / _TASKS_FIGURE).write_text(figures.successes(calm), encoding="utf-8")
    hit = [row for row in usual if row.trial.attachments]
    drawn = figures.endings(tables.by_fault(hit).items())
    (images / _FAULTS_FIGURE).write_text(drawn, encoding="utf-8")
    folder = os.path.relpath(images, path.parent)
    text = "\n".join(page(rows, "" if folder == "." else f"{folder}/"))
    path.write_text(f"{text}\n", encoding="utf-8")


def usual_clock(rows: Sequence[Row]) -> float:
    """Give the clock at which most of the runs were made."""
    counts = Counter(row.trial.clock for row in rows)
    return counts.most_common(1)[0][0] if counts else 1.0


def page(rows: Sequence[Row], images: str) -> Iterator[str]:
    """Give the page as lines of Markdown.

    Args:
        rows: What was run.
        images: The folder of the figures, as seen from the page, with its slash.
    """
    clock = usual_clock(rows)
    usual = [row for row in rows if row.trial.clock == clock]
    calm = [row for row in usual if row.trial.fault == NO_FAULT]
    struck = [row for row in usual if row.trial.fault != NO_FAULT]
    yield "# The paper's six tasks, through every fault a cell can have"
    yield ""
    yield "Made by `make experiment-gearbox`."
    yield ""
    yield _setting(rows, clock)
    yield ""
    yield from _summary(rows, calm)
    yield ""
    if calm:
        yield from ("## Nothing goes wrong", "", *tables.tasks_table(calm), "")
        yield from (f"![How often each task was done]({images}{_TASKS_FIGURE})", "", _HOW_JUDGED)
        yield ""
        yield from _why_without(calm)
    if struck:
        yield from ("## Something goes wrong", "")
        yield from _faults(struck, images)
        yield from _travels([row for row in rows if row.trial.fault != NO_FAULT])
    yield from _beliefs(usual)
    yield from _clocks(rows)
    yield from _exceptions(rows)
    yield from ("", "## To repeat it, or a part of it", "", _TO_REPEAT)


def _setting(rows: Sequence[Row], clock: float) -> str:
    loads = [row.load for row in rows] or [0.0]
    codes = Counter(row.code for row in rows if row.code)
    versions = (
        "all by the same code"
        if len(codes) <= 1
        else f"by {len(codes)} states of the code ({', '.join(map(str, codes.values()))} runs)"
    )
    return (
        f"{len(rows):,} runs, {versions}; stand-in controller (not a robot) at {clock:g} times "
        f"real time, simulated cell, the real `ur-rtde` client. {platform.machine()}, CPython "
        f"{platform.python_version()}, {os.cpu_count()} cores, load {min(loads):.1f} to "
        f"{max(loads):.1f}. At a fast clock the timing of a run depends on the machine: the same "
        "seed is the same scene, noise and plan of faults, not the same number of cycles."
    )


def _summary(rows: Sequence[Row], calm: Sequence[Row]) -> Iterator[str]:
    for attachments, side in ((True, "With"), (False, "Without")):
        some = [row for row in calm if row.trial.attachments is attachments]
        if some:
            false = sum(bool(row.false_at_end) for row in some)
            yield (
                f"* **{side} attachments, nothing goes wrong: {tables.done(some)} done**, "
                f"{false} with a false belief at the end."
            )
    hit = [row for row in rows if row.trial.fault != NO_FAULT and row.trial.attachments]
    if hit:
        good = Rate(sum(row.ending in GOOD for row in hit), len(hit))
        yield f"* **With faults: {good} ended as achieved, recovered, or failed with the reason.**"
    yield f"* **Unsafe motions: {sum(len(row.unsafe) for row in rows)}.**"
    damaged = Rate(sum(bool(row.trace.damage) for row in rows), len(rows))
    yield f"* **Traces damaged: {damaged.hits} of {damaged.runs}.**"
    wall, cpu = median(row.wall_s for row in rows), median(row.cpu_s for row in rows)
    yield f"* A run takes {wall:.1f} s, {cpu:.1f} s of processor time (medians)."


def _why_without(calm: Sequence[Row]) -> Iterator[str]:
    without = [row for row in calm if not row.trial.attachments and not row.achieved]
    if without:
        yield from ("Why runs without attachments failed:", "", *tables.reasons(without), "")


def _faults(struck: Sequence[Row], images: str) -> Iterator[str]:
    for attachments, side in ((True, "With"), (False, "Without")):
        some = [row for row in struck if row.trial.attachments is attachments]
        if not some:
            continue
        yield from (f"### {side} attachments", "", *tables.faults_table(some), "")
        if attachments:
            yield from (f"![How runs ended]({images}{_FAULTS_FIGURE})", "", _HOW_FAULTS, "")
        yield from ("Done, task by task:", "", *tables.matrix(some), "")
        failed = [row for row in some if row.ending is Ending.FAILED]
        if failed:
            yield from ("The reasons of those that failed:", "", *tables.reasons(failed), "")


def _travels(rows: Sequence[Row]) -> Iterator[str]:
    if any(row.travels for row in rows):
        yield from ("### How far the arm went on", "", _HOW_TRAVELS, "")
        yield from (*tables.travels_table(rows), "")


def _beliefs(rows: Sequence[Row]) -> Iterator[str]:
    with_them = [row for row in rows if row.trial.attachments]
    if any(row.episodes for row in with_them):
        yield from ("## What was believed without being true, with attachments", "")
        yield from (*tables.episodes_table(with_them), "")


def _clocks(rows: Sequence[Row]) -> Iterator[str]:
    lines = tables.clocks_table(rows)
    if lines:
        yield from ("## The clock", "")
        yield "The same runs at several paces of the stand-in; 1 is real time."
        yield from ("", *lines, "")


def _exceptions(rows: Sequence[Row]) -> Iterator[str]:
    """Give each run that speaks against the system; without attachments runs fail anyway."""
    yield from ("## Every run that ended otherwise", "")
    lines = tables.exceptions(rows)
    yield from (lines or ["There is none."])
