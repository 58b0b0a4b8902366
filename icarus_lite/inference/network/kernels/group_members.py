"""The members of a group of pair rules, what bounds their partners, and how all of it is named."""

from __future__ import annotations

import re
from collections.abc import Sequence

from icarus_lite.inference.network.kernels.columns import PLAIN
from icarus_lite.inference.network.kernels.exact import PairSide
from icarus_lite.inference.network.kernels.kernel import PairKernel
from icarus_lite.inference.network.kernels.order import OrderPlan
from icarus_lite.inference.network.kernels.ranges import is_guarded
from icarus_lite.inference.network.kernels.side import SidePlan
from icarus_lite.inference.network.kernels.tester import AxisPlan, MatrixPlan
from icarus_lite.language.syntax import Expression, Variable
from icarus_lite.records import dataclass


@dataclass(frozen=True, slots=True)
class Member:
    """A pair rule of a group.

    Args:
        name: Its identifier.
        kernel: The compiled rule.
        left: The type of its left objects.
        right: The type of its right objects.
    """

    name: str
    kernel: PairKernel
    left: str
    right: str

    @property
    def mirrored(self) -> bool:
        """Whether one half of its matrix says it all."""
        return self.kernel.symmetric and self.left == self.right and self.order is None

    @property
    def order(self) -> OrderPlan | None:
        """Its plan, if it is an order of keys."""
        plan = self.kernel.plan
        return plan if isinstance(plan, OrderPlan) else None

    @property
    def matrix(self) -> MatrixPlan | None:
        """Its plan, if it is kept as a matrix."""
        plan = self.kernel.plan
        return plan if isinstance(plan, MatrixPlan) else None

    def sides(self) -> tuple[tuple[str, PairSide, SidePlan, str], ...]:
        """Give word, pattern, plan and type of its left and of its right side."""
        (left, right), plan = self.kernel.sides, self.kernel.plan
        return ("left", left, plan.left, self.left), ("right", right, plan.right, self.right)


@dataclass(frozen=True, slots=True)
class Bound:
    """An attribute along which rules bound how far partners are from a mover.

    Args:
        attribute: The attribute.
        axes: Where each of the rules says so: its number in the group, and the axis.
    """

    attribute: str
    axes: tuple[tuple[int, AxisPlan], ...]


def is_groupable(kernel: PairKernel) -> bool:
    """Tell whether a rule may be followed together with others: nothing about it is unusual."""
    plan = kernel.plan
    strict = min(plan.left.limit, plan.right.limit) < PLAIN
    unsure = not plan.distinct_first and any(is_guarded(test, PLAIN) for test in kernel.paired)
    return not (strict or unsure or any(kernel.gates))


def box_of(type_: str, members: Sequence[Member]) -> tuple[tuple[Bound, ...], frozenset[int]]:
    """Choose the attributes that bound where partners are, and the rules that they bound."""
    axes: dict[str, dict[int, AxisPlan]] = {}
    for number, member in enumerate(members):
        plan = member.matrix
        if plan is None or not member.left == member.right == type_:
            continue
        left, right = (dict(side.attributes) for side in member.kernel.sides)
        for axis in plan.axes:
            one, other = plan.left.inputs.terms[axis.left], plan.right.inputs.terms[axis.right]
            if isinstance(one, Variable) and isinstance(other, Variable):
                attribute = left[one.name]
                if attribute == right[other.name]:
                    axes.setdefault(attribute, {}).setdefault(number, axis)
    if not axes:
        return (), frozenset()
    first = max(axes, key=lambda attribute: len(axes[attribute]))
    boxed = frozenset(axes[first])
    chosen = [first, *(a for a in axes if a != first and boxed <= axes[a].keys())][:2]
    found = tuple(Bound(a, tuple((n, axes[a][n]) for n in sorted(boxed))) for a in chosen)
    return found, boxed


class GroupNames:
    """The identifiers of a group: of the lists (or arrays) that its generated code reads.

    Args:
        members: The rules of the group.

    Attributes:
        members: The same.
        columns: For each attribute, by type and name, its identifier.
        inputs: For each derived input, by member, side and place among its own, its identifier.
    """

    def __init__(self, members: Sequence[Member]) -> None:
        self.members = members
        self.columns: dict[tuple[str, str], str] = {}
        self.inputs: dict[tuple[int, str, int], str] = {}

    def column(self, type_: str, attribute: str) -> str:
        """Name the list or array of an attribute."""
        place = type_, attribute
        if place not in self.columns:
            self.columns[place] = self._fresh(f"{type_}_{attribute}")
        return self.columns[place]

    def derived(self, number: int, word: str, place: int) -> str:
        """Name the list or array of a derived input."""
        if self.members[number].mirrored:
            word = "left"
        key = number, word, place
        if key not in self.inputs:
            self.inputs[key] = self._fresh(f"{self.members[number].name}_{word}_{place + 1}")
        return self.inputs[key]

    def _fresh(self, word: str) -> str:
        name = "of_" + re.sub(r"\W", "_", word, flags=re.ASCII)
        taken = {*self.columns.values(), *self.inputs.values()}
        while name in taken:
            name += "_"
        return name

    def terms(self, number: int, word: str) -> list[tuple[Expression, str]]:
        """Give the inputs of a side, each with the name of its list or array."""
        _, side, plan, type_ = self.members[number].sides()[word == "right"]
        attribute_of = dict(side.attributes)
        found: list[tuple[Expression, str]] = []
        derived = 0
        for term in plan.inputs.terms:
            if isinstance(term, Variable):
                found.append((term, self.column(type_, attribute_of[term.name])))
            else:
                found.append((term, self.derived(number, word, derived)))
                derived += 1
        return found
