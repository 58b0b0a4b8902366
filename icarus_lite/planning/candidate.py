"""What the planner had before it: the skills that could start now, and what held the others up."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from icarus_lite.inference.near_miss import near_misses
from icarus_lite.language.syntax import Condition, Domain
from icarus_lite.planning.plan import NoPlan, Plan
from icarus_lite.planning.relevance import relevance
from icarus_lite.planning.situation import Imagination
from icarus_lite.records import dataclass
from icarus_lite.symbols import Action


@dataclass(frozen=True, slots=True)
class Candidate:
    """A skill that could serve the goal, and what became of it.

    Args:
        skill: The instance that could start now, or the head of a skill that could not.
        chosen: Whether the plan begins with it.
        why_not: Why it was not chosen; for a skill that cannot start, the first condition that
            fails in its best attempt.
    """

    skill: str
    chosen: bool
    why_not: str = ""


def candidates(
    domain: Domain, imagination: Imagination, goals: Sequence[Condition], found: Plan | NoPlan
) -> Iterator[Candidate]:
    """Give every skill that can serve the goals: the chosen one, the others, the impossible.

    Skills that no chain of effects and conditions leads to from the goals are left out: see
    `relevance`.
    """
    facts = imagination.now
    skills = relevance(domain, goals).skills
    first = found.steps[0].action if isinstance(found, Plan) and found.steps else None
    ready: set[str] = set()
    seen: set[Action] = set()
    for step in imagination.applicable(skills, facts):
        ready.add(step.action.name)
        if step.action in seen:
            continue
        seen.add(step.action)
        why_not = "" if step.action == first else f"the plan begins with {first}"
        if isinstance(found, NoPlan):
            why_not = "leads to no plan"
        yield Candidate(str(step.action), step.action == first, why_not)
    for clause in skills:
        if clause.head.predicate not in ready:
            for miss in near_misses(clause.head, [clause], facts, imagination.evaluator):
                yield Candidate(str(clause.head), chosen=False, why_not=str(miss.obstacle))
