"""How the cost of a frame grows with the number of rules, ours and CLIPS's.

    python benchmarks/engine_rules.py [--objects 50] [--rounds 3] [--out PAGE.md]

Two ways to have more rules: copies of all rules over the same things, each with constants of its
own, where each frame must do as much more work; and copies over things of another kind that never
move, where it should do none. In the end both engines must have the same facts.
"""

from __future__ import annotations

import argparse
import platform
import re
import statistics
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from tabletop.engines import ClipsEngine, Engine, NetworkEngine
from tabletop.engines.clips_engine import RULES as CLIPS_RULES
from tabletop.engines.clips_engine import TEMPLATE as CLIPS_TEMPLATE
from tabletop.engines.network_engine import RULES as OUR_RULES
from tabletop.measuring import timed
from tabletop.oracle import PREDICATES
from tabletop.scene import Mode, State, Workload, make_workload

from icarus_lite.inference.network import CompiledDomain, compile_domain
from icarus_lite.language import DomainError, diagnose_text

COPIES = (1, 2, 4, 8)
_ASSERTED = ("holding", "fixed", "attached")


def domain_text(copies: int, *, idle: bool) -> str:
    """Write the rules of the table top so many times.

    Args:
        copies: How many times, 1 for the rules as they are.
        idle: Whether the further copies speak of things of another kind, and of other assertions.
    """
    text = OUR_RULES.read_text(encoding="utf-8")
    start, end = text.index("(concepts"), text.index("; What actions assert")
    parts = [text]
    for number in range(1, copies):
        copied = _different(_renamed(text[start:end], PREDICATES, f"-{number}"), number)
        if idle:
            copied = _renamed(copied, ("obj",), "-idle")
            copied = _renamed(copied, _ASSERTED, "-idle")
        parts.append(copied)
    if idle and copies > 1:
        parts.append("(percepts (obj-idle ^type ^x ^y ^z ^w ^d ^h))")
        parts.append(
            "(skills ((idle ?a ?b) :elements ((obj-idle ?a) (obj-idle ?b)) :actions ((*idle ?a ?b))"
            " :effects ((holding-idle ?a) (fixed-idle ?a ?b))))"
        )
    return "\n".join(parts)


def clips_rules(copies: int, *, idle: bool) -> str:
    """Write the rules of CLIPS so many times."""
    parts = [CLIPS_RULES]
    for number in range(1, copies):
        copied = _different(_renamed(CLIPS_RULES, PREDICATES, f"-{number}"), number)
        copied = re.sub(r"\(defrule (\S+)", rf"(defrule \1-{number}", copied)
        if idle:
            copied = _renamed(copied, ("obj", *_ASSERTED), "-idle")
        parts.append(copied)
    return "\n".join(parts)


def _different(text: str, number: int) -> str:
    """Change a constant in each rule about pairs, so that no work is shared between copies."""
    for old, new in (
        ("90000", f"{90000 + 1000 * number}"),
        ("?hb))) 5)", f"?hb))) {5 + number})"),
        ("(+ (* 2 ?xa) ?wa)", f"(+ (* 2 ?xa) ?wa {number})"),
    ):
        if text.count(old) != 1:
            raise ValueError(f"{old} is not there once")
        text = text.replace(old, new)
    return text


def _renamed(text: str, names: Sequence[str], suffix: str) -> str:
    some = "|".join(map(re.escape, names))
    return re.sub(rf"\(({some})(?=[\s)])", rf"(\1{suffix}", text)


def compiled(copies: int, *, idle: bool) -> CompiledDomain:
    """Read, check and compile the rules so many times.

    Raises:
        DomainError: the rules are wrong.
    """
    text = domain_text(copies, idle=idle)
    domain, source, problems = diagnose_text(text, OUR_RULES.with_name("copies.icr"))
    if domain is None:
        raise DomainError(problems, source)
    return compile_domain(domain)


@dataclass(frozen=True, slots=True)
class Row:
    """Median times of a frame in µs, for a number of rules."""

    copies: int
    idle: bool
    mode: Mode
    rules: int
    ours: float
    clips: float


