from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from icarus_lite import Action, Outcome, Status
from runtime.drivers import DryRunDriver, Grip, MoveJoints, MoveLinear, Press, Tare, Turn
from runtime.drivers.limits import tcp_matrix
from runtime.errors import UsageError

PICK = Action("pick-up", ("hand1", "hubcover"))
GRASP = (Action("grasp", ("hand1", "hubcover")),)
INSERT = Action("insert", ("hubcover", "case"))
INSERTING = (Action("insert", ("hand1", "hubcover", "case")),)


@pytest.fixture
def driver(config, parts):
    return DryRunDriver(config, parts, dt=0.1)


@pytest.fixture
def anchored(driver, scene, parts):
    """The scene as anchoring would give it: the hand where it is, a held part in it."""

    def _anchored(**moved):
        x, y, z = driver.state().tcp_pose[:3]
        places = {"hand1": (x, y, z)}
        if driver.state().gripped:
            places["hubcover"] = (x, y, z - parts["hubcover"].grasp_height_m)
        return scene(**{**places, **moved})

    return _anchored


def run(driver, anchors, *, polls=2000):
    """Poll until the action has ended; give its outcome and the tool's places on the way."""
    places = []
    for _ in range(polls):
        outcome = driver.poll(anchors())
        places.append(driver.state().tcp_pose[:3])
        if outcome is None or outcome.status is not Status.RUNNING:
            return outcome, np.array(places)
    pytest.fail("the action never ended")


def test_a_hub_cover_is_picked_up_and_inserted(driver, anchored, parts):
    driver.start(PICK, GRASP, anchored())
    outcome, _ = run(driver, anchored)
    assert outcome == Outcome(PICK, Status.SUCCEEDED)
    assert driver.poll(anchored()) is None, "an outcome is reported once"
    assert driver.state().gripped
    assert driver.state().tcp_pose[:2] == pytest.approx((0.42, -0.10))

    driver.start(INSERT, INSERTING, anchored())
    outcome, _ = run(driver, anchored)
    assert outcome == Outcome(INSERT, Status.SUCCEEDED)
    assert not driver.state().gripped
    assert not driver.state().gripper_closed
    seat = np.add((0.40, 0.16, 0.035), parts["hubcover"].seats[0].offset)
    off = np.subtract(driver.state().tcp_pose[:3], seat)
    assert off == pytest.approx((0.0, 0.0, parts["hubcover"].grasp_height_m), abs=1e-6)
    assert [type(step) for step in driver.log] == [
        MoveJoints,
        Tare,
        MoveLinear,
        Grip,
        MoveLinear,
        MoveJoints,
        MoveJoints,
        Tare,
        MoveLinear,
        Press,
        Grip,
    ]


def test_the_virtual_arm_keeps_to_the_configured_speeds(driver, anchored, config):
    driver.start(PICK, GRASP, anchored())
    joints = [driver.state().joints]
    while driver.poll(anchored()).status is Status.RUNNING:
        joints.append(driver.state().joints)
    speeds = np.abs(np.diff(joints, axis=0)) / 0.1
    assert 0.2 < speeds.max() <= config.speeds.joint + 1e-9
    assert driver.state().timestamp_s == pytest.approx(0.1 * len(joints))


def test_two_runs_are_the_same_to_the_last_bit(config, parts, scene):
    logs = []
    for _ in range(2):
        driver = DryRunDriver(config, parts, dt=0.07)
        driver.start(PICK, GRASP, scene())
        _, places = run(driver, scene)
        logs.append((driver.log, places.tobytes()))
    assert logs[0] == logs[1]


def test_the_receiver_is_where_it_was_last_seen(driver, anchored, parts):
    driver.start(PICK, GRASP, anchored())
    run(driver, anchored)
    driver.start(INSERT, INSERTING, anchored())
    moved = (0.45, 0.10, 0.035)

    def after_a_push():
        return anchored(case=moved)

    outcome, _ = run(driver, after_a_push)
    assert outcome.status is Status.SUCCEEDED
    seat = np.add(moved, parts["hubcover"].seats[0].offset)
    assert driver.state().tcp_pose[:2] == pytest.approx(seat[:2])


