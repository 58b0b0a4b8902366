from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aapa.anchors import Anchor, AnchorStatus
from aapa.camera import Camera
from aapa.hypotheses import Move, explain, move_between
from aapa.parameters import AnchoringParameters
from aapa.view import View

IMAGE = View(AnchoringParameters(image_size=(320, 240)))
STILL = Move()


def anchor(name, x=100.0, y=100.0, *, side=20.0, confidence=1.0, position=None):
    return Anchor(
        name,
        name.split("-")[0],
        (x, y, x + side, y + side),
        AnchorStatus.VISIBLE,
        confidence=confidence,
        position=position,
        size=None if position is None else (0.1, 0.1),
    )


def explained(lost, seen=(), moves=None, parents=None, view=IMAGE):
    moves = {thing.name: STILL for thing in seen} | (moves or {})
    explanation = explain(lost, tuple(seen), moves, parents or {}, view)
    return {thing.name: thing for thing in explanation.kept}, explanation.dropped


def test_nothing_lost_needs_no_explanation():
    assert explained([], [anchor("cone")]) == ({}, ())


def test_a_stranger_to_the_detector_only_fades():
    kept, dropped = explained([anchor("cone", confidence=0.2)], [anchor("ball")])
    assert kept["cone"].status is AnchorStatus.MISSING
    assert kept["cone"].confidence == 0.1
    assert kept["cone"].reason == (
        "It is not seen and it had been seen too little to be reasoned about; "
        "its confidence falls to 0.1."
    )
    assert dropped == ()


def test_below_zero_an_anchor_is_given_up():
    kept, [gone] = explained([anchor("cone", confidence=0.0)])
    assert kept == {}
    assert (gone.name, gone.status, gone.confidence) == ("cone", AnchorStatus.MISSING, 0.0)
    assert gone.reason.endswith("; it is given up.")


def test_an_attached_child_moves_with_its_parent():
    kept, _ = explained(
        [anchor("snitch")], [anchor("cone")], {"cone": Move(7.0, -3.0)}, {"snitch": "cone"}
    )
    snitch = kept["snitch"]
    assert snitch.box == (107.0, 97.0, 127.0, 117.0)
    assert (snitch.status, snitch.parent, snitch.confidence) == (AnchorStatus.ATTACHED, "cone", 1)
    assert snitch.reason == "It is attached to cone (visible) and moves with it."


def test_the_parent_may_be_unseen_itself():
    lost = [anchor("plug", 10, 10), anchor("case"), anchor("hubcover", 60, 60)]
    parents = {"plug": "case", "hubcover": "case", "case": "hand"}
    kept, _ = explained(lost, [anchor("hand")], {"hand": Move(5.0, 5.0)}, parents)
    assert [thing.box[:2] for thing in kept.values()] == [(105, 105), (65, 65), (15, 15)]
    assert {thing.status for thing in kept.values()} == {AnchorStatus.ATTACHED}
    assert kept["plug"].reason == "It is attached to case (attached) and moves with it."


def test_a_missing_parent_keeps_its_child_as_long_as_it_lasts():
    parents = {"snitch": "cone"}
    kept, dropped = explained([anchor("snitch"), anchor("cone", confidence=0.5)], (), {}, parents)
    assert (kept["cone"].status, kept["cone"].confidence) == (AnchorStatus.MISSING, 0.4)
    assert (kept["snitch"].status, kept["snitch"].confidence) == (AnchorStatus.ATTACHED, 1.0)
    lost = [anchor("snitch"), anchor("cone", confidence=0.3)]
    view = View(AnchoringParameters(confidence_loss=0.4))
    kept, dropped = explained(lost, (), {}, parents, view)
    assert [thing.name for thing in dropped] == ["cone"]
    assert (kept["snitch"].status, kept["snitch"].confidence) == (AnchorStatus.MISSING, 0.6)
    assert kept["snitch"].parent is None


def test_a_parent_nobody_has_anchored_explains_nothing():
    kept, _ = explained([anchor("case")], [anchor("plug", 10, 10)], {}, {"case": "human-hand"})
    assert kept["case"].status is AnchorStatus.MISSING


def test_an_action_shows_that_its_object_exists():
    lost = [anchor("snitch", confidence=0.1), anchor("cone", confidence=0.0)]
    kept, dropped = explained(lost, [anchor("hand")], {}, {"snitch": "cone", "cone": "hand"})
    assert dropped == ()
    assert {name: thing.confidence for name, thing in kept.items()} == {"snitch": 0.3, "cone": 0.3}


