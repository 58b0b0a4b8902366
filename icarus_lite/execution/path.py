"""A skill path: from what is to be achieved, through macro skills, down to one primitive skill."""

from __future__ import annotations

from typing import TypeAlias

from icarus_lite.inference import bind_pattern
from icarus_lite.language.syntax import Atom, Condition, SkillClause
from icarus_lite.planning import PlanStep
from icarus_lite.records import dataclass
from icarus_lite.symbols import Value

Bound: TypeAlias = tuple[tuple[str, Value], ...]
"""Bindings as a value: pairs of variable and what it is bound to, sorted by name."""

Aim: TypeAlias = Condition | Atom
"""What a path leads to: a goal, or a skill that is to be carried out."""


@dataclass(frozen=True, slots=True)
class Level:
    """One skill instance on a path.

    Args:
        clause: The clause that was chosen for it.
        bindings: What its variables are bound to: by the call, by its own start conditions, and
            by the subskills it has finished, which pass theirs back.
        position: For a macro, the subskill that it has come to, from 0; those before it are done
            or were not needed.
        since_s: When it was begun, in s, if the agent is told the time.
    """

    clause: SkillClause
    bindings: Bound
    position: int = 0
    since_s: float | None = None

    @property
    def instance(self) -> Atom:
        """The head with what is bound filled in: `(make-clear a)`."""
        return bind_pattern(self.clause.head, dict(self.bindings))

    @property
    def call(self) -> Atom:
        """The subskill that a macro has come to, with what is bound filled in."""
        return bind_pattern(self.clause.subskills[self.position], dict(self.bindings))

    @property
    def is_primitive(self) -> bool:
        """Whether it acts itself rather than through subskills."""
        return self.clause.is_primitive

    @property
    def is_at_end(self) -> bool:
        """Whether it is a macro with no subskill left."""
        return self.position >= len(self.clause.subskills)

    def __str__(self) -> str:
        return str(self.instance)


@dataclass(frozen=True, slots=True)
class SkillPath:
    """What the present action is for, level by level.

    Args:
        aims: What it leads to: one goal, one intended skill, or, where the action is the next
            step of a plan, all the goals that the plan is for.
        levels: The skill instances from the outermost macro to the primitive, the last one.
        step: The primitive as an action with its commands.
    """

    aims: tuple[Aim, ...]
    levels: tuple[Level, ...]
    step: PlanStep

    def __str__(self) -> str:
        parts = [" ".join(map(str, self.aims)), *map(str, self.levels)]
        # An intended skill is its own outermost level, and is not named twice.
        return " → ".join(parts[1:] if parts[0] == parts[1] else parts)


def as_bound(bindings: dict[str, Value]) -> Bound:
    """Give bindings as a value."""
    return tuple(sorted(bindings.items()))
