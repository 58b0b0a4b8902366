"""The inference engine on "table-top beliefs", beside CLIPS and clingo in one run.

    python benchmarks/engine_peers.py [--objects 15 50 200 1000] [--seconds 8] [--out PAGE.md]

The engines take turns, round after round, in one process; each ratio is between medians of one
round. Whether their facts are right is found out before, in runs of their own, and memory in a
process of its own for each engine. On a quiet machine all of it takes about ten minutes, a third of
them in three frames of CLIPS with all of a thousand things moving.
"""

from __future__ import annotations

import argparse
import platform
import statistics
import sys
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from tabletop.measuring import (
    CLINGO,
    CLIPS,
    OURS,
    SCRATCH,
    SNAPSHOTS,
    Times,
    Verdict,
    checked,
    makers,
    peak_line,
    peak_memory_mb,
    timed,
)
from tabletop.oracle import total, truth
from tabletop.scene import FRAMES, Mode, make_workload, moved_count
from tabletop.whys import Whys, measure_whys, section

ENGINES = (OURS, SNAPSHOTS, CLIPS, CLINGO, SCRATCH)
TARGETS = {
    (Mode.TWO, 15): 0.35, (Mode.TWO, 50): 0.2, (Mode.TWO, 200): 0.06, (Mode.TWO, 1000): 0.012,
    (Mode.ALL, 15): 0.08, (Mode.ALL, 50): 0.02, (Mode.ALL, 200): 0.003, (Mode.ALL, 1000): 0.0002,
}  # fmt: skip
FIRST_TARGET, MEMORY_TARGET_MB = 0.01, 100
_LARGE = 1000
_SCRATCH_UP_TO = 50


@dataclass(frozen=True, slots=True)
class Cell:
    """All that was measured at one size and mode.

    Args:
        count: How many things there are.
        mode: How many of them move.
        moved: How many of them move in a frame, on average.
        facts: How many facts hold at the start.
        verdicts: For each engine, what the oracle says.
        rounds: For each round, the times of each engine.
        whys: How long ours took to say why.
    """

    count: int
    mode: Mode
    moved: float
    facts: int
    verdicts: dict[str, Verdict]
    rounds: tuple[dict[str, Times], ...]
    whys: Whys

    def step(self, name: str) -> float:
        """Give the median time of a frame after the first, in µs: the median over the rounds."""
        return statistics.median(_median(each[name]) for each in self.rounds if name in each)

    def first(self, name: str) -> float:
        """Give the time of the first frame, in µs: the median over the rounds."""
        return statistics.median(each[name].first for each in self.rounds)

    def ratio(self, name: str, other: str = CLIPS) -> float:
        """Give how many times as long as another engine one takes for a frame, round by round."""
        return statistics.median(_median(each[name]) / _median(each[other]) for each in self.rounds)

    def first_ratio(self, name: str, other: str = CLIPS) -> float:
        """Give the same for the first frame."""
        return statistics.median(each[name].first / each[other].first for each in self.rounds)

    def frames(self, name: str) -> int:
        """Give how many frames after the first were timed, in all rounds."""
        return sum(len(each[name].steps) for each in self.rounds)


def _median(times: Times) -> float:
    return statistics.median(times.steps)


def measure(count: int, mode: Mode, rounds: int, seconds: float) -> Cell:
    """Measure all engines at one size and mode."""
    workload = make_workload(count, mode)
    states = list(workload.states())
    make = makers(workload)
    verdicts = {}
    names = [name for name in ENGINES if name != SCRATCH or count <= _SCRATCH_UP_TO]
    for name in names:
        verdicts[name] = checked(make[name](), workload, states, seconds / 2)
        _say(f"{count} {mode}: {name}: {verdicts[name]}")
    found = []
    for number in range(rounds):
        if number:
            names = [name for name in names if name != SCRATCH]  # once is enough of it
        turn = number % len(names)
        times = {}
        for name in (*names[turn:], *names[:turn]):
            times[name] = timed(make[name](), workload, states, seconds)
            _say(f"{count} {mode}: {name}: {_median(times[name]):.1f} µs a frame")
        found.append(times)
    facts = total(truth(states[0], workload.base))
    return Cell(
        count,
        mode,
        moved_count(workload.frames),
        facts,
        verdicts,
        tuple(found),
        measure_whys(workload),
    )


def _say(text: str) -> None:
    print(f"{time.strftime('%H:%M:%S')} {text}", file=sys.stderr, flush=True)


