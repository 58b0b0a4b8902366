"""From a problem to a plan: search, then leave out what the plan does not need."""

from __future__ import annotations

from icarus_lite.planning.ground_task import GroundTask
from icarus_lite.planning.search.elimination import without_needless_steps
from icarus_lite.planning.search.greedy import greedy
from icarus_lite.planning.search.relaxed_plan import Relaxation
from icarus_lite.planning.search.result import Limits, SearchResult
from icarus_lite.records import replace


def search(task: GroundTask, limits: Limits | None = None) -> SearchResult:
    """Find a plan, soon rather than a shortest one; `improve` makes it shorter.

    The same task, and the same limit of evaluations, give the same plan. Of operators that do
    the same service those that undo least are tried first: to get a hand free, putting a block on
    the table rather than on another block.

    Args:
        task: The problem.
        limits: When to give up; never, without.
    """
    operators = task.operators
    undone = [~op.keep & (1 << len(task.atoms)) - 1 for op in operators]
    order = sorted(range(len(operators)), key=lambda number: undone[number].bit_count())
    ordered = replace(task, operators=tuple(operators[number] for number in order))
    relaxation = Relaxation(ordered)
    result = greedy(ordered, relaxation, limits or Limits())
    if result.plan is not None:
        plan = without_needless_steps(ordered, result.plan)
        return replace(result, plan=tuple(order[step] for step in plan))
    if result.exhausted and not result.progress:  # even the relaxed problem has no plan
        unreachable = relaxation.unreachable(task.initial, task.goal)
        return replace(result, unreachable=unreachable)
    return result
