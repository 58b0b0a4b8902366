"""Plans as data: the steps, what each of them is for, or why there is no plan."""

from __future__ import annotations

from collections.abc import Sequence

from icarus_lite.language.syntax import Condition
from icarus_lite.planning.account import Account
from icarus_lite.planning.causes import CausalLink, Needs, Requirement
from icarus_lite.planning.failures import FailureReason
from icarus_lite.planning.steps import PlanStep
from icarus_lite.records import dataclass, field, replace


@dataclass(frozen=True, slots=True)
class Plan:
    """The steps that lead from now to the goal; none if it holds already.

    Args:
        steps: The skill instances, in order, each with its commands and expected effects.
        goals: What they lead to.
        needs: What each step and the goal need and which steps see to it, in the order of the
            steps, the goal last; empty where nobody has asked for it, see `with_links`.
        account: How it was looked for; None where it is given, or nothing was to be done.
    """

    steps: tuple[PlanStep, ...]
    goals: tuple[Condition, ...] = ()
    needs: tuple[Needs, ...] = field(default=(), compare=False)
    account: Account | None = field(default=None, compare=False)

    @property
    def links(self) -> tuple[CausalLink, ...]:
        """Which step serves which condition of which later step, or which goal."""
        return tuple(link for needs in self.needs for link in needs.links())

    def rebound(self, start: int, steps: Sequence[PlanStep]) -> Plan:
        """Give the plan with some of its steps, from one on, bound anew."""
        before, after = self.steps[:start], self.steps[start + len(steps) :]
        return replace(self, steps=(*before, *steps, *after))

    def required(self, position: int) -> tuple[Requirement, ...]:
        """Give what must hold for the rest of the plan, from the step at a position, to work.

        Source: Fikes, Hart and Nilsson 1972, the kernels of a triangle table.
        """
        waiting = [
            requirement
            for needs in self.needs
            if needs.consumer is None or needs.consumer >= position
            for requirement in needs.required(position)
        ]
        return tuple(dict.fromkeys(waiting))


@dataclass(frozen=True, slots=True)
class NoPlan:
    """Why there is no plan.

    Args:
        reason: A sentence for the person who asked.
        final: True when no plan can exist for these percepts, False when a limit was reached.
        failure: The name of the reason.
        account: How a plan was looked for; None where that was not needed to tell.
    """

    reason: str
    final: bool
    failure: FailureReason = FailureReason.GOAL_UNREACHABLE
    account: Account | None = field(default=None, compare=False)
