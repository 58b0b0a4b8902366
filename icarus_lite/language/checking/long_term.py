"""Long-term goals: each has a name of its own, and a priority that is known when it is relevant."""

from __future__ import annotations

from collections.abc import Iterable

from icarus_lite.language.checking.report import Report
from icarus_lite.language.syntax import LongTermGoal, Variable


def check_long_term_goals(goals: Iterable[LongTermGoal], report: Report) -> None:
    """Check the names and priorities of long-term goals."""
    first: dict[str, LongTermGoal] = {}
    for goal in goals:
        earlier = first.setdefault(goal.name, goal)
        if earlier is not goal:
            message = f"there are two long-term goals `{goal.name}`"
            hint = f"the first is in {earlier.span.in_line}; give each its own name"
            report.error(goal.span, "ICR011", message, hint)
        if isinstance(goal.priority, Variable):
            _check_priority(goal, goal.priority, report)


def _check_priority(goal: LongTermGoal, priority: Variable, report: Report) -> None:
    positive = [c.atom for c in goal.relevance if not c.negated]
    measured = {name for atom in positive for name in atom.variables}
    if priority.name in measured:
        return
    message = f"{priority} in :priority of `{goal.name}` is never bound"
    meant = report.closest(priority.name, measured)
    hint = "bind it in :relevance, such as ((dirty ?table ^degree ?degree))"
    report.error(priority.span, "ICR012", message, f"did you mean {meant}?" if meant else hint)
