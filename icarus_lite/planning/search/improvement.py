"""A shorter plan from a plan: stretches of it are planned anew, and its order is varied."""

from __future__ import annotations

import math
import random

from icarus_lite.planning.ground_task import GroundTask, State
from icarus_lite.planning.search.elimination import without_needless_steps
from icarus_lite.planning.search.ordering import reordered
from icarus_lite.planning.search.relaxed_plan import Relaxation
from icarus_lite.planning.search.result import Limits
from icarus_lite.planning.search.window import shorter_way

FIRST_BUDGET = 10
"""States judged for a stretch in the first round; twice as many after a round without gain."""
WHOLE = 10
"""How many times as many states are judged for the whole plan as for a stretch of it."""
SHORTEST = 4
"""Steps of the shortest stretch that is planned anew; the next is half as long again."""
ORDERS = 5
"""Orders of the steps that are tried once no stretch is left unfinished for lack of budget."""


def improve(task: GroundTask, plan: tuple[int, ...], limits: Limits) -> tuple[int, ...]:
    """Make a plan shorter, as far as the limits allow.

    A stretch of the plan need not lead to the state it leads to now, only to what the rest of the
    plan and the goal ask for. The same task, plan and limit of evaluations give the same result.

    Args:
        task: The problem.
        plan: Numbers of operators that lead to its goal.
        limits: When to end. It also ends where all stretches, the whole plan among them, have
            been looked through as far as the estimates let them; that comes soon only in small
            problems.

    Returns:
        A plan that is no longer than the given one.

    Source: Siddiqui and Haslum, Continuing plan quality optimisation, 2015 (windows and block
        deordering), in a simple form.
    """
    return _Improvement(task, without_needless_steps(task, plan), limits).run()


class _Improvement:
    """A plan, and what is known of the stretches that were planned anew in vain."""

    def __init__(self, task: GroundTask, plan: tuple[int, ...], limits: Limits) -> None:
        self.task = task
        self.relaxation = Relaxation(task)
        self.most, self.until, self.clock = limits.most, limits.until(), limits.clock
        self.judged = 0
        self.tried: dict[tuple[State, State, int], float] = {}
        self.unfinished = False
        self.conditions = [sum(1 << atom for atom in set(op.conditions)) for op in task.operators]
        self.goal = sum(1 << atom for atom in set(task.goal))
        self.plan: tuple[int, ...] = ()
        self.states: list[State] = []
        self.needs: list[State] = []
        states = self.follow(plan)
        assert states is not None, "only a plan that works is made shorter"
        self.take(plan, states)

    def run(self) -> tuple[int, ...]:
        """Plan stretches of all lengths anew, in ever other orders, until a limit is reached."""
        chance = random.Random(len(self.plan))  # noqa: S311 - the same every time, on purpose
        budget, settled = FIRST_BUDGET, 0
        while self.plan and not self.over() and settled < ORDERS:
            length, judged = len(self.plan), self.judged
            self.unfinished = False
            size = SHORTEST
            while not self.over():
                if size >= len(self.plan):
                    self.sweep(len(self.plan), WHOLE * budget)
                    break
                self.sweep(size, budget)
                size += size // 2
            if len(self.plan) < length:
                settled = 0
            elif not self.unfinished:
                settled += 1
            elif self.judged == judged and budget >= self.most - self.judged:
                break  # every stretch was tried with all that is left
            else:
                budget *= 2
            self.consider(reordered(self.task, self.plan, chance))
        return self.plan

    def over(self) -> bool:
        """Tell whether a limit is reached."""
        return self.judged >= self.most or self.late()

    def late(self) -> bool:
        """Tell whether the time is up."""
        return self.clock() > self.until

    def sweep(self, size: int, budget: int) -> None:
        """Plan each stretch of a length anew, from the first to the last."""
        first = 0
        while first + 1 < len(self.plan) and not self.over():
            last = min(first + size, len(self.plan))
            if not self.renewed(first, last, budget):
                if last == len(self.plan):
                    return
                first += max(1, size // 3)

    def renewed(self, first: int, last: int, budget: int) -> bool:
        """Put a shorter stretch in the place of one, if one is found that serves the rest."""
        start, need = self.states[first], self.needs[last]
        question = start, need, last - first
        budget = int(min(budget, self.most - self.judged))
        tried = self.tried.get(question, 0)
        if start & need != need and tried >= budget:
            self.unfinished |= tried < math.inf
            return False
        found: tuple[int, ...] | None = ()
        if start & need != need:
            found, judged = shorter_way(
                self.task, self.relaxation, start, need, last - first, budget, self.late
            )
            self.judged += judged
            self.tried[question] = math.inf if judged < budget else budget
            self.unfinished |= judged >= budget
        return found is not None and self.consider(self.plan[:first] + found + self.plan[last:])

    def consider(self, plan: tuple[int, ...]) -> bool:
        """Take a plan that works and is not longer; tell whether it is shorter."""
        states = self.follow(plan)
        if states is None or len(plan) > len(self.plan):
            return False
        shorter = len(plan) < len(self.plan)
        if shorter:
            plan = without_needless_steps(self.task, plan)
            states = self.follow(plan)
            assert states is not None
        self.take(plan, states)
        return shorter

    def follow(self, plan: tuple[int, ...]) -> list[State] | None:
        """Give the states along a plan; None if it does not work."""
        states = [self.task.initial]
        for step in plan:
            if states[-1] & self.conditions[step] != self.conditions[step]:
                return None
            states.append(self.task.after(states[-1], self.task.operators[step]))
        return states if states[-1] & self.goal == self.goal else None

    def take(self, plan: tuple[int, ...], states: list[State]) -> None:
        """Take a plan for the present one, and see what must hold after each of its steps.

        Derived atoms are taken to be needed as long as they hold; a plan for less is tried out
        before it is taken.
        """
        needs = [self.goal]
        for step, state in zip(reversed(plan), reversed(states[:-1]), strict=True):
            missing = needs[-1] & ~self.task.operators[step].add
            needs.append((missing | self.conditions[step]) & state)
        self.plan, self.states, self.needs = plan, states, needs[::-1]
