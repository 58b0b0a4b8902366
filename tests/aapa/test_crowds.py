"""A crowd is aligned as its objects would be one by one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from aapa import Anchoring, AnchoringParameters, Detection, anchoring, who
from aapa.anchors import Anchor, AnchorStatus
from aapa.crowds import align_crowd


def crowd(seed, count, types=1, size=None):
    """Detections of objects scattered over a square, one to 60 x 60 px."""
    chance = np.random.default_rng(seed)
    corners = chance.uniform(0, size or 60 * count**0.5, (count, 2))
    return [
        Detection(f"t{n % types}", (x, y, x + 18.0, y + 12.0), 0.5, (x / 100, y / 100, 0.4))
        for n, (x, y) in enumerate(corners.tolist())
    ]


def moved(detections, seed, spread=6.0):
    chance = np.random.default_rng(seed)
    found = []
    for detection, (dx, dy) in zip(
        detections, chance.normal(0, spread, (len(detections), 2)).tolist(), strict=True
    ):
        x1, y1, x2, y2 = detection.box
        x, y, z = detection.position
        box = (x1 + dx, y1 + dy, x2 + dx, y2 + dy)
        found.append(replace(detection, box=box, position=(x + dx / 100, y + dy / 100, z)))
    return found


def as_anchors(detections):
    return [
        Anchor(f"{n:04}", d.type, d.box, AnchorStatus.VISIBLE, None, 1.0, d.position)
        for n, d in enumerate(detections)
    ]


@pytest.mark.parametrize(("space", "tau"), [("image", 3000.0), ("base", 0.3)])
@pytest.mark.parametrize("types", [1, 5])
def test_a_stream_is_anchored_as_it_is_without_columns_of_numbers(monkeypatch, space, tau, types):
    first = crowd(1, 240, types)
    frames = [first]
    for number in range(2, 6):
        later = moved(frames[-1], number)
        frames.append(
            [d for n, d in enumerate(later) if n % 19 != number] + crowd(number, 6, types)
        )
    parameters = AnchoringParameters(tau=tau, space=space)
    # Object by object all the same, of which only the alignment goes by columns of numbers.
    monkeypatch.setattr(anchoring, "are_many", lambda *_: False)
    results = []
    for many in (True, False):
        monkeypatch.setattr(who, "are_many", lambda old, _, many=many: many and old)
        tracker = Anchoring(parameters)
        results.append([tracker.update(frame) for frame in frames])
    assert results[0] == results[1]
    assert len(results[0][-1]) > 200


def test_every_object_occurs_exactly_once():
    old, new = crowd(1, 200), moved(crowd(1, 200), 2)[:190] + crowd(3, 8)
    anchors = as_anchors(old)
    found = align_crowd(anchors, new, 3000.0, "image")
    pairs = list(found.pairs)
    names = [anchor.name for anchor, _, _ in pairs]
    assert names == sorted(names)
    assert sorted(names + [anchor.name for anchor in found.lost]) == [a.name for a in anchors]
    assert sorted(map(id, [*(d for _, d, _ in pairs), *found.appeared])) == sorted(map(id, new))
    for anchor, detection, squared in pairs:
        offsets = np.array(anchor.box) - np.array(detection.box)
        centre = (offsets[:2] + offsets[2:]) / 2
        assert squared == pytest.approx((centre**2).sum())
        assert squared <= 3000


@pytest.mark.parametrize("whole", [False, True])
def test_the_detector_s_order_does_not_matter(whole):
    old, new = crowd(1, 200, 2), moved(crowd(1, 200, 2), 2, 25.0)
    if whole:  # with ties
        new = [replace(d, box=tuple(float(round(x / 20) * 20) for x in d.box)) for d in new]
        old = [replace(d, box=tuple(float(round(x / 20) * 20) for x in d.box)) for d in old]
    anchors = as_anchors(old)
    order = np.random.default_rng(0).permutation(200).tolist()
    straight = align_crowd(anchors, new, 3000.0, "image")
    shuffled = align_crowd(anchors, [new[n] for n in order], 3000.0, "image")
    assert [(a.name, d.box, s) for a, d, s in straight.pairs] == [
        (a.name, d.box, s) for a, d, s in shuffled.pairs
    ]
    assert [a.name for a in straight.lost] == [a.name for a in shuffled.lost]


def test_objects_all_in_one_spot_are_told_from_none():
    spot = [Detection("ball", (5.0, 5.0, 9.0, 9.0))] * 200
    found = align_crowd(as_anchors(spot), spot[:160], 100.0, "image")
    assert len(list(found.pairs)) == 160
    assert len(found.lost) == 40
    assert found.appeared == []