def page(cells: Sequence[Cell], memory: dict[str, float], seconds: float) -> Iterator[str]:
    """Write the results as a Markdown page."""
    yield "# The inference engine, beside CLIPS and clingo"
    yield ""
    yield (
        'Made by `make bench-engine`: "table-top beliefs", the rules of `benchmarks/tabletop.icr` '
        f"(14 concepts, 3 strata, one recursion) over {FRAMES} frames of a scene of N things, of "
        "which two or all move in each frame. The engines take turns in one process; times are "
        "medians of processor time for a frame, ratios are taken round by round, between runs "
        f"that follow one another. Python {platform.python_version()}; the machine was shared. "
        "What is timed: from the moved things and the actions handed over to all derived facts "
        f"up to date. An engine that needs more than {seconds:g} s for a run stops there."
    )
    yield ""
    yield "## A frame, as a ratio to CLIPS"
    yield ""
    yield from _ratios(cells)
    yield "## A frame, in µs"
    yield ""
    yield from _steps(cells)
    yield "## The first frame, in ms"
    yield ""
    yield from _firsts(cells)
    yield "## Whole snapshots instead of what has moved"
    yield ""
    yield from _snapshots(cells)
    if memory:
        yield "## Memory"
        yield ""
        yield from _memories(memory)
    yield "## Why"
    yield ""
    yield from section([(cell.count, cell.mode, cell.whys) for cell in cells])
    yield ""
    yield "## Were they right?"
    yield ""
    yield from _verdicts(cells)


def _ratios(cells: Sequence[Cell]) -> Iterator[str]:
    yield "| | " + " | ".join(f"N={n}" for n in _counts(cells)) + " |"
    yield "|---|" + "---|" * len(_counts(cells))
    for mode, words in ((Mode.TWO, "two move"), (Mode.ALL, "all move")):
        row = [cell for cell in cells if cell.mode is mode]
        yield f"| {words}, reached | {' | '.join(_short(c.ratio(OURS)) for c in row)} |"
        targets = [TARGETS.get((c.mode, c.count)) for c in row]
        yield f"| {words}, target | {' | '.join(f'≤ {t:g}' if t else '-' for t in targets)} |"
    missed = [
        f"{cell.mode} at N={cell.count} ({cell.ratio(OURS):.3g}, not {target:g})"
        for cell in cells
        if (target := TARGETS.get((cell.mode, cell.count))) and cell.ratio(OURS) > target
    ]
    yield ""
    yield f"Not reached: {'; '.join(missed)}." if missed else "All targets are reached."
    yield ""


def _steps(cells: Sequence[Cell]) -> Iterator[str]:
    yield "| N | moving | facts | icarus-lite | p95 | worst | CLIPS | clingo | scratch | frames |"
    yield "|---|---|---|---|---|---|---|---|---|---|"
    for cell in cells:
        every = sorted(step for each in cell.rounds for step in each[OURS].steps)
        p95 = every[int(0.95 * (len(every) - 1))]
        yield (
            f"| {cell.count} | {cell.mode} ({cell.moved:.0f}) | {cell.facts:,} "
            f"| {_us(cell.step(OURS))} | {_us(p95)} | {_us(every[-1])} | {_us(cell.step(CLIPS))} "
            f"| {_us(cell.step(CLINGO))} "
            f"| {_us(cell.step(SCRATCH)) if SCRATCH in cell.verdicts else '-'} "
            f"| {cell.frames(CLIPS)} / {cell.frames(CLINGO)} |"
        )
    yield ""
    yield (
        "The last column says on how many frames the medians of CLIPS and clingo rest, all rounds "
        "together; "
        "CLIPS with all of a thousand things moving takes most of a minute for one. clingo "
        'grounds the whole state anew in each frame; the text of the state is ready-made. "From '
        'scratch" is our own inference without the network.'
    )
    yield ""
    growth = [f"{_us(c.step(OURS))} at {c.count}" for c in cells if c.mode is Mode.TWO]
    yield f"Growth with N, two moving: {', '.join(growth)} µs."
    yield ""


