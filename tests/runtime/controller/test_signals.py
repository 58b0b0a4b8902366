from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from runtime.controller.signals import SignalError, Signals, parse_digital

_TERMINALS = st.sampled_from(
    [("standard", n) for n in range(8)]
    + [("configurable", n) for n in range(8)]
    + [("tool", n) for n in range(2)]
)


@given(st.dictionaries(_TERMINALS, st.booleans()))
def test_terminals_do_not_disturb_each_other(levels):
    signals = Signals()
    for (group, index), on in levels.items():
        signals.set_input(group, index, on=on)
        signals.set_output(group, index, on=not on)
    for (group, index), on in levels.items():
        assert signals.input_is_on(group, index) is on
        assert signals.output_is_on(group, index) is not on


def test_bits_lie_where_the_state_stream_has_them():
    signals = Signals()
    signals.set_output("standard", 3, on=True)
    signals.set_output("configurable", 1, on=True)
    signals.set_output("tool", 1, on=True)
    assert signals.digital_outputs == 1 << 3 | 1 << 9 | 1 << 17
    assert [name for name, on in signals.named_outputs().items() if on] == [
        "standard_digital_out_3",
        "configurable_digital_out_1",
        "tool_digital_out_1",
    ]


def test_a_mask_names_the_outputs_that_change():
    signals = Signals()
    signals.switch_masked("tool", 0b11, 0b11)
    signals.switch_masked("tool", 0b01, 0b10)
    assert signals.digital_outputs == 1 << 17
    signals.switch_masked("tool", 0xFF, 0xFF)
    assert signals.digital_outputs == 0b11 << 16


def test_names_of_inputs_are_read_and_wrong_ones_explained():
    assert parse_digital("tool_digital_in_1", "in") == ("tool", 1)
    for name in ("tool_digital_in_2", "tool_digital_out_0", "standard_digital_in_10", "x"):
        with pytest.raises(SignalError, match=f"there is no input '{name}'"):
            parse_digital(name, "in")


def test_a_terminal_that_is_not_there_is_refused():
    with pytest.raises(SignalError, match="there is no tool digital terminal 2; they are 0 to 1"):
        Signals().set_output("tool", 2, on=True)
