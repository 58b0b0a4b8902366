from __future__ import annotations

import dataclasses
import math
import pickle

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from runtime.checked_yaml import read
from runtime.config import (
    DATA,
    MAX_JOINT_SPEED,
    MAX_TOOL_SPEED,
    RobotConfig,
    load_robot,
)
from runtime.errors import ConfigError
from runtime.kinematics import MODELS, forward, pose_to_matrix

SHIPPED = yaml.safe_load((DATA / "ur5.yaml").read_text(encoding="utf-8"))


@pytest.fixture
def write(tmp_path):
    """Write the shipped configuration with some values replaced; None removes a key."""

    def _write(**changes):
        tree = {key: dict(v) if isinstance(v, dict) else v for key, v in SHIPPED.items()}
        for path, value in changes.items():
            *outer, key = path.split("__")
            place = tree
            for name in outer:
                place = place[name]
            if value is None:
                del place[key]
            else:
                place[key] = value
        file = tmp_path / "robot.yaml"
        file.write_text(yaml.safe_dump(tree), encoding="utf-8")
        return file

    return _write


@pytest.mark.parametrize("name", ["ur5", "ur16e"])
def test_the_shipped_robots_are_cautious(name):
    config = load_robot(name)
    assert config.arm is MODELS[name]
    assert config.speeds.tool <= MAX_TOOL_SPEED == 0.25
    assert config.speeds.joint <= 0.5 < MAX_JOINT_SPEED
    tool = forward(config.arm, config.look_joints) @ pose_to_matrix(config.tcp)
    assert tool[:3, 2] == pytest.approx([0, 0, -1], abs=1e-4), "the tool points down when it looks"
    assert config.payload.part("hubcover") == 0.1
    assert config.payload.part("something else") == config.payload.part_kg
    assert 0.7 < config.reach_m <= config.arm.reach_m


def test_a_file_reads_as_the_shipped_name_does(write):
    assert load_robot(write()) == load_robot("ur5")


def test_what_is_left_out_takes_its_default(write):
    config = load_robot(write(watch=None, look_cycles=None, payload__parts_kg=None))
    assert config.watch.silence_s == 0.15
    assert config.look_cycles == 3
    assert config.payload.parts_kg == ()