def measure(workload: Workload, copies: int, rounds: int, seconds: float, *, idle: bool) -> Row:
    """Measure both engines with so many copies of the rules, in turns."""
    states = list(workload.states())
    domain = compiled(copies, idle=idle)
    template = CLIPS_TEMPLATE
    if idle:
        template += CLIPS_TEMPLATE.replace("deftemplate obj", "deftemplate obj-idle")
    rules = clips_rules(copies, idle=idle)
    more = idle and copies > 1

    def ours() -> NetworkEngine:
        return NetworkEngine(domain, workload.base, workload.count, idle=more)

    def clips() -> ClipsEngine:
        return ClipsEngine(workload.base, template, rules, idle=more)

    same_facts(ours(), clips(), workload, states)
    make: tuple[Callable[[], Engine], ...] = (ours, clips)
    medians: list[list[float]] = [[], []]
    for number in range(rounds):
        for which in (0, 1) if number % 2 else (1, 0):
            times = timed(make[which](), workload, states, seconds)
            medians[which].append(statistics.median(times.steps))
    one, other = (statistics.median(each) for each in medians)
    print(f"{workload.mode} x {copies} idle={idle}: {one:.1f} {other:.1f}", file=sys.stderr)
    return Row(copies, idle, workload.mode, len(domain.domain.concepts), one, other)


def same_facts(
    ours: NetworkEngine, clips: ClipsEngine, workload: Workload, states: Sequence[State]
) -> None:
    """Run some frames through both engines, and compare how many facts of each predicate hold.

    Raises:
        AssertionError: they differ.
    """
    for engine in (ours, clips):
        engine.begin(states[0])
        for frame, state in zip(workload.frames[:12], states[1:], strict=False):
            engine.prepare(frame, state)()
    assert ours.counts() == clips.counts()


def page(rows: Sequence[Row], count: int) -> Iterator[str]:
    """Write the results as a Markdown page."""
    yield "# The inference engine and the number of rules"
    yield ""
    yield (
        f'Made by `make bench-engine-rules`: "table-top beliefs" with N={count}, the rules of '
        "`benchmarks/tabletop.icr` several times over. Median processor time of a frame in µs, "
        f"Python {platform.python_version()}; the machine was shared."
    )
    for idle, words in (
        (False, "More rules over the same things, with other constants: each copy is work"),
        (True, "More rules over as many things of another kind, which never move"),
    ):
        yield ""
        yield f"## {words}"
        yield ""
        yield "| clauses | two move: icarus-lite | CLIPS | all move: icarus-lite | CLIPS |"
        yield "|---|---|---|---|---|"
        for copies in COPIES:
            found = {r.mode: r for r in rows if r.copies == copies and r.idle is idle}
            two, every = found[Mode.TWO], found[Mode.ALL]
            yield (
                f"| {two.rules} | {two.ours:,.0f} | {two.clips:,.0f} "
                f"| {every.ours:,.0f} | {every.clips:,.0f} |"
            )
        yield ""
        first, last = (
            next(r for r in rows if (r.copies, r.idle, r.mode) == (c, idle, Mode.TWO))
            for c in (COPIES[0], COPIES[-1])
        )
        yield (
            f"With two moving, {last.rules / first.rules:.0f} times the rules cost "
            f"{last.ours / first.ours:.1f} times as much in icarus-lite, "
            f"{last.clips / first.clips:.1f} times in CLIPS."
        )


def main() -> None:
    """Measure and report."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--objects", type=int, default=50)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=3.0, help="for a run of an engine")
    parser.add_argument("--out", type=Path)
    options = parser.parse_args()
    rows = [
        measure(
            make_workload(options.objects, mode), copies, options.rounds, options.seconds, idle=idle
        )
        for idle in (False, True)
        for mode in Mode
        for copies in COPIES
    ]
    text = "\n".join(page(rows, options.objects)) + "\n"
    print(text)
    if options.out:
        options.out.parent.mkdir(parents=True, exist_ok=True)
        options.out.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
