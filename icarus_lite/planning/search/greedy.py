"""Any plan, soon: lazy greedy best-first search that tries preferred operators first."""

from __future__ import annotations

from icarus_lite.planning.ground_task import GroundTask, State
from icarus_lite.planning.search.relaxed_plan import Relaxation
from icarus_lite.planning.search.result import Effort, Limits, Progress, SearchResult
from icarus_lite.planning.search.waiting import Waiting, way

BOOST = 1_000
"""How many turns the preferred operators get in advance when they led nearer to the goal."""


def greedy(task: GroundTask, relaxation: Relaxation, limits: Limits) -> SearchResult:
    """Find a plan, or see all there is, or reach a limit.

    A state is judged when it is taken up, not when it is put in line. What waits is in the order
    of its parent's estimate, then parents with an atom never seen at that estimate first, then
    the oldest first. Nothing is left out for good, so a search that ends by itself without a plan
    has shown that there is none. The same task, and the same limit of evaluations, give the same
    plan.

    Args:
        task: The problem.
        relaxation: Of the same problem.
        limits: When to give up.

    Source: Richter and Helmert, Preferred operators and deferred evaluation in satisficing
        planning, 2009; Lipovetzky and Geffner, Best-first width search, 2017 (novelty).
    """
    wanted = sum(1 << atom for atom in set(task.goal))
    most, until = limits.most, limits.until()
    states: list[State] = [task.initial]
    origins: list[tuple[int, int]] = [(-1, -1)]
    seen = {task.initial}
    met: dict[int, State] = {}
    every, preferred = Waiting(), Waiting()
    progress: list[Progress] = []
    evaluations = expansions = node = 0
    state = task.initial

    def ended(plan: tuple[int, ...] | None, *, exhausted: bool = False) -> SearchResult:
        effort = Effort(evaluations, expansions)
        return SearchResult(plan, exhausted, effort, progress=tuple(progress))

    while state & wanted != wanted:
        if evaluations >= most or limits.clock() > until:
            return ended(None)
        estimate = relaxation.estimate(state, task.goal)
        evaluations += 1
        if estimate is not None:
            expansions += 1
            if not progress or estimate.steps < progress[-1].estimate:
                preferred.turns -= BOOST
                depth = len(way(origins, node))
                progress.append(Progress(depth, estimate.steps, evaluations))
            familiar = met.get(estimate.steps, 0)
            met[estimate.steps] = familiar | state
            rank = 2 * estimate.steps + (familiar | state == familiar)
            every.push(rank, node, estimate.applicable)
            preferred.push(rank, node, estimate.preferred)
        while state in seen:
            if not every:
                return ended(None, exhausted=True)
            line = preferred if preferred and preferred.turns <= every.turns else every
            parent, step = line.pop()
            state = task.after(states[parent], task.operators[step])
        node = len(states)
        states.append(state)
        origins.append((parent, step))
        seen.add(state)
    return ended(way(origins, node))
