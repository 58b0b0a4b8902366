"""Times, memory, and whether every frame is right; each taken where it does not disturb the others.

What is timed: in frame 0, from the given facts handed over to all derived facts in the engine; in
each later frame, from what has moved and been done handed over to all derived facts up to date.
Reading facts out and making pictures of the scene is in nobody's time. Times are processor time of
the process.
"""

from __future__ import annotations

import gc
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from tabletop.engines import (
    ClingoEngine,
    ClipsEngine,
    Engine,
    NetworkEngine,
    ScratchEngine,
    SnapshotEngine,
)
from tabletop.engines.network_engine import compiled_rules
from tabletop.oracle import difference, facts, truth
from tabletop.scene import Mode, State, Workload, make_workload

OURS, SNAPSHOTS, CLIPS, CLINGO = "icarus-lite", "icarus-lite, snapshots", "CLIPS", "clingo"
SCRATCH = "icarus-lite, from scratch"
_SMALL = 50
_EVERY = 50
_PEAK = "peak resident MB: "


def makers(workload: Workload) -> Mapping[str, Callable[[], Engine]]:
    """Give what makes each engine, ready for a workload; the rules are compiled here and now."""
    compiled, base, count = compiled_rules(), workload.base, workload.count
    return {
        OURS: lambda: NetworkEngine(compiled, base, count),
        SNAPSHOTS: lambda: SnapshotEngine(compiled, base, count),
        CLIPS: lambda: ClipsEngine(base),
        CLINGO: lambda: ClingoEngine(base),
        SCRATCH: lambda: ScratchEngine(base),
    }


@dataclass(frozen=True, slots=True)
class Times:
    """How long an engine took over a workload: frame 0, and each later frame it came to; in µs."""

    first: float
    steps: tuple[float, ...]


def timed(engine: Engine, workload: Workload, states: Sequence[State], seconds: float) -> Times:
    """Run an engine over a workload, for so long at most, but one frame at least."""
    gc.collect()
    clock = time.process_time_ns
    begun = clock()
    engine.begin(states[0])
    first = clock() - begun
    steps = []
    end = time.process_time() + seconds
    for frame, state in zip(workload.frames, states[1:], strict=True):
        step = engine.prepare(frame, state)
        begun = clock()
        step()
        steps.append(clock() - begun)
        if time.process_time() > end:
            break
    return Times(first / 1000, tuple(each / 1000 for each in steps))


@dataclass(frozen=True, slots=True)
class Verdict:
    """How many frames of an engine were compared with the oracle, and how many were wrong."""

    frames: int
    wrong: int


def checked(engine: Engine, workload: Workload, states: Sequence[State], seconds: float) -> Verdict:
    """Compare the facts of each frame with the oracle's; of peers for so long at most.

    Of ours every frame is compared. Of more than fifty things these are the net changes, and the
    facts as a whole, up to half a million, in the first frame, in every fiftieth and in the last.
    """
    large = workload.count > _SMALL
    ours = type(engine) is NetworkEngine
    end = time.process_time() + seconds
    before = truth(states[0], workload.base)
    engine.begin(states[0])
    frames, wrong = 1, int(engine.facts() != facts(before))
    for number, (frame, state) in enumerate(zip(workload.frames, states[1:], strict=True), 1):
        engine.prepare(frame, state)()
        now = truth(state, workload.base)
        last = number == len(workload.frames)
        right = True
        if isinstance(engine, NetworkEngine):
            right = engine.news() == difference(before, now)
        if not large or not ours or last or number % _EVERY == 0:
            right &= engine.facts() == facts(now)
        frames, wrong, before = frames + 1, wrong + (not right), now
        if not ours and time.process_time() > end:
            break
    return Verdict(frames, wrong)


def peak_memory_mb(script: str, name: str, count: int, mode: Mode, frames: int) -> float:
    """Measure an engine in a process of its own that does nothing else."""
    command = [sys.executable, script, "--memory-of", name, str(count), mode, str(frames)]
    done = subprocess.run(command, check=True, capture_output=True, text=True)  # noqa: S603 - this script
    return next(
        float(line.removeprefix(_PEAK))
        for line in done.stdout.splitlines()  # CLIPS prints lines of its own
        if line.startswith(_PEAK)
    )


def peak_line(name: str, count: int, mode: Mode, frames: int) -> str:
    """Run an engine over some frames; give a line with the peak resident memory of this process."""
    workload = make_workload(count, mode, frames=frames)
    engine = makers(workload)[name]()
    state = workload.start
    engine.begin(state)
    for frame in workload.frames:
        state = state.after(frame)
        engine.prepare(frame, state)()
    return f"{_PEAK}{_peak_kb() / 1024}"


def _peak_kb() -> int:
    """Give the most that this program has had resident; what its parent had does not count.

    `getrusage` would count it: on Linux that figure outlives the start of another program.
    """
    for line in Path("/proc/self/status").read_text(encoding="ascii").splitlines():
        name, _, value = line.partition(":")
        if name == "VmHWM":
            return int(value.split()[0])
    raise OSError("/proc/self/status does not tell the peak memory")
