"""How far a goal is, counted by a plan for the problem in which nothing is ever made false."""

from __future__ import annotations

from bisect import bisect_left
from heapq import heappop, heappush

from icarus_lite.planning.ground_task import GroundTask, State
from icarus_lite.records import dataclass

_UNMET = 1 << 24
"""What an unmet condition weighs in the number kept for each operator, above any cost."""
FAR = 1 << 30
"""The cost of an atom that nothing reaches."""


@dataclass(frozen=True, slots=True)
class Estimate:
    """What a relaxed plan tells of a state.

    Args:
        steps: How many operators it has.
        preferred: Those of them that can start in the state, lowest number first.
        applicable: All operators that can start in the state, lowest number first.
    """

    steps: int
    preferred: list[int]
    applicable: list[int]


class Relaxation:
    """The problem without deletions, in which a plan is found without search.

    Each atom costs what the cheapest operator that adds it costs, and an operator one more than
    all its conditions together (h_add); the plan takes, backwards from the goal, the cheapest
    operator for each atom that is needed, once (h_FF). Rules cost nothing.

    For each operator one number is kept: its cost so far, plus `_UNMET` for each condition that
    is not met. What the state itself meets is kept from call to call and only corrected where
    the next state differs, so the operators that can start come for nothing.

    Source: Bonet and Geffner, Planning as heuristic search, 2001; Hoffmann and Nebel, The FF
    planning system, 2001; Keyder and Geffner, Heuristics for planning with action costs
    revisited, 2008.
    """

    __slots__ = (
        "_adds",
        "_applicable",
        "_cap",
        "_conditions",
        "_cost",
        "_operators",
        "_pending",
        "_readers",
        "_state",
        "_supporter",
    )

    def __init__(self, task: GroundTask) -> None:
        self._operators = len(task.operators)
        self._conditions = [op.conditions for op in task.operators]
        self._conditions += [rule.conditions for rule in task.rules]
        self._adds = [bits(op.possible) for op in task.operators]
        self._adds += [[rule.atom] for rule in task.rules]
        self._readers: list[list[int]] = [[] for _ in task.atoms]
        for number, conditions in enumerate(self._conditions):
            for atom in conditions:
                self._readers[atom].append(number)
        self._cap = _UNMET // (2 + max(map(len, self._conditions), default=0))
        self._state: State = 0
        self._cost = [FAR] * len(task.atoms)
        self._pending = [
            len(conditions) * _UNMET + (number < self._operators)
            for number, conditions in enumerate(self._conditions)
        ]
        self._applicable = {n for n, waiting in enumerate(self._pending) if waiting < _UNMET}
        self._supporter = [0] * len(task.atoms)

    def estimate(self, state: State, goal: tuple[int, ...]) -> Estimate | None:
        """Count the steps of a relaxed plan; None if not even that exists.

        The goal then cannot be reached from this state, whatever is done.
        """
        start = self._move(state)
        cost = self._propagate(start, goal)
        if any(cost[atom] == FAR for atom in goal):
            return None
        plan = self._plan(cost, goal)
        pending, operators = self._pending, self._operators
        steps = sorted(number for number in plan if number < operators)
        preferred = [number for number in steps if pending[number] < _UNMET]
        return Estimate(len(steps), preferred, start[: bisect_left(start, operators)])

    def costs(self, state: State) -> list[int]:
        """Give what each atom costs from a state (h_add); `FAR` for what nothing reaches."""
        return self._propagate(self._move(state), tuple(range(len(self._cost))))

    def means(self) -> list[list[int]]:
        """Give, for each atom, the operators and then the rules that may make it true.

        Rules are numbered after the operators.
        """
        means: list[list[int]] = [[] for _ in self._cost]
        for number, atoms in enumerate(self._adds):
            for atom in atoms:
                means[atom].append(number)
        return means

    def unreachable(self, state: State, goal: tuple[int, ...]) -> tuple[int, ...]:
        """Give the goal atoms that no sequence of operators makes true from this state."""
        cost = self._propagate(self._move(state), goal)
        return tuple(atom for atom in goal if cost[atom] == FAR)

    def _move(self, state: State) -> list[int]:
        """Take a state for the present one; give what can start in it, rules last."""
        pending, cost, applicable = self._pending, self._cost, self._applicable
        changed = self._state ^ state
        self._state = state
        for atom in bits(changed & ~state):
            cost[atom] = FAR
            for number in self._readers[atom]:
                if pending[number] < _UNMET:
                    applicable.discard(number)
                pending[number] += _UNMET
        for atom in bits(changed & state):
            cost[atom] = 0
            for number in self._readers[atom]:
                pending[number] -= _UNMET
                if pending[number] < _UNMET:
                    applicable.add(number)
        return sorted(applicable)

    def _propagate(  # noqa: C901, PLR0912 - one loop, in which a call would cost as much as its work
        self, start: list[int], goal: tuple[int, ...]
    ) -> list[int]:
        """Give what each atom costs, cheapest first, up to the last one of the goal."""
        adds, readers, supporter, cap = self._adds, self._readers, self._supporter, self._cap
        cost, waiting = self._cost[:], self._pending[:]
        missing = {atom for atom in goal if cost[atom]}
        if not missing:
            return cost
        found: dict[int, list[int]] = {}
        for number in start:
            total = waiting[number]
            for atom in adds[number]:
                if total < cost[atom]:
                    cost[atom] = total
                    supporter[atom] = number
                    if total in found:
                        found[total].append(atom)
                    else:
                        found[total] = [atom]
        costs = sorted(found)
        while costs:
            present = heappop(costs)
            change = present - _UNMET
            for atom in found[present]:  # rules may add to it meanwhile
                if cost[atom] != present:
                    continue
                if atom in missing:
                    missing.discard(atom)
                    if not missing:
                        return cost
                for number in readers[atom]:
                    waiting[number] = total = waiting[number] + change
                    if total < _UNMET:
                        if total > cap:  # noqa: PLR1730 - `min` takes as long as all the rest
                            total = cap
                        for added in adds[number]:
                            if total < cost[added]:
                                cost[added] = total
                                supporter[added] = number
                                if total in found:
                                    found[total].append(added)
                                else:
                                    found[total] = [added]
                                    heappush(costs, total)
        return cost

    def _plan(self, cost: list[int], goal: tuple[int, ...]) -> set[int]:
        """Collect the cheapest operators, and rules, for the goal and for each other."""
        conditions, supporter = self._conditions, self._supporter
        plan: set[int] = set()
        needed = [atom for atom in goal if cost[atom]]
        while needed:
            number = supporter[needed.pop()]
            if number not in plan:
                plan.add(number)
                needed += [atom for atom in conditions[number] if cost[atom]]
        return plan


def bits(mask: int) -> list[int]:
    """Give the numbers of the bits that are set, lowest first."""
    numbers = []
    while mask:
        lowest = mask & -mask
        numbers.append(lowest.bit_length() - 1)
        mask ^= lowest
    return numbers
