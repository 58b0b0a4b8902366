"""How a part comes over its seat, whatever way the tool has to be turned for that."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from icarus_lite import Action
from runtime.drivers import MotionError, Press, plan_motion
from runtime.drivers.limits import tcp_matrix
from runtime.drivers.steps import GiveUp, Progress


def test_a_part_beside_the_middle_of_the_hand_turns_with_it(config, parts, scene, arm_at):
    """Where the tool has to be turned, the part is still over its seat."""
    beside = 0.006
    held = scene(
        hand1=(0.3, 0.0, 0.42),
        hubcover=(0.3 - beside, 0.0, 0.42 - parts["hubcover"].grasp_height_m),
        case=(0.40, 0.10, 0.035),
    )
    state = arm_at(closed=True, gripped=True)
    insert = Action("insert", ("hand1", "hubcover", "case"))
    narrow = dataclasses.replace(
        config, workspace=dataclasses.replace(config.workspace, joint_limit_rad=3.0)
    )
    steps = plan_motion((insert,), held, state, narrow, parts, Progress(looked=True))
    press = next(step for step in steps if isinstance(step, Press))
    tool = tcp_matrix(config, press.joints)
    look = tcp_matrix(config, config.look_joints)
    turned = math.atan2(tool[1, 0], tool[0, 0]) - math.atan2(look[1, 0], look[0, 0])
    assert turned == pytest.approx(math.radians(-60), abs=1e-6)
    seat = np.add(held["case"].position, parts["hubcover"].seats[0].offset)
    expected = (beside * math.cos(turned), beside * math.sin(turned))
    assert np.subtract(press.pose[:2], seat[:2]) == pytest.approx(expected, abs=1e-6)


def top_in_hand(scene, parts, **moved):
    """The scene with the casing's top in the hand."""
    top = parts["casingtop"]
    anchors = scene(hand1=(0.3, 0.0, 0.42), **moved)
    anchors["top"] = dataclasses.replace(
        anchors["hubcover"],
        name="top",
        type="casingtop",
        position=(0.3, 0.0, 0.42 - top.grasp_height_m),
    )
    return anchors


def test_a_part_that_is_not_round_is_not_turned(config, parts, scene, arm_at):
    narrow = dataclasses.replace(
        config, workspace=dataclasses.replace(config.workspace, joint_limit_rad=3.0)
    )
    state = arm_at(closed=True, gripped=True)
    command = Action("insert", ("hand1", "top", "case"))
    near, far = (
        top_in_hand(scene, parts, case=(0.40, y, 0.035), hubcover=(0.5, -0.1, 0.012))
        for y in (0.0, 0.15)
    )
    looked = Progress(looked=True)
    steps = plan_motion((command,), near, state, narrow, parts, looked)
    press = next(step for step in steps if isinstance(step, Press))
    tool, look = (tcp_matrix(config, joints) for joints in (press.joints, config.look_joints))
    assert tool[:3, :3] == pytest.approx(look[:3, :3], abs=1e-4)
    with pytest.raises(MotionError, match="cannot reach the seat of top in case"):
        plan_motion((command,), far, state, narrow, parts, looked)


def test_after_a_failure_the_hand_comes_up_with_the_part(config, parts, scene, arm_at):
    x, y, z = 0.40, 0.12, 0.05
    low = plan_motion(
        (Action("grasp", ("hand1", "hubcover")),),
        scene(hubcover=(x, y, z)),
        arm_at(),
        config,
        parts,
    )[2].joints
    state = arm_at(low, closed=True, gripped=True)
    command = Action("insert", ("hand1", "hubcover", "case"))
    up, end = plan_motion(
        (command,), scene(), state, config, parts, Progress(looked=True, failure="jammed")
    )
    assert up.holding
    assert up.pose[2] >= config.heights.transit_m - 1e-6
    assert end == GiveUp("jammed")


def test_more_than_the_configuration_allows_is_not_pressed(config, parts, scene, arm_at):
    weak = dataclasses.replace(config, force=dataclasses.replace(config.force, most_n=30.0))
    anchors = top_in_hand(scene, parts)
    state = arm_at(closed=True, gripped=True)
    command = Action("insert", ("hand1", "top", "case"))
    with pytest.raises(MotionError, match=r"it takes 30 N to seat it; the configuration allows 30"):
        plan_motion((command,), anchors, state, weak, parts, Progress(looked=True))
