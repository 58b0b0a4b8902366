"""The live view of a run: what is seen, what is kept though hidden, beliefs, goal and skill."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from types import TracebackType
from typing import Final, Self

from rich.console import Console, Group
from rich.live import Live
from rich.table import Table
from rich.text import Text

from aapa import Anchor, AnchorStatus
from icarus_lite import DecisionKind, Status
from runtime.cycle_report import CycleReport
from runtime.percepts import HAND_TYPE

_STYLES: Final = {
    AnchorStatus.VISIBLE: "green",
    AnchorStatus.ATTACHED: "cyan",
    AnchorStatus.OCCLUDED: "yellow",
    AnchorStatus.OUT_OF_VIEW: "yellow",
    AnchorStatus.MISSING: "red",
}


class RunView:
    """Shows each cycle: a panel that renews itself on a terminal, plain lines elsewhere.

    Args:
        console: Where to write; decides by itself whether it is a terminal.
        title: What runs, on the first line.
    """

    def __init__(self, console: Console, title: str) -> None:
        self._console = console
        self._title = title
        self._events: deque[Text] = deque(maxlen=14)
        self._milestones: list[Text] = []
        self._live = Live(console=console, refresh_per_second=10, transient=True)
        self._statuses: dict[str, AnchorStatus] = {}
        self._doing = ""

    def __enter__(self) -> Self:
        self._console.print(self._title, style="bold", highlight=False)
        if self._console.is_terminal:
            self._live.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        value: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        if self._console.is_terminal:
            self._live.stop()
            for milestone in self._milestones:
                self._console.print(milestone, highlight=False, soft_wrap=True)

    def announce(self, words: str) -> None:
        """Say what arm and what cell this is."""
        self._console.print(words, style="dim", highlight=False, soft_wrap=True)

    def show(self, report: CycleReport) -> None:
        """Show one finished cycle."""
        events = list(self._changes(report))
        if not self._console.is_terminal:
            for event in events:
                self._console.print(event, soft_wrap=True, highlight=False)
            return
        self._events.extend(events)
        self._live.update(self._panel(report))

    def _changes(self, report: CycleReport) -> Iterator[Text]:
        """Give a line for everything that is not as it was in the cycle before."""
        cycle = f"cycle {report.decision.cycle:4d}  "
        for outcome in report.outcomes:
            if outcome.status is not Status.RUNNING:
                style = "green" if outcome.status is Status.SUCCEEDED else "bold red"
                reason = f": {outcome.reason}" if outcome.reason else ""
                yield self._milestone(
                    Text(f"{cycle}{outcome.action} {outcome.status}{reason}", style=style)
                )
        for belief in report.decision.added:
            yield Text(f"{cycle}+ {belief}")
        for belief in report.decision.removed:
            yield Text(f"{cycle}- {belief}", style="dim")
        yield from self._seen_or_kept(report, cycle)
        doing = _doing(report)
        if doing != self._doing:
            self._doing = doing
            yield self._milestone(Text(f"{cycle}{doing}", style="bold"))

    def _milestone(self, event: Text) -> Text:
        """Keep an event to show when the panel is gone."""
        self._milestones.append(event)
        return event

    def _seen_or_kept(self, report: CycleReport, cycle: str) -> Iterator[Text]:
        now = {a.name: a for a in report.anchors if a.type != HAND_TYPE}
        for name in [name for name in self._statuses if name not in now]:
            yield Text(f"{cycle}  {name}: no longer anchored", style="red")
        for name, anchor in now.items():
            before = self._statuses.get(name)
            if before is not anchor.status:
                yield Text(f"{cycle}  {name}: {_place(anchor)}", style=_STYLES[anchor.status])
        self._statuses = {name: anchor.status for name, anchor in now.items()}

    def _panel(self, report: CycleReport) -> Group:
        table = Table(box=None, pad_edge=False, header_style="dim")
        for column in ("object", "how it is known", "x, y, z (m)", "confidence"):
            table.add_column(column)
        for anchor in report.anchors:
            if anchor.type == HAND_TYPE:
                continue
            at = "" if anchor.position is None else ", ".join(f"{v:6.3f}" for v in anchor.position)
            table.add_row(
                anchor.name,
                Text(_place(anchor), style=_STYLES[anchor.status]),
                at,
                f"{anchor.confidence:.1f}",
            )
        goals = Text("goal   ", style="dim")
        for status in report.decision.goals:
            mark, style = ("✓", "green") if status.satisfied else ("·", "yellow")
            goals.append(f"{mark} {status.goal}  ", style=style)
        skill = Text("skill  ", style="dim").append(_doing(report), style="bold")
        head = Text(f"cycle {report.decision.cycle}", style="bold")
        return Group(head, goals, skill, Text(), table, Text(), *self._events)


def _place(anchor: Anchor) -> str:
    if anchor.status is AnchorStatus.VISIBLE:
        return "seen"
    if anchor.status is AnchorStatus.ATTACHED:
        return f"not seen, kept: attached to {anchor.parent}"
    if anchor.status is AnchorStatus.MISSING:
        return "not seen, unexplained"
    return f"not seen, kept: {anchor.status}"


def _doing(report: CycleReport) -> str:
    decision = report.decision
    if decision.kind is DecisionKind.ACHIEVED:
        return "nothing: all goals are believed"
    if decision.kind is DecisionKind.IMPASSE:
        return f"impasse: {decision.reason}"
    action = "" if decision.step is None else str(decision.step.action)
    if decision.request is not None:
        return decision.request.text
    if decision.kind is DecisionKind.ABORT:
        return f"{action} aborted: {decision.reason}"
    return action
