"""A stretch of a plan planned anew: weighted A* with deferred evaluation, within a bound."""

from __future__ import annotations

from collections.abc import Callable

from icarus_lite.planning.ground_task import GroundTask, State
from icarus_lite.planning.search.relaxed_plan import Relaxation, bits
from icarus_lite.planning.search.waiting import Waiting, way

WEIGHT = 3
"""How much more than a step behind a step ahead counts, in the order in which states are tried."""


def shorter_way(
    task: GroundTask,
    relaxation: Relaxation,
    start: State,
    need: State,
    bound: int,
    budget: int,
    expired: Callable[[], bool] = bool,
) -> tuple[tuple[int, ...] | None, int]:
    """Look for a way of fewer steps from a state to all atoms of a mask.

    States from which the relaxed plan does not fit into the bound are left out. The relaxed plan
    can be longer than a shortest plan, so not to find a way does not prove that there is none.

    Args:
        task: Gives the operators.
        relaxation: Of the same task.
        start: Where the way begins.
        need: Mask of the atoms that must hold at its end; not all of them hold at the start.
        bound: The way must have fewer steps than this.
        budget: How many states to judge at most.
        expired: Tells whether there is no time left; by default there always is.

    Returns:
        The operators' numbers, or None; and how many states were judged.
    """
    goal = tuple(bits(need))
    waiting = Waiting()
    states, origins, depths = [start], [(-1, -1)], [0]
    reached = {start: 0}
    node = judged = 0
    while judged < budget and not expired():
        estimate = relaxation.estimate(states[node], goal)
        judged += 1
        fewest = bound if estimate is None else depths[node] + estimate.steps
        if estimate is not None and fewest < bound:
            rank = (depths[node] + WEIGHT * estimate.steps) * bound + estimate.steps
            others = set(estimate.applicable).difference(estimate.preferred)
            waiting.push(rank, node, estimate.preferred)
            if fewest + 1 < bound:
                waiting.push(rank + WEIGHT * bound, node, sorted(others))
        while True:
            if not waiting:
                return None, judged
            parent, step = waiting.pop()
            depth = depths[parent] + 1
            state = task.after(states[parent], task.operators[step])
            if depth < reached.get(state, bound):
                break
        reached[state] = depth
        node = len(states)
        states.append(state)
        origins.append((parent, step))
        depths.append(depth)
        if state & need == need:
            return way(origins, node), judged
    return None, judged
