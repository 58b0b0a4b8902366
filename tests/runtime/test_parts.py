from __future__ import annotations

import pytest
import yaml

from runtime.errors import ConfigError
from runtime.parts import GEARBOX, GRIPPER_OPENING_M, load_parts

PEG = {
    "colour": [0.5, 0.5, 0.5],
    "grasp": 0.02,
    "grip": 0.02,
    "solids": [["cylinder", 0.02, 0.02, 0.04, 0, 0, 0]],
}


def write(tmp_path, tree):
    path = tmp_path / "parts.yaml"
    path.write_text(tree if isinstance(tree, str) else yaml.safe_dump(tree), encoding="utf-8")
    return path


def test_the_gearbox_has_the_parts_of_the_papers_tasks():
    parts = load_parts()
    assert {"case", "casingtop", "hubcover", "input", "output", "plug"} <= set(parts)
    assert list(parts) == list(yaml.safe_load(GEARBOX.read_text(encoding="utf-8")))
    assert [seat.into for seat in parts["hubcover"].seats] == ["case"]
    assert not parts["case"].grippable
    assert all(part.grip_width_m < GRIPPER_OPENING_M for n, part in parts.items() if n != "case")


@pytest.mark.parametrize("name", list(load_parts()))
def test_solids_fill_the_box_around_the_centre(name):
    part = load_parts()[name]
    for axis in range(3):
        lows = [s.offset[axis] - s.size[axis] / 2 for s in part.primitives]
        highs = [s.offset[axis] + s.size[axis] / 2 for s in part.primitives]
        assert min(lows) == pytest.approx(-part.size[axis] / 2)
        assert max(highs) == pytest.approx(part.size[axis] / 2)
    assert abs(part.grasp_height_m) <= part.size[2] / 2


def test_heights_are_converted_to_centres(tmp_path):
    peg = {**PEG, "seats": [{"into": "block", "at": [0.01, 0, 0.05]}]}
    block = {**PEG, "solids": [["box", 0.1, 0.1, 0.06, 0, 0, 0]]}
    parts = load_parts(write(tmp_path, {"peg": peg, "block": block}))
    assert parts["peg"].grasp_height_m == pytest.approx(0.0)
    # The peg's lower face 50 mm above the block's: its centre 70 - 30 mm above the block's centre.
    assert parts["peg"].seats[0].offset == pytest.approx((0.01, 0.0, 0.04))


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"grasp": 0.5}, "peg.grasp: 0.5 is out of range; expected 0 to 0.04."),
        ({"grip": "wide"}, "peg.grip: 'wide' is no number; expected 0.001 to 0.5."),
        ({"grip": True}, "peg.grip: True is no number; expected 0.001 to 0.5."),
        ({"grap": 1}, "peg: unknown key 'grap'; did you mean 'grasp'?."),
        ({"colour": [0, 0, 2]}, "peg.colour: 2 is out of range; expected 0 to 1."),
        ({"colour": [0, 0]}, "peg.colour: [0, 0] has 2 entries; expected 3 numbers."),
        ({"solids": []}, "peg.solids: [] is empty; expected at least one solid."),
        ({"solids": 3}, "peg.solids: 3 found; expected a list."),
        (
            {"solids": [["cone", 0.02, 0.02, 0.04, 0, 0, 0]]},
            "peg.solids[0]: unknown shape 'cone'; expected 'box' or 'cylinder'.",
        ),
        (
            {"solids": [["cylinder", 0.02, 0.03, 0.04, 0, 0, 0]]},
            "peg.solids[0]: a cylinder of width 0.02 and depth 0.03; expected them equal.",
        ),
        (
            {"solids": [["box", 0.02, 0.02, 0.04, 0, 0, 0.01]]},
            (
                "peg.solids: the box around them is centred at x 0, y 0 with its lower face"
                " at z 0.01; expected 0, 0, 0."
            ),
        ),
        (
            {"seats": [{"into": "pge", "at": [0, 0, 0]}]},
            "peg.seats[0].into: 'pge' is no other part; expected one of .",
        ),
        (
            {"seats": [{"into": "peg", "at": [0, 0, 0], "presn": 3}]},
            "peg.seats[0]: unknown key 'presn'; did you mean 'press_n'?.",
        ),
        (
            {"seats": [{"into": "peg"}]},
            "peg.seats[0]: the key 'at' is missing.",
        ),
    ],
)
def test_wrong_values_are_named_with_key_and_range(tmp_path, change, text):
    path = write(tmp_path, {"peg": {**PEG, **change}})
    with pytest.raises(ConfigError) as caught:
        load_parts(path)
    assert str(caught.value) == f"{path}: {text}"


