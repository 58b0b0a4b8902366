"""The variables of the state stream and of the inputs: names, types, where they come from.

A type must be exactly the protocol's: clients unpack by their own table, so that one wrong size
shifts everything after it. Source: Universal Robots, "RTDE Guide", tables of fields.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, TypeAlias

from runtime.controller.control_box import ControlBox
from runtime.controller.rtde_wire import DataType, Value
from runtime.controller.safety import RobotMode
from runtime.controller.signals import REGISTERS
from runtime.controller.versions import Version

Read: TypeAlias = Callable[[ControlBox], Value]

_ZERO3: Final = (0.0, 0.0, 0.0)
_ZERO6: Final = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)

# The joint modes of the protocol: running, idle, booting, power off.
_JOINT_MODES: Final = {
    RobotMode.RUNNING: 253,
    RobotMode.IDLE: 255,
    RobotMode.POWER_ON: 247,
    RobotMode.POWER_OFF: 239,
}


@dataclass(frozen=True, slots=True)
class Output:
    """A variable of the state stream.

    Args:
        kind: Its type on the wire.
        read: How to get its value.
        since: The minor version it came with, for each major one; None if always there.
    """

    kind: DataType
    read: Read
    since: Mapping[int, int] | None = None


def outputs(version: Version) -> dict[str, Output]:
    """Give the variables a controller of this version streams, by name."""
    found = {**_motion(), **_status(), **_electrical(), **_registers()}
    return {
        name: output
        for name, output in found.items()
        if output.since is None or version.is_at_least(output.since)
    }


def _motion() -> dict[str, Output]:
    six = DataType.VECTOR6D

    def joints(box: ControlBox) -> Value:
        return box.arm.joints

    def speeds(box: ControlBox) -> Value:
        return tuple(box.arm.state.qd.tolist())

    def pose(box: ControlBox) -> Value:
        return box.arm.tcp_pose

    def velocity(box: ControlBox) -> Value:
        return box.arm.tcp_speed

    return {
        "timestamp": Output(DataType.DOUBLE, lambda box: box.time_s),
        "target_q": Output(six, joints),
        "actual_q": Output(six, joints),
        "target_qd": Output(six, speeds),
        "actual_qd": Output(six, speeds),
        "target_qdd": Output(six, _constant(_ZERO6)),
        "actual_TCP_pose": Output(six, pose),
        "target_TCP_pose": Output(six, pose),
        "actual_TCP_speed": Output(six, velocity),
        "target_TCP_speed": Output(six, velocity),
        "actual_TCP_force": Output(six, lambda box: box.arm.wrench),
        "ft_raw_wrench": Output(six, lambda box: box.arm.raw_wrench, {5: 9}),
        "actual_tool_accelerometer": Output(DataType.VECTOR3D, _constant((0.0, 0.0, 9.81))),
        "speed_scaling": Output(DataType.DOUBLE, lambda box: box.arm.scaling),
        "target_speed_fraction": Output(DataType.DOUBLE, lambda box: box.arm.speed_fraction),
        "actual_momentum": Output(DataType.DOUBLE, _constant(0.0)),
        "payload": Output(DataType.DOUBLE, lambda box: box.arm.payload_kg, {3: 11, 5: 6}),
        "payload_cog": Output(DataType.VECTOR3D, lambda box: box.arm.payload_cog, {3: 11, 5: 6}),
        "payload_inertia": Output(six, _constant(_ZERO6), {3: 15, 5: 11}),
        "elbow_position": Output(DataType.VECTOR3D, _constant(_ZERO3), {3: 5, 5: 0}),
        "elbow_velocity": Output(DataType.VECTOR3D, _constant(_ZERO3), {3: 5, 5: 0}),
    }


def _status() -> dict[str, Output]:
    integer, unsigned = DataType.INT32, DataType.UINT32
    return {
        "robot_mode": Output(integer, lambda box: int(box.safety.robot_mode)),
        "joint_mode": Output(
            DataType.VECTOR6INT32, lambda box: (_JOINT_MODES[box.safety.robot_mode],) * 6
        ),
        "safety_mode": Output(integer, lambda box: int(box.safety.mode)),
        "runtime_state": Output(unsigned, lambda box: int(box.runtime_state)),
        "robot_status_bits": Output(unsigned, lambda box: box.robot_status_bits),
        "safety_status_bits": Output(unsigned, lambda box: box.safety.status_bits),
        "actual_digital_input_bits": Output(
            DataType.UINT64, lambda box: box.signals.digital_inputs
        ),
        "actual_digital_output_bits": Output(
            DataType.UINT64, lambda box: box.signals.digital_outputs
        ),
    }


def _electrical() -> dict[str, Output]:
    """Currents and the like, which a kinematic arm does not have: plausible constants."""
    six, double = DataType.VECTOR6D, DataType.DOUBLE
    table: dict[str, Output] = {
        name: Output(six, _constant(_ZERO6))
        for name in (
            "target_current",
            "target_moment",
            "actual_current",
            "joint_control_output",
        )
    }
    table["actual_current_as_torque"] = Output(six, _constant(_ZERO6), {5: 23})
    table["joint_temperatures"] = Output(six, _constant((25.0,) * 6))
    table["actual_joint_voltage"] = Output(six, _constant((48.0,) * 6))
    table["actual_execution_time"] = Output(double, _constant(0.0))
    table["actual_main_voltage"] = Output(double, _constant(48.0))
    table["actual_robot_voltage"] = Output(double, _constant(48.0))
    table["actual_robot_current"] = Output(double, _constant(0.0))
    for index in range(2):
        table[f"standard_analog_input{index}"] = Output(
            double, _element(lambda box: box.signals.analog_inputs, index)
        )
        table[f"standard_analog_output{index}"] = Output(
            double, _element(lambda box: box.signals.analog_outputs, index)
        )
    return table


def _registers() -> dict[str, Output]:
    table: dict[str, Output] = {
        "output_bit_registers0_to_31": Output(
            DataType.UINT32, lambda box: box.signals.output_bits & 0xFFFFFFFF
        ),
        "output_bit_registers32_to_63": Output(
            DataType.UINT32, lambda box: box.signals.output_bits >> 32
        ),
    }
    for index in range(REGISTERS):
        since = {3: 9, 5: 3} if index >= REGISTERS // 2 else None
        table[f"output_int_register_{index}"] = Output(
            DataType.INT32, _element(lambda box: box.signals.output_ints, index), since
        )
        table[f"output_double_register_{index}"] = Output(
            DataType.DOUBLE, _element(lambda box: box.signals.output_doubles, index), since
        )
    return table


def _element(source: Callable[[ControlBox], Sequence[float]], index: int) -> Read:
    return lambda box: source(box)[index]


def _constant(value: Value) -> Read:
    return lambda _box: value
