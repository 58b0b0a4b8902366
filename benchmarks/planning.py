"""Sixty problems of the planning competitions, beside pyperplan in the same run.

    python benchmarks/planning.py --instances CHECKOUT --out docs/results/planning.md

Each planner gets a process of its own for each problem, and as many seconds of processor time,
those of its start included; the two take turns, several for a small problem, of which the median
counts. Each plan is checked against the PDDL files by code of its own. Without --instances the
repository that holds the problems, and the peer, is fetched. What is measured is kept with --rows,
and an interrupted measurement goes on from there.
"""

from __future__ import annotations

import argparse
import ast
import json
import os
import resource
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from planners.instances import Instance, checked_out, instances
from planners.page import page
from planners.small import section
from planners.validation import flaw

HERE = Path(__file__).parent
SEEDS = ("0", "1")
"""Two orders of hashing; the plan has to be the same."""
TURNS, BRIEF_S = 7, 6.0
"""How often a problem is planned at most, and after how much processor time no more."""


@dataclass(frozen=True, slots=True)
class Run:
    """What one planner did with one problem.

    Args:
        cpu_s: Processor time of the process and its children, start included.
        plan: The actions; None if there was none in time.
        report: What the process told besides.
        flaw: What is wrong with the plan, or why there is none.
    """

    cpu_s: float
    plan: list[tuple[str, ...]] | None
    report: dict[str, Any]
    flaw: str

    @property
    def length(self) -> int | None:
        """Steps of a valid plan."""
        return None if self.plan is None or self.flaw else len(self.plan)


@dataclass(frozen=True, slots=True)
class Row:
    """One problem: our first plan, its improvement, and the peer's plan.

    Args:
        name: Of the problem.
        first: Our first plan.
        improved: What became of it; None if that was not asked for.
        peer: pyperplan's plan; None if it was not asked.
        same: Whether two hash seeds gave the same first plan.
        load: How many processes shared the machine.
        turns: How often each planner had its turn; of its times the median counts.
    """

    name: str
    first: Run
    improved: Run | None
    peer: Run | None
    same: bool
    load: float
    turns: int = 1


def main() -> None:
    """Measure, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("wanted", nargs="*", help="domains or problems such as blocks-05; all")
    parser.add_argument("--instances", type=Path, help="a checkout of pyperplan's repository")
    parser.add_argument("--seconds", type=int, default=20, help="processor time for each problem")
    parser.add_argument("--improve", type=int, help="the same for a plan that is made shorter")
    parser.add_argument("--random", type=int, default=1_000, help="blocks problems to draw")
    parser.add_argument("--no-peer", action="store_true")
    parser.add_argument("--rows", type=Path, help="keeps what has been measured, as JSON Lines")
    parser.add_argument("--out", type=Path)
    args = parser.parse_args()
    improve = args.seconds if args.improve is None else args.improve
    checkout = (args.instances or checked_out(Path("build/pyperplan"))).resolve()
    wanted = instances(checkout, args.wanted)
    rows = kept(args.rows)
    if len(rows) < len(wanted):
        measure(wanted[0], args.seconds, 0, checkout)  # compiles the modules of both
    for each in wanted:
        if each.name not in rows:
            rows[each.name] = measure(
                each, args.seconds, improve, None if args.no_peer else checkout
            )
            if args.rows:
                args.rows.parent.mkdir(parents=True, exist_ok=True)
                with args.rows.open("a", encoding="utf-8") as file:
                    file.write(json.dumps(asdict(rows[each.name])) + "\n")
        row = rows[each.name]
        lengths = [run.length for run in (row.first, row.improved, row.peer) if run is not None]
        print(each.name, *lengths, f"{row.first.cpu_s:.2f} s", row.first.flaw, flush=True)
    shown = [rows[each.name] for each in wanted]
    blocks = [each for each in wanted if each.name.startswith("blocks")]
    text = page(shown, args.seconds, improve, section(args.random, blocks))
    print(text)
    if args.out:
        args.out.write_text(text, encoding="utf-8")


def kept(path: Path | None) -> dict[str, Row]:
    """Give what was measured before, by the problem's name."""
    if path is None or not path.exists():
        return {}
    rows = {}
    for line in path.read_text(encoding="utf-8").splitlines():
        entry = json.loads(line)
        runs = {key: entry[key] and Run(**entry[key]) for key in ("first", "improved", "peer")}
        rows[entry["name"]] = Row(
            entry["name"], **runs, **{key: entry[key] for key in ("same", "load", "turns")}
        )
    return rows


