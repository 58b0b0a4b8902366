"""Many trials of the inference engine against clingo and against inference from scratch.

    python tests/differential/fuzz.py [--programs 10000] [--cycles 20] [--jobs 2] [--first 0]

What is done is kept in a file, so that a run that was stopped goes on where it was. A trial that
fails is made as small as it can be and written down with its domain and its history.
"""

from __future__ import annotations

import argparse
import json
import platform
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass, field
from multiprocessing import get_context
from pathlib import Path

from engine_trials.clips_oracle import clips_failure
from engine_trials.shrinking import shrunk
from engine_trials.trial import DEEP_EVERY, PLAIN_EVERY, draw_trial, failure_of, report

_CHUNK = 20


@dataclass
class Progress:
    """What has been tried so far.

    Args:
        cycles: How long each history is.
        done: The first seeds of the chunks that are finished.
        seconds: Processor time of all trials.
        given: How many percepts and asserted beliefs were told, over all cycles.
        by_clips: How many trials CLIPS has judged as well.
        failed: The seeds of the trials that failed.
    """

    cycles: int
    done: list[int] = field(default_factory=list)
    seconds: float = 0.0
    given: int = 0
    by_clips: int = 0
    failed: list[int] = field(default_factory=list)


@dataclass(frozen=True, slots=True)
class Chunk:
    """What became of some consecutive seeds."""

    first: int
    seconds: float
    given: int
    by_clips: int
    reports: tuple[tuple[int, str], ...]


def run_chunk(work: tuple[int, int, int]) -> Chunk:
    """Run the trials of seeds from the first to before the last, with histories of a length."""
    first, last, cycles = work
    begun = time.process_time()
    reports, given, by_clips = [], 0, 0
    for seed in range(first, last):
        trial = draw_trial(seed, cycles)
        given += trial.size
        failure = failure_of(trial)
        judge = failure_of
        if failure is None and seed % PLAIN_EVERY == 0:
            failure, judge = clips_failure(trial), clips_failure
            by_clips += 1
        if failure is not None:
            if not reports:  # one of a chunk will do; where there is one there are often more
                trial, failure = shrunk(trial, failure, judge)
            reports.append((seed, report(trial, failure)))
    return Chunk(first, time.process_time() - begun, given, by_clips, tuple(reports))


def chunks(first: int, programs: int, progress: Progress) -> Iterator[tuple[int, int, int]]:
    """Give the work that is still to be done, in chunks of consecutive seeds."""
    done = set(progress.done)
    for start in range(first, first + programs, _CHUNK):
        if start not in done:
            yield start, min(start + _CHUNK, first + programs), progress.cycles


def take_up(state: Path, cycles: int) -> Progress:
    """Read how far an earlier run came, if it had histories of this length."""
    if state.exists():
        progress = Progress(**json.loads(state.read_text(encoding="utf-8")))
        if progress.cycles == cycles:
            return progress
    return Progress(cycles)


def note(progress: Progress, chunk: Chunk, state: Path, failures: Path) -> None:
    """Keep what became of a chunk."""
    progress.done.append(chunk.first)
    progress.seconds += chunk.seconds
    progress.given += chunk.given
    progress.by_clips += chunk.by_clips
    for seed, text in chunk.reports:
        progress.failed.append(seed)
        failures.mkdir(parents=True, exist_ok=True)
        (failures / f"{seed}.txt").write_text(text, encoding="utf-8")
    state.parent.mkdir(parents=True, exist_ok=True)
    state.write_text(json.dumps(asdict(progress)), encoding="utf-8")


def page(progress: Progress, programs: int, first: int, wall: float) -> str:
    """Write the result as a page."""
    failed = f"seeds {sorted(progress.failed)}" if progress.failed else "none"
    return f"""# The inference engine against clingo, CLIPS and inference from scratch

Made by `make fuzz-engine`, Python {platform.python_version()}: random stratified domains, each
with a random history of {progress.cycles} cycles of percepts and asserted beliefs (see
`tests/differential`). After each cycle the incremental network must believe what clingo and
inference from scratch believe, attributes included; tell exactly the net changes; give as reasons
of a belief all of its derivations, each of which is checked on its own, and a proof that ends at
what is given. Afterwards it must remember each cycle, and a network told the last cycle at once
must believe the same.

| | |
|---|---|
| domains | {programs:,} (seeds {first} to {first + programs - 1}), {progress.cycles} cycles each |
| percepts and assertions, over all cycles | {progress.given:,} |
| judged by clingo | {programs - programs // DEEP_EVERY:,}; the others recur through attributes |
| judged by CLIPS as well | {progress.by_clips:,} domains |
| failures | {failed} |
| processor time | {progress.seconds:.0f} s |
| the last run took | {wall:.0f} s |
"""


def _say(text: str) -> None:
    print(text, end="", flush=True)  # noqa: T201 - it speaks to the person who runs it


def main() -> int:
    """Run what is left to be run; the exit status says whether all agreed."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--programs", type=int, default=10_000)
    parser.add_argument("--cycles", type=int, default=20)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--state", type=Path, default=Path("build/fuzz-engine/state.json"))
    parser.add_argument("--failures", type=Path, default=Path("build/fuzz-engine/failures"))
    parser.add_argument("--afresh", action="store_true", help="forget what was done before")
    parser.add_argument("--out", type=Path)
    options = parser.parse_args()
    if options.afresh:
        options.state.unlink(missing_ok=True)
    progress = take_up(options.state, options.cycles)
    begun = time.perf_counter()
    work = list(chunks(options.first, options.programs, progress))
    with get_context("spawn").Pool(options.jobs, maxtasksperchild=20) as pool:
        for number, chunk in enumerate(pool.imap_unordered(run_chunk, work), 1):
            note(progress, chunk, options.state, options.failures)
            done, rate = 100 * number / len(work), (time.perf_counter() - begun) / number
            left = rate * (len(work) - number)
            _say(f"\r{done:5.1f} %  {len(progress.failed)} failures  {left:6.0f} s left ")
    text = page(progress, options.programs, options.first, time.perf_counter() - begun)
    _say(f"\n{text}\n")
    if options.out:
        options.out.parent.mkdir(parents=True, exist_ok=True)
        options.out.write_text(text, encoding="utf-8")
    return 1 if progress.failed else 0


if __name__ == "__main__":
    raise SystemExit(main())