def _firsts(cells: Sequence[Cell]) -> Iterator[str]:
    yield "| N | moving | icarus-lite | CLIPS | clingo | ratio to CLIPS |"
    yield "|---|---|---|---|---|---|"
    for cell in cells:
        values = " | ".join(_ms(cell.first(name)) for name in (OURS, CLIPS, CLINGO))
        yield f"| {cell.count} | {cell.mode} | {values} | {_short(cell.first_ratio(OURS))} |"
    yield ""
    large = [cell for cell in cells if cell.count >= _LARGE]
    for cell in large:
        reached = cell.first_ratio(OURS) <= FIRST_TARGET
        yield (
            f"Target at N={cell.count}: ≤ {FIRST_TARGET:g}; with {cell.mode} moving "
            f"{'reached' if reached else 'not reached'}."
        )
    yield ""


def _snapshots(cells: Sequence[Cell]) -> Iterator[str]:
    yield "| N | moving | what has moved, µs | all percepts, µs | the difference costs, µs |"
    yield "|---|---|---|---|---|"
    for cell in cells:
        less, more = cell.step(OURS), cell.step(SNAPSHOTS)
        yield f"| {cell.count} | {cell.mode} | {_us(less)} | {_us(more)} | {_us(more - less)} |"
    yield ""


def _memories(memory: dict[str, float]) -> Iterator[str]:
    yield f"Peak resident memory at N={_LARGE}, two moving, each engine in a process of its own:"
    yield ""
    yield "| " + " | ".join(memory) + " |"
    yield "|---" * len(memory) + "|"
    yield "| " + " | ".join(f"{each:.0f} MB" for each in memory.values()) + " |"
    yield ""
    reached = memory.get(OURS, 0) <= MEMORY_TARGET_MB
    yield (
        f"Target: ≤ {MEMORY_TARGET_MB} MB, {'reached' if reached else 'not reached'}. Ours holds "
        "the interpreter, numpy, and the reader and checker of the language."
    )
    yield ""


def _verdicts(cells: Sequence[Cell]) -> Iterator[str]:
    yield "Frames compared with the oracle (frames wrong), outside the timed runs:"
    yield ""
    yield f"| N | moving | {' | '.join(ENGINES)} |"
    yield "|---|---|" + "---|" * len(ENGINES)
    for cell in cells:
        row = [
            f"{cell.verdicts[n].frames} ({cell.verdicts[n].wrong})" if n in cell.verdicts else "-"
            for n in ENGINES
        ]
        yield f"| {cell.count} | {cell.mode} | {' | '.join(row)} |"
    yield ""
    yield (
        "Ours: the net changes in each frame, and all facts in each frame up to N=50, from there "
        "on in the first, each fiftieth and the last; snapshots and peers: all facts, as far as "
        "they came in the time they had."
    )


def _counts(cells: Sequence[Cell]) -> list[int]:
    return list(dict.fromkeys(cell.count for cell in cells))


def _short(value: float) -> str:
    return f"{value:.2g}" if value >= 0.001 else f"{value:.5f}"


def _us(value: float) -> str:
    return f"{value:,.1f}" if value < 100 else f"{value:,.0f}"


def _ms(value: float) -> str:
    return f"{value / 1000:,.2f}" if value < 100_000 else f"{value / 1000:,.0f}"


def main() -> int:
    """Measure and report; the exit status says whether all engines were right."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--objects", type=int, nargs="*", default=[15, 50, 200, 1000])
    parser.add_argument("--rounds", type=int, help="the same for all; otherwise fewer for more")
    parser.add_argument("--seconds", type=float, default=8.0, help="for a run of an engine")
    parser.add_argument("--out", type=Path)
    parser.add_argument("--memory-of", nargs=4, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.memory_of:
        name, count, mode, frames = options.memory_of
        print(peak_line(name, int(count), Mode(mode), int(frames)))
        return 0
    cells = []
    for count in options.objects:
        for mode in Mode:
            rounds = options.rounds or {15: 5, 50: 3, 200: 2}.get(count, 1)
            cells.append(measure(count, mode, rounds, options.seconds))
    memory = {}
    if _LARGE in options.objects:
        for name in (OURS, CLIPS, CLINGO):
            frames = 4 if name == CLINGO else 40
            memory[name] = peak_memory_mb(__file__, name, _LARGE, Mode.TWO, frames)
            _say(f"memory of {name}: {memory[name]:.0f} MB")
    text = "\n".join(page(cells, memory, options.seconds)) + "\n"
    print(text)
    if options.out:
        options.out.parent.mkdir(parents=True, exist_ok=True)
        options.out.write_text(text, encoding="utf-8")
    return int(any(verdict.wrong for cell in cells for verdict in cell.verdicts.values()))


if __name__ == "__main__":
    raise SystemExit(main())
