"""The control box's terminals and registers: what can be wired to it, read and written."""

from __future__ import annotations

import re
from typing import Final

REGISTERS: Final = 48
"""General purpose registers of each kind and direction; the upper half is meant for fieldbuses."""

_BIT_OFFSETS: Final = {"standard": 0, "configurable": 8, "tool": 16}
_COUNTS: Final = {"standard": 8, "configurable": 8, "tool": 2}
_NAME: Final = re.compile(r"(standard|configurable|tool)_digital_(in|out)_(\d)")


class SignalError(ValueError):
    """There is no such terminal, or the value does not fit it."""


class Signals:
    """Digital and analog terminals and the RTDE registers.

    Digital levels are kept as in the state stream: bits 0-7 standard, 8-15 configurable, 16-17
    tool.
    """

    __slots__ = (
        "analog_inputs",
        "analog_outputs",
        "digital_inputs",
        "digital_outputs",
        "input_bits",
        "input_doubles",
        "input_ints",
        "output_bits",
        "output_doubles",
        "output_ints",
    )

    def __init__(self) -> None:
        self.digital_inputs = 0
        self.digital_outputs = 0
        self.analog_inputs = [0.0, 0.0]
        self.analog_outputs = [0.0, 0.0]
        self.input_bits = 0
        self.output_bits = 0
        self.input_ints = [0] * REGISTERS
        self.input_doubles = [0.0] * REGISTERS
        self.output_ints = [0] * REGISTERS
        self.output_doubles = [0.0] * REGISTERS

    def set_input(self, group: str, index: int, *, on: bool) -> None:
        """Wire a level to a digital input. Raises SignalError if there is none of that kind."""
        self.digital_inputs = _with_bit(self.digital_inputs, _bit(group, index), on=on)

    def set_output(self, group: str, index: int, *, on: bool) -> None:
        """Switch a digital output. Raises SignalError if there is none of that kind."""
        self.digital_outputs = _with_bit(self.digital_outputs, _bit(group, index), on=on)

    def input_is_on(self, group: str, index: int) -> bool:
        """Read a digital input. Raises SignalError if there is none of that kind."""
        return bool(self.digital_inputs >> _bit(group, index) & 1)

    def output_is_on(self, group: str, index: int) -> bool:
        """Read a digital output back. Raises SignalError if there is none of that kind."""
        return bool(self.digital_outputs >> _bit(group, index) & 1)

    def switch_masked(self, group: str, mask: int, levels: int) -> None:
        """Set the outputs of a group named by a mask's bits to the levels in the same bits."""
        offset = _BIT_OFFSETS[group]
        mask &= (1 << _COUNTS[group]) - 1
        kept = self.digital_outputs & ~(mask << offset)
        self.digital_outputs = kept | (levels & mask) << offset

    def named_inputs(self) -> dict[str, bool]:
        """Every digital input by name, such as "tool_digital_in_0"."""
        return _named(self.digital_inputs, "in")

    def named_outputs(self) -> dict[str, bool]:
        """Every digital output by name, such as "standard_digital_out_3"."""
        return _named(self.digital_outputs, "out")


def parse_digital(name: str, direction: str) -> tuple[str, int]:
    """Split "tool_digital_in_0" into group and index.

    Args:
        name: Of an input or output.
        direction: "in" or "out", which it has to be.

    Raises:
        SignalError: There is none of that name.
    """
    matched = _NAME.fullmatch(name)
    if matched is None or matched[2] != direction or int(matched[3]) >= _COUNTS[matched[1]]:
        raise SignalError(
            f"there is no {direction}put '{name}'; there are standard_digital_{direction}_0 to 7, "
            f"configurable_digital_{direction}_0 to 7, tool_digital_{direction}_0 and 1"
        )
    return matched[1], int(matched[3])


def _bit(group: str, index: int) -> int:
    if not 0 <= index < _COUNTS[group]:
        raise SignalError(
            f"there is no {group} digital terminal {index}; they are 0 to {_COUNTS[group] - 1}"
        )
    return _BIT_OFFSETS[group] + index


def _with_bit(bits: int, bit: int, *, on: bool) -> int:
    return bits | 1 << bit if on else bits & ~(1 << bit)


def _named(bits: int, direction: str) -> dict[str, bool]:
    return {
        f"{group}_digital_{direction}_{index}": bool(bits >> offset + index & 1)
        for group, offset in _BIT_OFFSETS.items()
        for index in range(_COUNTS[group])
    }
