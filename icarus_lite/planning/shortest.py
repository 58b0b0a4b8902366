"""A shortest plan, where the problem is small enough to look at everything near the start."""

from __future__ import annotations

from icarus_lite.planning.ground_task import GroundTask, State
from icarus_lite.planning.lower_bound import at_least


def shorter_plan(
    task: GroundTask, plan: tuple[int, ...], checks: int
) -> tuple[tuple[int, ...], bool]:
    """Look breadth first for a plan that is shorter than a given one.

    Args:
        task: The problem.
        plan: A plan, as numbers of operators.
        checks: How often to ask whether an operator can start, at most.

    Returns:
        A shortest plan, of several the first in the order of the operators; or the given one where
        too many checks are needed to tell. And whether it is known that there is no shorter one.
    """
    if at_least(task) >= len(plan):
        return plan, True
    wanted = sum(1 << atom for atom in set(task.goal))
    needs = [
        (sum(1 << atom for atom in set(operator.conditions)), number)
        for number, operator in enumerate(task.operators)
    ]
    level = [(task.initial, 0)]
    seen: set[State] = {task.initial}
    origins = [(-1, -1)]
    for depth in range(1, len(plan) + 1):
        following: list[tuple[State, int]] = []
        for state, node in level:
            checks -= len(needs)
            if checks < 0:
                return plan, depth == len(plan)
            for mask, number in needs:
                if state & mask != mask:
                    continue
                after = task.after(state, task.operators[number])
                if after in seen:
                    continue
                seen.add(after)
                origins.append((node, number))
                if after & wanted == wanted:
                    return _way(origins), True
                following.append((after, len(origins) - 1))
        level = following
    return plan, True


def _way(origins: list[tuple[int, int]]) -> tuple[int, ...]:
    """Give the operators that led to the node found last."""
    way, node = [], len(origins) - 1
    while node:
        node, number = origins[node]
        way.append(number)
    return tuple(reversed(way))
