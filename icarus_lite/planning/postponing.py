"""Requests as late as the plan allows: nobody holds a part while the arm has yet to fetch another.

An agent that waits keeps still, so what it can do first, it does first.
"""

from __future__ import annotations

from icarus_lite.planning.plan import Plan
from icarus_lite.planning.projection import validate
from icarus_lite.planning.situation import Imagination
from icarus_lite.records import replace


def postponed(imagination: Imagination, plan: Plan) -> Plan:
    """Move the steps of other agents behind one's own, as far as the plan still works.

    Args:
        imagination: The beliefs of now; each order is carried out in the mind before it is taken.
        plan: A plan that works.
    """
    steps = list(plan.steps)
    for start in range(len(steps) - 1, -1, -1):
        if steps[start].clause.agent is None:
            continue
        place = start
        while place + 1 < len(steps) and steps[place + 1].clause.agent is None:
            other = [*steps[:place], steps[place + 1], steps[place], *steps[place + 2 :]]
            if validate(imagination, tuple(other), plan.goals) is not None:
                break
            steps, place = other, place + 1
    return plan if tuple(steps) == plan.steps else replace(plan, steps=tuple(steps))
