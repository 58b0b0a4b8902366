"""Operators on bits, each of which knows the plan step that it stands for."""

from __future__ import annotations

from collections.abc import Callable

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
        _set(self, "_instance", instance)
        _set(self, "conditions", conditions)
        _set(self, "add", add)
        _set(self, "keep", keep)
        _set(self, "possible", possible)
        _set(self, "exception", exception)

    @property
    def step(self) -> PlanStep:
        """The instance, as the plan will have it."""
        instance: Instance = self._instance  # type: ignore[attr-defined] # a slot
        clause = instance.clause
        step = plan_step(clause.skill, dict(zip(clause.variables, instance.row, strict=True)))
        assert step is not None, "clauses with free arguments are not ground"
        return step


_set = object.__setattr__