def test_a_configuration_can_be_hashed_and_sent_to_another_process():
    config = load_robot("ur5")
    again = pickle.loads(pickle.dumps(config))
    assert again == config
    assert hash(again) == hash(config)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"speeds__tool": 0.3}, "speeds.tool: 0.3; expected a number from 0.005 to 0.25 m/s"),
        ({"speeds__joint": 3.0}, "speeds.joint: 3.0; expected a number from 0.01 to 1 rad/s"),
        ({"speeds__joint": "fast"}, "speeds.joint: 'fast'; expected a number from 0.01 to 1 rad/s"),
        ({"speeds__joint": True}, "speeds.joint: True; expected a number from 0.01 to 1 rad/s"),
        (
            {"speeds__joint": math.nan},
            "speeds.joint: nan; expected a number from 0.01 to 1 rad/s",
        ),
        (
            {"look_joints": [0.0, 0.0]},
            "look_joints: (0.0, 0.0); expected 6 numbers, rad",
        ),
        (
            {"look_joints": [0.0, 0.0, 0.0, 0.0, 0.0, 7.0]},
            "look_joints: 7.0; expected a number from -6.28319 to 6.28319 rad",
        ),
        (
            {"tcp": [0.4, 0.4, 0.0, 0.0, 0.0, 0.0]},
            "tcp: 0.565685 m from the flange to the tool centre point; expected at most 0.5 m",
        ),
        ({"model": "ur7"}, "model: 'ur7' is not an arm that is known; expected one of ur16e, ur5"),
        ({"look_cycles": 2.5}, "look_cycles: 2.5; expected a whole number from 1 to 100 cycles"),
        ({"gripper__output": 2}, "gripper.output: 2; expected a whole number from 0 to 1"),
        (
            {"payload__part_kg": 4.5},
            (
                "payload: gripper and heaviest part weigh 5.4 kg; "
                "expected at most the 5 kg a ur5 may carry"
            ),
        ),
        (
            {"payload__parts_kg": {"plug": -1}},
            "payload.parts_kg.plug: -1; expected a number from 0 to 16 kg",
        ),
        (
            {"workspace__x": [0.7, 0.2]},
            (
                "workspace.x: 0.7 to 0.2 m is empty; the first number of each pair must be the "
                "smaller one"
            ),
        ),
        (
            {"watch__watchdog_hz": 20.0},
            (
                "speeds.stop_deceleration: 4; expected at least 12.5 rad/s^2, "
                "or the watchdog (20 Hz) acts first"
            ),
        ),
        (
            {"gripper__opening_m": 85},
            (
                "gripper.opening_m: 85; expected a number from 0.005 to 0.3 m; "
                "did you mean 0.085 m (85 mm)?"
            ),
        ),
        (
            {"look_joints": [158.7, -113.2, 87.1, -63.9, -90.0, -111.3]},
            (
                "look_joints: 158.7; expected a number from -6.28319 to 6.28319 rad; "
                "did you mean 2.77 rad (158.7 degrees)?"
            ),
        ),
        (
            {"tcp": [0.0, 0.0, 150.0, 0.0, 0.0, 0.0]},
            ("tcp: 150.0; expected a number from -0.5 to 0.5 m; did you mean 0.15 m (150 mm)?"),
        ),
        (
            {"tcp": [0.0, 0.0, 0.15, 0.0, 0.0, 90]},
            (
                "tcp: 90; expected a number from -3.14159 to 3.14159 rad; "
                "did you mean 1.571 rad (90 degrees)?"
            ),
        ),
        (
            {"speeds__tool": 150},
            (
                "speeds.tool: 150; expected a number from 0.005 to 0.25 m/s; "
                "did you mean 0.15 m/s (150 mm/s)?"
            ),
        ),
        (
            {"payload__gripper_kg": 900},
            (
                "payload.gripper_kg: 900; expected a number from 0 to 10 kg; "
                "did you mean 0.9 kg (900 g)?"
            ),
        ),
        (
            {"gripper__close_time_s": 400},
            (
                "gripper.close_time_s: 400; expected a number from 0.05 to 5 s; "
                "did you mean 0.4 s (400 ms)?"
            ),
        ),
        ({"speeds__tool": 0}, "speeds.tool: 0; expected a number from 0.005 to 0.25 m/s"),
        ({"speeds__joint": -0.5}, "speeds.joint: -0.5; expected a number from 0.01 to 1 rad/s"),
        ({"force__most_n": 0}, "force.most_n: 0; expected a number from 10 to 120 N"),
        (
            {"force__most_n": 15},
            (
                "force.descent_n: 8; expected at most half of force.most_n (15 N), which ends "
                "whatever is done by force"
            ),
        ),
        (
            {"force__search_n": 9.0},
            (
                "force.search_n: 9; expected at most force.descent_n (8 N), or a part climbs out "
                "of every chamfer that leads it in"
            ),
        ),
        ({"force__torqe_nm": 1}, "force.torqe_nm: unknown key; did you mean 'torque_nm'?"),
        (
            {"look_joints": [0.3, -1.97585, 1.520418, -1.115364, -1.570796, -1.943176]},
            (
                "look_joints: they bring the tool of a ur5 to x = -0.235 m; "
                "expected within workspace.x, 0.15 to 0.75 m"
            ),
        ),
        (
            {"look_joints": [2.769213, -1.97585, 1.520418, -1.115364, -1.2, -1.943176]},
            (
                "look_joints: the tool of a ur5 would point 21 degrees away from straight down; "
                "expected at most 5 (are they this arm's angles, in rad?)"
            ),
        ),
        (
            {"look_joints": [2.769213, -1.97585, 1.520418, -1.115364, -1.570796, -6.2]},
            ("look_joints: -6.2; expected at most workspace.joint_limit_rad, 6.1 rad either way"),
        ),
        ({"gripper": 3}, "gripper: expected keys with values, got 3"),
        ({"heights__transit_m": None}, "heights.transit_m: missing"),
        ({"speeds": None}, "speeds: missing"),
        (
            {"speeds__tool_sped": 0.1},
            "speeds.tool_sped: unknown key; did you mean 'tool'?",
        ),
        ({"griper": {}}, "griper: unknown key; did you mean 'gripper'?"),
        (
            {"xyzzy": 1},
            (
                "xyzzy: unknown key; expected model, look_joints, tcp, look_cycles, speeds, "
                "workspace, payload, gripper, heights, force, watch"
            ),
        ),
    ],
)
def test_a_wrong_value_is_named_with_what_is_allowed(write, changes, message):
    file = write(**changes)
    with pytest.raises(ConfigError) as caught:
        load_robot(file)
    place, said = str(caught.value).split(": ", 1)
    assert said == message
    name, _, line = place.rpartition(":")
    if not name:  # what is missing at the top has no line
        assert place == str(file)
        assert message.endswith(": missing")
        return
    assert name == str(file)
    key = message.partition(":")[0]
    written = file.read_text(encoding="utf-8").splitlines()[int(line) - 1].strip()
    assert written.partition(":")[0] in key.split(".")


