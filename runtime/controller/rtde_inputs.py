"""The input variables: what a client may write, and what its writing does.

Source: Universal Robots, "RTDE Guide", table of input fields.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Final, TypeAlias

from runtime.controller.control_box import ControlBox
from runtime.controller.rtde_wire import DataType, Value
from runtime.controller.signals import REGISTERS

_Values: TypeAlias = Mapping[str, Value]

_GROUPS: Final = ("standard", "configurable", "tool")


def input_types() -> dict[str, DataType]:
    """Give the type of each variable a client may write, by name."""
    table: dict[str, DataType] = {
        "speed_slider_mask": DataType.UINT32,
        "speed_slider_fraction": DataType.DOUBLE,
        "standard_analog_output_mask": DataType.UINT8,
        "standard_analog_output_type": DataType.UINT8,
        "standard_analog_output_0": DataType.DOUBLE,
        "standard_analog_output_1": DataType.DOUBLE,
        "input_bit_registers0_to_31": DataType.UINT32,
        "input_bit_registers32_to_63": DataType.UINT32,
        "external_force_torque": DataType.VECTOR6D,
    }
    for group in _GROUPS:
        table[f"{group}_digital_output_mask"] = DataType.UINT8
        table[f"{group}_digital_output"] = DataType.UINT8
    for index in range(REGISTERS):
        table[f"input_int_register_{index}"] = DataType.INT32
        table[f"input_double_register_{index}"] = DataType.DOUBLE
    return table


def write_inputs(box: ControlBox, values: _Values) -> None:
    """Carry out what one data package asks for; values that cannot be are left out."""
    for name, value in values.items():
        if name.startswith("input_int_register_"):
            box.signals.input_ints[_index(name)] = int(_number(value))
        elif name.startswith("input_double_register_"):
            box.signals.input_doubles[_index(name)] = _number(value)
    for action in (_bit_registers, _digital_outputs, _analog_outputs, _speed_slider):
        action(box, values)
    box.input_renewed(tuple(values))


def _bit_registers(box: ControlBox, values: _Values) -> None:
    for name, shift in (("input_bit_registers0_to_31", 0), ("input_bit_registers32_to_63", 32)):
        if name in values:
            kept = box.signals.input_bits & ~(0xFFFFFFFF << shift)
            box.signals.input_bits = kept | int(_number(values[name])) << shift


def _digital_outputs(box: ControlBox, values: _Values) -> None:
    for group in _GROUPS:
        mask, levels = f"{group}_digital_output_mask", f"{group}_digital_output"
        if mask in values and levels in values:
            box.signals.switch_masked(
                group, int(_number(values[mask])), int(_number(values[levels]))
            )


def _analog_outputs(box: ControlBox, values: _Values) -> None:
    mask = int(_number(values.get("standard_analog_output_mask", 0)))
    for index in range(2):
        name = f"standard_analog_output_{index}"
        if mask >> index & 1 and name in values:
            level = _number(values[name])
            if math.isfinite(level):
                box.signals.analog_outputs[index] = max(0.0, min(1.0, level))


def _speed_slider(box: ControlBox, values: _Values) -> None:
    if _number(values.get("speed_slider_mask", 0)) and "speed_slider_fraction" in values:
        fraction = _number(values["speed_slider_fraction"])
        if math.isfinite(fraction):
            box.arm.speed_fraction = max(0.0, min(1.0, fraction))


def _index(name: str) -> int:
    return int(name.rpartition("_")[2])


def _number(value: Value) -> float:
    return value[0] if isinstance(value, tuple) else value
