"""A planning problem without variables: what grounding gives and search works on.

A state is one whole number, a bit for each ground atom: testing, adding and deleting atoms are
single operations on it, and two states are the same when the numbers are. An atom that some
condition wants false has a second bit, its complement, so that all conditions ask for set bits.
"""

from __future__ import annotations

from collections.abc import Callable

from icarus_lite.planning.steps import PlanStep
from icarus_lite.records import dataclass
from icarus_lite.symbols import Belief

State = int
"""The atoms that hold, a bit each; derived atoms and complements included."""


@dataclass(frozen=True, slots=True)
class GroundAtom:
    """What a bit of the state stands for.

    Args:
        belief: The belief.
        negated: Whether the bit is set when the belief is *not* held.
        derived: Whether rules decide on it, rather than operators.
    """

    belief: Belief
    negated: bool = False
    derived: bool = False

    def __str__(self) -> str:
        return f"(not {self.belief})" if self.negated else str(self.belief)


@dataclass(frozen=True, slots=True)
class GroundOperator:
    """A skill instance.

    Args:
        step: The instance, as the plan will have it.
        conditions: Numbers of the atoms that must hold before it.
        add: Mask of the atoms it makes true.
        keep: Mask of all atoms but those it makes false; what it both deletes and adds is true.
        possible: Mask of the atoms that it may make true in some state, `add` included. It is
            larger than `add` only where `exception` is given.
        exception: Gives the state after the operator from the states before it and after
            `keep` and `add`, for effects that depend on the state, such as an attachment that is
            refused because it would be a circle. None for nearly all operators.
    """

    step: PlanStep
    conditions: tuple[int, ...]
    add: int
    keep: int
    possible: int
    exception: Callable[[State, State], State] | None = None


@dataclass(frozen=True, slots=True)
class GroundRule:
    """A way in which a derived atom, or its complement, can become true.

    The rules are what the heuristic counts with, not what states are computed by: for complements
    they may promise too much, never too little.

    Args:
        atom: Number of the atom.
        conditions: Numbers of the atoms that make it true when they all hold.
    """

    atom: int
    conditions: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class GroundTask:
    """A planning problem.

    Args:
        atoms: What each bit stands for.
        initial: The present state, derived atoms included.
        goal: Numbers of the atoms that must hold in the end.
        operators: The skill instances, in the order of the domain and, within a clause, of their
            bindings: the same beliefs give the same order.
        rules: How derived atoms come about, for the heuristic.
        closure: Gives a state with its derived atoms from one in which they are out of date;
            None where there are none.
    """

    atoms: tuple[GroundAtom, ...]
    initial: State
    goal: tuple[int, ...]
    operators: tuple[GroundOperator, ...]
    rules: tuple[GroundRule, ...] = ()
    closure: Callable[[State], State] | None = None

    def after(self, state: State, operator: GroundOperator) -> State:
        """Give the state that an operator leads to; its conditions are taken to hold."""
        changed = state & operator.keep | operator.add
        if operator.exception is not None:
            return operator.exception(state, changed)
        return changed if self.closure is None else self.closure(changed)

    def reached(self, state: State) -> bool:
        """Tell whether the goal holds in a state."""
        return all(state >> atom & 1 for atom in self.goal)
