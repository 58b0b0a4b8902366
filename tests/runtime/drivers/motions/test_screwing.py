"""What is planned after each stroke of the wrist, from how far it came and how it ended."""

from __future__ import annotations

import math

import numpy as np
import pytest

from icarus_lite import Action
from runtime.drivers import (
    Grip,
    MotionError,
    MoveJoints,
    MoveLinear,
    Press,
    Tare,
    Turn,
    plan_motion,
)
from runtime.drivers.limits import arm_solutions, tcp_matrix
from runtime.drivers.steps import GiveUp, Progress

SCREW = Action("screw-in", ("hand1", "plug-1", "case"))
UNSCREW = Action("unscrew", ("hand1", "plug-1", "case"))
TURN = 2 * math.pi
WHOLE = 4 * TURN


@pytest.fixture
def on_thread(config, parts, scene, arm_at):
    """Plan for a plug that is held in its thread, the wrist somewhere."""

    def _plan(progress, *, wrist=5.8, command=SCREW):
        anchors = scene()
        seat = np.add(anchors["case"].position, parts["plug"].seats[0].offset)
        first = scene(
            **{"hand1": (0.3, 0.0, 0.42), "plug-1": (0.3, 0.0, 0.42 - parts["plug"].grasp_height_m)}
        )
        state = arm_at(closed=True, gripped=True)
        steps = plan_motion((SCREW,), first, state, config, parts, Progress(looked=True))
        press = next(step for step in steps if isinstance(step, Press))
        joints = (*press.joints[:5], wrist)
        x, y, z = tcp_matrix(config, joints)[:3, 3]
        held = scene(**{"hand1": (x, y, z), "plug-1": (x, y, z - parts["plug"].grasp_height_m)})
        assert (x, y) == pytest.approx(seat[:2], abs=1e-6)
        now = arm_at(joints, closed=True, gripped=True)
        return plan_motion((command,), held, now, config, parts, progress)

    return _plan


def kinds(steps):
    return [type(step).__name__ for step in steps]


def test_a_screw_is_put_on_its_thread_and_turned_as_far_as_the_wrist_goes(
    config, parts, scene, arm_at
):
    held = scene(
        **{"hand1": (0.3, 0.0, 0.42), "plug-1": (0.3, 0.0, 0.42 - parts["plug"].grasp_height_m)}
    )
    state = arm_at(closed=True, gripped=True)
    steps = plan_motion((SCREW,), held, state, config, parts, Progress(looked=True))
    assert kinds(steps) == ["MoveJoints", "Tare", "MoveLinear", "Press", "Turn", "Grip"]
    press, turn = steps[3], steps[4]
    seat = parts["plug"].seats[0]
    z = 0.035 + seat.offset[2] + parts["plug"].grasp_height_m
    assert press.pose[2] == pytest.approx(z + seat.thread.depth_m)
    assert press.press_n == config.force.descent_n
    assert turn.clockwise
    assert turn.angle_rad == pytest.approx(WHOLE)
    assert turn.torque_nm == config.force.torque_nm
    assert turn.wrist_until_rad < config.workspace.joint_limit_rad
    assert turn.then == (SCREW,)


def test_at_the_end_of_its_range_the_hand_takes_hold_anew(on_thread, config):
    steps = on_thread(Progress(looked=True, turned_rad=7.0))
    assert kinds(steps) == [
        *("Grip", "MoveLinear", "MoveJoints", "Tare", "MoveLinear", "Grip", "Turn", "Grip")
    ]
    release, up, back, _, down, close, turn, _ = steps
    assert (release.close, close.close) == (False, True)
    assert up.length_m == pytest.approx(config.force.regrip_m)
    assert down.length_m == pytest.approx(config.force.regrip_m)
    assert back.joints[:5] == back.start[:5]
    assert back.joints[5] == pytest.approx(-5.8)
    assert turn.angle_rad == pytest.approx(WHOLE - 7.0)


def test_the_wrist_turns_back_no_farther_than_is_left(on_thread):
    steps = on_thread(Progress(looked=True, turned_rad=WHOLE - 0.5))
    back = next(step for step in steps if isinstance(step, MoveJoints))
    assert 0.5 < 5.8 - back.joints[5] < TURN * 1.5 + 0.5 + 0.5


@pytest.mark.parametrize("turned", [WHOLE - 0.4 * TURN, WHOLE, WHOLE + TURN])
def test_a_screw_that_stops_where_it_should_is_tight(on_thread, turned):
    steps = on_thread(Progress(looked=True, turned_rad=turned, stalled=True), wrist=2.0)
    assert kinds(steps) == ["Grip"]
    assert not steps[0].close