def test_what_reaches_out_of_the_image_is_kept_for_ever():
    kept, _ = explained([anchor("cone", 310, 50)])
    assert kept["cone"].status is AnchorStatus.OUT_OF_VIEW
    assert kept["cone"].confidence == 1.0


def test_what_something_stands_in_front_of_is_kept_where_it_is():
    kept, _ = explained([anchor("ball")], [anchor("cone", 110, 110)], {"cone": Move(30.0, 0.0)})
    assert kept["ball"].status is AnchorStatus.OCCLUDED
    assert kept["ball"].box == (100, 100, 120, 120)
    assert kept["ball"].reason == "cone stands in front of it."


def test_an_explained_thing_may_hide_the_next():
    lost = [anchor("a", 140), anchor("b", 125)]
    kept, _ = explained(lost, [anchor("cone", 110)])
    assert kept["b"].reason == "cone stands in front of it."
    assert kept["a"].reason == "b stands in front of it."


def test_two_vanished_things_do_not_keep_each_other():
    kept, _ = explained([anchor("a"), anchor("b")], [anchor("cone", 10)])
    assert {thing.status for thing in kept.values()} == {AnchorStatus.MISSING}


def test_a_vanished_parent_is_not_hidden_by_what_it_carries():
    kept, _ = explained([anchor("cone"), anchor("snitch")], [], {}, {"snitch": "cone"})
    assert kept["cone"].status is AnchorStatus.MISSING
    assert kept["snitch"].status is AnchorStatus.ATTACHED


def test_what_is_too_uncertain_hides_nothing():
    lost = [anchor("a", 140), anchor("b", 125, confidence=0.2)]
    kept, _ = explained(lost, [anchor("cone", 110)])
    assert {thing.status for thing in kept.values()} == {AnchorStatus.MISSING}


BLINKING = View(AnchoringParameters(image_size=(320, 240), blink=2))


@pytest.mark.parametrize(("streak", "hides"), [(7, True), (-1, True), (-2, False), (-9, False)])
def test_what_the_detector_misses_for_a_moment_still_hides(streak, hides):
    lid = dataclasses.replace(anchor("lid", 105), streak=streak)
    kept, _ = explained([dataclasses.replace(anchor("box"), streak=-50), lid], view=BLINKING)
    assert kept["lid"].status is AnchorStatus.MISSING
    assert kept["lid"].confidence < 1
    if hides:
        assert kept["box"].reason == "lid stands in front of it."
        assert kept["box"].confidence == 1
    else:
        assert kept["box"].status is AnchorStatus.MISSING


def test_a_lid_that_is_attached_to_what_it_hides_may_be_missed_for_a_moment():
    lid = dataclasses.replace(anchor("lid", 105), streak=3)
    box = dataclasses.replace(anchor("box"), streak=-50)
    kept, _ = explained([box, lid], parents={"lid": "box"}, view=BLINKING)
    assert (kept["box"].status, kept["lid"].status) == (
        AnchorStatus.OCCLUDED,
        AnchorStatus.ATTACHED,
    )
    assert {thing.confidence for thing in kept.values()} == {1}


def test_two_that_are_missed_at_once_do_not_hide_each_other():
    lost = [dataclasses.replace(anchor(name), streak=3) for name in ("a", "b")]
    kept, _ = explained(lost, [anchor("cone", 10)], view=BLINKING)
    assert {thing.status for thing in kept.values()} == {AnchorStatus.MISSING}


def test_what_an_unseen_parent_carries_may_hide_the_next():
    lost = [anchor("a", 200), anchor("case", 100), anchor("plug", 190)]
    parents = {"plug": "case", "case": "hand"}
    kept, _ = explained(lost, [anchor("hand", 10)], {}, parents)
    assert kept["a"].reason == "plug stands in front of it."


def test_attachment_comes_before_the_other_reasons():
    edge = anchor("snitch", 0, 0)
    kept, _ = explained([edge], [anchor("cone", 5, 5)], {}, {"snitch": "cone"})
    assert kept["snitch"].status is AnchorStatus.ATTACHED
    kept, _ = explained([edge], [anchor("cone", 5, 5)])
    assert kept["snitch"].status is AnchorStatus.OUT_OF_VIEW


