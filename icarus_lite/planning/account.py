"""How a plan was looked for, for the person who asks: subgoals, search, and what each came to."""

from __future__ import annotations

from collections.abc import Iterator

from icarus_lite.planning.search import Effort, Progress
from icarus_lite.planning.subgoals import Subgoal
from icarus_lite.records import dataclass


@dataclass(frozen=True, slots=True)
class Account:
    """How a plan was looked for.

    Args:
        goals: The goals, each with the subgoals that means-ends analysis has gone through for it.
        subgoals: How many those are.
        analysed: Steps of the plan that means-ends analysis found, needless ones left out; None
            if it found none.
        searched: Steps of the plan that search found; None if it found none.
        effort: What the search took; None where none was needed.
        progress: How the search came nearer to the goal.
        steps: Steps of the plan that was taken in the end; None without one.
        shortest: Whether it is known that no plan is shorter than that.
    """

    goals: tuple[Subgoal, ...]
    subgoals: int
    analysed: int | None
    searched: int | None = None
    effort: Effort | None = None
    progress: tuple[Progress, ...] = ()
    steps: int | None = None
    shortest: bool = False

    def lines(self) -> Iterator[str]:
        """Tell it line by line."""
        came = "no plan" if self.analysed is None else f"a plan of {self.analysed} steps"
        yield f"means-ends analysis: {came}, {self.subgoals} subgoals"
        for goal in self.goals:
            yield from goal.lines("  ")
        if self.effort is not None:
            came = "no plan" if self.searched is None else f"a plan of {self.searched} steps"
            yield f"search: {came}, {self.effort.evaluations} situations judged"
            for each in self.progress:
                yield f"  after {each.steps} steps about {each.estimate} more seem to be needed"
        if self.steps is not None:
            known = "; no plan is shorter" if self.shortest else ""
            yield f"the plan that was taken has {self.steps} steps{known}"

    def as_dict(self) -> dict[str, object]:
        """Give it as JSON has it."""
        return {
            "means_ends": {
                "plan": self.analysed,
                "subgoals": self.subgoals,
                "goals": [goal.as_dict() for goal in self.goals],
            },
            "search": None
            if self.effort is None
            else {
                "plan": self.searched,
                "evaluations": self.effort.evaluations,
                "expansions": self.effort.expansions,
                "progress": [
                    {"steps": each.steps, "estimate": each.estimate} for each in self.progress
                ],
            },
            "steps": self.steps,
            "shortest": self.shortest,
        }
