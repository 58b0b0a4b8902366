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

    Operators that start under the same conditions, such as turning from one direction to any
    other, are one *way* here: what they cost is the same until one of them is taken. Each rule is
    a way as well. For each way one number is kept: its cost so far, plus `_UNMET` for each
    condition that is not met. What the state itself meets is kept from call to call and only
    corrected where the next state differs, so the operators that can start come for nothing.

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
        "_makers",
        "_members",
        "_pending",
        "_readers",
        "_state",
        "_supporter",
        "_task",
        "_way",
    )

    def __init__(self, task: GroundTask) -> None:
        self._task = task
        alike: dict[tuple[int, ...], list[int]] = {}
        for number, operator in enumerate(task.operators):
            alike.setdefault(operator.conditions, []).append(number)
        self._members = [*alike.values()]
        self._way = [0] * len(task.operators)
        self._makers: list[dict[int, int]] = []
        for way, members in enumerate(self._members):
            makers: dict[int, int] = {}
            for number in members:
                self._way[number] = way
                for atom in bits(task.operators[number].possible):
                    makers.setdefault(atom, number)
            self._makers.append(makers)
        for number, rule in enumerate(task.rules, len(task.operators)):
            self._makers.append({rule.atom: number})
        self._adds = [[*makers] for makers in self._makers]
        self._conditions = [*alike, *(rule.conditions for rule in task.rules)]
        self._readers: list[list[int]] = [[] for _ in task.atoms]
        for way, conditions in enumerate(self._conditions):
            for atom in conditions:
                self._readers[atom].append(way)
        self._cap = _UNMET // (2 + max(map(len, self._conditions), default=0))
        self._state: State = 0
        self._cost = [FAR] * len(task.atoms)
        self._pending = [
            len(conditions) * _UNMET + (way < len(alike))
            for way, conditions in enumerate(self._conditions)
        ]
        self._applicable = {way for way, waiting in enumerate(self._pending) if waiting < _UNMET}
        self._supporter = [0] * len(task.atoms)

    def estimate(self, state: State, goal: tuple[int, ...]) -> Estimate | None:
        """Count the steps of a relaxed plan; None if not even that exists.

        The goal then cannot be reached from this state, whatever is done.
        """
        start = self._move(state)
        cost = self._propagate(start, goal)
        if any(cost[atom] == FAR for atom in goal):
            return None
        steps = self._plan(cost, goal)
        pending, way, members = self._pending, self._way, self._members
        preferred = [number for number in steps if pending[way[number]] < _UNMET]
        applicable = []
        for each in start[: bisect_left(start, len(members))]:
            applicable += members[each]
        applicable.sort()
        return Estimate(len(steps), preferred, applicable)

    def costs(self, state: State) -> list[int]:
        """Give what each atom costs from a state (h_add); `FAR` for what nothing reaches."""
        return self._propagate(self._move(state), tuple(range(len(self._cost))))

    def means(self) -> list[list[int]]:
        """Give, for each atom, the operators and then the rules that may make it true.

        Rules are numbered after the operators.
        """
        means: list[list[int]] = [[] for _ in self._cost]
        for number, operator in enumerate(self._task.operators):
            for atom in bits(operator.possible):
                means[atom].append(number)
        for number, rule in enumerate(self._task.rules, len(self._task.operators)):
            means[rule.atom].append(number)
        return means

    def unreachable(self, state: State, goal: tuple[int, ...]) -> tuple[int, ...]:
        """Give the goal atoms that no sequence of operators makes true from this state."""
        cost = self._propagate(self._move(state), goal)
        return tuple(atom for atom in goal if cost[atom] == FAR)

    def _move(self, state: State) -> list[int]:
        """Take a state for the present one; give the ways that can start in it, rules last."""
        pending, cost, applicable = self._pending, self._cost, self._applicable
        changed = self._state ^ state
        self._state = state
        for atom in bits(changed & ~state):
            cost[atom] = FAR
            for way in self._readers[atom]:
                if pending[way] < _UNMET:
                    applicable.discard(way)
                pending[way] += _UNMET
        for atom in bits(changed & state):
            cost[atom] = 0
            for way in self._readers[atom]:
                pending[way] -= _UNMET
                if pending[way] < _UNMET:
                    applicable.add(way)
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
        for way in start:
            total = waiting[way]
            for atom in adds[way]:
                if total < cost[atom]:
                    cost[atom] = total
                    supporter[atom] = way
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
                for way in readers[atom]:
                    waiting[way] = total = waiting[way] + change
                    if total < _UNMET:
                        if total > cap:  # noqa: PLR1730 - `min` takes as long as all the rest
                            total = cap
                        for added in adds[way]:
                            if total < cost[added]:
                                cost[added] = total
                                supporter[added] = way
                                if total in found:
                                    found[total].append(added)
                                else:
                                    found[total] = [added]
                                    heappush(costs, total)
        return cost

    def _plan(self, cost: list[int], goal: tuple[int, ...]) -> list[int]:
        """Collect the cheapest operators for the goal and for each other, lowest number first."""
        conditions, supporter, makers = self._conditions, self._supporter, self._makers
        plan: set[int] = set()
        needed = [atom for atom in goal if cost[atom]]
        while needed:
            atom = needed.pop()
            way = supporter[atom]
            number = makers[way][atom]
            if number not in plan:
                plan.add(number)
                needed += [atom for atom in conditions[way] if cost[atom]]
        operators = len(self._way)
        return sorted([number for number in plan if number < operators])


def bits(mask: int) -> list[int]:
    """Give the numbers of the bits that are set, lowest first."""
    numbers = []
    while mask:
        lowest = mask & -mask
        numbers.append(lowest.bit_length() - 1)
        mask ^= lowest
    return numbers
