"""Many trials of the inference engine against clingo and against inference from scratch.

    python tests/differential/fuzz.py [--programs 10000] [--cycles 20] [--jobs 2]

Seeds are tried in chunks from 0 on, until so many programs have been judged by clingo. Each chunk
that is done is a line in a file, so that a run that was stopped goes on where it was, and one that
asks for more programs goes on from there. A chunk that failed is tried again once the code is
another. A trial that fails is made as small as it can be and written down with its domain and its
history.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import platform
import time
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from multiprocessing import get_context
from pathlib import Path

from engine_trials.clips_oracle import clips_failure
from engine_trials.shrinking import shrunk
from engine_trials.trial import PLAIN_EVERY, draw_trial, failure_of, flavour_of, report
from engine_trials.vocabulary import Flavour

_CHUNK = 20
_ROOT = Path(__file__).parents[2]
_CODE = ("icarus_lite/inference", "icarus_lite/language", "tests/differential/engine_trials")


@dataclass(frozen=True, slots=True)
class Chunk:
    """What became of some consecutive seeds.

    Args:
        first: The first of them.
        cycles: How long each history is.
        code: Which code was tried: a digest of it.
        seconds: Processor time of the trials.
        given: How many percepts and asserted beliefs were told, over all cycles.
        judged: How many of them clingo has judged.
        by_clips: How many CLIPS has judged as well.
        failed: The seeds of those that failed.
    """

    first: int
    cycles: int
    code: str
    seconds: float
    given: int
    judged: int
    by_clips: int
    failed: tuple[int, ...] = ()


def run_chunk(first: int, cycles: int, code: str) -> tuple[Chunk, dict[int, str]]:
    """Run the trials of a chunk; give a report on each that failed."""
    begun = time.process_time()
    reports: dict[int, str] = {}
    given = by_clips = 0
    for seed in range(first, first + _CHUNK):
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
            reports[seed] = report(trial, failure)
    seconds = round(time.process_time() - begun, 2)
    judged = _judged(range(first, first + _CHUNK))
    return Chunk(first, cycles, code, seconds, given, judged, by_clips, tuple(reports)), reports


def _judged(seeds: Iterable[int]) -> int:
    """Count the seeds whose programs clingo can have an opinion on."""
    return sum(flavour_of(seed) is not Flavour.DEEP for seed in seeds)


def chunks(programs: int) -> Iterator[int]:
    """Give the first seeds of the chunks in which so many programs are judged by clingo."""
    first = judged = 0
    while judged < programs:
        yield first
        judged += _judged(range(first, first + _CHUNK))
        first += _CHUNK


def done_before(state: Path, cycles: int) -> dict[int, Chunk]:
    """Read what was tried with histories of a length: by first seed, the latest of each."""
    found: dict[int, Chunk] = {}
    if state.exists():
        for line in state.read_text(encoding="utf-8").splitlines():
            row = json.loads(line)
            chunk = Chunk(**{**row, "failed": tuple(row["failed"])})
            if chunk.cycles == cycles:
                found[chunk.first] = chunk
    return found


def left(programs: int, done: dict[int, Chunk], code: str) -> list[int]:
    """Give the chunks still to be tried: those not done, and those that failed with other code."""
    return [
        first
        for first in chunks(programs)
        if (chunk := done.get(first)) is None or (chunk.failed and chunk.code != code)
    ]


def note(chunk: Chunk, reports: dict[int, str], state: Path, failures: Path) -> None:
    """Keep what became of a chunk."""
    for seed, text in reports.items():
        failures.mkdir(parents=True, exist_ok=True)
        (failures / f"{seed}.txt").write_text(text, encoding="utf-8")
    state.parent.mkdir(parents=True, exist_ok=True)
    with state.open("a", encoding="utf-8") as file:
        file.write(json.dumps(asdict(chunk)) + "\n")


def digest() -> str:
    """Give a digest of the code that is tried: language, inference, and the trials themselves."""
    found = hashlib.sha256()
    for folder in _CODE:
        for path in sorted((_ROOT / folder).rglob("*")):
            if path.suffix in (".py", ".lark"):
                found.update(str(path.relative_to(_ROOT)).encode() + b"\0" + path.read_bytes())
    return found.hexdigest()[:12]


def page(tried: Sequence[Chunk]) -> str:
    """Write the result as a page."""
    failed = [seed for chunk in tried for seed in chunk.failed]
    seeds = [seed for chunk in tried for seed in range(chunk.first, chunk.first + _CHUNK)]
    flavours = Counter(flavour_of(seed) for seed in seeds)
    kinds = ", ".join(f"{count:,} {flavour}" for flavour, count in sorted(flavours.items()))
    return f"""# The inference engine against clingo, CLIPS and inference from scratch

