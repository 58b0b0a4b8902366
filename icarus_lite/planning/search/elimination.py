"""A plan without the steps it does not need."""

from __future__ import annotations

from icarus_lite.planning.ground_task import GroundTask, State

LONG = 200
"""Steps of a plan from which on the first step that can go goes, instead of the best."""


def without_needless_steps(task: GroundTask, plan: tuple[int, ...]) -> tuple[int, ...]:
    """Leave out steps, each with all that depended on it, as long as the goal is still reached.

    Of the steps that can go, the one that takes most others with it goes first; in a long plan,
    where it would take long to find that one, the first.

    Args:
        task: The problem.
        plan: Numbers of operators that lead to its goal.

    Source: Nakhost and Müller, Action elimination and plan neighborhood graph search, 2010;
        Balyo, Chrpa and Kilani, On different strategies for eliminating redundant actions from
        plans, 2014 (greedy action elimination).
    """
    conditions = {
        step: sum(1 << atom for atom in set(task.operators[step].conditions)) for step in plan
    }
    position, state = 0, task.initial
    while position < len(plan) > LONG:
        shorter = _without(task, conditions, plan, position, state)
        if shorter is not None:
            plan = shorter
        else:
            state = task.after(state, task.operators[plan[position]])
            position += 1
    while len(plan) <= LONG:
        best = plan
        state = task.initial
        for position, step in enumerate(plan):
            shorter = _without(task, conditions, plan, position, state)
            if shorter is not None and len(shorter) < len(best):
                best = shorter
            state = task.after(state, task.operators[step])
        if best is plan:
            return plan
        plan = best
    return plan


def _without(
    task: GroundTask, conditions: dict[int, int], plan: tuple[int, ...], position: int, state: State
) -> tuple[int, ...] | None:
    """Leave out one step, and whatever can then not start; None if that misses the goal.

    Args:
        task: The problem.
        conditions: Mask of the conditions, by operator.
        plan: The plan.
        position: Of the step to leave out.
        state: Before that step.
    """
    kept = list(plan[:position])
    for step in plan[position + 1 :]:
        if state & conditions[step] == conditions[step]:
            state = task.after(state, task.operators[step])
            kept.append(step)
    return tuple(kept) if task.reached(state) else None
