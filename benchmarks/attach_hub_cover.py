"""Task 1.1 on many seeds, with and without attachments, judged by the cell's ground truth.

    python benchmarks/attach_hub_cover.py [--seeds 20] [--clock 6] [--out docs/results/task-1.1.md]

The ground truth is used here, to judge, and nowhere else.
"""

from __future__ import annotations

import argparse
import statistics
import tempfile
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from icarus_lite import load_domain
from runtime.config import load_robot
from runtime.parts import load_parts
from runtime.run import RunOptions, find_task, run_at
from runtime.workplace import open_workplace

DOMAIN = Path(__file__).parent.parent / "domains" / "gearbox.icr"


@dataclass(frozen=True, slots=True)
class Row:
    """One run: what the system said, and what was true in the end."""

    seed: int
    attachments: bool
    achieved: bool
    seated: bool
    cycles: int
    seconds: float
    reason: str


def run(seed: int, clock: float, folder: Path, *, attachments: bool) -> Row:
    """Run one seed."""
    domain = load_domain(DOMAIN)
    task = find_task(domain, "1.1")
    config = load_robot("ur5")
    options = RunOptions(attachments=attachments, seed=seed, clock=clock)
    trace = folder / f"{seed}-{attachments}.jsonl"
    begun = time.perf_counter()
    with open_workplace(config, load_parts(), seed=seed, clock=clock, log=trace) as workplace:
        result = run_at(workplace, domain, task, config, options, trace)
        seated = workplace.cell.truth.seated
    return Row(
        seed,
        attachments,
        result.achieved,
        seated.get("hubcover-1", "").startswith("case"),
        result.cycles,
        time.perf_counter() - begun,
        result.reason,
    )


def report(rows: Sequence[Row], clock: float) -> Iterator[str]:
    """Give the results as a Markdown page."""
    yield "# Task 1.1, attach hub cover to case, UR5"
    yield ""
    yield f"Made by `make bench-task`; stand-in controller at {clock:g} times real time."
    yield ""
    yield "| attachments | runs | achieved | seated (truth) | false beliefs | cycles | seconds |"
    yield "|---|---|---|---|---|---|---|"
    for attachments in (True, False):
        some = [row for row in rows if row.attachments is attachments]
        false = sum(row.achieved != row.seated for row in some)
        yield (
            f"| {'with' if attachments else 'without'} | {len(some)} "
            f"| {sum(row.achieved for row in some)} | {sum(row.seated for row in some)} | {false} "
            f"| {statistics.median(row.cycles for row in some):g} "
            f"| {statistics.median(row.seconds for row in some):.1f} |"
        )
    yield ""
    yield "Cycles and seconds are medians."
    yield ""
    yield "Why the runs without attachments failed:"
    yield ""
    for row in rows:
        if not row.attachments:
            yield f"* seed {row.seed}: {row.reason}"


def main() -> int:
    """Run it all; the exit status says whether each run with attachments was achieved and true."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--clock", type=float, default=6.0)
    parser.add_argument("--out", type=Path)
    arguments = parser.parse_args()
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(arguments.seeds):
            for attachments in (True, False):
                row = run(seed, arguments.clock, Path(folder), attachments=attachments)
                rows.append(row)
                print(row, flush=True)
    text = "\n".join(report(rows, arguments.clock)) + "\n"
    print(text)
    if arguments.out:
        arguments.out.parent.mkdir(parents=True, exist_ok=True)
        arguments.out.write_text(text, encoding="utf-8")
    good = all(row.achieved and row.seated for row in rows if row.attachments)
    return 0 if good else 1


if __name__ == "__main__":
    raise SystemExit(main())
