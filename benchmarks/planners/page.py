"""The page that the planning benchmark writes."""

from __future__ import annotations

import math
import os
import platform
from collections.abc import Sequence
from typing import TYPE_CHECKING

from planners.instances import COMMIT

if TYPE_CHECKING:
    from planning import Row, Run


def page(rows: Sequence[Row], seconds: int, improve: int, small: Sequence[str]) -> str:
    """Give the page as Markdown.

    Args:
        rows: What was measured, problem by problem.
        seconds: The limit for a first plan.
        improve: The limit for a plan that is made shorter.
        small: The part of the page about small problems.
    """
    loads = [row.load for row in rows]
    both = [row for row in rows if row.first.length and row.peer and row.peer.length]
    lines = [
        "# Planning beside pyperplan",
        "",
        "`make bench-planning` writes this page.",
        "",
        (
            f"{platform.machine()}, CPython {platform.python_version()}; {seconds} s of processor "
            "time for each problem and planner, start of the interpreter, reading and grounding "
            f"included. {min(loads):.0f} to {max(loads):.0f} processes shared "
            f"{os.cpu_count()} cores, which makes all times longer; the two planners took turns, "
            f"up to {max(row.turns for row in rows)} for a small problem, of which the median "
            "counts. "
            f"pyperplan is commit {COMMIT[:7]}, greedy best-first search with hFF "
            "(`-s gbfs -H hff`), run by the same interpreter. Both have their modules compiled "
            "beforehand. Every plan was checked against the PDDL files by code that shares "
            "nothing with the planner."
        ),
        "",
        *summary(rows, both),
        "",
        *small,
        "## The problems",
        "",
        (
            "*s* is all processor time, *planning* that without starting and ending the "
            "interpreter and importing modules; *evaluations* are states for which a distance was "
            f"estimated; *improved* is the length after {improve} s in all; *ratio* is pyperplan's "
            "*s* to ours."
        ),
        "",
        (
            "| problem | length | improved | s | planning s | evaluations | expansions | "
            "pyperplan's length | s | evaluations | ratio |"
        ),
        "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|",
        *(line(row) for row in rows),
    ]
    return "\n".join(lines) + "\n"


def summary(rows: Sequence[Row], both: Sequence[Row]) -> list[str]:
    """Give the figures over all problems."""
    solved = [row for row in rows if row.first.length is not None]
    lines = [
        f"* **Solved: {len(solved)} of {len(rows)}**"
        + "".join(f"; {row.name}: {row.first.flaw}" for row in rows if row not in solved)
        + ".",
        f"* Length of the first plans: {sum(row.first.length or 0 for row in solved)}.",
    ]
    improved = [row.improved for row in rows if row.improved is not None]
    if improved:
        total = sum(run.length or 0 for run in improved)
        lines.append(f"* **Length after improvement: {total}.**")
    seeds = sum(row.same for row in rows)
    lines.append(f"* The same plan under two hash seeds: {seeds} of {len(rows)}.")
    lines.append(
        f"* Our processor time: {sum(row.first.cpu_s for row in rows):.1f} s in all, "
        f"{sum(planning_s(row.first) for row in rows):.1f} s of it planning; starting, "
        f"importing and ending takes {mean_start(rows):.2f} s of each process."
    )
    peers = [row for row in rows if row.peer]
    if peers and both:
        mine = [row.first for row in both]
        theirs = [row.peer for row in both if row.peer]
        whole = geometric_mean([t.cpu_s / m.cpu_s for m, t in zip(mine, theirs, strict=True)])
        planning = geometric_mean(
            [planning_s(t) / planning_s(m) for m, t in zip(mine, theirs, strict=True)]
        )
        ratio = sum(t.report["evaluations"] for t in theirs) / sum(
            m.report["evaluations"] for m in mine
        )
        lines.append(
            f"* pyperplan solves {sum(row.peer.length is not None for row in peers if row.peer)}. "
            f"On the {len(both)} that both solve, the geometric mean of the ratios is "
            f"**{whole:.1f}**, and {planning:.1f} without starting, importing and ending on either "
            f"side; it needs {ratio:.1f} times the evaluations "
            f"({sum(t.report['evaluations'] for t in theirs)} to "
            f"{sum(m.report['evaluations'] for m in mine)}), and its plans have "
            f"{sum(t.length or 0 for t in theirs)} steps to our "
            f"{sum(m.length or 0 for m in mine)}."
        )
    return lines


def line(row: Row) -> str:
    """Give a problem's line of the table."""
    first, peer = row.first, row.peer
    ratio = f"{peer.cpu_s / first.cpu_s:.1f}" if peer and peer.length and first.length else ""
    cells = [
        row.name,
        length(first),
        length(row.improved),
        f"{first.cpu_s:.2f}",
        f"{planning_s(first):.2f}",
        str(first.report.get("evaluations", "")),
        str(first.report.get("expansions", "")),
        length(peer),
        f"{peer.cpu_s:.2f}" if peer else "",
        str(peer.report.get("evaluations", "")) if peer else "",
        ratio,
    ]
    return f"| {' | '.join(cells)} |"


def length(run: Run | None) -> str:
    """Give the length of a plan, or a dash."""
    if run is None:
        return ""
    return "-" if run.length is None else str(run.length)


def planning_s(run: Run) -> float:
    """Give the processor time without starting and ending the process."""
    if "end_s" not in run.report:
        return run.cpu_s
    return float(run.report["end_s"]) - float(run.report["start_s"])


def mean_start(rows: Sequence[Row]) -> float:
    """Give the mean processor time of starting, importing and ending."""
    starts = [row.first.cpu_s - planning_s(row.first) for row in rows]
    return sum(starts) / len(starts)


def geometric_mean(values: Sequence[float]) -> float:
    """Give the geometric mean."""
    return math.exp(sum(map(math.log, values)) / len(values))
