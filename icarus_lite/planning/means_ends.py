"""Means-ends analysis: from a goal back to the skills that bring it about, and to what they need.

A goal that is not met is worked on by *skill chaining*: a skill with that effect is chosen, and
those of its conditions that do not hold become subgoals, which come first. A goal that a concept
defines is worked on by *concept chaining*: the elements of its definition become subgoals. A
literal that neither can ever make true is unchainable, and whatever needs it is not tried.

When a goal undoes another one beside it, the other is put off until after it; one that cannot be
reached after the others is tried before them. If no order does, what was undone is achieved once
more. What that costs too much is left out of the finished plan.

Source: Newell and Simon 1961 (GPS); Langley and Choi 2006 (impasses in ICARUS); the order of
goals after interference as in Sussman 1975.
"""

from __future__ import annotations

from collections.abc import Sequence

from icarus_lite.planning.ground_task import GroundTask, State
from icarus_lite.planning.search.relaxed_plan import FAR, Relaxation
from icarus_lite.planning.subgoals import Ending, Subgoal, Way
from icarus_lite.records import dataclass

MAX_DEPTH = 60
"""Subgoals below one another."""

MAX_SUBGOALS = 250
"""Subgoals taken up, over all."""

MAX_WAYS = 8
"""Ways tried to one subgoal, the nearest first."""


@dataclass(frozen=True, slots=True)
class Analysis:
    """What means-ends analysis has come to.

    Args:
        plan: Numbers of the operators that lead to the goal, in order; None if it found none.
        goals: The goals and, below them, what was wanted for each.
        subgoals: How many subgoals were taken up.
    """

    plan: tuple[int, ...] | None
    goals: tuple[Subgoal, ...]
    subgoals: int


@dataclass(frozen=True, slots=True)
class _Reached:
    """A state in which what was wanted holds, and the operators that led there."""

    state: State
    steps: tuple[int, ...]


def means_ends(
    task: GroundTask, relaxation: Relaxation | None = None, most: int = MAX_SUBGOALS
) -> Analysis:
    """Work on a problem from its goals backwards.

    The same problem gives the same plan. That none is found does not mean that there is none.

    Args:
        task: The problem.
        relaxation: Of the same problem, where somebody has made it already.
        most: Subgoals to be taken up at most.
    """
    solver = _Solver(task, relaxation or Relaxation(task), most)
    reached, tree = solver.achieve(task.goal, task.initial, ())
    return Analysis(None if reached is None else reached.steps, tree, solver.taken_up)


class _Solver:
    """Works on one problem.

    Args:
        task: The problem.
        relaxation: Says what is near and what is out of reach.
        most: Subgoals to be taken up at most.
    """

    def __init__(self, task: GroundTask, relaxation: Relaxation, most: int) -> None:
        self._task = task
        self._most = most
        self._relaxation = relaxation
        self._means = relaxation.means()
        self._costs: dict[State, list[int]] = {}
        self.taken_up = 0

    def achieve(
        self, wanted: Sequence[int], state: State, above: tuple[int, ...]
    ) -> tuple[_Reached | None, tuple[Subgoal, ...]]:
        """Make all of some atoms true together.

        Args:
            wanted: The atoms, in the order in which they are stated.
            state: The state to begin in.
            above: What they are wanted for, the nearest last.
        """
        order, put_off, hurried = list(wanted), 0, set[int]()
        reached, tree = [_Reached(state, ())], list[Subgoal]()
        while len(tree) < len(order):
            atom = order[len(tree)]
            present, subgoal = self._reach(atom, reached[-1], above)
            if present is None:
                if not tree or atom in hurried or subgoal.ending is Ending.LIMIT:
                    return None, (*tree, subgoal)
                hurried.add(atom)  # those before it may have barred the way
                order.insert(0, order.pop(len(tree)))
                del reached[1:], tree[:]
                continue
            lost = next((i for i in range(len(tree)) if not present.state >> order[i] & 1), None)
            if lost is not None and put_off < len(order):
                order.insert(len(tree), order.pop(lost))
                put_off += 1
                del reached[lost + 1 :], tree[lost:]
                continue
            reached.append(present)
            tree.append(subgoal)
        return self._once_more(order, reached[-1], above, tree)

    def _once_more(
        self, wanted: Sequence[int], present: _Reached, above: tuple[int, ...], tree: list[Subgoal]
    ) -> tuple[_Reached | None, tuple[Subgoal, ...]]:
        """Achieve again what was undone meanwhile, until everything holds together."""
        for _ in range(len(wanted) + 1):
            lost = [atom for atom in wanted if not present.state >> atom & 1]
            if not lost:
                return present, tuple(tree)
            for atom in lost:
                found, subgoal = self._reach(atom, present, above)
                tree.append(subgoal)
                if found is None:
                    return None, tuple(tree)
                present = found
        return None, tuple(tree)

    def _reach(
        self, atom: int, present: _Reached, above: tuple[int, ...]
    ) -> tuple[_Reached | None, Subgoal]:
        """Make one atom true."""
        literal = str(self._task.atoms[atom])
        if present.state >> atom & 1:
            return present, Subgoal(literal, Ending.HELD)
        if atom in above:
            return None, Subgoal(literal, Ending.CIRCULAR)
        if not self._means[atom]:
            return None, Subgoal(literal, Ending.UNCHAINABLE)
        tried: list[Way] = []
        if self.taken_up < self._most and len(above) < MAX_DEPTH:
            self.taken_up += 1
            for number in self._nearest(self._means[atom], present.state):
                found, way = self._by(number, atom, present.state, above)
                if found is not None:
                    whole = _Reached(found.state, present.steps + found.steps)
                    return whole, Subgoal(literal, Ending.ACHIEVED, (way,))
                tried.append(way)
        tired = self.taken_up >= self._most or len(above) >= MAX_DEPTH
        return None, Subgoal(literal, Ending.LIMIT if tired else Ending.FAILED, tuple(tried))

    def _by(
        self, number: int, atom: int, state: State, above: tuple[int, ...]
    ) -> tuple[_Reached | None, Way]:
        """Try one operator, or one rule, for an atom."""
        operators = self._task.operators
        is_skill, conditions = number < len(operators), self._conditions(number)
        if is_skill:
            means = str(operators[number].step.action)
        else:
            means = " ".join(str(self._task.atoms[each]) for each in conditions)
        reached, tree = self.achieve(conditions, state, (*above, atom))
        if reached is not None and is_skill:
            after = self._task.after(reached.state, operators[number])
            reached = _Reached(after, (*reached.steps, number))
        leads = reached is not None and bool(reached.state >> atom & 1)
        return reached if leads else None, Way(means, is_skill, tree, leads)

    def _nearest(self, means: Sequence[int], state: State) -> list[int]:
        """Give the ways to an atom that may lead there, those first that take least."""
        costs = self._costs.get(state)
        if costs is None:
            costs = self._costs[state] = self._relaxation.costs(state)
        known = costs
        ways = []
        for number in means:
            conditions = self._conditions(number)
            takes = [known[each] for each in conditions]
            if FAR not in takes:
                ways.append((sum(takes), len(conditions), number))
        return [number for *_, number in sorted(ways)[:MAX_WAYS]]

    def _conditions(self, number: int) -> tuple[int, ...]:
        """Give what an operator, or after the operators a rule, needs."""
        operators = self._task.operators
        if number < len(operators):
            return operators[number].conditions
        return self._task.rules[number - len(operators)].conditions
