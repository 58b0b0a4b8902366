"""PA and AAPA on short films made by hand."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from aapa import AnchoringError, Attachment
from aapa.lacater.models import Frame, model_named

SNITCH, CONE = 140, 48
CAST = {"Spl_0": SNITCH, "Cone_0": CONE}
BOUND = (Attachment("Spl_0", "Cone_0"),)


def frame(number, seen, attachments=()):
    boxes = np.array([box for _, box in seen], dtype=np.int64).reshape(-1, 4)
    return Frame(number, boxes, np.array([c for c, _ in seen], dtype=np.int64), (), attachments)


def follow(name, frames, cast=None):
    tracker = model_named(name).start(CAST if cast is None else cast)
    return [tracker.observe(f) for f in frames]


def moved(box, dx, dy=0):
    return box[0] + dx, box[1] + dy, box[2] + dx, box[3] + dy


def hidden_and_carried(last):
    """The snitch in view for five frames, then under a cone that slides by 3 px a frame."""
    snitch, cone = (100, 100, 120, 120), (90, 70, 130, 125)
    frames = [frame(n, [(SNITCH, snitch), (CONE, moved(cone, 60))]) for n in range(5)]
    frames.append(frame(5, [(CONE, cone)]))
    frames += [frame(5 + n, [(CONE, moved(cone, 3 * n))], BOUND) for n in range(1, last + 1)]
    return frames


def test_with_attachments_the_snitch_goes_with_the_cone():
    answers = follow("aapa-6500", hidden_and_carried(8))
    assert answers[4] == answers[5] == (100, 100, 120, 120)
    assert answers[-1] == (124, 100, 144, 120)


def test_without_attachments_it_stays():
    assert follow("pa-6500", hidden_and_carried(8))[-1] == (100, 100, 120, 120)


def test_what_is_beyond_the_radius_is_not_believed_at_once():
    at, leap = (100, 100, 120, 120), (160, 100, 180, 120)
    frames = [frame(n, [(SNITCH, at)]) for n in range(12)]
    frames += [frame(12 + n, [(SNITCH, leap)]) for n in range(12)]
    # 60 px: within the radius of 80.6 px, beyond that of 54.8.
    assert follow("aapa-6500", frames)[12] == leap
    answers = follow("aapa-3000", frames)
    assert answers[12] == at
    assert answers[-1] == leap


def test_the_last_box_is_held_when_the_anchor_has_been_given_up():
    at = (100, 100, 120, 120)
    frames = [frame(n, [(SNITCH, at)] if n < 3 else []) for n in range(30)]
    assert follow("aapa-6500", frames) == [at] * 30


def test_a_twin_cone_is_told_by_where_it_stands():
    # Two cones of one class; the second stands over the snitch.
    snitch, here, there = (100, 100, 120, 120), (90, 70, 130, 125), (200, 70, 240, 125)
    cast = {"Spl_0": SNITCH, "Cone_0": CONE, "Cone_1": CONE}
    frames = [frame(n, [(CONE, there), (SNITCH, snitch), (CONE, here)]) for n in range(5)]
    bound = (Attachment("Spl_0", "Cone_0"),)
    frames += [
        frame(5 + n, [(CONE, moved(there, n, 5)), (CONE, moved(here, 4 * n))], bound)
        for n in range(5)
    ]
    assert follow("aapa-6500", frames, cast)[-1] == moved(snitch, 16)


def test_who_is_who_is_asked_anew_when_something_new_is_attached():
    # In the first bond Cone_0 is the left one; in the second, after it was freed, the right one.
    snitch, left, right = (100, 100, 120, 120), (90, 70, 130, 125), (200, 70, 240, 125)
    cast = {"Spl_0": SNITCH, "Cone_0": CONE, "Cone_1": CONE}
    frames = [frame(n, [(SNITCH, snitch), (CONE, left), (CONE, right)]) for n in range(4)]
    bound = (Attachment("Spl_0", "Cone_0"),)
    frames += [frame(4 + n, [(CONE, left), (CONE, right)], bound) for n in range(2)]
    at_right = moved(snitch, 110)
    frames += [
        frame(6 + n, [(SNITCH, moved(snitch, 22 * (n + 1))), (CONE, left), (CONE, right)])
        for n in range(5)
    ]
    frames += [
        frame(11 + n, [(CONE, left), (CONE, moved(right, 0, 5 * n))], bound) for n in range(4)
    ]
    assert follow("aapa-6500", frames, cast)[-1] == moved(at_right, 0, 15)


def test_a_parent_that_is_not_anchored_carries_nothing():
    frames = hidden_and_carried(8)
    unseen = [
        Frame(
            f.number,
            f.boxes[f.classes == SNITCH],
            f.classes[f.classes == SNITCH],
            (),
            f.attachments,
        )
        for f in frames
    ]
    assert follow("aapa-6500", unseen)[-1] == (100, 100, 120, 120)


def test_an_object_without_a_class_is_passed_over():
    bound = (Attachment("Spl_0", "Thing_7"),)
    frames = [frame(n, [(SNITCH, (10, 10, 20, 20))], bound) for n in range(4)]
    assert follow("aapa-6500", frames) == [(10, 10, 20, 20)] * 4


@pytest.mark.parametrize("name", ["last-seen", "heuristic", "pa-6500", "aapa-6500", "aapa-0.5"])
def test_a_model_has_the_name_it_was_asked_for(name):
    assert model_named(name).name == name


def test_the_radius_of_tau_is_reported():
    assert model_named("aapa-6500").parameters == {"tau_px2": 6500.0, "radius_px": 80.6}


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("aapa", "there is no model 'aapa'"),
        ("aapa-", "known are last-seen, heuristic, pa-TAU, aapa-TAU"),
        ("last-sen", "did you mean 'last-seen'"),
        ("aapa-0", "tau is 0.0; it has to be above 0"),
        ("aapa--5", "there is no model"),
        ("aapa-1e9", "there is no model"),
    ],
)
def test_an_unknown_model_is_refused_with_a_hint(name, text):
    with pytest.raises(AnchoringError, match=text):
        model_named(name)


def random_frames(seed, count):
    chance = np.random.default_rng(seed)
    places = chance.uniform(20, 200, (4, 2))
    classes = np.array([SNITCH, CONE, CONE, 156])
    frames = []
    for number in range(count):
        places += chance.normal(0, 4, places.shape)
        seen = chance.random(4) < 0.7
        boxes = np.concatenate([places, places + 25], axis=1).clip(0, 239).astype(np.int64)
        bound = (Attachment("Spl_0", "Cone_0"),) if number % 20 > 10 else ()
        frames.append(Frame(number, boxes[seen], classes[seen], (), bound))
    return frames


MODELS = ("last-seen", "heuristic", "pa-6500", "aapa-3000", "aapa-10000")


@pytest.mark.parametrize("name", MODELS)
@settings(max_examples=15)
@given(seed=st.integers(0, 2**32 - 1), cut=st.integers(1, 39))
def test_what_is_said_of_a_frame_does_not_depend_on_later_ones(name, seed, cut):
    cast = {**CAST, "Cone_1": CONE}
    frames, others = random_frames(seed, 40), random_frames(seed + 1, 40)
    said = follow(name, frames, cast)
    assert follow(name, frames[:cut] + others[cut:], cast)[:cut] == said[:cut]
    assert follow(name, frames[:cut], cast) == said[:cut]


@pytest.mark.parametrize("name", MODELS)
@settings(max_examples=15)
@given(seed=st.integers(0, 2**32 - 1))
def test_from_the_first_sighting_on_there_is_a_box_in_every_frame(name, seed):
    frames = random_frames(seed, 40)
    said = follow(name, frames)
    first = next(n for n, f in enumerate(frames) if SNITCH in f.classes)
    assert said[:first] == [None] * first
    for box in said[first:]:
        assert box is not None
        assert box[0] <= box[2]
        assert box[1] <= box[3]


@pytest.mark.parametrize("name", MODELS)
def test_two_trackers_of_one_model_do_not_know_of_each_other(name):
    model, frames = model_named(name), random_frames(5, 30)
    first, second = model.start(CAST), model.start(CAST)
    apart = follow(name, frames)
    together = [(first.observe(f), second.observe(f)) for f in frames]
    assert together == list(zip(apart, apart, strict=True))
