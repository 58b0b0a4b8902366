"""One step of a plan: a skill instance with what it needs carried out and what it changes."""

from __future__ import annotations

from collections.abc import Mapping

from icarus_lite.inference import Change, change_of, ground
from icarus_lite.language.syntax import SkillClause
from icarus_lite.records import dataclass
from icarus_lite.symbols import Action, Value


@dataclass(frozen=True, slots=True)
class PlanStep:
    """One skill instance of a plan.

    Args:
        action: The skill with its arguments.
        commands: What the driver is to carry out for it.
        clause: The clause of the skill that was chosen.
        bindings: What the clause's variables are bound to.
        change: What will be believed, or no longer, once it has succeeded.
    """

    action: Action
    commands: tuple[Action, ...]
    clause: SkillClause
    bindings: tuple[tuple[str, Value], ...]
    change: Change


def plan_step(clause: SkillClause, bindings: Mapping[str, Value]) -> PlanStep | None:
    """Give a primitive skill instance as a step; None if an argument of it is still free."""
    head = ground(clause.head, bindings)
    commands = tuple(ground(command, bindings) for command in clause.actions)
    if head is None or None in commands:
        return None
    return PlanStep(
        Action(head.predicate, head.args),
        tuple(Action(c.predicate, c.args) for c in commands if c is not None),
        clause,
        tuple(sorted(bindings.items())),
        change_of(clause.effects, bindings),
    )
