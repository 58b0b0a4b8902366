"""What `icarus plan` shows: the steps, what each is for, how they were found, a macro skill."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from icarus_lite.planning import NoPlan, Plan, find_plan, macro, project, purpose, with_links

if TYPE_CHECKING:
    from icarus_lite.language.syntax import Condition, Domain
    from icarus_lite.planning import Imagination, Macro


@dataclass(frozen=True, slots=True)
class Bounds:
    """How long may be searched.

    Args:
        limit: Situations judged at most; None for no limit.
        seconds: Time at most in s; None for no limit.
        improve_s: How long the plan is made shorter, in s; None for a little, the same each time.
    """

    limit: int | None
    seconds: float | None
    improve_s: float | None


@dataclass(frozen=True, slots=True)
class Answer:
    """What planning has come to, and what it takes to tell more about it.

    Args:
        domain: The domain.
        imagination: The state planned from.
        found: The plan, or why there is none.
    """

    domain: Domain
    imagination: Imagination
    found: Plan | NoPlan

    @classmethod
    def of(
        cls, domain: Domain, imagination: Imagination, goals: Sequence[Condition], bounds: Bounds
    ) -> Answer:
        """Plan for goals."""
        if bounds.improve_s is None:
            found = find_plan(
                domain, imagination, goals, limit=bounds.limit, seconds=bounds.seconds
            )
        else:
            found = find_plan(
                domain,
                imagination,
                goals,
                limit=bounds.limit,
                seconds=bounds.seconds,
                improvement=None,
                improvement_s=bounds.improve_s,
            )
        return cls(domain, imagination, found)

    def linked(self, plan: Plan) -> Plan:
        """Give the plan with its causal links."""
        projection = project(self.imagination, plan.steps, plan.goals)
        return with_links(self.imagination, plan, projection)

    def macro(self, plan: Plan) -> Macro | None:
        """Give the plan as a macro skill; None for one without steps."""
        if not plan.steps:
            return None
        start = project(self.imagination, ()).stages[0]
        return macro(self.domain, self.linked(plan), start)


def lines(answer: Answer, *, explain: bool, as_macro: bool) -> Iterator[str]:
    """Give what a person reads, line by line.

    Args:
        answer: What planning has come to.
        explain: Whether to say what each step is for, and how the plan was found.
        as_macro: Whether to show it as a macro skill; that alone, unless it is to be explained.
    """
    found = answer.found
    if isinstance(found, Plan):
        if not found.steps:
            yield "nothing to do: the goal holds already"
        elif explain:
            yield from _explained(answer.linked(found))
        elif not as_macro:
            yield from (f"{number:>3}  {step.action}" for number, step in enumerate(found.steps, 1))
    if explain and found.account is not None:
        yield "How it was looked for"
        yield from (f"  {line}" for line in found.account.lines())
    if as_macro and isinstance(found, Plan):
        made = answer.macro(found)
        if made is not None:
            yield from (["", *made.text.splitlines()] if explain else made.text.splitlines())


def _explained(plan: Plan) -> Iterator[str]:
    """Say of each step what it needs, what it brings about, and what for."""
    for number in range(len(plan.steps)):
        yield from purpose(plan, number).lines()
        yield ""


def document(answer: Answer, *, explain: bool, as_macro: bool) -> dict[str, object]:
    """Give the answer as one JSON document.

    Without further wishes it has the keys of the contract and no others.
    """
    found = answer.found
    shown: dict[str, object]
    if isinstance(found, Plan):
        steps = [str(step.action) for step in found.steps]
        shown = {"solved": True, "steps": steps, "cost": len(steps)}
    else:
        shown = {"solved": False, "steps": [], "cost": None, "reason": found.reason}
        if explain:
            shown |= {"failure": str(found.failure), "final": found.final}
    if explain and isinstance(found, Plan):
        shown["links"] = [link.as_dict() for link in dict.fromkeys(answer.linked(found).links)]
    if explain:
        shown["account"] = None if found.account is None else found.account.as_dict()
    if as_macro and isinstance(found, Plan):
        made = answer.macro(found)
        shown["macro"] = None if made is None else made.text
    return shown