def test_a_solid_with_too_few_numbers_is_explained(tmp_path):
    path = write(tmp_path, {"peg": {**PEG, "solids": [["box", 0.02]]}})
    with pytest.raises(ConfigError, match="has 2 entries; expected shape, width, depth, height"):
        load_parts(path)


def test_a_missing_key_is_named(tmp_path):
    path = write(tmp_path, {"peg": {key: PEG[key] for key in PEG if key != "grip"}})
    with pytest.raises(ConfigError, match="peg: the key 'grip' is missing"):
        load_parts(path)


@pytest.mark.parametrize("text", ["- 1", "peg: 3", "a: [", ""])
def test_bad_yaml_is_a_config_error(tmp_path, text):
    with pytest.raises(ConfigError, match=r"parts\.yaml"):
        load_parts(write(tmp_path, text))


def test_a_missing_file_is_a_config_error(tmp_path):
    with pytest.raises(ConfigError, match="cannot be read"):
        load_parts(tmp_path / "none.yaml")


BLOCK = {**PEG, "solids": [["box", 0.1, 0.1, 0.06, 0, 0, 0]]}


def test_how_a_part_goes_in_is_read_and_has_defaults(tmp_path):
    seats = [
        {"into": "block", "at": [0, 0, 0.05]},
        {
            "into": "block",
            "at": [0, 0, 0.05],
            "press_n": 30,
            "thread": {"pitch_m": 0.001, "turns": 5},
        },
    ]
    first, second = load_parts(write(tmp_path, {"peg": {**PEG, "seats": seats}, "block": BLOCK}))[
        "peg"
    ].seats
    assert (first.press_n, first.clearance_m, first.chamfer_m) == (12.0, 0.0006, 0.003)
    assert (first.engages_m, first.thread) == (0.0, None)
    assert second.press_n == 30
    assert second.thread is not None
    assert second.thread.depth_m == pytest.approx(0.005)


@pytest.mark.parametrize(
    ("more", "text"),
    [
        ({"press_n": -1}, "peg.seats[0].press_n: -1 is out of range; expected 0 to 100."),
        ({"clearance_m": 0.6}, "clearance_m: 0.6 is out of range; expected 0.0001 to 0.005."),
        ({"thread": {"pitch_m": 0.0015}}, "peg.seats[0].thread: the key 'turns' is missing."),
        ({"thread": {"pitch_m": 1.5, "turns": 4}}, "pitch_m: 1.5 is out of range"),
        ({"thread": 4}, "peg.seats[0].thread: 4 found; expected names with values."),
    ],
)
def test_a_seat_with_wrong_values_is_explained(tmp_path, more, text):
    seats = [{"into": "block", "at": [0, 0, 0], **more}]
    path = write(tmp_path, {"peg": {**PEG, "seats": seats}, "block": BLOCK})
    with pytest.raises(ConfigError) as caught:
        load_parts(path)
    assert text in str(caught.value)


def test_in_the_gearbox_the_plug_is_screwed_in_and_the_lid_takes_a_press():
    parts = load_parts()
    thread = parts["plug"].seats[0].thread
    assert thread is not None
    assert (thread.pitch_m, thread.turns) == (0.0015, 4)
    assert parts["casingtop"].seats[0].press_n == 30
    assert [name for name, part in parts.items() if any(s.thread for s in part.seats)] == ["plug"]