def test_an_unknown_name_lists_the_shipped_ones():
    with pytest.raises(ConfigError) as caught:
        load_robot("ur55")
    assert str(caught.value) == (
        "ur55: no robot configuration of this name and no such file; "
        "expected a YAML file or one of ur16e, ur5"
    )


@pytest.mark.parametrize("content", [b"a: [", b"\xff\xfe\x00", b"", b"- 1\n"])
def test_a_file_that_is_no_configuration_is_refused(tmp_path, content):
    file = tmp_path / "robot.yaml"
    file.write_bytes(content)
    with pytest.raises(ConfigError, match=r"robot\.yaml(:1)?: "):
        load_robot(file)


def test_the_caps_hold_when_a_value_is_replaced_later():
    config = load_robot("ur5")
    with pytest.raises(ConfigError, match=r"speeds\.tool: 0\.5; expected a number from"):
        dataclasses.replace(config.speeds, tool=0.5)
    faster = dataclasses.replace(config.speeds, joint=1.0, stop_deceleration=1.0)
    with pytest.raises(ConfigError, match="watchdog"):
        dataclasses.replace(config, speeds=faster)


def test_every_number_has_a_declared_range():
    config = load_robot("ur5")
    for part in (
        config,
        config.speeds,
        config.workspace,
        config.heights,
        config.force,
        config.watch,
    ):
        for entry in dataclasses.fields(part):
            bare = entry.type in {"float", "int"}
            assert not bare, f"{type(part).__name__}.{entry.name} is not checked"
    assert isinstance(config, RobotConfig)


@settings(derandomize=True, max_examples=150)
@given(
    path=st.sampled_from(
        [(key,) for key in SHIPPED]
        + [
            (section, key)
            for section, values in SHIPPED.items()
            if isinstance(values, dict)
            for key in values
        ]
    ),
    value=st.recursive(
        st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
        lambda inner: (
            st.lists(inner, max_size=7) | st.dictionaries(st.text(max_size=5), inner, max_size=3)
        ),
        max_leaves=8,
    ),
)
def test_any_value_gives_a_configuration_or_an_error_that_names_its_key(path, value):
    tree = {key: dict(v) if isinstance(v, dict) else v for key, v in SHIPPED.items()}
    place = tree
    for key in path[:-1]:
        place = place[key]
    place[path[-1]] = value
    try:
        config = read(RobotConfig, tree)
    except ConfigError as error:
        names = (*path, "payload", "speeds.stop_deceleration")  # these depend on other values
        assert any(name in str(error) for name in names)  # noqa: PT017 - both ways are fine
    else:
        assert config.speeds.tool <= MAX_TOOL_SPEED
        assert config.speeds.joint <= MAX_JOINT_SPEED