Made by `make fuzz-engine`, Python {platform.python_version()}: random stratified domains, each
with a random history of {tried[0].cycles} cycles of percepts and asserted beliefs (see
`tests/differential`). After each cycle the incremental network must believe what clingo and
inference from scratch believe, attributes included; tell exactly the net changes; give as reasons
of a belief all of its derivations, each of which is checked on its own, and a proof that ends at
what is given. Afterwards it must remember each cycle, and a network told the last cycle at once
must believe the same.

| | |
|---|---|
| domains | {len(seeds):,} (seeds {seeds[0]} to {seeds[-1]}), {tried[0].cycles} cycles each |
| of the kinds | {kinds} |
| percepts and assertions, over all cycles | {sum(c.given for c in tried):,} |
| judged by clingo | {sum(c.judged for c in tried):,}; the others recur through attributes |
| judged by CLIPS as well | {sum(c.by_clips for c in tried):,} |
| failures | {f"seeds {failed}" if failed else "none"} |
| processor time | {sum(c.seconds for c in tried):,.0f} s |

The code that was tried, by a digest of its files:

| code | seeds |
|---|---|
{chr(10).join(_versions(tried))}
"""


def _versions(tried: Sequence[Chunk]) -> Iterator[str]:
    spans: list[list[int]] = []
    codes: list[str] = []
    for chunk in tried:
        if codes and codes[-1] == chunk.code and spans[-1][1] == chunk.first - 1:
            spans[-1][1] = chunk.first + _CHUNK - 1
        else:
            codes.append(chunk.code)
            spans.append([chunk.first, chunk.first + _CHUNK - 1])
    for code, (first, last) in zip(codes, spans, strict=True):
        yield f"| `{code}` | {first} to {last} |"


def _say(text: str) -> None:
    print(text, end="", flush=True)  # noqa: T201 - it speaks to the person who runs it


def main() -> int:
    """Run what is left to be run; the exit status says whether all agreed."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument(
        "--programs", type=int, default=10_000, help="how many clingo is to judge (10,000)"
    )
    parser.add_argument("--cycles", type=int, default=20, help="the length of a history (20)")
    parser.add_argument("--jobs", type=int, default=2, help="how many processes (2)")
    parser.add_argument("--state", type=Path, default=Path("build/fuzz-engine/chunks.jsonl"))
    parser.add_argument("--failures", type=Path, default=Path("build/fuzz-engine/failures"))
    parser.add_argument("--afresh", action="store_true", help="forget what was done before")
    parser.add_argument("--out", type=Path, help="write the page here")
    options = parser.parse_args()
    if options.afresh:
        options.state.unlink(missing_ok=True)
    done, code = done_before(options.state, options.cycles), digest()
    work = left(options.programs, done, code)
    begun = time.perf_counter()
    with get_context("spawn").Pool(options.jobs, maxtasksperchild=20) as pool:
        run = partial(run_chunk, cycles=options.cycles, code=code)
        for number, (chunk, reports) in enumerate(pool.imap_unordered(run, work), 1):
            note(chunk, reports, options.state, options.failures)
            done[chunk.first] = chunk
            rate = (time.perf_counter() - begun) / number
            failed = sum(len(each.failed) for each in done.values())
            _say(
                f"\r{100 * number / len(work):5.1f} %  {failed} failures  "
                f"{rate * (len(work) - number):6.0f} s left "
            )
    tried = [done[first] for first in chunks(options.programs)]
    text = page(tried)
    _say(f"\n{text}\n")
    if options.out:
        options.out.parent.mkdir(parents=True, exist_ok=True)
        options.out.write_text(text, encoding="utf-8")
    return 1 if any(chunk.failed for chunk in tried) else 0


if __name__ == "__main__":
    raise SystemExit(main())
