"""`why this action`: what the present step is for, down to the goal."""

from __future__ import annotations

from icarus_lite.execution.decision import Decision
from icarus_lite.planning import Purpose, purpose
from icarus_lite.records import dataclass
from icarus_lite.symbols import Action


@dataclass(frozen=True, slots=True)
class ActionReason:
    """Why an agent does what it does in a cycle.

    Args:
        cycle: The cycle.
        action: The step that is begun, goes on or is stopped; None where there is none.
        reason: What was decided, in words.
        aims: The goal or intention that it is for, and the skills on the way, outermost first.
        purpose: Where a plan is followed, what the step brings about and which later steps, or
            goals, wait for it; None where skills lead the way.
    """

    cycle: int
    action: Action | None
    reason: str
    aims: tuple[str, ...] = ()
    purpose: Purpose | None = None

    def __str__(self) -> str:
        if self.action is None:
            return f"cycle {self.cycle}: no action; {self.reason}"
        lines = [f"cycle {self.cycle}: {self.action}; {self.reason}"]
        if self.aims:
            lines.append(f"for {' → '.join(self.aims)}")
        if self.purpose is not None:
            lines += self.purpose.lines()
        return "\n".join(lines)

    def as_dict(self) -> dict[str, object]:
        """Give the answer as JSON has it."""
        return {
            "cycle": self.cycle,
            "action": None if self.action is None else str(self.action),
            "reason": self.reason,
            "aims": list(self.aims),
            "purpose": None if self.purpose is None else self.purpose.as_dict(),
        }


def action_reason(decision: Decision) -> ActionReason:
    """Say what the action of a cycle is for."""
    step, path, status = decision.step, decision.skill_path, decision.plan
    if step is None:
        return ActionReason(decision.cycle, None, decision.reason)
    aims: list[str] = []
    if path is not None:
        aims = [" ".join(map(str, path.aims)), *map(str, path.levels[:-1])]
        if aims[1:] and aims[0] == aims[1]:  # an intended skill is its own outermost level
            del aims[0]
    served = None if status is None else purpose(status.plan, status.position)
    return ActionReason(decision.cycle, step.action, decision.reason, tuple(aims), served)
