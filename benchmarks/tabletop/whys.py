"""How long it takes to say why: the whole proof of a belief, down to percepts and assertions.

Asked is `explain`, which is behind `agent.why(…)`: its answer has for each belief of the proof the
clause, the bindings, what it rests on and what is absent. Beliefs are drawn from all concepts
alike, as most of all beliefs are of the one relation over all pairs. Each is asked about once,
after one question about each concept: what is worked out once for a clause is in nobody's time.
"""

from __future__ import annotations

import gc
import statistics
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice

import numpy as np

from icarus_lite import Action, Belief, Outcome, load_domain
from icarus_lite.inference import BeliefState, Explanation, InferenceEngine, Memory, explain
from tabletop.engines.network_engine import RULES, NetworkEngine, compiled_rules
from tabletop.oracle import truth
from tabletop.scene import Frame, Mode, State, Verb, Workload, make_workload

TARGET_US = 100
_EACH = 40
"""Beliefs asked about of each concept, at most."""
_FRAMES, _BACK = 40, 20
"""How many frames there have been, and how far back is asked about the past."""
_SKILLS = {Verb.GRASP: "grasp", Verb.RELEASE: "release", Verb.ATTACH: "fix", Verb.DETACH: "loosen"}


@dataclass(frozen=True, slots=True)
class Whys:
    """How long it took to say why in one scene.

    Args:
        nodes: How many percepts and beliefs each proof has.
        now: Processor time of each, about the present, in µs.
        then: Likewise about an earlier frame, once one has gone back to it.
        back: Processor time to go back to it, in µs.
    """

    nodes: tuple[int, ...]
    now: tuple[float, ...]
    then: tuple[float, ...]
    back: float


def measure_whys(workload: Workload) -> Whys:
    """Go through some frames of a workload and ask why."""
    engine, memory = InferenceEngine(load_domain(RULES)), Memory()
    telling = NetworkEngine(compiled_rules(), workload.base, workload.count)
    states = list(islice(workload.states(), _FRAMES))
    for frame, state in zip([None, *workload.frames], states, strict=False):
        done = _first(state) if frame is None else _actions(frame)
        memory = engine.step(memory, telling.percepts(state), [*map(Outcome, done)])
    nodes, now = _ask(memory.state, _beliefs(states[-1], workload))
    frame_ = len(states) - 1 - _BACK
    begun = time.process_time_ns()
    past = engine.look_back(frame_)
    back = (time.process_time_ns() - begun) / 1000
    return Whys(nodes, now, _ask(past, _beliefs(states[frame_], workload))[1], back)


def _first(state: State) -> Iterator[Action]:
    """Give the actions behind what is given in frame 0."""
    yield from (Action("grasp", (f"o{each}",)) for each in sorted(state.holding))
    yield from (Action("fix", (f"o{a}", f"o{b}")) for a, b in sorted(state.fixed))


def _actions(frame: Frame) -> Iterator[Action]:
    for verb, things in frame.actions:
        yield Action(_SKILLS[verb], tuple(f"o{each}" for each in things))


def _beliefs(state: State, workload: Workload) -> list[Belief]:
    """Draw beliefs that are held in a frame, the same number of each concept where there are."""
    draw = np.random.default_rng(workload.count)
    found = []
    for name, held in truth(state, workload.base).items():
        places = np.argwhere(held)
        chosen = draw.permutation(len(places))[: _EACH + 1]
        found += [Belief(name, tuple(f"o{each}" for each in row)) for row in places[chosen]]
    return found


def _ask(
    state: BeliefState, beliefs: Sequence[Belief]
) -> tuple[tuple[int, ...], tuple[float, ...]]:
    """Ask about beliefs; give the sizes of the proofs, and the times in µs."""
    asked: set[str] = set()
    nodes, times = [], []
    gc.collect()
    for belief in beliefs:
        begun = time.process_time_ns()
        found = explain(belief, state)
        spent = time.process_time_ns() - begun
        if belief.predicate in asked:
            times.append(spent / 1000)
            nodes.append(_size(found))
        asked.add(belief.predicate)
        assert found.holds, f"{belief} is true, but not believed"
    return tuple(nodes), tuple(times)


def _size(root: Explanation) -> int:
    """Count what a proof rests on, itself included, each once."""
    seen: set[int] = set()
    pending = [root]
    while pending:
        each = pending.pop()
        if id(each) not in seen:
            seen.add(id(each))
            pending += each.premises
    return len(seen)


def section(rows: Sequence[tuple[int, str, Whys]]) -> Iterator[str]:
    """Write what was measured as lines of a page.

    Args:
        rows: The number of things, how many of them move, and the times.
    """
    yield (
        "The whole proof of a belief, down to percepts and actions, as `agent.why` gives it: for "
        "each belief in it the clause, the bindings, what it rests on and what is absent. Up to "
        f"{_EACH} beliefs of each of the 14 concepts, drawn at random, each asked about once; "
        "nothing is kept per frame for it but the log of changes. *Then* is the same question "
        f"about a frame {_BACK} frames back; going there, once, takes the time in the last column."
    )
    yield ""
    yield (
        "| N | moving | proofs | nodes, median / most | µs, median | µs, p95 | µs, worst "
        "| then: µs, median | p95 | going back, ms |"
    )
    yield "|---|---|---|---|---|---|---|---|---|---|"
    for count, moving, whys in rows:
        yield (
            f"| {count:,} | {moving} | {len(whys.now)} "
            f"| {statistics.median(whys.nodes):g} / {max(whys.nodes)} "
            f"| {statistics.median(whys.now):.0f} | {_p95(whys.now):.0f} | {max(whys.now):.0f} "
            f"| {statistics.median(whys.then):.0f} | {_p95(whys.then):.0f} "
            f"| {whys.back / 1000:,.1f} |"
        )
    yield ""
    slowest = max(statistics.median(whys.now) for _, _, whys in rows)
    slow = max(_p95(whys.now) for _, _, whys in rows)
    yield (
        f"Target: under {TARGET_US} µs; the slowest median is {slowest:.0f} µs "
        f"({'reached' if slowest < TARGET_US else 'not reached'}), the slowest p95 {slow:.0f} µs."
    )


def _p95(times: Sequence[float]) -> float:
    return sorted(times)[int(0.95 * (len(times) - 1))]


def main() -> None:
    """Measure on its own, and print the section."""
    rows = []
    for count in (15, 50, 200, 1000):
        for mode in Mode:
            workload = make_workload(count, mode, frames=_FRAMES)
            rows.append((count, str(mode), measure_whys(workload)))
    print("\n".join(section(rows)))


if __name__ == "__main__":
    main()
