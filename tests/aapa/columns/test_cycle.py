"""By columns comes out what comes out object by object, to the last bit."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest

from aapa import (
    Anchoring,
    AnchoringError,
    AnchoringParameters,
    AnchoringState,
    AnchorStatus,
    Detection,
    DetectionColumns,
    anchoring,
)
from aapa.columns import cycle


def stream(seed, count, types=1, noise=6.0, raster=0.0, frames=9):
    """Objects one to 60 x 60 px; a tenth is missed, as many detections are of nothing."""
    chance = np.random.default_rng(seed)
    side = 60 * math.sqrt(count)
    places, sizes = chance.uniform(0, side, (count, 2)), chance.uniform(4, 40, (count, 2))
    kinds = chance.integers(0, types, count)
    for number in range(frames):
        if number % 3:  # at rest in every third frame
            places = places + chance.normal(0, noise, places.shape)
        kept = chance.random(count) > 0.1
        new = int((~kept).sum())
        centres = np.concatenate([places[kept], chance.uniform(-40, side + 40, (new, 2))])
        halves = np.concatenate([sizes[kept], chance.uniform(4, 40, (new, 2))]) / 2
        classes = np.concatenate([kinds[kept], chance.integers(0, types, new)])
        boxes = np.concatenate([centres - halves, centres + halves], axis=1)
        if raster:
            boxes = np.round(boxes / raster) * raster
        scores = np.round(chance.uniform(0.2, 1, count), 3)
        order = chance.permutation(count)
        if number == 6:
            order = order[:5]  # too few for columns
        yield [
            Detection(f"t{classes[n]}", tuple(boxes[n].tolist()), scores[n].item()) for n in order
        ]


def as_columns(frame):
    return DetectionColumns(
        [d.type for d in frame], [d.box for d in frame], [d.score for d in frame]
    )


def told(parameters, frames, links, way):
    """All that is said about a stream, as text: -0.0 and 0.0, 1 and 1.0 differ."""
    tracker = Anchoring(parameters)
    said = []
    for number, frame in enumerate(frames):
        attachments = links(number, tracker) if links else ()
        if way == "columns" or (way == "mixed" and number % 3 == 1):
            reported = tuple(tracker.update_columns(as_columns(frame), attachments))
        else:
            reported = tracker.update(frame, attachments)
        said.append(repr((reported, tracker.frame, tracker.state)))
    return said


def chains(number, tracker):
    """Attachments of anchors, seen and lost, in every other frame."""
    if number < 3 or number % 2:
        return ()
    names = [anchor.name for anchor in tracker.anchors]
    random.Random(number).shuffle(names)
    return [*zip(names[:30:2], names[1:30:2], strict=False), (names[1], names[31])]


@pytest.mark.parametrize(
    ("scene", "settings", "links"),
    [
        ({}, {"tau": 3000.0}, None),
        ({"noise": 25.0}, {"image_size": (930, 930)}, None),
        ({"types": 5, "noise": 20.0}, {"initial_confidence": 0.35}, chains),
        ({"raster": 10.0, "types": 2}, {"min_report_confidence": 0.3}, None),
        ({"noise": 0.0}, {"image_size": (800, 700), "margin_px": 0.0}, chains),
        ({"types": 3}, {"unique_types": frozenset({"t0"}), "confidence_loss": 0.45}, None),
        ({}, {"unique_types": frozenset({"t0"}), "reunite_after": 2}, None),
        ({}, {"initial_confidence": 1, "confidence_loss": 1}, None),
        ({"types": 240}, {}, None),
        ({}, {"position_gain": 0.5}, None),
        ({}, {"use_attachments": False}, chains),
    ],
)
def test_a_stream_is_told_as_it_is_object_by_object(monkeypatch, scene, settings, links):
    frames = list(stream(3, 240, **scene))
    parameters = AnchoringParameters(**settings)
    found = [told(parameters, frames, links, way) for way in ("objects", "columns", "mixed")]
    monkeypatch.setattr(anchoring, "are_many", lambda *_: False)
    expected = told(parameters, frames, links, "objects")
    assert found == [expected] * 3
    assert all(status in "".join(expected) for status in ("visible", "missing"))


def test_a_crowd_goes_by_columns(monkeypatch):
    called = []
    real = cycle.Sighted.reasoned
    monkeypatch.setattr(cycle.Sighted, "reasoned", lambda s: (called.append(1), real(s))[1])
    tracker = Anchoring()
    for frame in stream(1, 200, frames=4):
        tracker.update(frame)
    assert called == [1, 1, 1]  # all but the first, when there was nothing yet
    assert len(tracker.state.columns) == len(tracker.anchors) > 200


def test_one_can_go_on_from_anchors_that_were_written_down():
    frames = list(stream(2, 200))
    first, second = Anchoring(), Anchoring()
    for frame in frames[:4]:
        first.update(frame)
    second.state = AnchoringState.of(first.anchors, first.frame)
    second.update_columns(as_columns(frames[4]))
    first.update(frames[4])
    assert second.anchors == first.anchors
    assert second.frame == 5


@pytest.mark.parametrize("wrong", ["inverted", "nan", "far", "score", "type"])
def test_a_malformed_detection_is_named_and_the_state_stays(wrong):
    first, frame, *_ = stream(4, 200)
    good = as_columns(frame)
    boxes, scores, types = good.boxes.copy(), good.scores.copy(), list(good.types)
    if wrong == "inverted":
        boxes[6] = (9, 9, 5, 12)
    elif wrong == "nan":
        boxes[6, 2] = math.nan
    elif wrong == "far":
        boxes[6, 2] = 1e12
    elif wrong == "score":
        scores[6] = 1.5
    else:
        types[6] = ""
    tracker = Anchoring()
    tracker.update(first)
    tracker.update_columns(good)
    before = tracker.anchors
    with pytest.raises(AnchoringError, match="detection 7 "):
        tracker.update_columns(DetectionColumns(types, boxes, scores))
    assert (tracker.anchors, tracker.frame) == (before, 2)
    with pytest.raises(AnchoringError, match="is attached to both"):
        tracker.update_columns(good, [("a", "b"), ("a", "c")])
    assert (tracker.anchors, tracker.frame) == (before, 2)


def test_the_order_of_detections_does_not_matter():
    first, second, *_ = stream(5, 200, types=2, raster=10.0)
    straight, shuffled = Anchoring(), Anchoring()
    straight.update(first)
    shuffled.update(first)
    known = {anchor.name for anchor in straight.anchors}
    results = []
    for tracker, frame in ((straight, second), (shuffled, random.Random(1).sample(second, 200))):
        columns = tracker.update_columns(as_columns(frame))
        results.append([anchor for anchor in columns if anchor.name in known])
    assert results[0] == results[1]
    assert len(results[0]) > 170


def test_nothing_is_made_before_it_is_read(monkeypatch):
    frames = list(stream(6, 200))
    tracker, plain = Anchoring(), Anchoring()
    tracker.update(frames[0])
    plain.update(frames[0])
    with monkeypatch.context() as patch:
        patch.setattr("aapa.columns.anchors.anchors_of", None)  # would fail if it were asked
        for frame in frames[1:6]:
            columns = tracker.update_columns(as_columns(frame))
            plain_columns = columns.boxes, columns.confidences, columns.statuses
    for frame in frames[1:6]:
        anchors = plain.update(frame)
    assert [tuple(box) for box in plain_columns[0].tolist()] == [a.box for a in anchors]
    assert plain_columns[1].tolist() == [a.confidence for a in anchors]
    assert columns[-1] == anchors[-1]
    assert [tuple(AnchorStatus)[n] for n in plain_columns[2]] == [a.status for a in anchors]