DOWN = np.array([[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]])
CAMERA = Camera(640, 480, 500.0, (0.0, 0.0, 1.0), DOWN, near_m=0.1)
BASE = View(AnchoringParameters(space="base", tau=0.01), CAMERA)


def test_in_base_space_what_lies_below_hides_nothing():
    plug = anchor("plug", position=(0.0, 0.0, 0.1))
    below = dataclasses.replace(
        anchor("case", position=(0.0, 0.0, 0.0)), box=(280.0, 200.0, 360.0, 280.0)
    )
    above = dataclasses.replace(below, position=(0.0, 0.0, 0.3))
    assert explained([plug], [below], view=BASE)[0]["plug"].status is AnchorStatus.MISSING
    kept, _ = explained([plug], [above], view=BASE)
    assert kept["plug"].status is AnchorStatus.OCCLUDED
    assert kept["plug"].box == pytest.approx((292.2, 212.2, 347.8, 267.8), abs=0.1)


def test_what_is_held_before_the_lens_hides_what_lies_below():
    # The paper's task 2.2: the output subassembly obstructs the view of the case.
    case = anchor("case", position=(0.0, 0.0, 0.0))
    output = anchor("output", position=(0.0, 0.0, 0.93))
    hand = anchor("hand", 600, 400, position=(0.0, 0.0, 0.99))
    kept, _ = explained([case, output], [hand], {}, {"output": "hand"}, BASE)
    assert kept["output"].status is AnchorStatus.ATTACHED
    assert (kept["case"].status, kept["case"].reason) == (
        AnchorStatus.OCCLUDED,
        "output stands in front of it.",
    )


def test_a_carried_position_follows_in_metres_and_in_the_image():
    plug = anchor("plug", position=(0.0, 0.0, 0.0))
    hand = anchor("hand", position=(0.0, 0.0, 0.2))
    move = {"hand": Move(99.0, 99.0, (0.1, 0.0, 0.0))}
    kept, _ = explained([plug], [hand], move, {"plug": "hand"}, BASE)
    assert kept["plug"].position == (0.1, 0.0, 0.0)
    assert kept["plug"].box == pytest.approx((345, 215, 395, 265))


def test_a_position_is_forgotten_where_the_way_is_not_known():
    plug = anchor("plug", position=(0.0, 0.0, 0.0))
    move = {"hand": Move(3.0, 0.0, None)}
    kept, _ = explained([plug], [anchor("hand")], move, {"plug": "hand"})
    assert (kept["plug"].position, kept["plug"].box[0]) == (None, 103)


def test_the_way_between_two_places():
    old = anchor("a", position=(0.0, 0.0, 0.0))
    new = anchor("a", 103, 98, position=(0.1, 0.0, -0.2))
    assert move_between(old, new) == Move(3.0, -2.0, (0.1, 0.0, -0.2))
    assert move_between(old, anchor("a")).offset is None


spots = st.integers(0, 12).map(lambda step: step * 15.0 + 20)
things = st.lists(st.tuples(spots, spots, st.integers(0, 10)), max_size=7)


@given(things, things, st.dictionaries(st.integers(0, 6), st.integers(0, 13), max_size=5))
def test_every_lost_anchor_is_kept_or_dropped_and_order_does_not_matter(lost, seen, links):
    hidden = [anchor(f"h{i}", x, y, confidence=c / 10) for i, (x, y, c) in enumerate(lost)]
    shown = [anchor(f"s{i}", x, y) for i, (x, y, _) in enumerate(seen)]
    names = [*(thing.name for thing in shown), *(thing.name for thing in hidden)]
    parents = {
        f"h{child}": names[index]
        for child, index in links.items()
        if index < len(names) and (names[index] < f"h{child}" or names[index][0] == "s")
    }
    kept, dropped = explained(hidden, shown, {}, parents)
    assert sorted([*kept, *(thing.name for thing in dropped)]) == [h.name for h in hidden]
    assert explained(hidden[::-1], shown, {}, parents) == (kept, dropped)
    for thing in kept.values():
        assert 0 <= thing.confidence <= 1
        assert thing.reason.endswith(".")
        assert (thing.parent is not None) == (thing.status is AnchorStatus.ATTACHED)
        if thing.status is AnchorStatus.ATTACHED:
            assert thing.parent == parents[thing.name]
            assert thing.parent in {*kept, *names[: len(shown)]}
