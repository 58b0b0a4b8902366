"""`why this action`: what a step of a plan brings about, for whom, and so on down to the goal."""

from __future__ import annotations

from collections.abc import Sequence

from icarus_lite.planning.causes import CausalLink
from icarus_lite.planning.plan import Plan
from icarus_lite.records import dataclass
from icarus_lite.symbols import Action


@dataclass(frozen=True, slots=True)
class Purpose:
    """What one step of a plan is for.

    Args:
        step: The step, from 0.
        plan: The plan, with its links.
        needs: The links that end at it: what makes its conditions hold.
        serves: The links that begin at it: which condition of which later step, or which goal,
            it sees to.
        onward: Links from it to a goal, by the fewest steps; empty if it serves nothing.
    """

    step: int
    plan: Plan
    needs: tuple[CausalLink, ...]
    serves: tuple[CausalLink, ...]
    onward: tuple[CausalLink, ...]

    @property
    def action(self) -> Action:
        """The skill instance that is asked about."""
        return self.plan.steps[self.step].action

    def lines(self) -> list[str]:
        """Give the answer line by line, the step itself first."""
        actions = [step.action for step in self.plan.steps]
        lines = [f"{self.action}, step {self.step + 1} of {len(actions)}"]
        for link in self.needs:
            came = "holds" if link.producer is None else f"by step {link.producer + 1}"
            lines.append(f"  needs {link.condition}{_rests_on(link)}: {came}")
        lines += [f"  brings about {x.fact}{_which_is_for(x, actions)}" for x in self.serves]
        if not self.serves:
            lines.append("  serves nothing that this plan needs")
        chain = [link for link in self.onward if link.consumer is not None]
        if chain:
            way = [f"step {link.consumer + 1} {actions[link.consumer]}" for link in chain]  # type: ignore[operator,index] # goals are left out
            lines.append(f"  and so: {' → '.join([*way, str(self.onward[-1].condition)])}")
        return lines

    def __str__(self) -> str:
        return "\n".join(self.lines())

    def as_dict(self) -> dict[str, object]:
        """Give the answer as JSON has it; steps are counted from 0."""
        return {
            "action": str(self.action),
            "step": self.step,
            "steps": len(self.plan.steps),
            "needs": [link.as_dict() for link in self.needs],
            "serves": [link.as_dict() for link in self.serves],
            "onward": [link.as_dict() for link in self.onward],
        }


def purpose(plan: Plan, step: int) -> Purpose:
    """Say what a step of a plan is for.

    Args:
        plan: A plan with links.
        step: The step, from 0.

    Raises:
        IndexError: the plan has no such step.
    """
    if not 0 <= step < len(plan.steps):
        raise IndexError(f"the plan has {len(plan.steps)} steps; there is no step {step}")
    links = tuple(dict.fromkeys(plan.links))
    return Purpose(
        step,
        plan,
        tuple(link for link in links if link.consumer == step),
        tuple(link for link in links if link.producer == step),
        _way_to_a_goal(links, step),
    )


def _way_to_a_goal(links: Sequence[CausalLink], step: int) -> tuple[CausalLink, ...]:
    """Follow links from a step to a goal, through as few other steps as possible."""
    ways: dict[int, tuple[CausalLink, ...]] = {step: ()}
    waiting = [step]
    for producer in waiting:
        for link in links:
            if link.producer != producer:
                continue
            way = (*ways[producer], link)
            if link.consumer is None:
                return way
            if link.consumer not in ways:
                ways[link.consumer] = way
                waiting.append(link.consumer)
    return ()


def _rests_on(link: CausalLink) -> str:
    return "" if link.fact == link.condition else f", for which {link.fact}"


def _which_is_for(link: CausalLink, actions: Sequence[Action]) -> str:
    inner = "" if link.fact == link.condition else f", so that {link.condition}"
    if link.consumer is None:
        return f"{inner}, a goal"
    return f"{inner}, which step {link.consumer + 1} {actions[link.consumer]} needs"
