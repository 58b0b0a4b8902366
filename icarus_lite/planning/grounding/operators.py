"""Operators on bits, each of which knows the plan step that it stands for."""

from __future__ import annotations

from collections.abc import Callable
from types import MemberDescriptorType

from icarus_lite.planning.ground_task import GroundOperator, State
from icarus_lite.planning.grounding.instances import Instance
from icarus_lite.planning.steps import PlanStep, plan_step


class InstanceOperator(GroundOperator):
    """An operator whose plan step is made when somebody asks for it: of most nobody does.

    Args:
        instance: The skill instance.
        conditions: Numbers of the atoms that must hold before it.
        add: Mask of the atoms it makes true.
        keep: Mask of all atoms but those it makes false.
        possible: Mask of the atoms that it may make true in some state.
        exception: Effects that depend on the state, if any.
    """

    __slots__ = ("_instance",)

    def __init__(
        self,
        instance: Instance,
        conditions: tuple[int, ...],
        add: State,
        keep: State,
        possible: State,
        exception: Callable[[State, State], State] | None,
    ) -> None:
        _set_instance(self, instance)
        _set_conditions(self, conditions)
        _set_add(self, add)
        _set_keep(self, keep)
        _set_possible(self, possible)
        _set_exception(self, exception)

    @property
    def step(self) -> PlanStep:
        """The instance, as the plan will have it."""
        instance: Instance = self._instance  # type: ignore[attr-defined] # a slot
        clause = instance.clause
        step = plan_step(clause.skill, dict(zip(clause.variables, instance.row, strict=True)))
        assert step is not None, "clauses with free arguments are not ground"
        return step


def _setter(kind: type, name: str) -> Callable[[object, object], None]:
    """Give what sets an attribute around `__setattr__`, which refuses."""
    descriptor: MemberDescriptorType = kind.__dict__[name]
    return descriptor.__set__


_set_instance = _setter(InstanceOperator, "_instance")
_set_conditions = _setter(GroundOperator, "conditions")
_set_add = _setter(GroundOperator, "add")
_set_keep = _setter(GroundOperator, "keep")
_set_possible = _setter(GroundOperator, "possible")
_set_exception = _setter(GroundOperator, "exception")
