"""The command line of the experiment: which runs, how many at a time, and where the page goes."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Iterator, Sequence
from itertools import groupby
from pathlib import Path
from typing import Final

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)

from gearbox.faults import KINDS, applies
from gearbox.page import write_page
from gearbox.pool import run_all
from gearbox.rows import GOOD, Ending, Row, RowFile, code_digest
from gearbox.running import Desk
from gearbox.trials import CLOCK, NO_FAULT, TASKS, Trial, trials

ROWS: Final = Path("build/experiment-gearbox.jsonl")
_INTERRUPTED: Final = 130
_PATIENCE_S: Final = 90.0
_ROBOT_S: Final = 900.0


def main(words: Sequence[str] | None = None) -> int:
    """Run what is not run yet, write the page; 0 if no run ended as none must."""
    arguments = _arguments(words)
    kept = RowFile(arguments.rows)
    wanted = whole() if arguments.whole else _chosen(arguments)
    if not arguments.page_only:
        try:
            _run(wanted, arguments, kept)
        except KeyboardInterrupt:
            print(f"\ninterrupted; the same command goes on from {kept.path}", file=sys.stderr)
            return _INTERRUPTED
    rows = list(kept.rows.values())
    if arguments.out is not None:
        write_page(rows, arguments.out, arguments.images or arguments.out.parent)
    bad = [row for row in rows if row.ending not in GOOD or row.unsafe or row.trace.damage]
    return 1 if any(_counts(row) for row in bad) else 0


def _counts(row: Row) -> bool:
    """Whether a bad row speaks against the program: without attachments it may well fail."""
    return row.trial.attachments or row.ending is Ending.BROKEN or bool(row.unsafe)


def whole() -> list[Trial]:
    """Give the runs of the whole experiment, the important ones first."""
    tasks, sides, struck = list(TASKS), (True, False), [name for name in KINDS if name != NO_FAULT]
    parts = (
        trials(tasks, range(50), [NO_FAULT], sides, CLOCK),
        trials(tasks, range(10), struck, (True,), CLOCK),
        # At real time: that nothing depends on the clock, and how far a stopped arm goes.
        trials(tasks, range(2), [NO_FAULT], sides, 1.0),
        trials(["1.1", "2.1"], range(2), struck, (True,), 1.0),
    )
    return [trial for part in parts for trial in part if applies(trial)]


def _chosen(arguments: argparse.Namespace) -> list[Trial]:
    """Give the runs that the options choose."""
    seeds = range(arguments.first_seed, arguments.first_seed + arguments.seeds)
    chosen = trials(arguments.tasks, seeds, arguments.faults, arguments.sides, arguments.clock)
    return [trial for trial in chosen if applies(trial)]


def _run(chosen: Sequence[Trial], arguments: argparse.Namespace, kept: RowFile) -> None:
    """Carry out what has no row yet, with a bar that shows how far it is."""
    code = code_digest()
    wanted = [trial for trial in chosen if not _is_done(kept.rows.get(trial.key), arguments, code)]
    console = Console(stderr=True)
    progress = Progress(
        TextColumn("runs"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TimeRemainingColumn(),
        TextColumn("{task.description}"),
        console=console,
        disable=not console.is_terminal,
    )
    desk = Desk(arguments.traces, arguments.keep)
    with progress:
        bar = progress.add_task("", total=len(wanted))
        for row in _rows(wanted, desk, arguments.jobs):
            kept.add(row)
            progress.update(bar, advance=1, description=f"{row.trial.key}: {row.ending}")
            if row.ending not in GOOD or row.unsafe or row.trace.damage or not console.is_terminal:
                progress.console.print(told(row), highlight=False, markup=False, soft_wrap=True)


def _rows(wanted: Sequence[Trial], desk: Desk, jobs: int) -> Iterator[Row]:
    """Carry runs out, those of one clock after those of another."""
    for clock, some in groupby(wanted, key=lambda trial: trial.clock):
        # At real time a run mostly waits for the arm: more of them fit on the machine.
        yield from run_all(list(some), desk, jobs * (2 if clock <= 1 else 1), limit_s)


def limit_s(trial: Trial) -> float:
    """Give how long a run may take, s of wall time."""
    return _PATIENCE_S + _ROBOT_S / trial.clock


def told(row: Row) -> str:
    """Tell a row on a line, for whoever watches."""
    words = f"{row.trial.key}: {row.ending}, {row.cycles} cycles, {row.wall_s:.1f} s"
    if row.ending is not Ending.ACHIEVED:
        words += f": {row.reason.strip().splitlines()[-1] if row.reason else 'no reason'}"
    for unsafe in row.unsafe:
        words += f"\n  UNSAFE: {unsafe}"
    if row.trace.damage:
        words += f"\n  TRACE: {row.trace.damage}"
    return words


def _is_done(row: Row | None, arguments: argparse.Namespace, code: str) -> bool:
    if row is None or (arguments.redo_broken and row.ending not in GOOD):
        return False
    return row.code == code or not arguments.redo_stale


def _arguments(words: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="experiment_gearbox.py",
        description="The paper's six tasks, many seeds, with and without attachments, through "
        "every fault a cell can have. Goes on where it was interrupted.",
    )
    parser.add_argument(
        "--whole", action="store_true", help="all of it, whatever --tasks, --seeds and so on say"
    )
    names = ", ".join(KINDS)
    parser.add_argument("--tasks", type=_of(TASKS), default=list(TASKS), help="such as 1.1,1.4")
    parser.add_argument("--seeds", type=int, default=50, help="how many")
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument(
        "--faults",
        type=_of(KINDS),
        default=[NO_FAULT],
        help=f"'all' (of them but none), or some of: {names}",
    )
    parser.add_argument(
        "--attachments", choices=("both", "with", "without"), default="both", dest="sides"
    )
    parser.add_argument("--clock", type=float, default=CLOCK, help="robot seconds per second")
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)))
    parser.add_argument("--rows", type=Path, default=ROWS, help="what has been run, JSON Lines")
    parser.add_argument("--traces", type=Path, default=ROWS.with_suffix(""), help="a folder")
    parser.add_argument("--keep", action="store_true", help="keep the traces of good runs too")
    parser.add_argument("--redo-stale", action="store_true", help="run again what older code ran")
    parser.add_argument("--redo-broken", action="store_true", help="run again what ended badly")
    parser.add_argument("--page-only", action="store_true", help="run nothing, write the page")
    parser.add_argument("--out", type=Path, help="the page, such as docs/results/gearbox.md")
    parser.add_argument("--images", type=Path, help="where its figures go; beside it if left out")
    arguments = parser.parse_args(sys.argv[1:] if words is None else words)
    arguments.sides = {"both": (True, False), "with": (True,), "without": (False,)}[arguments.sides]
    if arguments.jobs < 1 or arguments.seeds < 1 or not 0 < arguments.clock <= 100:
        parser.error("--jobs and --seeds take 1 or more, --clock more than 0 and up to 100")
    return arguments


class _of:  # noqa: N801 - reads as an argument's type
    """Reads a list of names, parted by commas.

    Args:
        known: The names that there are.
    """

    def __init__(self, known: object) -> None:
        self._known = list(known)  # type: ignore[call-overload]
        self.__name__ = "name"

    def __call__(self, text: str) -> list[str]:
        """Read a list of names. Raises ArgumentTypeError for one that there is not."""
        if text == "all":
            return [name for name in self._known if name != NO_FAULT]
        for name in text.split(","):
            if name not in self._known:
                there = ", ".join(self._known)
                raise argparse.ArgumentTypeError(f"there is no {name!r}; there are {there}, all")
        return text.split(",")