def measure(instance: Instance, seconds: int, improve: int, checkout: Path | None) -> Row:
    """Let the planners take their turns at a problem; of several turns the median counts."""
    runs, rivals, spent = list[Run](), list[Run](), 0.0
    while not runs or (spent < BRIEF_S and len(runs) < TURNS):
        runs.append(ours(instance, seconds, SEEDS[0]))
        if checkout is not None:
            rivals.append(peers(instance, seconds, checkout))
        spent += sum(turns[-1].cpu_s for turns in (runs, rivals) if turns)
    first = median_of(runs)
    peer = median_of(rivals) if rivals else None
    again = ours(instance, seconds, SEEDS[1])
    improved = ours(instance, improve, SEEDS[0], "improve") if improve else None
    same = first.plan == again.plan
    return Row(instance.name, first, improved, peer, same, os.getloadavg()[0], len(runs))


def median_of(runs: Sequence[Run]) -> Run:
    """Give the run that took neither more nor less processor time than half of the others."""
    return sorted(runs, key=lambda run: run.cpu_s)[(len(runs) - 1) // 2]


def ours(instance: Instance, seconds: int, seed: str, *options: str) -> Run:
    """Run our planner; it gets a little less, for what it takes to end."""
    options = (f"{0.8 * seconds}", *options)
    return measured("planners/ours.py", options, instance, seconds, {"PYTHONHASHSEED": seed})


def peers(instance: Instance, seconds: int, checkout: Path) -> Run:
    """Run pyperplan, of the checkout, by the same interpreter."""
    path = {"PYTHONPATH": str(checkout), "PYTHONHASHSEED": "0"}
    return measured("planners/peer.py", (), instance, seconds, path)


def measured(
    script: str,
    options: tuple[str, ...],
    instance: Instance,
    seconds: int,
    environment: dict[str, str],
) -> Run:
    """Run a planner on a problem, up to a limit of processor time, and check its plan."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(  # noqa: S603 - our own scripts
        [sys.executable, str(HERE / script), str(instance.domain), str(instance.problem), *options],
        env={**compiled(), **environment},
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (seconds + 1, seconds + 2)),
        capture_output=True,
        text=True,
        check=False,
    )
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu_s = after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime
    if cpu_s > seconds:
        return Run(cpu_s, None, {}, f"nothing in {seconds} s")
    if done.returncode:
        told = done.stderr.strip().splitlines()
        reason = told[-1] if done.returncode > 0 and told else f"nothing in {seconds} s"
        return Run(cpu_s, None, {}, reason)
    report = ast.literal_eval(done.stdout.splitlines()[-1])
    plan = report.pop("plan")
    if plan is None:
        reason = "called unsolvable" if report["unsolvable"] else f"nothing in {seconds} s"
        return Run(cpu_s, None, report, reason)
    steps = [tuple(step) for step in plan]
    return Run(cpu_s, steps, report, flaw(instance.domain, instance.problem, steps))


def compiled() -> dict[str, str]:
    """Give an environment in which modules are compiled once, as where they are installed."""
    elsewhere = ("PYTHONDONTWRITEBYTECODE", "PYTHONPYCACHEPREFIX")
    return {name: value for name, value in os.environ.items() if name not in elsewhere}


if __name__ == "__main__":
    main()
