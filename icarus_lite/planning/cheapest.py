"""The cheapest plan, where the problem is small enough to look at all that costs less."""

from __future__ import annotations

from heapq import heappop, heappush

from icarus_lite.language.teams import cost_of
from icarus_lite.planning.ground_task import GroundTask, State
from icarus_lite.planning.lower_bound import at_least
from icarus_lite.planning.steps import PlanStep

MOST_CHECKS = 200_000
"""How often it is asked whether an operator can start before the look around is given up."""


def least_cost(task: GroundTask) -> int:
    """Give a cost that no plan can go below."""
    return at_least(task, [cost_of(operator.step.clause) for operator in task.operators])


def cheaper_plan(
    task: GroundTask, cost: int, checks: int = MOST_CHECKS
) -> tuple[tuple[PlanStep, ...] | None, bool]:
    """Look for the cheapest plan that costs less than a given one (uniform-cost search).

    Args:
        task: The problem.
        cost: What the given plan costs; `least_cost` is less, or there is nothing to look for.
        checks: How often to ask whether an operator can start, at most.

    Returns:
        The steps of the plan, or None where none was found; and whether it is known that there is
        none that costs less.
    """
    steps = [operator.step for operator in task.operators]
    needs = [sum(1 << atom for atom in set(op.conditions)) for op in task.operators]
    prices = [cost_of(step.clause) for step in steps]
    best: dict[State, int] = {task.initial: 0}
    origins: dict[State, tuple[State, int]] = {}
    queue = [(0, 0, task.initial)]
    while queue:
        spent, _, state = heappop(queue)
        if spent > best[state]:
            continue
        if task.reached(state):
            return tuple(steps[number] for number in _way(task.initial, state, origins)), True
        checks -= len(needs)
        if checks < 0:
            return None, False
        for number, (mask, price) in enumerate(zip(needs, prices, strict=True)):
            if state & mask != mask or spent + price >= cost:
                continue
            after = task.after(state, task.operators[number])
            if spent + price < best.get(after, cost):
                best[after] = spent + price
                origins[after] = state, number
                heappush(queue, (spent + price, len(origins), after))
    return None, True


def _way(initial: State, state: State, origins: dict[State, tuple[State, int]]) -> list[int]:
    """Give the operators that lead to a state."""
    way = []
    while state != initial:
        state, number = origins[state]
        way.append(number)
    return way[::-1]