@pytest.mark.parametrize(
    ("gone", "reason"),
    [
        ({"case": None}, "case is not anchored"),
        ({"hubcover": None}, "hubcover is not anchored"),
        ({"hubcover": (0.42, -0.10, 0.012)}, "away from its place in hand1"),
        ({"case": (0.74, 0.44, 0.035)}, "reach"),
    ],
)
def test_what_the_look_does_not_find_ends_the_insertion(driver, anchored, gone, reason, config):
    driver.start(PICK, GRASP, anchored())
    run(driver, anchored)
    driver.start(INSERT, INSERTING, anchored())
    outcome, _ = run(driver, lambda: anchored(**gone))
    assert outcome.status is Status.FAILED
    assert reason in outcome.reason
    assert driver.state().joints == config.look_joints, "the arm waits at the look pose"
    assert driver.state().gripper_closed


def test_a_grasp_that_feels_nothing_fails(driver, anchored, config):
    driver.feel(gripped=False)
    driver.start(PICK, GRASP, anchored())
    outcome, _ = run(driver, anchored)
    assert outcome == Outcome(PICK, Status.FAILED, "the gripper closed but feels no part")
    waited = config.gripper.close_time_s + config.gripper.sense_time_s
    assert driver.state().timestamp_s > waited


def test_a_part_lost_on_the_way_stops_the_arm(driver, anchored):
    driver.start(PICK, GRASP, anchored())
    run(driver, anchored)
    driver.start(INSERT, INSERTING, anchored())
    held = anchored()
    for _ in range(5):
        assert driver.poll(held).status is Status.RUNNING
    driver.feel(gripped=False)
    outcome, _ = run(driver, lambda: held)
    assert outcome.status is Status.FAILED
    assert "no longer feels the part" in outcome.reason
    where = driver.state().joints
    assert driver.poll(held) is None
    assert driver.state().joints == where


def test_what_cannot_be_planned_fails_at_the_next_poll_and_moves_nothing(driver, scene, config):
    far = scene(hubcover=(0.9, 0.0, 0.012))
    driver.start(PICK, GRASP, far)
    outcome = driver.poll(far)
    assert outcome.status is Status.FAILED
    assert "cannot reach hubcover" in outcome.reason
    assert driver.state().joints == config.look_joints
    assert driver.log == ()


def test_nothing_moves_after_a_stop(driver, scene):
    driver.start(PICK, GRASP, scene())
    for _ in range(10):
        driver.poll(scene())
    where = driver.state().joints
    driver.stop()
    driver.stop()
    for _ in range(10):
        assert driver.poll(scene()) is None
    assert driver.state().joints == where
    driver.close()


def test_a_second_action_must_wait(driver, scene):
    driver.start(PICK, GRASP, scene())
    with pytest.raises(UsageError, match=r"\(pick-up hand1 hubcover\) is still under way"):
        driver.start(PICK, GRASP, scene())


def test_parking_goes_up_and_to_the_look_pose(driver, scene, config):
    driver.start(PICK, GRASP, scene())
    run(driver, scene)
    driver.park()
    outcome, _ = run(driver, scene)
    assert outcome == Outcome(Action("park"), Status.SUCCEEDED)
    assert driver.state().joints == config.look_joints


def test_an_action_without_commands_succeeds_at_once(driver, scene):
    driver.start(PICK, (), scene())
    assert driver.poll(scene()) == Outcome(PICK, Status.SUCCEEDED)


def test_the_place_where_it_starts_can_be_given(config, parts):
    joints = (config.look_joints[0] + 0.1, *config.look_joints[1:])
    driver = DryRunDriver(config, parts, joints=joints)
    tool = tcp_matrix(config, joints)
    assert driver.state().tcp_pose[:3] == pytest.approx(tool[:3, 3])


