"""The same plan in another order."""

from __future__ import annotations

import random

from icarus_lite.planning.ground_task import GroundTask


def reordered(task: GroundTask, plan: tuple[int, ...], chance: random.Random) -> tuple[int, ...]:
    """Order the steps of a plan differently where they do not touch each other.

    What follows from the step before comes next if it can, so that steps that belong together,
    such as the trips of one truck, come to stand together. What effects rules and exceptions have
    is not looked at: where there are any, the new order has to be tried out.

    Args:
        task: The problem.
        plan: Numbers of operators.
        chance: Decides between steps that could all be next.
    """
    everything = (1 << len(task.atoms)) - 1
    masks = []
    for step in plan:
        operator = task.operators[step]
        conditions = sum(1 << atom for atom in set(operator.conditions))
        masks.append((conditions, operator.add, ~operator.keep & everything))
    blockers = [0] * len(plan)
    followers: list[list[int]] = [[] for _ in plan]
    for later, (wants, adds, deletes) in enumerate(masks):
        for earlier, (wanted, added, deleted) in enumerate(masks[:later]):
            if added & (wants | deletes) or deleted & (wants | adds) or wanted & deletes:
                blockers[later] += 1
                followers[earlier].append(later)
    ready = [position for position, count in enumerate(blockers) if not count]
    order: list[int] = []
    while ready:
        linked = [each for each in ready if order and each in followers[order[-1]]]
        chosen = chance.choice(linked or ready)
        ready.remove(chosen)
        order.append(chosen)
        for follower in followers[chosen]:
            blockers[follower] -= 1
            if not blockers[follower]:
                ready.append(follower)
    return tuple(plan[position] for position in order)
