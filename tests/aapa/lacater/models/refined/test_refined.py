"""`aapa-refined`: what it adds is bounded, causal, and nothing at all where nothing was learned."""

from __future__ import annotations

from dataclasses import fields, replace
from functools import cache

import numpy as np
import pytest

from aapa.lacater.classes import SNITCH
from aapa.lacater.generator import DetectorNoise
from aapa.lacater.generator.video import generate_video
from aapa.lacater.layout import PerceptionKind
from aapa.lacater.metric import first_sighting, score_video
from aapa.lacater.models import Frame, model_named
from aapa.lacater.models.plus import BeyondAapa, Ideas
from aapa.lacater.models.refined import Refined, shipped_weights
from aapa.lacater.models.refined.evidence import WIDTH_OF_EVIDENCE, Evidence
from aapa.lacater.models.refined.recurrent import Weights
from aapa.lacater.models.refined.tracker import MOST_PX, corrected
from icarus_lite import load_domain
from runtime.cater.attachments import AttachmentEngine, timed_actions
from runtime.cater.evaluate import cater_domain
from runtime.cater.evaluation import cast_of, frames_of, run_model

KINDS = (PerceptionKind.PP, PerceptionKind.OD)


@cache
def video(number, kind):
    made = generate_video(78, number, DetectorNoise())
    engine = AttachmentEngine(load_domain(cater_domain()))
    reports = engine.reports(timed_actions(made.video.scene), 300)
    perception = made.perceptions[kind]
    return made.video, cast_of(made.video.scene), frames_of(perception, reports), perception


def nothing_learned():
    learned = shipped_weights()
    return Weights(*(np.zeros_like(getattr(learned, field.name)) for field in fields(Weights)))


def always(offset):
    return replace(nothing_learned(), out_bias=np.full(4, offset))


def boxes(tracker, frames):
    return [tracker.observe(frame) for frame in frames]


@pytest.mark.parametrize("kind", KINDS)
def test_without_anything_learned_it_is_aapa_plus(kind):
    _, cast, frames, _ = video(0, kind)
    plain = boxes(Refined(Ideas(), nothing_learned(), cast), frames)
    assert plain == boxes(BeyondAapa(Ideas(), cast), frames)


def test_no_edge_is_moved_by_more_than_the_bound():
    _, cast, frames, _ = video(1, PerceptionKind.OD)
    plain = np.array(boxes(Refined(Ideas(), nothing_learned(), cast), frames)[60:])
    wild = np.array(boxes(Refined(Ideas(), always(1e6), cast), frames)[60:])
    assert abs(wild - plain).max() <= MOST_PX + 1  # and rounding, of corner and side


@pytest.mark.parametrize(
    ("box", "offs", "answer"),
    [
        ((10.0, 10.0, 20.0, 20.0), [0.6, 0.0, 0.6, 0.0], (11, 10, 21, 20)),
        ((1.0, 1.0, 20.0, 20.0), [-4.0, -4.0, 0.0, 0.0], (0, 0, 20, 20)),
        ((310.0, 230.0, 319.0, 239.0), [0.0, 0.0, 4.0, 4.0], (310, 230, 320, 240)),
        ((10.0, 10.0, 12.0, 12.0), [4.0, 4.0, -4.0, -4.0], (14, 14, 14, 14)),
    ],
)
def test_a_corrected_box_is_a_box_within_the_picture(box, offs, answer):
    assert corrected(box, offs) == answer


@pytest.mark.parametrize("kind", KINDS)
def test_later_frames_change_nothing(kind):
    _, cast, frames, _ = video(2, kind)
    at = 150
    nothing = np.zeros((0, 4), dtype=np.int64), np.zeros(0, dtype=np.int64)
    changed = [*frames[:at], *(Frame(f.number, *nothing) for f in frames[at:])]
    whole = boxes(Refined(Ideas(), shipped_weights(), cast), frames)
    assert boxes(Refined(Ideas(), shipped_weights(), cast), changed)[:at] == whole[:at]


def test_two_videos_do_not_share_a_memory():
    _, cast, frames, _ = video(2, PerceptionKind.OD)
    model = model_named("aapa-refined")
    alone = run_model(model, frames, cast)
    other_cast, other = video(3, PerceptionKind.OD)[1:3]
    run_model(model, other, other_cast)
    np.testing.assert_array_equal(run_model(model, frames, cast), alone)


def test_evidence_is_finite_and_moderate():
    for kind in KINDS:
        for number in range(2):
            _, cast, frames, _ = video(number, kind)
            tracker, evidence = BeyondAapa(Ideas(), cast), Evidence()
            for frame in frames:
                tracker.observe(frame)
                insight = tracker.insight
                if insight.box is None:
                    continue
                numbers = evidence.numbers(insight, frame.number)
                assert numbers.shape == (WIDTH_OF_EVIDENCE,)
                assert np.isfinite(numbers).all()
                assert abs(numbers).max() < 10


def test_before_the_snitch_was_seen_there_is_no_box():
    tracker = Refined(Ideas(), shipped_weights(), {"Spl_0": SNITCH})
    nothing = np.zeros((0, 4), dtype=np.int64), np.zeros(0, dtype=np.int64)
    assert tracker.observe(Frame(0, *nothing)) is None


def test_with_the_detector_it_is_better_than_aapa_plus_on_videos_it_never_saw():
    gains = []
    for number in range(9):
        film, cast, frames, perception = video(number, PerceptionKind.OD)
        start = first_sighting(perception)
        if start is None:
            continue
        true = film.labels.snitch.astype(float)
        plus, refined = (
            score_video(run_model(model_named(name), frames, cast), true, film.masks, start)
            for name in ("aapa-plus", "aapa-refined")
        )
        gains.append(refined.miou["overall"] - plus.miou["overall"])
    assert len(gains) > 6
    assert np.mean(gains) > 0.005