def test_a_screw_that_stops_early_is_backed_out(on_thread):
    steps = on_thread(Progress(looked=True, turned_rad=5.0, stalled=True), wrist=2.0)
    turn = steps[0]
    assert isinstance(turn, Turn)
    assert not turn.clockwise
    assert turn.most_rad == pytest.approx(5.0)
    assert turn.wrist_until_rad == pytest.approx(-5.8)
    assert turn.failure == "tight after 0.8 of 4 turns: its thread is crossed"


def test_where_the_wrist_cannot_turn_back_the_hand_takes_hold_anew(on_thread):
    steps = on_thread(Progress(looked=True, turned_rad=5.0, stalled=True), wrist=-5.5)
    assert kinds(steps)[:7] == [
        *("Grip", "MoveLinear", "MoveJoints", "Tare", "MoveLinear", "Grip", "Turn")
    ]
    assert steps[2].joints[5] == pytest.approx(-5.8 + 5.0 + 0.3)


def test_what_is_backed_out_comes_up_in_the_hand(on_thread):
    progress = Progress(looked=True, turned_rad=0.1, failure="its thread is crossed")
    steps = on_thread(progress, wrist=0.0)
    assert kinds(steps) == ["MoveLinear", "GiveUp"]
    assert steps[0].holding
    assert steps[1] == GiveUp("its thread is crossed; it was backed out and is still held")


def test_what_cannot_be_backed_out_is_let_go(on_thread):
    progress = Progress(looked=True, turned_rad=5.0, stalled=True, failure="its thread is crossed")
    steps = on_thread(progress, wrist=0.0)
    assert kinds(steps) == ["Grip", "MoveLinear", "GiveUp"]
    assert not steps[0].close
    assert steps[2].reason == "its thread is crossed; nor could it be backed out: it was let go"


def test_a_screw_that_never_gets_tight_is_backed_out(on_thread):
    steps = on_thread(Progress(looked=True, turned_rad=WHOLE + 1.5 * TURN), wrist=5.0)
    assert steps[0].failure == "it turns freely after 5.5 of 4 turns"


def test_a_screw_that_turns_without_going_in_is_lifted_off(on_thread):
    """A thread may bite as late as after one and a half turns; then it leads down."""
    late = Progress(looked=True, turned_rad=1.4 * TURN, sunk_m=0.0)
    assert kinds(on_thread(late))[-2:] == ["Turn", "Grip"]
    steps = on_thread(Progress(looked=True, turned_rad=3.0 * TURN, sunk_m=0.0004))
    assert kinds(steps) == ["MoveLinear", "GiveUp"]
    assert steps[0].holding
    words = "its thread does not catch: 0.4 mm down after 3.0 turns; it is still held"
    assert steps[1] == GiveUp(words)


def test_a_screw_that_went_in_a_little_is_not_torn_out(on_thread):
    steps = on_thread(Progress(looked=True, turned_rad=3.0 * TURN, sunk_m=0.001), wrist=5.0)
    assert isinstance(steps[0], Turn)
    assert not steps[0].clockwise
    assert steps[0].most_rad == pytest.approx(3.0 * TURN)
    assert steps[0].failure.startswith("its thread does not catch: 1.0 mm down")


@pytest.mark.parametrize("turns", [1.0, 2.0, 3.5, 5.0])
def test_a_thread_that_bites_late_is_followed(on_thread, turns):
    sunk_m = 0.0015 * max(0.0, turns - 1.5)
    steps = on_thread(Progress(looked=True, turned_rad=turns * TURN, sunk_m=sunk_m))
    assert kinds(steps)[-2:] == ["Turn", "Grip"]
    assert steps[-2].clockwise


def test_what_could_not_be_put_on_its_thread_comes_up_in_the_hand(on_thread):
    steps = on_thread(Progress(looked=True, failure="found no opening"), wrist=0.0)
    assert kinds(steps) == ["MoveLinear", "GiveUp"]


def test_unscrewing_takes_hold_and_turns_the_other_way(config, parts, scene, arm_at):
    anchors = scene()
    seat = np.add(anchors["case"].position, parts["plug"].seats[0].offset)
    steps = plan_motion((UNSCREW,), scene(**{"plug-1": tuple(seat)}), arm_at(), config, parts)
    assert kinds(steps) == ["MoveJoints", "Tare", "MoveLinear", "Grip", "Turn"]
    turn = steps[4]
    assert not turn.clockwise
    assert turn.angle_rad > WHOLE
    assert turn.torque_nm > config.force.torque_nm


