"""The URScript functions about force: force mode, contact, and what the tool feels."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from runtime.controller import script_values
from runtime.controller.force_control import ForceMode
from runtime.controller.script_values import ScriptValue, finite
from runtime.controller.tokens import ScriptError

if TYPE_CHECKING:
    from runtime.controller.control_box import ControlBox

_ANYWHERE: Final = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
_CONTACT_N: Final = 5.0  # what `tool_contact` takes for a contact


def force_functions(box: ControlBox) -> Mapping[str, Callable[..., Any]]:
    """Give the functions about force, by name."""
    force = _Force(box)
    return {
        "force_mode": force.force_mode,
        "end_force_mode": force.end_force_mode,
        "force_mode_set_damping": force.force_mode_set_damping,
        "force_mode_set_gain_scaling": force.force_mode_set_gain_scaling,
        "zero_ftsensor": box.arm.zero_wrench,
        "get_tcp_force": lambda: list(box.arm.wrench),
        "get_joint_torques": force.get_joint_torques,
        "tool_contact": force.tool_contact,
    }


class _Force:
    """What is done with force, and asked about it."""

    def __init__(self, box: ControlBox) -> None:
        self._arm = box.arm
        self._asked: tuple[ScriptValue, ...] = ()

    def force_mode(
        self,
        task_frame: ScriptValue,
        selection_vector: ScriptValue,
        wrench: ScriptValue,
        type: ScriptValue,  # noqa: A002 - the name URScript gives it
        limits: ScriptValue,
    ) -> None:
        asked = (task_frame, selection_vector, wrench, type, limits)
        if self._arm.force_mode is not None and asked == self._asked:
            return  # programs ask for the same thing in every cycle
        if type not in (1, 2, 3):
            raise ScriptError(f"force_mode() has types 1, 2 and 3, not {type!r}")
        selected = script_values.joints(selection_vector, "the selection vector")
        # Damping and gain hold from the beginning of force mode to its end.
        under_way = self._arm.force_mode
        self._arm.force_mode = ForceMode(
            script_values.pose(task_frame, "the task frame"),
            tuple(axis != 0 for axis in selected),
            script_values.pose(wrench, "the wrench"),
            script_values.pose(limits, "the limits"),
            int(type),
            self._arm.force_damping if under_way is None else under_way.damping,
            self._arm.force_gain if under_way is None else under_way.gain,
        )
        self._asked = tuple(script_values.copy(value) for value in asked)

    def end_force_mode(self) -> None:
        self._arm.force_mode = None

    def force_mode_set_damping(self, damping: ScriptValue) -> None:
        self._arm.force_damping = _between(damping, 0, 1, "damping")

    def force_mode_set_gain_scaling(self, scaling: ScriptValue) -> None:
        self._arm.force_gain = _between(scaling, 0, 2, "gain scaling")

    def tool_contact(self, direction: ScriptValue = None) -> int:
        """Give for how many cycles something has pressed against a direction, 0 if nothing does."""
        sought = (
            _ANYWHERE if direction is None else script_values.joints(direction, "the direction")
        )
        length = math.hypot(*sought[:3])
        fx, fy, fz = self._arm.wrench[:3]
        against = (
            math.hypot(fx, fy, fz)
            if length == 0
            else -(fx * sought[0] + fy * sought[1] + fz * sought[2]) / length
        )
        return self._arm.touch.cycles if against > _CONTACT_N else 0

    def get_joint_torques(self) -> list[float]:
        twist = self._arm.tool.jacobian(self._arm.state.q)[1]
        torques: list[float] = (twist.T @ np.array(self._arm.wrench)).tolist()
        return torques


def _between(value: ScriptValue, least: float, most: float, what: str) -> float:
    given = finite(value, f"the {what}")
    if not least <= given <= most:
        raise ScriptError(f"the {what} is {given:g}, but must be from {least:g} to {most:g}")
    return given
