"""What the engine makes of recorded actions, with the domain as it is shipped."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from aapa import Attachment
from aapa.lacater import Movement, Scene
from icarus_lite import Action, Outcome, Percept, load_domain
from icarus_lite.inference import InferenceEngine, Memory
from icarus_lite.language import parse_domain
from runtime.cater.attachments import AttachmentEngine, TimedAction, timed_actions
from runtime.cater.evaluate import cater_domain

DOMAIN = load_domain(cater_domain())
ENGINE = AttachmentEngine(DOMAIN)
WHOLE = InferenceEngine(DOMAIN)


def spans(actions, frames=60):
    """Give for each pair the frames in which it is believed to have been attached before."""
    found = {}
    for frame, report in enumerate(ENGINE.reports(actions, frames)):
        for child, parent in report.attachments:
            found.setdefault((child, parent), []).append(frame)
    return {pair: (numbers[0], numbers[-1]) for pair, numbers in found.items()}


def test_what_is_covered_moves_from_the_frame_after_the_contain_has_ended():
    # Believed after frame 20, it moves from frame 21 on; freed as the pick-place begins at 40.
    actions = [
        TimedAction("contain", ("Cone_0", "Spl_0"), 5, 20),
        TimedAction("slide", ("Cone_0",), 25, 30),
        TimedAction("pick-place", ("Cone_0",), 40, 55),
    ]
    assert spans(actions) == {("Spl_0", "Cone_0"): (21, 40)}


def test_what_is_never_freed_stays():
    assert spans([TimedAction("contain", ("Cone_0", "Spl_0"), 5, 20)]) == {
        ("Spl_0", "Cone_0"): (21, 59)
    }


def test_nested_cones_are_a_chain_and_come_off_one_by_one():
    actions = [
        TimedAction("contain", ("Cone_0", "Spl_0"), 0, 5),
        TimedAction("contain", ("Cone_1", "Cone_0"), 10, 15),
        TimedAction("pick-place", ("Cone_1",), 20, 25),
        TimedAction("pick-place", ("Cone_0",), 30, 35),
    ]
    assert spans(actions) == {("Spl_0", "Cone_0"): (6, 30), ("Cone_0", "Cone_1"): (16, 20)}


def test_moving_something_else_frees_nothing():
    actions = [
        TimedAction("contain", ("Cone_0", "Spl_0"), 0, 5),
        TimedAction("pick-place", ("Cone_1",), 10, 15),
        TimedAction("rotate", ("SmoothCube_v2_0",), 20, 25),
    ]
    assert spans(actions) == {("Spl_0", "Cone_0"): (6, 59)}


def test_one_frame_may_end_one_action_and_begin_another():
    # The contain ends in the frame in which its pick-place begins: covered and freed at once.
    actions = [
        TimedAction("contain", ("Cone_0", "Spl_0"), 0, 5),
        TimedAction("pick-place", ("Cone_0",), 5, 9),
    ]
    assert spans(actions) == {}


def test_beginnings_and_ends_are_reported_in_their_frames():
    [action] = [TimedAction("slide", ("Cone_0",), 2, 4)]
    reports = ENGINE.reports([action], 6)
    told = [(n, r.status, r.planned_end) for n, f in enumerate(reports) for r in f.actions]
    assert told == [(2, "running", 4), (4, "succeeded", None)]


def test_what_ends_after_the_video_is_told_as_begun_only():
    reports = ENGINE.reports([TimedAction("slide", ("Cone_0",), 2, 9)], 6)
    assert [r.status for f in reports for r in f.actions] == ["running"]


def test_a_scene_s_record_is_told_in_the_words_of_the_domain():
    movements = {
        "Spl_0": (Movement("_no_op", None, 1, 2), Movement("_slide", None, 30, 40)),
        "Cone_0": (
            Movement("_contain", "Spl_0", 3, 9),
            Movement("_pick_place", None, 12, 20),
        ),
    }
    assert timed_actions(Scene(1, "x.avi", (), movements)) == (
        TimedAction("contain", ("Cone_0", "Spl_0"), 3, 9),
        TimedAction("pick-place", ("Cone_0",), 12, 20),
        TimedAction("slide", ("Spl_0",), 30, 40),
    )


def test_other_rules_give_other_attachments():
    domain, _ = parse_domain(
        "(domain other) (percepts (object ^x)) (skills"
        " ((cover ?a ?b) :elements ((object ?a) (object ?b)) :actions ((*cover ?a ?b)))"
        " ((lift ?a) :elements ((object ?a)) :actions ((*lift ?a))))"
        " (attachments ((cover ?a ?b) :until (lift ?b) :child ?a :parent ?b))"
    )
    engine = AttachmentEngine(domain)
    actions = [
        TimedAction("cover", ("Spl_0", "Cone_0"), 0, 3),
        TimedAction("contain", ("Cone_1", "Spl_0"), 4, 5),
        TimedAction("lift", ("Cone_0",), 7, 9),
    ]
    pairs = [report.attachments for report in engine.reports(actions, 10)]
    bond = (Attachment("Spl_0", "Cone_0"),)
    assert pairs == [()] * 4 + [bond] * 4 + [()] * 2


def test_effects_that_attach_count_as_well():
    domain, _ = parse_domain(
        "(domain effects) (percepts (object ^x)) (skills"
        " ((glue ?a ?b) :elements ((object ?a) (object ?b)) :actions ((*glue ?a ?b))"
        " :effects ((attached ?a ?b))))"
    )
    reports = AttachmentEngine(domain).reports([TimedAction("glue", ("a", "b"), 0, 1)], 4)
    assert [len(report.attachments) for report in reports] == [0, 0, 1, 1]


names = st.sampled_from(["Cone_0", "Cone_1", "Cone_2", "Spl_0"])
any_action = st.one_of(
    st.tuples(st.just("contain"), st.tuples(names, names)),
    st.tuples(st.just("pick-place"), st.tuples(names)),
    st.tuples(st.just("slide"), st.tuples(names)),
)


@settings(max_examples=40)
@given(st.lists(any_action, max_size=12))
def test_the_hierarchy_is_that_of_the_whole_domain(steps):
    # One action after the other, each over before the next begins; and the whole engine with
    # percepts, concepts and skills, told of each when it counts.
    actions = [
        TimedAction(name, args, 10 * n + 1, 10 * n + 5) for n, (name, args) in enumerate(steps)
    ]
    reports = ENGINE.reports(actions, 10 * len(steps) + 10)
    memory = Memory()
    percepts = [
        Percept("object", name, {"type": "cone", "x": 9 * n, "y": 5, "width": 9 + n, "height": 9})
        for n, name in enumerate(["Cone_0", "Cone_1", "Cone_2", "Spl_0"])
    ]
    memory = WHOLE.step(memory, percepts)
    for number, (name, args) in enumerate(steps):
        memory = WHOLE.step(memory, percepts, [Outcome(Action(name, args))])
        expected = sorted(memory.state.hierarchy.pairs())
        assert sorted(map(tuple, reports[10 * number + 9].attachments)) == expected


@pytest.mark.parametrize("frames", [0, 1])
def test_a_video_without_actions_has_no_attachments(frames):
    assert all(not report.attachments for report in ENGINE.reports([], frames))
