"""Plans in a trace: how the present one stands, and its steps and links whenever they change."""

from __future__ import annotations

from icarus_lite.execution import PlanStatus


def plan_row(status: PlanStatus) -> dict[str, object]:
    """Give the plan that is being followed as a part of a cycle's line.

    Steps and links are written down in the cycle in which they are new. Steps are counted from 0;
    a link without a producer is about what held when the plan was made, one without a consumer
    serves a goal.
    """
    row: dict[str, object] = {
        "verdict": str(status.verdict),
        "text": status.text,
        "position": status.position,
        "surprises": [str(literal) for literal in status.surprises],
    }
    if status.changed:
        row["steps"] = [str(step.action) for step in status.plan.steps]
        row["links"] = [link.as_dict() for link in dict.fromkeys(status.plan.links)]
    return row
