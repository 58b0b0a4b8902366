"""Problem solving on an impasse: means-ends analysis first, then search, and the better of the two.

Means-ends analysis is quick and can be told to a person, but it commits itself and may take a
detour, or miss a plan. So its plan counts for what it is: where the problem is small, a look at
everything near the start tells whether a shorter one exists; elsewhere search is asked too.
"""

from __future__ import annotations

from icarus_lite.planning.account import Account
from icarus_lite.planning.ground_task import GroundTask
from icarus_lite.planning.means_ends import MAX_SUBGOALS, means_ends
from icarus_lite.planning.search import Limits, SearchResult, improve, search
from icarus_lite.planning.search.elimination import without_needless_steps
from icarus_lite.planning.search.relaxed_plan import Relaxation
from icarus_lite.planning.shortest import shorter_plan
from icarus_lite.records import dataclass, replace

_CHECKS = 100
"""Operators looked at breadth first in the time that it takes to judge a situation."""

_MOST_NEAR = 10_000
"""Situations' worth of looking breadth first where there is no limit."""

_SIZE = 1_000_000
"""Subgoals times operators that means-ends analysis may take before search takes over."""

_LONG = 200
"""Steps of a plan from which leaving out needless ones takes longer than searching."""


@dataclass(frozen=True, slots=True)
class Solution:
    """What problem solving has come to.

    Args:
        plan: Numbers of the operators that lead to the goal, in order; None if there is none.
        account: How it was looked for.
        search: How the search ended; None where none was needed.
    """

    plan: tuple[int, ...] | None
    account: Account
    search: SearchResult | None = None


def solve(task: GroundTask, limits: Limits, improvement: Limits) -> Solution:
    """Solve a problem without variables.

    The same problem gives the same plan, unless a limit of seconds is reached.

    Args:
        task: The problem.
        limits: When the search gives up.
        improvement: When to stop making the plan shorter; it is a shortest one where the problem
            is small.
    """
    relaxation = Relaxation(task)
    analysis = means_ends(task, relaxation, _subgoals(task, limits))
    plan = analysis.plan
    if plan is not None and len(plan) <= _LONG:
        plan = without_needless_steps(task, plan)
    account = Account(analysis.goals, analysis.subgoals, None if plan is None else len(plan))
    if plan is not None:
        shorter, settled = _settled(task, plan, improvement)
        if settled:
            return Solution(shorter, replace(account, steps=len(shorter), shortest=True))
    found = search(task, limits)
    account = replace(
        account,
        searched=None if found.plan is None else len(found.plan),
        effort=found.effort,
        progress=found.progress,
    )
    plan = _better(plan, found.plan)
    if plan is None:
        return Solution(None, account, found)
    shorter, settled = _settled(task, plan, improvement if analysis.plan is None else Limits(0))
    if settled:
        return Solution(shorter, replace(account, steps=len(shorter), shortest=True), found)
    if improvement.evaluations != 0:
        plan = improve(task, plan, improvement)
    return Solution(plan, replace(account, steps=len(plan)), found)


def _subgoals(task: GroundTask, limits: Limits) -> int:
    """Say how many subgoals may be taken up: fewer where each takes long, or little is allowed."""
    most = min(MAX_SUBGOALS, _SIZE // (1 + len(task.operators)))
    return most if limits.evaluations is None else min(most, limits.evaluations)


def _settled(
    task: GroundTask, plan: tuple[int, ...], improvement: Limits
) -> tuple[tuple[int, ...], bool]:
    """Give a shortest plan where that is cheap, and whether it was."""
    if len(plan) < 2:
        return plan, True
    judged = _MOST_NEAR if improvement.evaluations is None else improvement.evaluations
    return shorter_plan(task, plan, judged * _CHECKS) if judged > 0 else (plan, False)


def _better(
    analysed: tuple[int, ...] | None, searched: tuple[int, ...] | None
) -> tuple[int, ...] | None:
    """Give the shorter of two plans; of two alike, the one that can be told."""
    if analysed is None or searched is None:
        return analysed if searched is None else searched
    return searched if len(searched) < len(analysed) else analysed