@pytest.mark.parametrize(
    ("progress", "last"),
    [
        (Progress(turned_rad=-WHOLE - 0.6), "MoveLinear"),
        (Progress(turned_rad=-WHOLE, stalled=True), "MoveLinear"),
        (Progress(turned_rad=-1.0, stalled=True), "GiveUp"),
        (Progress(turned_rad=-7.0), "Turn"),
    ],
)
def test_what_unscrewing_does_next(on_thread, progress, last):
    steps = on_thread(progress, wrist=-5.8, command=UNSCREW)
    assert kinds(steps)[-1] == last
    if last == "GiveUp":
        assert kinds(steps) == ["Grip", "MoveLinear", "GiveUp"]
        assert steps[-1].reason == "it does not come loose: stuck after 0.2 of 4 turns"
    elif last == "MoveLinear":
        # It stands on its thread now, so how high is known: before, that could not be seen.
        assert kinds(steps) == ["Grip", "Tare", "Grip", "MoveLinear"]
        assert [step.close for step in steps[::2]] == [False, True]
        assert steps[0].again
        assert steps[-1].length_m == pytest.approx(0.0015)


def test_a_plug_that_was_turned_out_is_held_where_it_is_known_to_stand(
    config, parts, scene, arm_at
):
    anchors = scene()
    seat = parts["plug"].seats[0]
    x, y, z = np.add(anchors["case"].position, seat.offset)
    right = z + seat.thread.depth_m + parts["plug"].grasp_height_m
    target = np.diag([1.0, -1.0, -1.0, 1.0])
    target[:3, 3] = x, y, right + 0.005
    joints = arm_solutions(config, target, config.look_joints)[0]
    state = arm_at(joints, closed=True, gripped=True)
    out = Progress(turned_rad=-WHOLE - 0.6)
    steps = plan_motion((UNSCREW,), anchors, state, config, parts, out)
    assert kinds(steps) == ["Grip", "Tare", "MoveLinear", "Grip", "MoveLinear"]
    assert steps[2].pose[2] == pytest.approx(right)
    assert steps[2].guarded


def test_only_what_has_a_thread_is_screwed(config, parts, scene, arm_at):
    command = Action("screw-in", ("hand1", "hubcover", "case"))
    held = scene(
        hand1=(0.3, 0.0, 0.42), hubcover=(0.3, 0.0, 0.42 - parts["hubcover"].grasp_height_m)
    )
    state = arm_at(closed=True, gripped=True)
    with pytest.raises(MotionError, match="hubcover has no thread that goes into case"):
        plan_motion((command,), held, state, config, parts)
    insert = Action("insert", ("hand1", "plug-1", "case"))
    held = scene(
        **{"hand1": (0.3, 0.0, 0.42), "plug-1": (0.3, 0.0, 0.42 - parts["plug"].grasp_height_m)}
    )
    with pytest.raises(MotionError, match=r"plug-1 is screwed into case, not pressed: \(screw-in "):
        plan_motion((insert,), held, state, config, parts)


def test_moves_and_grips_are_all_the_hand_does_to_take_hold_anew(on_thread):
    steps = on_thread(Progress(looked=True, turned_rad=7.0))
    assert all(isinstance(step, Grip | MoveLinear | MoveJoints | Tare | Turn) for step in steps)


@pytest.mark.parametrize("command", [SCREW, Action("rest", ("hand1",))])
def test_a_plug_that_stands_in_its_thread_is_let_go_not_pulled_out(
    config, parts, scene, arm_at, command
):
    anchors = scene()
    seat = parts["plug"].seats[0]
    x, y, z = np.add(anchors["case"].position, seat.offset)
    grasp = parts["plug"].grasp_height_m

    def first(turned_m):
        """Give the first step from where the hand holds the plug, turned in so far."""
        height = z + seat.thread.depth_m - turned_m + grasp
        target = np.diag([1.0, -1.0, -1.0, 1.0])
        target[:3, 3] = x, y, height
        joints = arm_solutions(config, target, config.look_joints)[0]
        held = scene(**{"hand1": (x, y, height), "plug-1": (x, y, height - grasp)})
        state = arm_at(joints, closed=True, gripped=True)
        return plan_motion((command,), held, state, config, parts)

    half_in = first(0.003)
    assert kinds(half_in)[:2] == ["Grip", "MoveLinear"]
    assert not half_in[0].close
    assert not half_in[1].holding
    if command is SCREW:
        assert half_in[-1] == GiveUp("plug-1 stands in its thread already; it was let go there")
    above = first(-0.003)
    assert kinds(above)[0] == "MoveLinear"
    assert above[0].holding
