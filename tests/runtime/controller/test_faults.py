from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from runtime.controller.faults import KINDS, load_faults, parse_faults
from runtime.errors import ConfigError

SCHEDULE = """\
- fault: protective_stop
  when: {move: 3, travel_rad: 0.4}
- fault: stall
  when: {time_s: 2.5}
  wall_s: 6
- fault: occupy_registers
  when: {time_s: 0}
  range: upper
"""


def test_a_schedule_is_read_from_yaml(tmp_path):
    path = tmp_path / "faults.yaml"
    path.write_text(SCHEDULE)
    stop, stall, occupied = load_faults(path)
    assert (stop.kind, stop.move, stop.travel_rad, stop.time_s) == ("protective_stop", 3, 0.4, None)
    assert (stall.time_s, stall.number("wall_s")) == (2.5, 6.0)
    assert occupied.word("range") == "upper"
    assert str(occupied) == "occupy_registers, range upper, release_after_s 0.0"


@pytest.mark.parametrize("text", ["", "[]", "null"])
def test_nothing_is_an_empty_schedule(tmp_path, text):
    path = tmp_path / "faults.yaml"
    path.write_text(text)
    assert load_faults(path) == ()


def test_each_kind_has_defaults_for_all_it_takes():
    for kind, parameters in KINDS.items():
        (fault,) = parse_faults([{"fault": kind, "when": {"time_s": 1}}])
        assert [name for name, _ in fault.settings] == list(parameters)


_RANGES = [
    {"fault": "protective_stop", "when": {"time_s": [1, 9]}},
    {"fault": "kill_script", "when": {"travel_rad": [0.1, 0.5]}},
    {"fault": "drop_rtde", "when": {"move": [2, 6], "travel_rad": [0, 1]}},
]


@given(st.integers(0, 2**31))
def test_the_seed_decides_what_is_left_open_and_nothing_else_does(seed):
    stop, kill, drop = parse_faults(_RANGES, seed)
    assert 1 <= stop.time_s <= 9
    assert 0.1 <= kill.travel_rad <= 0.5
    assert 2 <= drop.move <= 6
    assert 0 <= drop.travel_rad <= 1
    assert parse_faults(_RANGES, seed) == (stop, kill, drop)


def test_seeds_differ_and_reach_all_moves():
    drawn = [parse_faults(_RANGES, seed) for seed in range(60)]
    assert len({stop.time_s for stop, _, _ in drawn}) == 60
    assert {drop.move for _, _, drop in drawn} == {2, 3, 4, 5, 6}
    assert drawn[7][0].time_s != drawn[7][1].travel_rad


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("stop", "a schedule is a list of faults, not 'stop'"),
        (["stop"], "entry 1: expected a fault with its keys, got 'stop'"),
        ([{"when": {"time_s": 1}}], "entry 1: fault: missing; one of protective_stop"),
        (
            [{"fault": "protective_stp", "when": {"time_s": 1}}],
            "entry 1: fault: 'protective_stp'; did you mean protective_stop?",
        ),
        ([{"fault": 5}], "entry 1: fault: 5; one of protective_stop, emergency_stop"),
        (
            [{"fault": "die"}],
            "entry 1: when: None; expected time_s, travel_rad or move, such as {time_s: 2.5}",
        ),
        (
            [{"fault": "die", "when": {"time": 1}}],
            "entry 1: when.time: unknown; did you mean time_s?",
        ),
        (
            [{"fault": "die", "when": {"time_s": -1}}],
            "entry 1: when.time_s: -1; expected a number from 0 to 1e+06 s",
        ),
        (
            [{"fault": "die", "when": {"time_s": "soon"}}],
            "entry 1: when.time_s: 'soon'; expected a number from 0 to 1e+06 s",
        ),
        (
            [{"fault": "die", "when": {"move": 1.5}}],
            "entry 1: when.move: 1.5; expected a whole number from 1 to 1e+06",
        ),
        (
            [{"fault": "die", "when": {"move": [4, 2]}}],
            "entry 1: when.move: [4, 2]; the least stands before the most",
        ),
        (
            [{"fault": "die", "when": {"travel_rad": [1]}}],
            "entry 1: when.travel_rad: [1]; expected a number, or a list of least and most",
        ),
        (
            [{"fault": "die", "when": {"time_s": 1, "move": 2}}],
            "entry 1: when: time_s stands alone; only travel_rad goes with move",
        ),
        (
            [
                {"fault": "die", "when": {"time_s": 1}},
                {"fault": "stall", "when": {"time_s": 1}, "wall_s": 9999},
            ],
            "entry 2: wall_s: 9999; expected a number from 0.001 to 600 s",
        ),
        (
            [{"fault": "stall", "when": {"time_s": 1}, "wall": 9}],
            "entry 1: wall: unknown for stall; did you mean wall_s?",
        ),
        (
            [{"fault": "garbage", "when": {"time_s": 1}, "port": "script"}],
            "entry 1: port: 'script'; one of rtde, dashboard",
        ),
        (
            [{"fault": "slow", "when": {"time_s": 1}, "factor": True}],
            "entry 1: factor: True; expected a number from 1 to 1000",
        ),
        (
            [{"fault": "slow", "when": {"time_s": 1}, "factor": float("nan")}],
            "entry 1: factor: nan; expected a number from 1 to 1000",
        ),
    ],
)
def test_what_is_no_schedule_is_refused_with_entry_key_value_and_what_is_allowed(content, words):
    with pytest.raises(ConfigError) as refused:
        parse_faults(content)
    assert str(refused.value).startswith(words)


def test_a_refusal_names_the_file(tmp_path):
    path = tmp_path / "faults.yaml"
    with pytest.raises(ConfigError, match=r"faults.yaml: cannot be read: No such file"):
        load_faults(path)
    path.write_text("- fault: [\n")
    with pytest.raises(ConfigError, match=r"faults.yaml: cannot be read as YAML: "):
        load_faults(path)
    path.write_text("- fault: dye\n")
    with pytest.raises(ConfigError, match=r"faults.yaml: entry 1: fault: 'dye'"):
        load_faults(path)
    path.write_bytes(b"\xff\xfe\xff")
    with pytest.raises(ConfigError, match=r"faults.yaml: cannot be read as YAML"):
        load_faults(path)
