"""The tables of the page."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Final

from gearbox.faults import KINDS
from gearbox.rows import GOOD, Episode, Row
from gearbox.statistics import Rate, median, shown
from gearbox.trials import TASKS


def table(columns: Sequence[str], lines: Iterable[Sequence[str]]) -> list[str]:
    """Give a Markdown table; all columns but the first are figures."""
    rule = "|".join(("---", *("--:" for _ in columns[1:])))
    rows = [f"| {' | '.join(line)} |" for line in lines]
    return [f"| {' | '.join(columns)} |", f"|{rule}|", *rows]


def tasks_table(rows: Sequence[Row]) -> list[str]:
    """Give the runs in which nothing went wrong, task by task, with and without attachments."""
    columns = (
        *("task", "arm", "attachments", "done, and known to be (95 %)"),
        *("false beliefs at the end", "outlived", "longest s", "astray", "cycles", "robot s", "s"),
    )
    return table(columns, _task_lines(rows))


def _task_lines(rows: Sequence[Row]) -> Iterator[tuple[str, ...]]:
    for task, benchmark in TASKS.items():
        for attachments in (True, False):
            some = [r for r in rows if r.trial.task == task and r.trial.attachments is attachments]
            if some:
                side = "with" if attachments else "without"
                words = f"{task} {benchmark.words}" if attachments else task
                yield (words, benchmark.robot, side, str(done(some)), *_figures(some))


def _figures(rows: Sequence[Row]) -> Iterator[str]:
    """Give the figures that every table has: false beliefs, places, durations (medians)."""
    yield str(sum(bool(row.false_at_end) for row in rows))
    late = [episode for row in rows for episode in row.episodes if episode.outlived]
    yield str(sum(any(e.outlived for e in row.episodes) for row in rows))
    yield shown(max((episode.seconds for episode in late), default=0.0))
    looked = sum(row.places.looked for row in rows)
    yield f"{100 * sum(row.places.astray for row in rows) / max(looked, 1):.2f} %"
    yield shown(median(row.cycles for row in rows), 0)
    yield shown(median(row.robot_s for row in rows))
    yield shown(median(row.wall_s for row in rows))


def done(rows: Sequence[Row]) -> Rate:
    """Give how many runs reached their goal, knew it, and were right."""
    return Rate(sum(row.achieved and row.true for row in rows), len(rows))


def faults_table(rows: Sequence[Row]) -> list[str]:
    """Give the runs in which something went wrong, kind by kind."""
    columns = (
        *("fault", "what happens", "runs", "struck", "done (95 %)"),
        *("achieved", "recovered", "failed, reason true", "otherwise"),
        *("false beliefs at the end", "unsafe motions", "traces damaged", "s"),
    )
    return table(columns, _fault_lines(rows))


def _fault_lines(rows: Sequence[Row]) -> Iterator[tuple[str, ...]]:
    for name, kind in KINDS.items():
        some = [row for row in rows if row.trial.fault == name]
        if some:
            counts = Counter(row.ending for row in some)
            yield (
                *(f"`{name}`", kind.words, str(len(some))),
                *(str(sum(bool(row.struck) for row in some)), str(done(some))),
                *(str(counts[ending]) for ending in GOOD),
                str(sum(row.ending not in GOOD for row in some)),
                str(sum(bool(row.false_at_end) for row in some)),
                str(sum(len(row.unsafe) for row in some)),
                str(sum(bool(row.trace.damage) for row in some)),
                shown(median(row.wall_s for row in some)),
            )


def matrix(rows: Sequence[Row]) -> list[str]:
    """Give how many runs of each task were done, whatever went wrong in them."""
    tasks = [task for task in TASKS if any(row.trial.task == task for row in rows)]
    lines = []
    for name in KINDS:
        some = [row for row in rows if row.trial.fault == name]
        if some:
            cells = (done([r for r in some if r.trial.task == task]) for task in tasks)
            lines.append((f"`{name}`", *(f"{c.hits} of {c.runs}" if c.runs else "" for c in cells)))
    return table(("fault", *tasks), lines)


def clocks_table(rows: Sequence[Row]) -> list[str]:
    """Give runs of the same seeds at different clocks beside each other."""
    by_clock: dict[float, dict[tuple[str, int, bool, str], Row]] = {}
    for row in rows:
        t = row.trial
        by_clock.setdefault(t.clock, {})[t.task, t.seed, t.attachments, t.fault] = row
    if len(by_clock) < 2:
        return []
    shared = set.intersection(*(set(found) for found in by_clock.values()))
    columns = ("clock", "runs", "done (95 %)", "false at the end", "cycles", "robot s", "s")
    lines = []
    for clock in sorted(by_clock):
        some = [by_clock[clock][each] for each in sorted(shared)]
        lines.append(
            (
                *(f"{clock:g}", str(len(some)), str(done(some))),
                str(sum(bool(row.false_at_end) for row in some)),
                shown(median(row.cycles for row in some), 0),
                shown(median(row.robot_s for row in some)),
                shown(median(row.wall_s for row in some)),
            )
        )
    return table(columns, lines) if shared else []


def episodes_table(rows: Sequence[Row]) -> list[str]:
    """Give what was believed without being true, in groups, the longest first."""
    groups: dict[tuple[str, str], list[tuple[str, Episode]]] = {}
    for row in rows:
        for episode in row.episodes:
            what = f"`{_without_numbers(episode.belief)}`"
            when = f"during `{episode.during}`" if episode.during else "with nothing under way"
            groups.setdefault((what, when), []).append((row.trial.key, episode))
    columns = ("belief", "began", "times", "outlived its action", "median s", "longest s")
    lines = [
        (
            *(what, when, str(len(found)), str(sum(e.outlived for _, e in found))),
            shown(median(e.seconds for _, e in found), 2),
            shown(max(e.seconds for _, e in found), 2),
        )
        for (what, when), found in sorted(groups.items(), key=lambda item: -_longest(item[1]))
    ]
    return table(columns, lines)


def _longest(found: Sequence[tuple[str, Episode]]) -> float:
    return max(episode.seconds for _, episode in found)


_AFTER: Final = {
    "protective_stop": "after a protective stop",
    "emergency_stop": "after an emergency stop",
    "program_ended": "after the program on the controller had ended",
    "link_lost": "after a link was lost",
    "noticed": "after the run had noticed it",
}


def travels_table(rows: Sequence[Row]) -> list[str]:
    """Give how far the leading joint went before it stood still, whatever stopped it."""
    lines = []
    for clock in sorted({row.trial.clock for row in rows}):
        found = [each for row in rows if row.trial.clock == clock for each in row.travels]
        for kind, words in _AFTER.items():
            went = sorted(way for name, way in found if name == kind)
            if went:
                late = went[min(len(went) - 1, int(0.95 * len(went)))]
                figures = (shown(each, 3) for each in (median(went), late, went[-1]))
                lines.append((words, f"{clock:g}", str(len(went)), *figures))
    return table(
        ("the leading joint went on", "clock", "times", "median rad", "95 %", "most"), lines
    )


def reasons(rows: Sequence[Row]) -> list[str]:
    """Give the reasons for which runs failed, numbers left out, the most frequent first."""
    counts = Counter(_without_numbers(row.reason) for row in rows if not row.achieved)
    return [f"* {count} times: {reason}" for reason, count in counts.most_common()]


def exceptions(rows: Sequence[Row]) -> list[str]:
    """Give every run that ended as none must, or with a false belief, and what can be said."""
    lines = []
    for row in rows:
        if row.ending not in GOOD:
            last = row.reason.strip().splitlines()[-1] if row.reason else "no reason"
            lines.append(f"* `{row.trial.key}`: {row.ending}: {last}")
        elif row.false_at_end and row.trial.attachments:
            beliefs = ", ".join(f"`{each}`" for each in row.false_at_end)
            lines.append(f"* `{row.trial.key}`: {row.ending}, with a false belief: {beliefs}")
        lines += [f"* `{row.trial.key}`: unsafe: {each}" for each in row.unsafe]
        if row.trace.damage:
            lines.append(f"* `{row.trial.key}`: trace: {row.trace.damage}")
    return lines


def by_fault(rows: Sequence[Row]) -> Mapping[str, Sequence[Row]]:
    """Give the rows in groups by their fault, in the order of the kinds."""
    return {name: [row for row in rows if row.trial.fault == name] for name in KINDS}


def _without_numbers(text: str) -> str:
    return re.sub(r"(?<![\w-])\d+(\.\d+)?", "…", " ".join(text.split()))
