"""A lost crowd is reasoned about as its objects are, one by one."""

from __future__ import annotations

import numpy as np
import pytest

from aapa import Anchor, AnchoringParameters, AnchorStatus
from aapa.columns.anchors import objects
from aapa.columns.lost import Lost, explained
from aapa.hypotheses import explain
from aapa.view import View


def crowd(seed, count, prefix):
    """Boxes of any size, some without area, within and around an image."""
    chance = np.random.default_rng(seed)
    corners = np.round(chance.uniform(-60, 320, (count, 2)))
    sizes = np.round(chance.uniform(0, 40, (count, 2)) - 4).clip(0)
    boxes = np.concatenate([corners, corners + sizes], axis=1)
    return [
        Anchor(
            f"{prefix}-{n:03}",
            "x",
            tuple(box),
            AnchorStatus.VISIBLE,
            confidence=round(confidence, 1),
            streak=streak,
        )
        for n, (box, confidence, streak) in enumerate(
            zip(
                boxes.tolist(),
                chance.uniform(0, 1, count).tolist(),
                chance.integers(-3, 4, count).tolist(),
                strict=True,
            )
        )
    ]


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("size", [None, (300, 240)])
@pytest.mark.parametrize("counts", [(60, 90), (60, 0), (1, 40), (90, 6)])
def test_every_lost_anchor_ends_as_it_does_alone(seed, size, counts):
    lost, seen = crowd(seed, counts[0], "lost"), crowd(seed + 50, counts[1], "seen")
    view = View(AnchoringParameters(image_size=size))
    alone = explain(lost, seen, {}, {}, view)
    columns = Lost(
        objects([a.name for a in lost]),
        np.array([a.box for a in lost]),
        np.array([a.confidence for a in lost]),
        np.array([a.streak for a in lost]),
    )
    front = np.array([a.box for a in seen]).reshape(-1, 4)
    result = explained(columns, (objects([a.name for a in seen]), front), view)
    kept = result.confidences >= 0
    assert [a.name for a in alone.kept] == columns.names[kept].tolist()
    assert [a.name for a in alone.dropped] == columns.names[~kept].tolist()
    assert [a.confidence for a in alone.kept] == result.confidences[kept].tolist()
    assert [a.streak for a in alone.kept] == result.streaks[kept].tolist()
    hidden = [
        None if a.status is not AnchorStatus.OCCLUDED else a.reason.split()[0] for a in alone.kept
    ]
    assert hidden == result.occluders[kept].tolist()