@pytest.mark.parametrize("dt", [0.0, -1.0, float("inf"), float("nan")])
def test_time_must_pass(config, parts, dt):
    with pytest.raises(UsageError, match="expected a positive time"):
        DryRunDriver(config, parts, dt=dt)


def test_it_looks_for_as_many_cycles_as_configured(config, parts, scene):
    many = dataclasses.replace(config, look_cycles=30)
    polls = []
    for chosen in (config, many):
        driver = DryRunDriver(chosen, parts)
        driver._gripped = driver._closed = True
        x, y, z = driver.state().tcp_pose[:3]
        anchors = scene(hand1=(x, y, z), hubcover=(x, y, z - parts["hubcover"].grasp_height_m))
        driver.start(INSERT, INSERTING, anchors)
        _, places = run(driver, lambda held=anchors: held)
        polls.append(len(places))
    assert polls[1] - polls[0] == 30 - config.look_cycles


SCREW = Action("screw-in", ("hand1", "plug-1", "case"))
UNSCREW = Action("unscrew", ("hand1", "plug-1", "case"))


def test_a_plug_is_screwed_in_and_out_again(driver, scene, parts):
    seat = parts["plug"].seats[0]
    case = (0.40, 0.16, 0.035)
    seated = tuple(a + b for a, b in zip(case, seat.offset, strict=True))

    def anchored():
        x, y, z = driver.state().tcp_pose[:3]
        plug = (x, y, z - parts["plug"].grasp_height_m)
        return scene(hand1=(x, y, z), **({"plug-1": plug} if driver.state().gripped else {}))

    pick = Action("grasp", ("hand1", "plug-1"))
    driver.start(pick, (pick,), anchored())
    run(driver, anchored)
    driver.start(SCREW, (SCREW,), anchored())
    outcome, _ = run(driver, anchored, polls=4000)
    assert outcome.status is Status.SUCCEEDED, outcome.reason
    turns = [step for step in driver.log if isinstance(step, Turn)]
    assert len(turns) == 3, "four turns are more than wrist 3 has in two strokes"
    assert outcome.reason.startswith("4.00 turns in all")
    place = driver.state().tcp_pose
    assert place[:2] == pytest.approx(seated[:2], abs=1e-6)
    assert place[2] == pytest.approx(seated[2] + parts["plug"].grasp_height_m, abs=1e-6)
    assert not driver.state().gripped

    def screwed():
        x, y, z = driver.state().tcp_pose[:3]
        return scene(**{"hand1": (x, y, z), "plug-1": seated})

    driver.start(UNSCREW, (UNSCREW,), screwed())
    outcome, _ = run(driver, screwed, polls=4000)
    assert outcome.status is Status.SUCCEEDED, outcome.reason
    assert driver.state().gripped
    off_its_thread = place[2] + parts["plug"].seats[0].thread.depth_m
    assert driver.state().tcp_pose[2] > off_its_thread


def test_the_virtual_wrist_keeps_to_its_range_and_speed(driver, scene, parts, config):
    driver._gripped = driver._closed = True
    limit = config.workspace.joint_limit_rad

    def anchored():
        x, y, z = driver.state().tcp_pose[:3]
        return scene(**{"hand1": (x, y, z), "plug-1": (x, y, z - parts["plug"].grasp_height_m)})

    driver.start(SCREW, (SCREW,), anchored())
    wrist, told = [driver.state().joints[5]], []
    while driver.poll(anchored()).status is Status.RUNNING:
        state = driver.state()
        wrist.append(state.joints[5])
        told.append((state.gripped, state.regrips))
    opened = [regrips for gripped, regrips in told if not gripped]
    first_for_good = opened.index(False)
    assert all(opened[:first_for_good]), "the hand opens to take hold again"
    assert first_for_good > 0
    assert not any(opened[first_for_good:]), "and lets go in the end"
    assert not driver.state().regrips
    assert max(map(abs, wrist)) <= limit
    speeds = np.abs(np.diff(wrist)) / 0.1
    assert speeds.max() <= max(config.speeds.joint, config.force.turning_speed) + 1e-9
