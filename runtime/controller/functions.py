"""The URScript functions the stand-in carries out that do not move the arm.

Together with `motion_functions` this is the closed table a program can reach; everything else
is refused by name. Source: Universal Robots, "The URScript Programming Language".
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from runtime.controller import script_values
from runtime.controller.script_values import ScriptPose, ScriptValue, finite, number
from runtime.controller.signals import REGISTERS, SignalError
from runtime.controller.tokens import ScriptError
from runtime.kinematics import matrix_to_pose, pose_to_matrix

if TYPE_CHECKING:
    from runtime.controller.control_box import ControlBox

_LONGEST_MESSAGE: Final = 400


def general_functions(box: ControlBox) -> Mapping[str, Callable[..., Any]]:
    """Give the functions for computing, terminals, registers and settings, by name."""
    return {**_mathematics(), **_poses(), **_terminals(box), **_registers(box), **_settings(box)}


def _mathematics() -> dict[str, Callable[..., Any]]:
    def one(function: Callable[[float], float]) -> Callable[[ScriptValue], float]:
        return lambda x: function(number(x))

    def norm(value: ScriptValue) -> float:
        if isinstance(value, list):
            return math.hypot(*(number(element) for element in value))
        return abs(number(value))

    return {
        "sin": one(math.sin),
        "cos": one(math.cos),
        "tan": one(math.tan),
        "asin": one(math.asin),
        "acos": one(math.acos),
        "atan": one(math.atan),
        "atan2": lambda y, x: math.atan2(number(y), number(x)),
        "sqrt": one(math.sqrt),
        "floor": one(math.floor),
        "ceil": one(math.ceil),
        "d2r": one(math.radians),
        "r2d": one(math.degrees),
        "norm": norm,
        "length": _length,
    }


def _length(value: ScriptValue) -> int:
    if not isinstance(value, list | str):
        raise ScriptError("length() takes a list or a text")
    return len(value)


def _poses() -> dict[str, Callable[..., Any]]:
    def matrix(value: ScriptValue) -> np.ndarray[Any, np.dtype[np.float64]]:
        return pose_to_matrix(script_values.pose(value))

    def between(a: ScriptValue, b: ScriptValue, sign: int) -> ScriptPose:
        # URScript adds the positions and multiplies the rotations, each by itself.
        first, second = matrix(a), matrix(b)
        result = np.eye(4)
        result[:3, :3] = first[:3, :3] @ (second[:3, :3] if sign > 0 else second[:3, :3].T)
        result[:3, 3] = first[:3, 3] + sign * second[:3, 3]
        return ScriptPose(matrix_to_pose(result))

    return {
        "pose_trans": lambda a, b: ScriptPose(matrix_to_pose(matrix(a) @ matrix(b))),
        "pose_inv": lambda a: ScriptPose(matrix_to_pose(np.linalg.inv(matrix(a)))),
        "pose_add": lambda a, b: between(a, b, 1),
        "pose_sub": lambda a, b: between(a, b, -1),
        "pose_dist": lambda a, b: float(np.linalg.norm(matrix(a)[:3, 3] - matrix(b)[:3, 3])),
    }


def _terminals(box: ControlBox) -> dict[str, Callable[..., Any]]:
    signals = box.signals

    def checked(action: Callable[..., Any]) -> Callable[..., Any]:
        def guarded(n: ScriptValue, *level: ScriptValue) -> Any:
            try:
                return action(int(number(n)), *level)
            except SignalError as error:
                raise ScriptError(str(error)) from error

        return guarded

    def reader(group: str, direction: str) -> Callable[..., Any]:
        read = signals.input_is_on if direction == "in" else signals.output_is_on
        return checked(lambda n: read(group, n))

    def writer(group: str) -> Callable[..., Any]:
        return checked(lambda n, b: signals.set_output(group, n, on=bool(b)))

    table: dict[str, Callable[..., Any]] = {}
    for group in ("standard", "configurable", "tool"):
        table[f"get_{group}_digital_in"] = reader(group, "in")
        table[f"get_{group}_digital_out"] = reader(group, "out")
        table[f"set_{group}_digital_out"] = writer(group)
    # The older names count through all terminals: 0-7 standard, 8-9 tool.
    table["set_digital_out"] = checked(
        lambda n, b: signals.set_output(*_old_terminal(n), on=bool(b))
    )
    table["get_digital_in"] = checked(lambda n: signals.input_is_on(*_old_terminal(n)))
    table["get_digital_out"] = checked(lambda n: signals.output_is_on(*_old_terminal(n)))
    return table


def _old_terminal(n: int) -> tuple[str, int]:
    return ("tool", n - 8) if n >= 8 else ("standard", n)


def _registers(box: ControlBox) -> dict[str, Callable[..., Any]]:
    signals = box.signals

    def index(n: ScriptValue) -> int:
        at = int(number(n))
        if not 0 <= at < REGISTERS:
            raise ScriptError(f"there is no register {at}; they are 0 to {REGISTERS - 1}")
        return at

    def write_integer(n: ScriptValue, value: ScriptValue) -> None:
        signals.output_ints[index(n)] = _int32(value)

    def write_float(n: ScriptValue, value: ScriptValue) -> None:
        signals.output_doubles[index(n)] = float(number(value))

    return {
        "read_input_integer_register": lambda n: signals.input_ints[index(n)],
        "read_input_float_register": lambda n: signals.input_doubles[index(n)],
        "read_output_integer_register": lambda n: signals.output_ints[index(n)],
        "read_output_float_register": lambda n: signals.output_doubles[index(n)],
        "write_output_integer_register": write_integer,
        "write_output_float_register": write_float,
    }


def _int32(value: ScriptValue) -> int:
    given = int(value) if isinstance(value, bool) else int(number(value))
    if not -(1 << 31) <= given < 1 << 31:
        raise ScriptError(f"{given} does not fit a 32-bit register")
    return given


def _settings(box: ControlBox) -> dict[str, Callable[..., Any]]:
    arm = box.arm

    def textmsg(*parts: ScriptValue) -> None:
        box.log("program: " + "".join(_text(part) for part in parts)[:_LONGEST_MESSAGE])

    def set_payload(m: ScriptValue, cog: ScriptValue = None, *_inertia: ScriptValue) -> None:
        mass = finite(m, "the payload")
        if not 0 <= mass <= arm.model.payload_kg:
            raise ScriptError(
                f"a payload of {mass:g} kg is outside 0 to {arm.model.payload_kg:g} kg, "
                f"what the {arm.model.name} may carry"
            )
        arm.payload_kg = mass
        if cog is not None:
            if not isinstance(cog, list) or len(cog) != 3:
                raise ScriptError("a centre of gravity must have three numbers")
            x, y, z = (finite(element, "the centre of gravity") for element in cog)
            arm.payload_cog = (x, y, z)

    def set_watchdog(
        variable_name: ScriptValue, min_frequency: ScriptValue, action: ScriptValue = "pause"
    ) -> None:
        if not isinstance(variable_name, str) or action not in ("ignore", "pause", "stop"):
            raise ScriptError(
                'rtde_set_watchdog() takes a variable\'s name, a frequency and "ignore", '
                '"pause" or "stop"'
            )
        box.set_watchdog(variable_name, finite(min_frequency, "the frequency"), action)

    return {
        "textmsg": textmsg,
        "popup": textmsg,
        "set_payload": set_payload,
        "set_payload_mass": set_payload,
        "set_target_payload": set_payload,
        "get_target_payload": lambda: arm.payload_kg,
        "get_target_payload_cog": lambda: list(arm.payload_cog),
        "get_target_payload_inertia": lambda: [0.0] * 6,
        "set_tcp": lambda pose: arm.set_tcp(script_values.pose(pose)),
        "get_tcp_offset": lambda: ScriptPose(arm.tool.tcp),
        "set_gravity": lambda _direction: None,  # the arm is kinematic: nothing falls
        "rtde_set_watchdog": set_watchdog,
        "protective_stop": lambda: box.protective_stop("the program asked for it"),
        "get_steptime": lambda: box.cycle_s,
    }


def _text(value: ScriptValue) -> str:
    if isinstance(value, ScriptPose):
        return f"p{list(value)}"
    return value if isinstance(value, str) else str(value)
